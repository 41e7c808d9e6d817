/// What must hold of every run by itself, whatever its model, walls, program and integrator.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "history/run.hpp"
#include "scenario/scenario.hpp"
#include "stress/checks.hpp"

namespace monograin {

/// Finer tolerances of an integrator are not kept: round-off of a scene's own equations may be larger
/// (docs/reference/limits.md).
inline constexpr double k_finest_rtol = 1e-11;

/// Changes of a scene's data that stand for rounding on the way from a text to a state.
inline constexpr double k_stress_rounding = 16.0 * std::numeric_limits<double>::epsilon();

/// What must hold of a run by itself: it completes, or stops at a stated limit that no touching wall contradicts; every
/// value is finite; contacts without adhesion do not pull; the dissipation never falls without a warning; monotone
/// quantities do not shrink; events come to an end; work is in proportion to rows, events and steps; the identities of
/// the columns hold.
[[nodiscard]] std::vector<Violation> check_run(const Run& run);

/// How a run has ended: "complete", the code of the model's limit, or the reason of a failure; empty where none is
/// stated.
[[nodiscard]] std::string stated_end(const Run& run);

/// Steps of the longest program, cycles written out.
[[nodiscard]] std::size_t step_count(const CheckedScenario& scenario);

/// What the work of a run of the direct form may be wrong by, over the largest energy; 0 for other runs.
[[nodiscard]] double direct_work_tolerance(const Run& run);

/// Error of a run's own that its rules have to grant, over the largest values.
[[nodiscard]] double own_tolerance(const Run& run);

/// Error of a run's own that has no largest value, over units of the particle: adds up as the relative one does, and is
/// held to be no finer.
[[nodiscard]] double own_absolute_tolerance(const Run& run);

/// The softest of a material's moduli and strengths.
[[nodiscard]] double softest(const CheckedScenario& scenario);

/// Whether the law of a scenario goes back the way it came.
[[nodiscard]] bool is_elastic(const CheckedScenario& scenario);

/// Whether a run of a model without walls has not yielded.
[[nodiscard]] bool stays_elastic(const Run& run);

}  // namespace monograin
