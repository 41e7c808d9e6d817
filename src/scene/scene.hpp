/// The scene of a scenario: walls grouped into contact classes, their programs, and the model bound to them.
#pragma once

#include <memory>
#include <string>
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
  std::vector<Step> steps;                            ///< empty: fixed
};

/// What the program prescribes one value of at a time: the walls of a contact class; a packing; the axial or the
/// lateral direction of a material point.
struct Channel {
  std::string name;           ///< for messages; that of the contact class
  Ramp at_rest;               ///< before the first step
  std::vector<Step> program;  ///< empty: nothing changes
};

struct Scene {
  std::vector<ContactClass> classes;            ///< empty where the model has no walls
  std::vector<std::vector<std::string>> walls;  ///< names of each class's walls
  std::vector<Channel> channels;                ///< those of the contact classes in their order, where there are walls
  std::vector<std::string> skipped;             ///< what is not computed because the scene does not need it
  std::unique_ptr<HybridSystem> system;

  [[nodiscard]] std::size_t step_count() const noexcept;
};

/// Walls of a scenario: those of the preset configuration, or the free ones.
[[nodiscard]] std::vector<Wall> make_walls(const CheckedScenario& scenario);

/// Groups walls that symmetry makes share one history: two walls are of one class if a rotation or reflection of the
/// whole wall set takes one to the other and every wall to one with the same program and gap.
/// @return for each wall the index of its class, numbered in the order of their first walls
[[nodiscard]] std::vector<std::size_t> symmetry_classes(const std::vector<Wall>& walls);

/// @param merges_walls  false: every wall is a class of its own (to test the merging)
/// @throws ScenarioError where the walls' programs do not go together
[[nodiscard]] Scene make_scene(const CheckedScenario& scenario, bool merges_walls = true);

/// Particle, material and the constants that follow from them before anything moves.
[[nodiscard]] std::vector<DerivedParameter> derived_parameters(const CheckedScenario& scenario);

}  // namespace monograin
