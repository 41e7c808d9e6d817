/// Copies of a scene whose walls are turned, reordered or moved together, and runs listed by wall so that they can be
/// compared.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

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

/// Projection onto the directions in which walls act on the particle.
/// @param normals  unit
[[nodiscard]] Eigen::Matrix3d onto_normals(std::span<const Eigen::Vector3d> normals);

/// A motion from the origin, with a constant velocity in each step of a program.
struct SharedMotion {
  std::vector<double> times;            ///< ends of the steps [s]
  std::vector<Eigen::Vector3d> places;  ///< [m] at these ends

  [[nodiscard]] Eigen::Vector3d at(double time) const;
};

/// A motion for the walls of a scene: in every direction in which they act on the particle, about as far as they move.
/// Nothing if the program does not say where a step ends, or when.
[[nodiscard]] std::optional<SharedMotion> shared_motion(const CheckedScenario& scenario, std::uint64_t sample);

/// The scene with a motion that all its walls share. It carries a particle along that its walls hold.
[[nodiscard]] CheckedScenario carried(CheckedScenario scenario, const SharedMotion& motion);

/// The run with columns for every single wall, in an order that does not depend on how walls were grouped into classes
/// or turned. Events name the walls of their class; events of two classes name both groups of walls.
/// @param rotation  rotation of the run's walls; the position of the centre is turned back by it
[[nodiscard]] Run by_wall(const Run& run, const Eigen::Matrix3d& rotation = Eigen::Matrix3d::Identity());

/// The run by wall, as it is once all its walls and its centre take part in a motion.
[[nodiscard]] Run by_wall(const Run& run, const SharedMotion& motion);

}  // namespace monograin
