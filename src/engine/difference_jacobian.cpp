#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/stepper.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

// Increments of difference quotients: k_share_of_step keeps them well within the step for which they are meant,
// k_least_increment (over xi) well above the round-off of xi.
constexpr double k_share_of_step = 0.1;
constexpr double k_least_increment = 1e-14;
const double k_cubic_root = std::cbrt(k_epsilon);
constexpr double k_least_size = 1e-2;  // least size of an unknown, over its scale, that scales its increment

}  // namespace

void DifferenceJacobian::at(double xi, std::span<const double> z, double length, std::span<double> jacobian,
                            std::span<double> by_xi) {
  static const double k_root = std::sqrt(k_epsilon);
  const std::size_t n = z.size();
  std::ranges::copy(z, point_.begin());
  form_.rates(xi, point_, base_);
  std::ranges::fill(jacobian, 0.0);
  double largest_change = k_root;  // in the step; k_root if nothing moves
  for (const double rate : base_) largest_change = std::max(largest_change, std::abs(length * rate));
  for (std::size_t j = 0; j < n; ++j) {
    if (form_.is_quadrature(j)) continue;  // no rate depends on it
    const double size = std::abs(z[j]);
    // Just after first touch, the rates change over the overlap, which is much smaller than the other unknowns. Steps
    // are as short as that, so the change of the unknown in a step bounds the increment.
    const double change = base_[j] != 0.0 ? std::abs(length * base_[j]) : largest_change;
    const double wanted = std::max(std::min(k_share_of_step * change, k_cubic_root * std::max(size, k_least_size)),
                                   k_root * std::max(size, change));
    const double spacing = sample_beside(xi, j, wanted);
    for (std::size_t i = 0; i < n; ++i) jacobian[i * n + j] = (shifted_[i] - beyond_[i]) / spacing;
  }
  // A second-order quotient over a good part of the step. Next to a pole, round-off of xi leaves few digits of a
  // quotient over a much smaller part, and a first-order quotient over the whole step has a large relative error.
  const double onward = std::max(std::min(k_cubic_root, k_share_of_step * length), k_least_increment * xi);
  // Beyond xi = 1 another leg of the program begins: the quotient is taken backwards.
  const double increment = shift_within_domain(xi + 2.0 * onward > 1.0 ? -onward : onward, [&](double by) {
    form_.rates(xi + by, point_, shifted_);
    form_.rates(xi + 2.0 * by, point_, beyond_);
  });
  for (std::size_t i = 0; i < n; ++i) {
    by_xi[i] = (4.0 * (shifted_[i] - base_[i]) - (beyond_[i] - base_[i])) / (2.0 * increment);
  }
}

double DifferenceJacobian::sample_beside(double xi, std::size_t j, double wanted) {
  const double z = point_[j];
  const double increment = shift_within_domain(wanted, [&](double by) {
    point_[j] = z + by;
    form_.rates(xi, point_, shifted_);
  });
  const double change_up = form_.change_of_rates(base_, shifted_);
  double change_down = k_infinity;
  try {
    point_[j] = z - increment;
    form_.rates(xi, point_, beyond_);
    change_down = form_.change_of_rates(base_, beyond_);
  } catch (const std::domain_error&) {
  }
  point_[j] = z;
  if (std::max(change_up, change_down) <= k_jump) return 2.0 * increment;
  std::ranges::copy(base_, (change_up <= change_down ? beyond_ : shifted_).begin());
  return increment;
}

}  // namespace monograin
