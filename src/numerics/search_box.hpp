/// The box of bounds of a least-squares problem, in coordinates that keep the bounds.
#pragma once

#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "numerics/least_squares_problem.hpp"

namespace monograin {

inline constexpr double k_no_cost = std::numeric_limits<double>::infinity();
/// The share sin(z)^2 takes every value from 0 to 1 once in 0 <= z <= k_end_of_z.
inline constexpr double k_end_of_z = std::numbers::pi / 2.0;

/// A point of the box. Each parameter is at the share sin(z)^2 of its range.
struct Place {
  std::vector<double> z;
  double cost = k_no_cost;
  bool has_converged = false;
};

/// The z in [0, k_end_of_z] with the share of a given z.
[[nodiscard]] double folded(double z);

/// Tells whether two points differ by less than `distance` in every z.
[[nodiscard]] bool is_near(std::span<const double> a, std::span<const double> b, double distance);

/// Evaluates the residuals of a problem at places of its box, and counts these evaluations.
class SearchBox {
 public:
  /// @param problem  must outlive the box
  explicit SearchBox(const LeastSquaresProblem& problem);

  [[nodiscard]] const LeastSquaresProblem& problem() const noexcept { return problem_; }
  [[nodiscard]] std::size_t size() const noexcept { return problem_.parameters.size(); }
  [[nodiscard]] std::vector<double> parameters_at(const Place& place) const;
  /// Share of the k-th parameter in its range.
  [[nodiscard]] double share(const Place& place, std::size_t k) const noexcept;
  /// Whether the k-th parameter is so near one of its bounds that it may belong there.
  [[nodiscard]] bool is_near_bound(const Place& place, std::size_t k) const noexcept;
  /// The z of a value of the k-th parameter; not at a bound, where the derivative with respect to z is zero.
  [[nodiscard]] double z_of(std::size_t k, double parameter) const;

  /// Computes sign(r) sqrt(rho(r)) of the residuals r, so that the sum of squares is the cost. The values at the last
  /// parameters are kept, because a descent may begin where the last one has ended.
  /// @return false if there are no residuals
  bool evaluate(const Place& place, std::span<double> values);
  /// @return k_no_cost if there are no residuals
  [[nodiscard]] double cost_at(const Place& place);
  /// Derivatives of these values with respect to each z, by differences: central, or one-sided where one side has no
  /// residuals or if central ones are not asked for. Zero where neither side has residuals.
  /// @param values  at the place
  [[nodiscard]] Eigen::MatrixXd derivatives(const Place& place, std::span<const double> values, bool is_central);
  /// The residuals themselves, without the loss.
  [[nodiscard]] std::vector<double> residuals_at(std::span<const double> parameters);

  /// A cost above those of all places so far, for a place without residuals.
  [[nodiscard]] double beyond_all_costs() const noexcept { return 2.0 * worst_cost_ + 1.0; }
  [[nodiscard]] long evaluations() const noexcept { return evaluations_; }
  [[nodiscard]] long failures() const noexcept { return failures_; }
  void count(long evaluations, long failures) noexcept;

 private:
  const LeastSquaresProblem& problem_;
  std::vector<double> residuals_;
  std::vector<double> last_parameters_;  ///< last parameters with residuals
  std::vector<double> last_values_;
  double worst_cost_ = 0.0;
  long evaluations_ = 0;
  long failures_ = 0;
};

}  // namespace monograin
