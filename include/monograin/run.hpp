/// Runs a scenario.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "monograin/history.hpp"
#include "monograin/scenario.hpp"
#include "monograin/status.hpp"

namespace monograin {

struct Run;

/// How a run has ended, and its curves up to there.
class RunResult {
 public:
  explicit RunResult(std::shared_ptr<const Run> run);

  RunStatus status = RunStatus::complete;
  std::string message;                ///< why it stopped or failed
  std::string limit;                  ///< code of the limit that stopped it, e.g. "walls-meet"; empty: none did
  std::vector<std::string> warnings;  ///< sentences
  std::string integrator;             ///< that was used
  History history;                    ///< a row at each output point, and two around each event
  History events;                     ///< a row for each event: time, class, event, and the history there

  /// Text of run.json: what was run, how, by which versions, and what it took.
  [[nodiscard]] std::string json() const;
  /// Writes history.csv, events.csv and run.json into a folder, whole or not at all, as `monograin run -o` does.
  /// @throws std::runtime_error naming what cannot be written
  void save(const std::filesystem::path& folder) const;

 private:
  std::shared_ptr<const Run> run_;
};

/// Runs a scenario. Where the model or the solver ends before the program does, the result says so and nothing is
/// thrown.
/// @throws ScenarioError with all faults of the scenario
[[nodiscard]] RunResult run(const Scenario& scenario);

}  // namespace monograin
