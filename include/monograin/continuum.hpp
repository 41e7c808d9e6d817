/// The particle of a scenario by finite elements, beside its law.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "monograin/continuum_difference.hpp"
#include "monograin/run.hpp"
#include "monograin/scenario.hpp"

namespace monograin {

/// Options of continuum().
struct ContinuumOptions {
  std::string mesh = "medium";   ///< coarse, medium or fine
  bool estimates_error = false;  ///< true: computes on the next coarser mesh as well
  /// For the files of the run; empty: no file stays. Files of an earlier run there are replaced, and others stay.
  std::filesystem::path folder{};
  bool keeps_files = false;  ///< true: files of CalculiX stay in the folder, too
  /// Asked about ten times a second, in the thread of the call. Returning true ends CalculiX, and the call by
  /// RunInterrupted; no file is then written. An empty function never ends it.
  std::function<bool()> stop{};
};

/// Result of continuum().
struct ContinuumResult {
  /// Run of the finite elements: displacement, overlap, force, contact radius and pressure of each contact class,
  /// volume and work. It has no events, and no profiles.
  RunResult run;
  RunResult law;                                 ///< run of the scenario's law, whose walls the finite elements follow
  std::string solver;                            ///< name and version of the program that has computed them
  std::size_t elements = 0;                      ///< number of elements
  std::vector<ContinuumDifference> differences;  ///< force and contact radius of each contact class
};

/// Runs a scenario, and computes its particle by finite elements, as `monograin continuum` does: a homogeneous sphere
/// under frictionless walls, at finite strain. The program ccx of CalculiX, which must be on the PATH, computes them in
/// a process of its own; this takes from seconds to many minutes.
///
/// Walls move as in the run of the law, also where a force drives them. If CalculiX gives up, the status of the run is
/// `failed`, and its history ends there.
/// @throws ScenarioError with all faults of the scenario
/// @throws std::invalid_argument for a model or a material that finite elements cannot stand for, walls that do not
///         stand in perpendicular pairs that move alike, an unknown mesh, and files to keep without a folder
/// @throws std::runtime_error if there is no program ccx, or before the computation if the folder holds a result of
///         another kind, or a file of the user with the name of one to write, or cannot be written
/// @throws RunInterrupted if the options end the computation
[[nodiscard]] ContinuumResult continuum(const Scenario& scenario, const ContinuumOptions& options = {});

/// Computes the particle of a run by finite elements; the law is not run again.
/// @throws std::invalid_argument also for a run of finite elements
[[nodiscard]] ContinuumResult continuum(const RunResult& law, const ContinuumOptions& options = {});

}  // namespace monograin
