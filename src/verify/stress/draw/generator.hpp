/// Draws the scenes of the stress test from the whole admissible space of every model, and from its edges.
#pragma once

#include <cstdint>
#include <filesystem>
#include <set>

#include "verify/stress/draw/scene.hpp"

namespace monograin {

/// Models whose scenes are drawn; empty: all. In any order the same.
using DrawnModels = std::set<const Model*>;

/// Scene number `index` of a sequence: the same on every machine, whatever was drawn before. Every set of models has
/// sequences of its own.
///
/// Some scenes are laid on places that a first run of theirs has found: corners of the program a rounding error beside
/// an event, forces beside the largest or the least that there was.
/// @param tables  where write_stress_tables has left them
[[nodiscard]] StressScene draw_stress_scene(std::uint64_t seed, std::uint64_t index,
                                            const std::filesystem::path& tables, const DrawnModels& models = {});

}  // namespace monograin
