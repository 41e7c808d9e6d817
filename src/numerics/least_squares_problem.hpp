/// Residuals as a function of few, bounded parameters.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "numerics/loss.hpp"

namespace monograin {

/// A parameter with finite bounds, lower < upper.
struct BoundedParameter {
  double lower = 0.0;
  double upper = 1.0;
  bool is_logarithmic = false;  ///< the search uses its logarithm; needs lower > 0
  std::optional<double> start;  ///< additional starting value
};

/// Residuals as a function of parameters, with the loss that weighs them.
struct LeastSquaresProblem {
  /// Computes residuals, all finite, at some parameters; returns false if there are none.
  using Residuals = std::function<bool(std::span<const double> parameters, std::span<double> residuals)>;
  /// Receives the share of the search that is done, from 0 to 1.
  using Progress = std::function<void(double done)>;

  std::vector<BoundedParameter> parameters;  ///< 1 to k_most_parameters
  std::size_t residual_count = 0;
  Residuals residuals;
  LossFunction loss;
  std::size_t plain_count = 0;  ///< number of residuals of priors, which come last; their loss is their square
  double noise = 1e-13;         ///< relative error of the computed residuals; sets the steps of differences
  Progress progress;            ///< may be empty
};

inline constexpr std::size_t k_most_parameters = 8;

/// Sum of rho over all residuals: the quantity that is minimised.
[[nodiscard]] double cost_of(const LeastSquaresProblem& problem, std::span<const double> residuals) noexcept;

/// The problem with the k-th parameter held at a value; refers to `problem`, which must outlive it.
[[nodiscard]] LeastSquaresProblem with_held(const LeastSquaresProblem& problem, std::size_t k, double value);

}  // namespace monograin
