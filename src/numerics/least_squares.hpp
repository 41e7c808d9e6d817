/// Nonlinear least squares with few, bounded parameters: the global minimum, by many starts and a trust region.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "numerics/least_squares_problem.hpp"

namespace monograin {

/// A minimum that a search has found.
struct LocalMinimum {
  std::vector<double> parameters;
  double cost = 0.0;  ///< sum of rho
};

struct LeastSquaresSolution : LocalMinimum {
  enum class Bound { none, lower, upper };
  std::vector<Bound> bounds;         ///< bound at which each parameter is
  std::vector<double> residuals;     ///< residuals without the loss
  std::vector<LocalMinimum> minima;  ///< all different minima that were polished to the end, the best first
  bool has_converged = false;
  long evaluations = 0;
  long failures = 0;  ///< evaluations without residuals
};

/// Finds the global minimum. The search draws points of a Sobol sequence, which are densest at the faces of the box of
/// bounds. From the best point of every slice of the box, GSL's multifit_nlinear (Levenberg-Marquardt in a trust
/// region) goes downhill, with derivatives that secants update (Broyden (1965)). The best minima are polished to the
/// end, with central differences. The transform u = sin(z)^2 keeps the bounds; a parameter that is driven into a bound
/// is set to it. Two parameters take about 250 evaluations.
///
/// Slices matter if parameters are correlated: the valley of low cost is then narrower than the distance of the drawn
/// points, and the best point of all may lie in the wrong part of it.
/// @return nothing if no drawn point has residuals
[[nodiscard]] std::optional<LeastSquaresSolution> minimise(const LeastSquaresProblem& problem);

/// Accuracy of minimise_near().
enum class Accuracy {
  full,  ///< parameters to the round-off of their residuals
  rough  ///< cost to a small share of the noise: one-sided differences and secants only; a parameter near a bound is
         ///< not set to it
};

/// Finds the minimum downhill from given points: from the best few of them, with rough accuracy only from the best one.
/// @return nothing if none of the points has residuals
[[nodiscard]] std::optional<LeastSquaresSolution> minimise_near(const LeastSquaresProblem& problem,
                                                                std::span<const LocalMinimum> starts,
                                                                Accuracy accuracy = Accuracy::full);

}  // namespace monograin
