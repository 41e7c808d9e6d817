/// Rules that every run has to keep by itself, whatever its model, walls, program and integrator.
#pragma once

#include <string>
#include <vector>

#include "history/run.hpp"
#include "scenario/scenario.hpp"
#include "stress_test/checks.hpp"
#include "system/resolution.hpp"

namespace monograin {

/// Relative change of a scene's data that stands for round-off on the path from a text to a state.
inline constexpr double k_stress_round_off = 16.0 * k_epsilon;

/// Checks a run by itself: it completes, or stops at a stated limit that no touching wall contradicts; every value is
/// finite; contacts without adhesion do not pull; the dissipation never falls without a warning; monotone quantities do
/// not shrink; events come to an end; work is in proportion to rows, events and steps; the identities of the columns
/// hold.
/// @return the rules that the run breaks
[[nodiscard]] std::vector<Violation> check_run(const Run& run);

/// How a run has ended: "complete", the code of the model's limit, or the reason of a failure; empty where none is
/// stated.
[[nodiscard]] std::string stated_end(const Run& run);

/// Steps of the longest program, cycles written out.
[[nodiscard]] std::size_t step_count(const CheckedScenario& scenario);

/// Tolerated error of the work in a run of the direct form, over the largest energy; 0 for other runs.
[[nodiscard]] double direct_work_tolerance(const Run& run);

/// Tolerated relative error of a run: over the largest value of each kind of column.
[[nodiscard]] double own_tolerance(const Run& run);

/// Tolerated absolute error of a run, over the particle's own units of each quantity: own_tolerance() with atol in
/// place of rtol; round-off for the direct form.
[[nodiscard]] double own_absolute_tolerance(const Run& run);

/// The softest of a material's moduli and strengths.
[[nodiscard]] double softest(const CheckedScenario& scenario);

/// True if unloading retraces loading by the law of a scenario.
[[nodiscard]] bool is_elastic(const CheckedScenario& scenario);

/// True for a run of a model without walls that has not yielded.
[[nodiscard]] bool stays_elastic(const Run& run);

}  // namespace monograin
