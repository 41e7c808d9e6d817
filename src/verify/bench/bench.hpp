/// Run time against error, over integrators and tolerances.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "engine/drive.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

struct BenchSettings {
  std::vector<std::string> integrators{};  ///< "auto" and the names of integrators; empty: all
  std::vector<double> tolerances{};        ///< relative ones, from loose to tight; empty: 1e-2 to 1e-13
  double least_time = 0.05;                ///< a run is repeated until it has taken so long [s]
};

/// One integrator at one tolerance. Errors are nan where the run has not come as far as the reference.
struct BenchPoint {
  std::string integrator;
  double rtol = 0.0;
  /// Forces, stresses, apparent radius and work, each over its largest value: the worst at any output point, and at the
  /// last.
  double curve_error = 0.0;
  double end_error = 0.0;
  double event_error = 0.0;  ///< of the events' times, over the whole time; nan where there are other events
  double fastest = 0.0;      ///< one history, recording included, set-up of the scene not [s]
  double median = 0.0;
  Statistics statistics;
  std::string fault;  ///< why there are no errors; empty: there are
};

struct BenchScene {
  std::string name;
  std::string title;
  std::string chosen;       ///< by "auto"
  std::string reference;    ///< what the errors are against
  std::string check;        ///< what those of the reference's own integrator are against
  double agreement = 0.0;   ///< of these two
  double setup = 0.0;       ///< scene from scenario [s]
  double evaluation = 0.0;  ///< one evaluation of the law along the history: an instant solved for, or its rates [s]
  std::size_t rows = 0;     ///< of the history
  std::vector<BenchPoint> points;
};

/// Where the time of one history goes [s]; what is left of the total is the integrator's own.
struct BenchProfile {
  std::string scene;
  std::string integrator;
  double total = 0.0;
  double law = 0.0;
  double linear_algebra = 0.0;  ///< of SUNDIALS' solvers; that of `direct` is part of the law
  double guards = 0.0;
  double recording = 0.0;
  long law_calls = 0;
};

/// What a scene is spared, measured by undoing it.
struct BenchSaving {
  std::string what;
  std::string scene;
  double time = 0.0;        ///< with the saving [s]
  double undone = 0.0;      ///< without [s]
  double difference = 0.0;  ///< of the two curves
};

/// Two scenes with the same curve, of which the second does what the first is spared.
struct BenchPair {
  std::string what;
  std::string name;
  CheckedScenario spared;
  CheckedScenario without;
};

/// Scenes and savings that are measured where no scene is named.
struct BenchList {
  std::vector<CheckedScenario> scenes;
  std::vector<BenchPair> savings;
};

/// @throws ScenarioError
[[nodiscard]] BenchList read_bench_list(const std::filesystem::path& file);

/// @param shown  called after each point
[[nodiscard]] BenchScene measure_scene(const CheckedScenario& scenario, const BenchSettings& settings,
                                       const std::function<void()>& shown);

/// @param name  of an integrator, or "auto"
[[nodiscard]] BenchProfile profile_scene(const CheckedScenario& scenario, const std::string& name);

/// The savings that a scene can do without, each over the default scenario or one near to it, and those of the list.
[[nodiscard]] std::vector<BenchSaving> measure_savings(const BenchSettings& settings,
                                                       const std::vector<BenchPair>& listed);

/// The least time in which an integrator has reached an error [s]; nan: it has not.
[[nodiscard]] double time_to_error(const BenchScene& scene, std::string_view integrator, double error);

/// Compiler, its flags, libraries and processor, a line.
[[nodiscard]] std::string machine_text();

/// What a terminal and `bench.md` show.
[[nodiscard]] std::string bench_text(const std::vector<BenchScene>& scenes, const std::vector<BenchProfile>& profiles,
                                     const std::vector<BenchSaving>& savings);

/// Writes bench.csv, bench.md and the figures: one for each scene, one of all, one of the events.
/// @return the files @throws FigureError
std::vector<std::filesystem::path> write_bench(const std::vector<BenchScene>& scenes,
                                               const std::vector<BenchProfile>& profiles,
                                               const std::vector<BenchSaving>& savings,
                                               const std::filesystem::path& folder);

/// Draws the figures of an earlier bench anew, from its bench.csv and without measuring.
/// @return the figures @throws FigureError, or std::runtime_error where the file is not of a bench
std::vector<std::filesystem::path> redraw_bench(const std::filesystem::path& csv, const std::filesystem::path& folder);

}  // namespace monograin
