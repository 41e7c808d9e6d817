/// Rules that runs of one scene and of its copies have to keep together.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "history/run.hpp"
#include "scenario/scenario.hpp"
#include "verify/stress/check/rules.hpp"

namespace monograin {

/// Processor time that all runs of a scene may take together [s]; a few hundredths are usual. A method of low order at
/// a fine tolerance needs much time for every step of a long program.
[[nodiscard]] double most_seconds_of(const CheckedScenario& scenario);
/// Name of the rule that a scene breaks if it takes longer.
inline constexpr const char* k_time_rule = "time";

/// Runs a scenario whose system a wrapper surrounds, as run_scenario() does.
using RunMaker = std::function<Run(const CheckedScenario&, const SystemWrapper&)>;

/// How thoroughly a scene is checked, and with which function it is run.
struct StressEffort {
  static constexpr std::uint64_t k_all_copies = ~std::uint64_t{0};
  /// Processor time [s] for all runs of a scene together. A scene that takes longer breaks the rule "time", unless its
  /// own run is about as slow as the runs with which it is compared.
  double seconds = 0.0;
  /// Which copy of a complete scene is run, as an index that starts again after the last copy. A scene that a limit has
  /// ended is compared with all of them.
  std::uint64_t copies = k_all_copies;
  RunMaker make_run = run_scenario;
};

/// Result of checking one scene.
struct StressVerdict {
  std::string end;  ///< stated_end() of its run
  std::vector<Violation> violations;
  long runs = 0;                    ///< number of runs that were made
  bool is_ill_conditioned = false;  ///< round-off of its data, or errors of the size of rtol, change it visibly
  bool is_cut_short = false;        ///< the scene itself is so slow that not all comparisons were made
};

/// Runs a scene, and other scenes that must agree with it: in the reference form, slower, with a step cut in two, for
/// elastic laws forth and back; and its copies: with a larger and softer particle, with all walls turned, with walls in
/// another order, with a motion of all walls that carries a free centre along, in another form of the equations.
/// Exceptions of a run become violations.
///
/// Ends. A limit, or an integrator that gives up for a stated reason, is accepted if all copies end there, too: at the
/// same limit, within the tolerance of the time. An integrated form may give up where another form goes on.
///
/// Agreement. The direct form is exact but for round-off, its work to a hundredth of rtol. A controlled integrator has
/// to be within k rtol of it, k = 100 (docs/howto/integrators.md: "the error of a curve stays below 100 rtol"). A scene
/// can magnify errors by itself: next to a fold or pull-off, on steep unloading branches, or where the order of two
/// events decides. The response of such a scene to data changed by rtol (by round-off, if two runs of the same form are
/// compared) is measured, and allowed.
[[nodiscard]] StressVerdict check_scene(const CheckedScenario& scenario, const StressEffort& effort);
/// Checks a scene with all copies, for at most most_seconds_of().
[[nodiscard]] StressVerdict check_scene(const CheckedScenario& scenario);

}  // namespace monograin
