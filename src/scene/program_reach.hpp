/// How far a program leads, before any of it is run.
#pragma once

#include <vector>

#include "scene/scene.hpp"
#include "system/model.hpp"

namespace monograin {

/// Largest displacement [m] and force [N] to which the programs lead: bounds that scale the tolerances of a run.
///
/// Tolerances have to fit the depth that is really reached. Targets of the program may be far larger: a condition ends
/// a ramp before its target, a wall that cannot pull ends the run, and so does an unloading for which the law has no
/// formula. The model predicts where that happens, to within a factor where it happens by another quantity than the
/// prescribed one. Where nothing is known, the target counts.
/// @param moves_centre  a free centre may follow the walls, which then move farther than their contacts are deep
[[nodiscard]] Reach program_reach(const Model& model, const ModelInput& input, const std::vector<Channel>& channels,
                                  bool moves_centre);

}  // namespace monograin
