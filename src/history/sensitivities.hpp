/// Sensitivities: derivatives of a history with respect to numbers of its scenario.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "scene/scene.hpp"

namespace monograin {

struct Run;

/// Records a run whose derivatives are integrated with it. They get the columns that add_sensitivities() describes, and
/// the run gets an estimate of their error.
/// @param scene      scene of the run; replaced with a new one if the derivatives cannot be integrated
/// @param new_scene  makes a scene for the run
/// @return empty if run and derivatives are recorded; otherwise why the derivatives cannot be integrated, and nothing
///         is recorded but the evaluations of the attempt
[[nodiscard]] std::optional<std::string> record_with_sensitivities(Run& run, Scene& scene,
                                                                   const std::function<Scene()>& new_scene);

/// Adds a column d(X)/d(KEY) to history and events for every column X of numbers and every key of the scenario's table
/// [sensitivities]. The run gets an estimate of their error. The derivatives are central differences of two more runs
/// for each key, which solve for their states directly if that is possible. Rows with too large a truncation, as next
/// to a square root, get them from two more runs with a smaller step, which write only these rows. If no direct
/// solution exists, CVODES integrates the derivatives with another run.
///
/// Output rows are compared at their instant, in the same segment of all runs. Rows at events and ends of steps, and
/// the events themselves, are compared with the same event or end in the other runs: d(time)/d(KEY) is not zero there,
/// and the derivative at fixed time is d(X)/d(KEY) - dX/dt d(time)/d(KEY), with the slope on the side of the row.
/// Derivatives are NaN after the first event that differs between the runs, and in output rows that lie before an event
/// in one run and after it in another, and in rows at an event where the column holds nothing but round-off.
/// @param why       reason for which the derivatives are not integrated with the run
/// @param scene_of  makes the scene of a scenario with another value of a key
void add_sensitivities(Run& run, std::string why, const std::function<Scene(const CheckedScenario&)>& scene_of);

}  // namespace monograin
