/// A system that tells where the time goes, and one that wastes it.
#pragma once

#include <memory>

#include "hybrid_system.hpp"

namespace monograin {

/// Time spent in a system, by what it was asked for, less what the clock itself takes.
struct SystemProfile {
  struct Share {
    double seconds = 0.0;
    long calls = 0;
  };
  Share law;        ///< right-hand sides, residuals, solutions, transitions
  Share guards;     ///< their values
  Share recording;  ///< observables
};

/// The same system, timed.
/// @param profile  outlives the system
[[nodiscard]] std::unique_ptr<HybridSystem> profiled(std::unique_ptr<HybridSystem> system, SystemProfile& profile);

/// The same system, which evaluates its observables wherever it evaluates its equations: what recording at output
/// points only is measured against.
[[nodiscard]] std::unique_ptr<HybridSystem> always_observed(std::unique_ptr<HybridSystem> system);

}  // namespace monograin
