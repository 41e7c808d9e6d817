#include "cel/centre.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace monograin::cel {

Centre::Centre(std::span<const ContactClass> classes, bool is_free) : lines_(classes, is_free), shares_(lines_.size()) {
  for (std::size_t i = 0; i < classes.size(); ++i)
    weights_.push_back(classes[i].multiplicity() * lines_.share_on_line(i));
  choose_balance(std::vector<double>(classes.size()));
}

void Centre::choose_balance(std::span<const double> forces) {
  if (directions() == 0) return;
  balance_ = lines_.stiffest_directions([&](std::size_t line) {
    double largest = std::numeric_limits<double>::min();
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      if (lines_.line_of(i) == line) largest = std::max(largest, std::abs(weights_[i]) * forces[i]);
    }
    return largest;
  });
  // Keeps the orientation of the basis, because the sign of the equations' determinant says whether a state is stable.
  const Eigen::Index n = lines_.free_directions();
  if (balance_.topLeftCorner(n, n).determinant() < 0.0) balance_.col(n - 1) *= -1.0;
  for (std::size_t line = 0; line < lines_.size(); ++line) shares_[line] = lines_.components(balance_, line);
}

void Centre::follow(double xi, std::span<const std::optional<double>> speeds) {
  rest_ += (xi - since_) * velocity_;
  since_ = xi;
  // Least squares, by a spring at every wall.
  const auto sum_along = [&](std::size_t line, auto&& value) {
    double sum = 0.0;
    for (std::size_t i = 0; i < speeds.size(); ++i) {
      if (speeds[i] && lines_.line_of(i) == line) sum += weights_[i] * value(i);
    }
    return sum;
  };
  const auto stiffness = [&](std::size_t line) {
    return sum_along(line, [&](std::size_t i) { return lines_.share_on_line(i); });
  };
  const auto force = [&](std::size_t line) { return sum_along(line, [&](std::size_t i) { return *speeds[i]; }); };
  velocity_ = lines_.displacement_that_balances(lines_.stiffest_directions(stiffness), stiffness, force);
}

Eigen::Vector3d Centre::net_force(double xi, const Eigen::Vector3d& x, std::span<const double> forces) const {
  Eigen::Vector3d net = k_weak_spring * balance_.transpose() * stretch(xi, x);
  for (std::size_t line = 0; line < lines_.size(); ++line) {
    double push = 0.0;
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      if (lines_.line_of(i) == line) push += weights_[i] * forces[i];
    }
    net += push * shares_[line];
  }
  return net;
}

}  // namespace monograin::cel
