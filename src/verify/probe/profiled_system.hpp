/// A system that tells where the time goes, one that has no more than so much, and some that waste it.
#pragma once

#include <array>
#include <memory>
#include <stdexcept>

#include "system/hybrid_system.hpp"

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

/// The time that a system has is up.
class OutOfTime : public std::runtime_error {
 public:
  OutOfTime() : std::runtime_error("out of time") {}
};

/// For how long this thread has had a processor [s]; what else the machine does takes none of it.
[[nodiscard]] double thread_seconds();

/// The same system, whose equations and guards throw OutOfTime from an instant on.
/// @param end  in thread_seconds()
[[nodiscard]] std::unique_ptr<HybridSystem> limited(std::unique_ptr<HybridSystem> system, double end);

/// The same system, which evaluates its observables wherever it evaluates its equations: what recording at output
/// points only is measured against.
[[nodiscard]] std::unique_ptr<HybridSystem> always_observed(std::unique_ptr<HybridSystem> system);

/// The same system, to which every step of the program is the first part of one that many times as long: it watches
/// what could happen after the step's end as well. With a factor of 10 what leaving out guards that cannot fire before
/// the end of a step is measured against; with one of 1 the same system.
/// @param factor  >= 1
[[nodiscard]] std::unique_ptr<HybridSystem> looking_beyond(std::unique_ptr<HybridSystem> system, double factor);

/// The same system, whose integrated unknowns are changed by a share of themselves wherever a step of the program
/// begins, and where they are shown: what its rates make of errors, and what is seen of them.
/// @param shares  of the unknowns in turn: errors of several may be alike, or against each other
[[nodiscard]] std::unique_ptr<HybridSystem> disturbed(std::unique_ptr<HybridSystem> system,
                                                      const std::array<double, 2>& shares);

/// The same system, without closed forms of its work: what they save is measured against it.
[[nodiscard]] std::unique_ptr<HybridSystem> always_integrated(std::unique_ptr<HybridSystem> system);

}  // namespace monograin
