/// Copies of a scene with turned or reordered walls, and runs listed by wall so that they can be compared.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "history/run.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

/// A rotation for a sample number, about an axis that is far from every axis of a preset.
[[nodiscard]] Eigen::Matrix3d stress_rotation(std::uint64_t sample);

/// The scene with all its walls turned; a preset is written out as a set of free walls. Nothing if the model takes no
/// free walls.
[[nodiscard]] std::optional<CheckedScenario> turned(CheckedScenario scenario, const Eigen::Matrix3d& rotation);

/// The scene with its free walls in the opposite order; nothing if it has fewer than two.
[[nodiscard]] std::optional<CheckedScenario> reordered(CheckedScenario scenario);

/// The run with columns for every single wall, in an order that does not depend on how walls were grouped into classes
/// or turned. Events name the walls of their class; events of two classes name both groups of walls.
/// @param rotation  rotation of the run's walls; the position of the centre is turned back by it
[[nodiscard]] Run by_wall(const Run& run, const Eigen::Matrix3d& rotation = Eigen::Matrix3d::Identity());

}  // namespace monograin
