/// Copies of a scene whose walls stand elsewhere or come in another order, and runs listed by wall so that they
/// compare.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "history/run.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

/// A rotation about an axis that is far from every axis of a preset: one for each sample.
[[nodiscard]] Eigen::Matrix3d stress_rotation(std::uint64_t sample);

/// The scene with all its walls turned; a preset becomes the free wall set that it is short for. Nothing where the
/// model takes no free walls.
[[nodiscard]] std::optional<CheckedScenario> turned(CheckedScenario scenario, const Eigen::Matrix3d& rotation);

/// The scene with its free walls in the opposite order; nothing where there is no order.
[[nodiscard]] std::optional<CheckedScenario> reordered(CheckedScenario scenario);

/// The run with the columns and events of every wall by itself, in an order that does not depend on how walls were
/// grouped into classes or turned. Events of two classes name both groups of walls.
/// @param rotation  of the walls, which the centre's place is turned back by
[[nodiscard]] Run by_wall(const Run& run, const Eigen::Matrix3d& rotation = Eigen::Matrix3d::Identity());

}  // namespace monograin
