/// Derivatives of a history with respect to numbers of its scenario.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "scene/scene.hpp"

namespace monograin {

struct Run;

/// Records a run with derivatives that are integrated with it, in the columns of add_sensitivities(), and says in the
/// run how near they are.
/// @param scene      of the run; a new one where the derivatives could not be had
/// @param new_scene  makes it
/// @return why they could not be had, and nothing is recorded; none: they are there
[[nodiscard]] std::optional<std::string> record_with_sensitivities(Run& run, Scene& scene,
                                                                   const std::function<Scene()>& new_scene);

/// Adds a column d(X)/d(KEY) to history and events for every column X of numbers and every key of the scenario's table
/// [sensitivities], and says in the run how near they are.
///
/// They are derivatives of what a row holds, by central differences of two more runs for each key. An output row stays
/// at its instant, on its branch. Rows at events and ends of steps, and the events themselves, follow them: there
/// d(time)/d(KEY) is not zero, and the derivative at fixed time is d(X)/d(KEY) - dX/dt d(time)/d(KEY), with the slope
/// of the row's own side. Undefined (nan): from where the runs pass different events; an output row that an event
/// passes from run to run.
/// @param why  they are not integrated with the run
void add_sensitivities(Run& run, const std::string& why);

}  // namespace monograin
