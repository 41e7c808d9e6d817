/// What runs of one scene have to do with each other.
#pragma once

#include <string>
#include <vector>

#include "scenario/scenario.hpp"
#include "study/stress_rules.hpp"

namespace monograin {

/// What all runs of a scene may take a processor together [s]; usual are a few hundredths. A method of low order at a
/// fine tolerance takes its time for every step of a long program.
[[nodiscard]] double most_seconds_of(const Scenario& scenario);
/// The rule of that.
inline constexpr const char* k_time_rule = "time";

/// All that was found of one scene.
struct StressVerdict {
  std::string end;  ///< as of stated_end
  std::vector<Violation> violations;
  long runs = 0;                    ///< that were made to find it
  bool is_ill_conditioned = false;  ///< rounding of its data, or errors of the size of rtol, change it visibly
  bool is_cut_short = false;        ///< the scene itself is so slow that not all comparisons were made
};

/// Runs a scene, and others that must agree with it: by the reference form, slower, of a larger and stiffer particle,
/// with a step cut in two, and for elastic laws forth and back. Never throws for what a run does.
///
/// Agreement. The direct form is exact but for rounding, its work to a hundredth of rtol; a controlled integrator is to
/// be within k rtol of it, k = 100 (README: "the error of a curve stays below 100 rtol"). A scene can magnify errors by
/// itself, next to a fold or pull-off, on steep unloading branches, where the order of two events decides; what such a
/// scene does with data changed by rtol (by rounding, where two runs of the same form are compared) is measured, and
/// allowed.
///
/// @param seconds  of a processor that all runs have together; a scene that takes longer breaks the rule "time", unless
///                 its own run is so slow that the runs it would be compared with are no slower
[[nodiscard]] StressVerdict check_scene(const Scenario& scenario, double seconds);
/// Has as long as `most_seconds_of` says.
[[nodiscard]] StressVerdict check_scene(const Scenario& scenario);

}  // namespace monograin
