/// Sobol indices and elementary effects: how much of a result's spread each factor causes.
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

/// Shares of a result's variance: that of each factor by itself, and that of each factor with all its interactions.
struct SobolIndices {
  std::vector<Estimate> first;
  std::vector<Estimate> total;
  std::size_t samples = 0;  ///< samples that count, because all of their points have a value
};

/// Estimates the first order by Saltelli et al. (2010, table 2) and the total one by Jansen (1999); nan if the result
/// is equal at all points. Intervals are percentiles of 500 resamples of the samples.
/// @param results     at the points of saltelli_design; nan for a missing one
/// @param confidence  level of the two-sided intervals, between 0 and 1
[[nodiscard]] SobolIndices sobol_indices(std::span<const double> results, std::size_t factors, double confidence);

/// Elementary effects: differences of the result over the change of a factor's coordinate, in units of the result over
/// the factor's whole range.
struct MorrisEffects {
  std::vector<Estimate> mean_size;  ///< mean of the absolute effects (mu*)
  std::vector<double> mean;         ///< mu
  std::vector<double> spread;       ///< standard deviation (sigma): it is large where the factor acts with others, or
                                    ///< not in proportion
  std::size_t samples = 0;          ///< trajectories that count, because all of their points have a value
};

/// Sources: Morris (1991); Campolongo, Cariboni, Saltelli (2007) for mu*.
/// @param design   of morris_design
/// @param results  at its points; nan for a missing one
[[nodiscard]] MorrisEffects morris_effects(const Design& design, std::span<const double> results, double confidence);

}  // namespace monograin
