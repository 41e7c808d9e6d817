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
struct ContinuumOptions {
  std::string_view mesh = "medium";
  bool estimates_error = false;  ///< true: computes on the next coarser mesh as well
  std::filesystem::path ccx;     ///< program of CalculiX
  std::filesystem::path folder;  ///< for its files
  /// Called now and then with the number of computed instants, and of all; may be empty.
  std::function<void(std::size_t, std::size_t)> progress{};
};

/// Largest differences in a quantity of a contact class, over the quantity's largest value. NaN: there are none.
struct ContinuumDifference {
  std::string column;    ///< without the unit
  double loading = 0.0;  ///< between the law and finite elements where the first class that moves is deeper than before
  double unloading = 0.0;   ///< where they are not
  double mesh_error = 0.0;  ///< estimate of the finite elements' own error
};

/// Finite elements beside the law.
struct ContinuumRun {
  Run run;  ///< of finite elements: history, status and warnings; no events
  std::string solver;
  std::size_t elements = 0;
  std::vector<ContinuumDifference> differences{};
};

/// Material for the finite elements of a scenario.
/// @throws std::invalid_argument if they cannot stand for the model's particle
[[nodiscard]] ContinuumMaterial continuum_material_of(const CheckedScenario& scenario);

/// Computes by finite elements what the law of a recorded run stands for: a homogeneous sphere, frictionless walls,
/// finite strain (docs/howto/finite-elements.md). The walls move as in the run, also where a force drives them. Rows of
/// the history are instants of the run, chosen where a wall has moved by 0.01 R0 or a force of the law has changed by 4
/// % of its largest value.
/// @param law  run of the scenario
/// @throws std::invalid_argument for walls without the symmetry of sector_of(), a material that
/// continuum_material_of() refuses, and a run without a step
/// @throws std::runtime_error if CalculiX cannot be started
[[nodiscard]] ContinuumRun run_continuum(const Run& law, const ContinuumOptions& options);

/// Files of CalculiX in ContinuumOptions::folder that a user may want.
inline constexpr std::array<std::string_view, 6> k_calculix_files{"continuum.inp", "continuum.dat", "continuum.log",
                                                                  "coarser.inp",   "coarser.dat",   "coarser.log"};

/// Text of run.json for the folder of the finite elements.
[[nodiscard]] std::string continuum_json(const ContinuumRun& result, std::string_view mesh);

}  // namespace monograin
