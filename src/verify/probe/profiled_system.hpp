/// Wrappers around a system: one that measures where its time goes, one that limits its time, and some that undo what
/// saves time.
#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <stdexcept>

#include "system/hybrid_system.hpp"

namespace monograin {

/// Time spent in a system's functions, without that of the clock itself.
struct SystemProfile {
  struct Share {
    double seconds = 0.0;
    long calls = 0;
  };
  Share law;        ///< right-hand sides, residuals, solutions, transitions
  Share guards;     ///< values of guards
  Share recording;  ///< observables
};

/// Wraps a system to measure the time spent in it.
/// @param profile  receives the times; must outlive the system
[[nodiscard]] std::unique_ptr<HybridSystem> profiled(std::unique_ptr<HybridSystem> system, SystemProfile& profile);

/// A system made by limited() has used up its time.
class OutOfTime : public std::runtime_error {
 public:
  OutOfTime() : std::runtime_error("out of time") {}
};

/// Time since an instant [s].
[[nodiscard]] double seconds_since(std::chrono::steady_clock::time_point start);

/// Processor time of this thread [s]; other load on the machine does not count.
[[nodiscard]] double thread_seconds();

/// Wraps a system so that its equations and guards throw OutOfTime from an instant on.
/// @param end  that instant, in thread_seconds()
[[nodiscard]] std::unique_ptr<HybridSystem> limited(std::unique_ptr<HybridSystem> system, double end);

/// Wraps a system so that it evaluates its observables with every evaluation of its equations. Shows what recording at
/// output points only saves.
[[nodiscard]] std::unique_ptr<HybridSystem> always_observed(std::unique_ptr<HybridSystem> system);

/// Wraps a system so that every step of the program is the first part of a longer one: guards that can only fire after
/// the step's end are then evaluated, too. A factor of 10, compared with 1 (which changes nothing), shows what leaving
/// out such guards saves.
/// @param factor  length of the longer step over that of the step, >= 1
[[nodiscard]] std::unique_ptr<HybridSystem> sampling_beyond(std::unique_ptr<HybridSystem> system, double factor);

/// Wraps a system so that its differential unknowns are disturbed at the beginning of every step of the program, and
/// where they are observed. Shows how the system carries errors on, and how they appear in the history.
/// @param shares  relative changes of every second unknown and of the others; of equal or opposite sign
[[nodiscard]] std::unique_ptr<HybridSystem> disturbed(std::unique_ptr<HybridSystem> system,
                                                      const std::array<double, 2>& shares);

/// Wraps a system so that its work has no closed form. Shows what closed forms save.
[[nodiscard]] std::unique_ptr<HybridSystem> always_integrated(std::unique_ptr<HybridSystem> system);

}  // namespace monograin
