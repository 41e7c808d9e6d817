/// The particle of a scenario by finite elements, under the walls' motion of its run.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "exchange/motion.hpp"
#include "history/run.hpp"
#include "system/continuum_material.hpp"

namespace monograin {

/// Names of the meshes that a user may ask for, from the coarsest to the finest.
inline constexpr std::array<std::string_view, 3> k_continuum_meshes{"coarse", "medium", "fine"};

/// How finite elements are computed.
struct ElementOptions {
  std::string_view mesh = "medium";
  bool estimates_error = false;  ///< true: computes on the next coarser mesh as well
  std::filesystem::path ccx;     ///< program of CalculiX
  std::filesystem::path folder;  ///< for its files
  /// Called now and then with the number of computed instants, and of all; may be empty.
  std::function<void(std::size_t, std::size_t)> progress{};
};

/// Material for the finite elements of a scenario.
/// @throws std::invalid_argument if they cannot stand for the model's particle
[[nodiscard]] ContinuumMaterial continuum_material_of(const CheckedScenario& scenario);

/// Computes by finite elements what the law of a recorded run stands for: a homogeneous sphere, frictionless walls,
/// finite strain (docs/howto/finite-elements.md). The walls move as in the run, also where a force drives them. Rows of
/// the history are instants of the run, chosen where a wall has moved by 0.01 R0 or a force of the law has changed by 4
/// % of its largest value.
/// @param law  run of the scenario
/// @return history, status and warnings of the finite elements; no events
/// @throws std::invalid_argument for walls without the symmetry of sector_of(), a material that
/// continuum_material_of() refuses, a run without a step, an unknown mesh, and a run of finite elements
/// @throws std::runtime_error if CalculiX cannot be started
[[nodiscard]] Run run_continuum(const Run& law, const ElementOptions& options);

}  // namespace monograin
