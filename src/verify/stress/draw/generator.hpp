/// Draws the scenes of the stress test from the whole admissible space of every model, and from its edges.
#pragma once

#include <cstdint>
#include <filesystem>
#include <set>

#include "verify/stress/draw/scene.hpp"

namespace monograin {

/// Models whose scenes are drawn; empty: all.
using DrawnModels = std::set<const Model*>;

/// Draws scene number `index` of a sequence: the same on every machine, whatever was drawn before. Every set of models
/// has sequences of its own.
///
/// A first run of some scenes finds critical values for their programs: corners within round-off of an event, forces
/// next to the largest or the least force.
/// @param tables  folder into which write_stress_tables() has written
[[nodiscard]] StressScene draw_stress_scene(std::uint64_t seed, std::uint64_t index,
                                            const std::filesystem::path& tables, const DrawnModels& models = {});

}  // namespace monograin
