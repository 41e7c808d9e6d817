/// Derivatives of residuals by differences.
#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Core>

#include "numerics/least_squares.hpp"

namespace monograin {

/// The step of central differences in a parameter: truncation, the square of it, and rounding, noise over it, are alike
/// where the residuals change on the scale of the parameter, or of its range where that is less.
[[nodiscard]] double difference_step(const LeastSquaresProblem& problem, std::span<const double> parameters,
                                     std::size_t k);

/// Derivatives of the residuals with respect to the parameters [residual / parameter], by central differences,
/// one-sided at a bound and where one side has no residuals. Where a residual jumps within the step, the difference is
/// that to the side without the jump: a law may jump, as a force does at yield, and a fit end where the jump stands at
/// a datum.
/// @return one row for each residual; zeros where there are no residuals at the parameters
[[nodiscard]] Eigen::MatrixXd residual_jacobian(const LeastSquaresProblem& problem, std::span<const double> parameters);

}  // namespace monograin
