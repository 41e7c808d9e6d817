/// Nonlinear least squares with few, bounded parameters: the global minimum, by many starts and a trust region.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "numerics/loss.hpp"

namespace monograin {

/// A parameter with finite bounds, lower < upper.
struct BoundedParameter {
  double lower = 0.0;
  double upper = 1.0;
  bool is_logarithmic = false;  ///< sought in its logarithm; lower > 0 then
  std::optional<double> start;  ///< a further place to begin at
};

struct LeastSquaresProblem {
  /// Residuals at some parameters, all finite; false where there are none.
  using Residuals = std::function<bool(std::span<const double> parameters, std::span<double> residuals)>;
  /// Told how much is done, from 0 to 1.
  using Progress = std::function<void(double done)>;

  std::vector<BoundedParameter> parameters;  ///< 1 to k_most_parameters
  std::size_t residual_count = 0;
  Residuals residuals;
  LossFunction loss;
  std::size_t plain_count = 0;  ///< of the last residuals, whose loss is their square: those of priors
  double noise = 1e-13;         ///< relative error of the residuals' model; sets the steps of differences
  Progress progress;            ///< may be empty
};

inline constexpr std::size_t k_most_parameters = 8;

/// The sum of rho of residuals, which is minimised.
[[nodiscard]] double cost_of(const LeastSquaresProblem& problem, std::span<const double> residuals) noexcept;

/// A minimum that a search has come to.
struct LocalMinimum {
  std::vector<double> parameters;
  double cost = 0.0;  ///< sum of rho
};

struct LeastSquaresSolution : LocalMinimum {
  enum class Bound { none, lower, upper };
  std::vector<Bound> bounds;         ///< at which each parameter sits
  std::vector<double> residuals;     ///< raw, without loss
  std::vector<LocalMinimum> minima;  ///< all that were polished and differ, the best first
  bool has_converged = false;
  long evaluations = 0;
  long failures = 0;  ///< evaluations without residuals
};

/// The global minimum: draws places of a Sobol sequence, which crowd at the faces of the box of bounds; lets GSL's
/// multifit_nlinear (Levenberg-Marquardt in a trust region) go downhill from the best of every slice of the box, with
/// derivatives that secants bring up to date (Broyden (1965)); and polishes the best of what that gives to the end,
/// with central differences. Bounds are kept by the transform u = sin(z)^2; a parameter that is driven into a bound is
/// set to it. Two parameters take about 250 evaluations.
///
/// Slices matter where parameters are correlated: the valley of low cost is then narrower than the draw is dense, and
/// the best place of all may lie in the wrong part of it.
/// @return nothing where no place that was drawn has residuals
[[nodiscard]] std::optional<LeastSquaresSolution> minimise(const LeastSquaresProblem& problem);

enum class Accuracy {
  full,  ///< parameters to the rounding of their residuals
  rough  ///< the cost to a small share of the noise; one-sided differences and secants alone, bounds kept but not
         ///< settled
};

/// The minimum downhill from the best of some places. @return nothing where none of them has residuals
[[nodiscard]] std::optional<LeastSquaresSolution> minimise_near(const LeastSquaresProblem& problem,
                                                                std::span<const LocalMinimum> starts,
                                                                Accuracy accuracy = Accuracy::full);

/// The problem in the other parameters, with the k-th held at a value; it refers to the given one.
[[nodiscard]] LeastSquaresProblem with_held(const LeastSquaresProblem& problem, std::size_t k, double value);

}  // namespace monograin
