/// How much of a result's spread is due to which factor: Sobol indices and elementary effects.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "study/sweep/design.hpp"

namespace monograin {

/// A value with the ends of its bootstrap interval.
struct Estimate {
  double value = 0.0;
  double lower = 0.0;
  double upper = 0.0;
};

/// Shares of the variance of a result: of each factor by itself, and with all that it does together with others.
struct SobolIndices {
  std::vector<Estimate> first;
  std::vector<Estimate> total;
  std::size_t samples = 0;  ///< that count: all of whose points have a value
};

/// The estimates of Saltelli et al. (2010, table 2) for the first order and of Jansen (1999) for the total one; nan
/// where the result is the same at all points. Intervals are percentiles of 500 resamples of the samples.
/// @param results     at the points of saltelli_design; nan where there is none
/// @param confidence  level of the two-sided intervals, between 0 and 1
[[nodiscard]] SobolIndices sobol_indices(std::span<const double> results, std::size_t factors, double confidence);

/// Elementary effects, in units of the result over the whole range of the factor: a difference over the change of the
/// coordinate.
struct MorrisEffects {
  std::vector<Estimate> mean_size;  ///< mean of the absolute effects (mu*)
  std::vector<double> mean;         ///< mu
  std::vector<double> spread;       ///< standard deviation (sigma): it is large where the factor acts with others, or
                                    ///< not in proportion
  std::size_t samples = 0;          ///< trajectories that count: all of whose points have a value
};

/// Sources: Morris (1991); Campolongo, Cariboni, Saltelli (2007) for mu*.
/// @param design   of morris_design
/// @param results  at its points; nan where there is none
[[nodiscard]] MorrisEffects morris_effects(const Design& design, std::span<const double> results, double confidence);

}  // namespace monograin
