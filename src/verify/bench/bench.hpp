/// Run time against error, over integrators and tolerances.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/drive.hpp"
#include "figure/figure.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

struct BenchSettings {
  std::vector<std::string> integrators{};  ///< "auto" and the names of integrators; empty: all
  std::vector<double> tolerances{};        ///< relative ones, from loose to tight; empty: 1e-2 to 1e-13
  double least_time = 0.05;                ///< a run is repeated for at least this time [s]
  std::size_t least_runs = 20;             ///< and so many times, except if these runs take long
};

/// Errors and times of one integrator at one tolerance. Errors are nan if the run does not end as the reference does.
struct BenchPoint {
  std::string integrator;
  double rtol = 0.0;
  /// Largest error at an output point of any force, displacement, stress, strain, apparent radius, packing fraction or
  /// work, each over its largest value.
  double curve_error = 0.0;
  double end_error = 0.0;    ///< the same error at the last row
  double event_error = 0.0;  ///< largest error of an event's time, over the whole time; nan if there are other events
  double fastest = 0.0;      ///< shortest processor time of a run [s], with recording, without set-up of the scene
  double median = 0.0;       ///< median processor time of a run [s]
  Statistics statistics{};
  std::string fault{};  ///< why the run has no errors; empty if it has
};

/// Measurements of one scene.
struct BenchScene {
  std::string name{};
  std::string title{};
  std::string chosen{};     ///< integrator that "auto" chooses
  std::string reference{};  ///< integrator of the reference, from which errors are measured
  std::string check{};      ///< integrator from which errors of the reference's own integrator are measured
  double agreement = 0.0;   ///< curve error of these two against each other
  double setup = 0.0;       ///< time to make the scene from its scenario [s]
  double evaluation = 0.0;  ///< time of one evaluation of the law along the history: a solution or its rates [s]
  std::size_t rows = 0;     ///< rows of the history
  std::vector<BenchPoint> points{};
};

/// Shares of the time of one run [s], clocks included; the rest of the total is the integrator's own.
struct BenchProfile {
  std::string scene;
  std::string integrator;
  double total = 0.0;
  double law = 0.0;
  double linear_algebra = 0.0;  ///< linear solvers of SUNDIALS; those of `direct` are part of the law
  double guards = 0.0;
  double recording = 0.0;
  long law_calls = 0;
};

/// Time saved by work that a scene leaves out, measured by a run that does this work.
struct BenchSaving {
  std::string what;
  std::string scene;
  double time = 0.0;        ///< time of a run with the saving [s]
  double undone = 0.0;      ///< time of a run without the saving [s]
  double difference = 0.0;  ///< curve error of the two runs against each other
};

/// Two scenes with the same curve; the second does work that the first leaves out.
struct BenchPair {
  std::string what;
  std::string name;
  CheckedScenario spared;
  CheckedScenario without;
};

/// Scenes and savings that are measured if no scene is named.
struct BenchList {
  std::vector<CheckedScenario> scenes;
  std::vector<BenchPair> savings;
};

/// Reads the list of scenes and savings (TOML) of a bench. @throws ScenarioError
[[nodiscard]] BenchList read_bench_list(const std::filesystem::path& file);

/// Measures errors and times of a scene with the integrators and tolerances of the settings.
/// @param shown  called after each point; may be empty
[[nodiscard]] BenchScene measure_scene(const CheckedScenario& scenario, const BenchSettings& settings,
                                       const std::function<void()>& shown);

/// Measures where the time of a run goes.
/// @param name  an integrator, or "auto"
[[nodiscard]] BenchProfile profile_scene(const CheckedScenario& scenario, const std::string& name);

/// Measures all savings that can be undone, each with the default scenario or a similar one, and the savings of a list.
[[nodiscard]] std::vector<BenchSaving> measure_savings(const BenchSettings& settings,
                                                       const std::vector<BenchPair>& listed);

/// Least time [s] in which an integrator has reached a curve error; nan if it has not.
[[nodiscard]] double time_to_error(const BenchScene& scene, std::string_view integrator, double error);

/// Compiler, its flags, libraries and processor, in one line.
[[nodiscard]] std::string machine_text();

/// Tables of a bench in Markdown, for the terminal and `bench.md`.
[[nodiscard]] std::string bench_text(const std::vector<BenchScene>& scenes, const std::vector<BenchProfile>& profiles,
                                     const std::vector<BenchSaving>& savings);

/// Writes bench.csv, bench.md and the figures: one for each scene, a summary, and one of the events.
/// @param format  of the figures, one of figure::k_formats
/// @return the files @throws FigureError
std::vector<std::filesystem::path> write_bench(const std::vector<BenchScene>& scenes,
                                               const std::vector<BenchProfile>& profiles,
                                               const std::vector<BenchSaving>& savings,
                                               const std::filesystem::path& folder,
                                               std::string_view format = figure::k_usual_format);

/// Draws the figures of an earlier bench again from its bench.csv, without measuring.
/// @return the figures @throws FigureError, or std::runtime_error if the file is not that of a bench
std::vector<std::filesystem::path> redraw_bench(const std::filesystem::path& csv, const std::filesystem::path& folder,
                                                std::string_view format = figure::k_usual_format);

}  // namespace monograin
