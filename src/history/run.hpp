/// From a scenario to a recorded run: the one way every command takes.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/drive.hpp"
#include "history/table.hpp"
#include "monograin/version.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

/// What a drive leaves behind.
struct RunRecord : DriveResult {
  Table history;
  Table events;
  bool creates_energy = false;  ///< the dissipation falls, and a warning says so
};

/// Drives a scene and records it.
[[nodiscard]] RunRecord record_run(Scene& scene, std::string_view integrator, const Tolerances& tolerances,
                                   const Output& output);

/// Parts of a history that a study does not read.
struct LeftOut {
  bool energies = false;  ///< their columns hold NaN
  bool rows = false;      ///< those at output points within a step; not where the scenario lists its output times
};

/// Runs a scenario by itself: without the header, the warnings and the timings of run_scenario(), and without
/// sensitivities.
[[nodiscard]] RunRecord record_run(const CheckedScenario& scenario, const LeftOut& left_out = {});

/// Carries derivatives along, and records them.
/// @param columns  of the derivatives, as many as a row of them has
[[nodiscard]] RunRecord record_run(Scene& scene, std::string_view integrator, const Tolerances& tolerances,
                                   const Output& output, ForwardSensitivities& sensitivities,
                                   const std::vector<Column>& columns);

struct ClassSummary {
  std::string name;
  std::vector<std::string> walls;
};

/// Wall-clock times [s].
struct Timings {
  double parse = 0.0;
  double setup = 0.0;
  double integration = 0.0;
  double output = 0.0;
};

/// Gives back a system with something around it, such as a clock.
using SystemWrapper = std::function<std::unique_ptr<HybridSystem>(std::unique_ptr<HybridSystem>)>;

/// How the derivatives by a number were found.
struct Sensitivity {
  std::string key;
  double value = 0.0;       ///< [SI]
  double step = 0.0;        ///< to either side [SI]
  double error = 0.0;       ///< estimate, over the largest derivative of the same column; nan: there are none
  bool is_forward = false;  ///< integrated with the run; else differences of two more runs
  std::string why;          ///< this method
};

struct Run {
  CheckedScenario scenario;
  RunRecord record;
  IntegratorChoice integrator;
  std::vector<ClassSummary> classes;
  std::vector<std::string> skipped;
  std::vector<Sensitivity> sensitivities;
  Timings timings;
};

/// Runs a checked scenario. Histories and events carry the header lines that make their files self-describing.
/// @param wrapped  takes the scene's system before it runs, and returns what is to run in its place
[[nodiscard]] Run run_scenario(const CheckedScenario& scenario, const SystemWrapper& wrapped = {});

/// Digest of a text, e.g. "xxh128:3f...".
[[nodiscard]] std::string text_digest(std::string_view text);

/// Digest of a scenario's text, its overrides and the files its options name.
[[nodiscard]] std::string scenario_digest(const CheckedScenario& scenario);

}  // namespace monograin
