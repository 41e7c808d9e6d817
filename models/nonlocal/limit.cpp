#include "nonlocal/limit.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "nonlocal/equations.hpp"
#include "nonlocal/equilibrium.hpp"
#include "system/resolution.hpp"

namespace monograin::nonlocal {
namespace {

// Longest step along the path of states, in the unknowns and xi.
constexpr double k_longest_path_step = 0.05;

/// A point of the path: the unknowns, then xi.
using Point = Eigen::VectorXd;

std::span<const double> unknowns(const Point& point) {
  return {point.data(), static_cast<std::size_t>(point.size() - 1)};
}

double xi_of(const Point& point) { return point[point.size() - 1]; }

class Path {
 public:
  Path(Contacts& contacts, std::span<const Ramp> ramps) : contacts_(contacts), ramps_(ramps) {}

  /// Unit tangent of the path at a point, with a positive component along `direction`.
  [[nodiscard]] Point tangent(const Point& point, const Point& direction) {
    Point unit = Point::Zero(point.size());
    unit[point.size() - 1] = 1.0;
    return solve(point, direction, unit).normalized();
  }

  /// Point of the path in the plane normal to `tangent` at `distance` from `from`; none if Newton's method fails.
  [[nodiscard]] std::optional<Point> beyond(const Point& from, const Point& tangent, double distance) {
    Point point = from + distance * tangent;
    Point missing(point.size());
    double last = 0.0;
    for (int iteration = 0; iteration < k_most_newton_steps; ++iteration) {
      if (!(*std::max_element(point.begin(), point.begin() + static_cast<long>(contacts_.class_count())) <
            contacts_.law().end())) {
        return std::nullopt;
      }
      const auto count = static_cast<std::size_t>(point.size() - 1);
      residual(contacts_, ramps_, xi_of(point), unknowns(point), {missing.data(), count});
      missing[point.size() - 1] = tangent.dot(point - from) - distance;
      const Point step = solve(point, tangent, missing);
      point -= step;
      const double size = step.norm();
      if (size <= k_round_off * point.norm()) return point;
      if (iteration > 0 && size > 0.5 * last) {
        if (size <= 100.0 * k_round_off * point.norm()) return point;
        return std::nullopt;
      }
      last = size;
    }
    return std::nullopt;
  }

 private:
  /// Solves the equations' Jacobian bordered by one row, which keeps it regular where the path turns back. The
  /// least-norm solution leaves the centre in place along directions that no contact supports.
  [[nodiscard]] Point solve(const Point& point, const Point& border, const Point& right_side) {
    const Eigen::Index count = point.size() - 1;
    jacobian(contacts_, ramps_, unknowns(point), jacobian_);
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(count + 1, count + 1);
    matrix.topLeftCorner(count, count) = jacobian_;
    matrix.row(count) = border;
    for (std::size_t j = 0; j < ramps_.size(); ++j) {
      const auto i = static_cast<Eigen::Index>(j);
      const double slope = ramps_[j].rate();
      if (!ramps_[j].is_force_controlled() || slope == 0.0) {
        matrix(i, count) = -slope;
        continue;
      }
      const LocalContact contact = contacts_.law().at(point[i]);
      matrix(i, count) =
          -slope / (2.0 * contacts_.composite_modulus() * contact.contact_radius * contact.approach_slope);
    }
    return matrix.completeOrthogonalDecomposition().solve(right_side);
  }

  Contacts& contacts_;
  std::span<const Ramp> ramps_;
  Eigen::MatrixXd jacobian_;
};

}  // namespace

std::optional<double> limit_of_step(Contacts& contacts, std::span<const Ramp> ramps, double end, std::span<double> y) {
  EquilibriumSearch search(contacts);
  // Start away from first touch, where a contact under force control has an infinite rate.
  double xi = std::min(end, 1.0 / 64.0);
  for (;; xi *= 0.5) {
    try {
      search.solve(contacts, ramps, xi, y);
      break;
    } catch (const std::domain_error&) {
      if (xi < k_ahead) throw;
    }
  }

  Path path(contacts, ramps);
  Point point(static_cast<Eigen::Index>(y.size()) + 1);
  std::copy(y.begin(), y.end(), point.begin());
  point[point.size() - 1] = xi;
  Point direction = Point::Zero(point.size());
  direction[point.size() - 1] = 1.0;
  double length = k_longest_path_step;
  while (xi_of(point) < end) {
    direction = path.tangent(point, direction);
    const std::optional<Point> next = path.beyond(point, direction, length);
    if (!next) {
      length *= 0.5;
      if (length < k_ahead) {
        throw std::domain_error("the path of equilibria ends at xi = " + std::to_string(xi_of(point)) +
                                " with a margin of " + std::to_string(contacts.margin(unknowns(point))));
      }
      continue;
    }
    if (contacts.margin(unknowns(*next)) > 0.0) {
      point = *next;
      length = std::min(2.0 * length, k_longest_path_step);
      continue;
    }
    Point found = *next;
    const auto margin_at = [&](double distance) {
      found = path.beyond(point, direction, distance).value();
      return contacts.margin(unknowns(found));
    };
    std::uintmax_t iterations = 100;
    const auto [below, above] = boost::math::tools::toms748_solve(
        margin_at, 0.0, length, boost::math::tools::eps_tolerance<double>(), iterations);
    static_cast<void>(margin_at(0.5 * (below + above)));
    if (xi_of(found) > end) break;
    std::copy(found.begin(), found.end() - 1, y.begin());
    return xi_of(found);
  }
  search.solve(contacts, ramps, end, y);
  return std::nullopt;
}

}  // namespace monograin::nonlocal
