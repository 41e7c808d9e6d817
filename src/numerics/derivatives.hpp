/// Derivatives of residuals by differences.
#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Core>

#include "numerics/least_squares_problem.hpp"

namespace monograin {

/// Step of central differences in the k-th parameter, in its unit. Truncation (proportional to the square of the step)
/// and round-off (the noise over the step) are similar if the residuals change on the scale of the parameter, or of its
/// range if that is smaller.
[[nodiscard]] double difference_step(const LeastSquaresProblem& problem, std::span<const double> parameters,
                                     std::size_t k);

/// Derivatives of the residuals with respect to the parameters [residual / parameter], by central differences,
/// one-sided at a bound and where one side has no residuals. If a residual jumps within the step, the difference is
/// taken on the side without the jump. A law may jump, as a force does at yield, and a fit may end with the jump at a
/// datum.
/// @return one row for each residual; a column of nan where neither side has residuals; zeros if there are none at the
/// parameters
[[nodiscard]] Eigen::MatrixXd residual_jacobian(const LeastSquaresProblem& problem, std::span<const double> parameters);

}  // namespace monograin
