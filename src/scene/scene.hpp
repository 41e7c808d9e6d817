/// The scene of a scenario: walls grouped into contact classes, their programs, and the model bound to them.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/scenario.hpp"
#include "system/hybrid_system.hpp"
#include "system/walls.hpp"

namespace monograin {

/// A wall of the scene with its program.
struct Wall {
  std::string name;
  std::string group;                                  ///< axial, lateral, oblique; empty in free wall sets
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, outward
  double gap = 0.0;                                   ///< [m]
  std::vector<Step> steps;                            ///< empty: the wall is fixed
};

/// A part of the scene for which the program prescribes one quantity at a time: the walls of a contact class; a
/// packing; the axial or the lateral direction of a material point.
struct Channel {
  std::string name;           ///< for messages; that of the contact class
  Ramp at_rest;               ///< control and value before the first step
  std::vector<Step> program;  ///< its legs; empty: nothing changes
};

/// Contact classes and channels of a scenario, and the system of its model.
struct Scene {
  std::vector<ContactClass> classes;            ///< empty if the model has no walls
  std::vector<std::vector<std::string>> walls;  ///< names of each class's walls
  std::vector<Channel> channels;                ///< with walls: one for each contact class, in the same order
  std::vector<std::string> skipped;             ///< computations that are left out because the scene does not need them
  std::unique_ptr<HybridSystem> system;

  /// Program with the most legs.
  [[nodiscard]] std::span<const Step> longest_program() const noexcept;
  /// Number of legs of the program: one or several for each step.
  [[nodiscard]] std::size_t leg_count() const noexcept { return longest_program().size(); }
  /// Channel of a contact class, of the class that has a wall, or of the first class whose wall's name begins so:
  /// without merging, a preset class such as "axial" is several. walls.size() if there is none.
  [[nodiscard]] std::size_t channel_of(std::string_view wall) const;
};

/// Walls of a scenario: those of the preset configuration, or the free walls.
[[nodiscard]] std::vector<Wall> make_walls(const CheckedScenario& scenario);

/// Groups walls that share one history by symmetry: two walls are of one class if a rotation or reflection of the whole
/// wall set maps one to the other, and every wall to a wall with the same program and gap.
/// @return for each wall the index of its class; classes are numbered in the order of their first walls
[[nodiscard]] std::vector<std::size_t> symmetry_classes(const std::vector<Wall>& walls);

/// Makes the scene of a scenario and binds its model to it.
/// @param merges_walls  false: every wall is a class of its own, to check and to time the merging
/// @throws std::invalid_argument if the model has no law for the material
[[nodiscard]] Scene make_scene(const CheckedScenario& scenario, bool merges_walls = true);

/// Parameters of particle and material, and the constants that follow from them before anything moves.
[[nodiscard]] std::vector<DerivedParameter> derived_parameters(const CheckedScenario& scenario);

}  // namespace monograin
