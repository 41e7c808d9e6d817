/// What runs of one scene have to do with each other.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "history/run.hpp"
#include "scenario/scenario.hpp"
#include "verify/stress/check/rules.hpp"

namespace monograin {

/// What all runs of a scene may take a processor together [s]; usual are a few hundredths. A method of low order at a
/// fine tolerance takes its time for every step of a long program.
[[nodiscard]] double most_seconds_of(const CheckedScenario& scenario);
/// The rule of that.
inline constexpr const char* k_time_rule = "time";

/// From a scenario to its run, with something around its system: run_scenario.
using RunMaker = std::function<Run(const CheckedScenario&, const SystemWrapper&)>;

/// How much is done to check a scene, and by what.
struct StressEffort {
  static constexpr std::uint64_t k_all_copies = ~std::uint64_t{0};
  /// Processor time [s] of all runs of a scene together; one that takes longer breaks the rule "time", unless its own
  /// run is so slow that the runs it would be compared with are no slower.
  double seconds = 0.0;
  /// Which copy of a complete scene is run, counted around; one that a limit has ended is held against all of them.
  std::uint64_t copies = k_all_copies;
  RunMaker make_run = run_scenario;
};

/// All that was found of one scene.
struct StressVerdict {
  std::string end;  ///< as of stated_end
  std::vector<Violation> violations;
  long runs = 0;                    ///< that were made to find it
  bool is_ill_conditioned = false;  ///< rounding of its data, or errors of the size of rtol, change it visibly
  bool is_cut_short = false;        ///< the scene itself is so slow that not all comparisons were made
};

/// Runs a scene, and others that must agree with it: by the reference form, slower, with a step cut in two, for elastic
/// laws forth and back; and its copies: of a larger and softer particle, with all walls turned, with walls in another
/// order, by another form of the equations. Never throws for what a run does.
///
/// Ends. A limit, or an integrator that gives up for a stated reason, is accepted where all copies end there too: at
/// the same limit, within what is tolerated of the time. An integrated form may give up where another form goes on.
///
/// Agreement. The direct form is exact but for rounding, its work to a hundredth of rtol; a controlled integrator is to
/// be within k rtol of it, k = 100 (docs/howto/integrators.md: "the error of a curve stays below 100 rtol"). A scene
/// can magnify errors by itself, next to a fold or pull-off, on steep unloading branches, where the order of two events
/// decides; what such a scene does with data changed by rtol (by rounding, where two runs of the same form are
/// compared) is measured, and allowed.
///
[[nodiscard]] StressVerdict check_scene(const CheckedScenario& scenario, const StressEffort& effort);
/// With all copies, and as long as `most_seconds_of` says.
[[nodiscard]] StressVerdict check_scene(const CheckedScenario& scenario);

}  // namespace monograin
