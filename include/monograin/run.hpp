/// Running a scenario, and the result of a run.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "monograin/history.hpp"
#include "monograin/scenario.hpp"
#include "monograin/status.hpp"

namespace monograin {

struct ContinuumOptions;
struct ContinuumResult;
struct Run;

/// What a call that runs a scenario may ask for.
struct RunOptions {
  /// Called now and then during a run, in the thread of the call. Returning true ends the run by RunInterrupted. An
  /// empty function never ends it.
  std::function<bool()> stop{};
};

/// Result of run(): how the run ended, and its curves up to that point.
class RunResult {
 public:
  explicit RunResult(std::shared_ptr<const Run> run);  ///< for the library itself
  /// A result that was moved from stays as it was.
  RunResult(const RunResult&) = default;
  RunResult& operator=(const RunResult&) = default;

  RunStatus status = RunStatus::complete;  ///< how the run ended
  std::string message;                     ///< why the run stopped or failed; empty if it is complete
  std::string limit;                       ///< code of the limit that stopped the run, e.g. "walls-meet"; empty: none
  std::vector<std::string> warnings;       ///< sentences for the user
  std::string integrator;                  ///< name of the integrator that was used
  History history;                         ///< a row at each output point, and two rows around each event
  History events;  ///< a row for each event: time, contact class, event, and all columns of the history

  /// Text of run.json: the scenario, the integrator, versions, warnings and timings.
  [[nodiscard]] std::string json() const;
  /// Writes history.csv, events.csv and run.json into a folder, as `monograin run -o` does. Either all files are
  /// written or none.
  /// @throws std::runtime_error that names the file or folder that cannot be written
  void save(const std::filesystem::path& folder) const;

  /// Pressure and surface under the contacts at one instant. Runs the scenario again up to that instant.
  /// @param time  [s], within the run; at an event, the state just before it counts
  /// @return columns `class` (words), `radius` [m], `pressure` [Pa], `displacement` [m] of the surface and
  ///         `relaxed_height` [m] of the unloaded surface: a row for each point of each class of contacts that is
  ///         closed
  /// @throws std::runtime_error if the model has no profile, the instant is not finite or negative, the run ends before
  ///         it, or no contact is closed then; the message says which
  /// @throws RunInterrupted if the options end the run
  [[nodiscard]] History profile(double time, const RunOptions& options = {}) const;

  /// Writes particle and walls for ParaView, as `monograin plot --vtk` does: run.pvd and the files that it lists, of at
  /// most 200 instants. Either all files are written or none.
  /// @param folder  made if it does not exist; files of an earlier particle are replaced, and others stay
  /// @throws std::invalid_argument for a model without a particle between walls
  /// @throws std::runtime_error that names the file or folder that cannot be written
  void write_vtk(const std::filesystem::path& folder) const;
  /// Input file of LAMMPS for the same test, as `monograin export lammps` writes it.
  /// @throws std::invalid_argument for a model or options whose law LAMMPS does not have; the message says why
  [[nodiscard]] std::string lammps_input() const;
  /// Force over displacement of one wall, as `monograin export table` writes it.
  /// @param contact_class  name of the class; empty: the first one that moves
  /// @return columns `branch`, and displacement [m] and force [N] of the class: each branch has one force for each
  ///         displacement, and ends where the displacement turns
  /// @throws std::invalid_argument for a model without walls, an unknown class, or one that does not move
  [[nodiscard]] History force_table(const std::string& contact_class = {}) const;

 private:
  friend ContinuumResult continuum(const RunResult& law, const ContinuumOptions& options);

  std::shared_ptr<const Run> run_;
};

/// Runs a scenario.
///
/// A run that ends early does not throw: RunResult::status is then `stopped` (limit of the model) or `failed` (solver).
/// @throws ScenarioError with all faults of the scenario
/// @throws RunInterrupted if the options end the run
/// @throws std::runtime_error for a law of your own whose functions contradict each other, and what these throw
[[nodiscard]] RunResult run(const Scenario& scenario, const RunOptions& options = {});

}  // namespace monograin
