/// A sector of a particle under its walls as a problem of CalculiX, and what CalculiX has computed.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "continuum/sector.hpp"
#include "continuum/sector_mesh.hpp"
#include "system/continuum_material.hpp"

namespace monograin {

/// Overlaps of the walls of a sector at an instant, over R0.
using WallOverlaps = std::vector<double>;

/// A sector with its walls, material and mesh.
struct SectorProblem {
  Sector sector;
  SectorMesh mesh;
  ContinuumMaterial material;
  std::vector<WallOverlaps> instants;  ///< the walls move straight from one to the next; the first from 0
};

/// Input file of CalculiX: one step for each instant. Lengths are in units of R0/10, stresses of E/1000.
[[nodiscard]] std::string calculix_input(const SectorProblem& problem);

/// Computed state at an instant.
struct SectorState {
  std::vector<Eigen::Vector3d> surface;  ///< positions of the surface nodes over R0, longitude by longitude
  std::vector<double> forces;            ///< of each wall on the sector, over E R0^2
};

/// Computed states, and why they end before the last instant.
struct SectorSolution {
  std::vector<SectorState> states;
  std::string failure;  ///< empty: all instants are computed
};

/// Reads the states from the text of the .dat file that CalculiX wrote. Nodes that the text lacks stay in their
/// undeformed places.
[[nodiscard]] std::vector<SectorState> read_states(const std::string& text, const SectorProblem& problem);

/// Version of CalculiX, e.g. "CalculiX 2.20".
/// @param folder  in which it is called
[[nodiscard]] std::string calculix_version(const std::filesystem::path& ccx, const std::filesystem::path& folder);

/// Solves a problem in a folder; the files of CalculiX, which begin with `name`, stay there.
/// @param progress  called now and then with the number of computed instants; may be empty
/// @throws std::runtime_error if CalculiX cannot be started or a file cannot be written
[[nodiscard]] SectorSolution run_calculix(const SectorProblem& problem, const std::filesystem::path& ccx,
                                          const std::filesystem::path& folder, const std::string& name,
                                          const std::function<void(std::size_t)>& progress);

}  // namespace monograin
