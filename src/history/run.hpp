/// Running a checked scenario and recording the run; every command runs scenarios by these functions.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/drive.hpp"
#include "history/table.hpp"
#include "monograin/continuum_difference.hpp"
#include "monograin/status.hpp"
#include "monograin/version.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

/// Result of a run: status, statistics, and the recorded tables.
struct RunRecord : DriveResult {
  Table history;
  Table events;
  bool creates_energy = false;  ///< true if the dissipation falls; a warning then says when
};

/// Runs the program of a scene and records it.
/// @param integrator  name of an integrator, not `auto`
[[nodiscard]] RunRecord record_run(Scene& scene, std::string_view integrator, const Tolerances& tolerances,
                                   const Output& output);

/// Parts of a history that a run need not compute.
struct LeftOut {
  bool energies = false;  ///< true: columns of energies hold NaN
  bool rows = false;      ///< true: no rows within a step, unless the scenario lists output times
};

/// Makes the scene of a scenario, runs its program and records it, without the header, warnings, timings and
/// sensitivities of run_scenario().
[[nodiscard]] RunRecord record_run(const CheckedScenario& scenario, const LeftOut& left_out = {});

/// Runs the program of a scene with forward sensitivities, and records both.
/// @param integrator  name of an integrator that can integrate sensitivities
/// @param columns  headings of the derivatives, one for each derivative of a row
[[nodiscard]] RunRecord record_run(Scene& scene, std::string_view integrator, const Tolerances& tolerances,
                                   const Output& output, ForwardSensitivities& sensitivities,
                                   const std::vector<Column>& columns);

/// Checks that the integrator of a scenario suits its scene.
/// @throws ScenarioError if it asks for a direct solution, and the scene has none
void check_integrator(const CheckedScenario& scenario);

/// A contact class, the names of its walls and their outward unit normals.
struct ClassSummary {
  std::string name;
  std::vector<std::string> walls;
  std::vector<std::array<double, 3>> normals;
};

/// Wall-clock times [s].
struct Timings {
  double parse = 0.0;
  double setup = 0.0;
  double integration = 0.0;
  double output = 0.0;
};

/// Wraps a system in another one, such as one that measures times.
using SystemWrapper = std::function<std::unique_ptr<HybridSystem>(std::unique_ptr<HybridSystem>)>;

/// Method and accuracy of the derivatives with respect to one key.
struct Sensitivity {
  std::string key;
  double value = 0.0;       ///< value of the key [SI]
  double step = 0.0;        ///< distance of the two neighbouring values from `value` [SI]
  double error = 0.0;       ///< estimated error over the largest derivative of the column; NaN: no derivatives
  bool is_forward = false;  ///< true: integrated with a run; false: differences of more runs
  std::string why;          ///< reason for the method
};

/// Returns a wrapper that asks `stop` now and then, and ends the run by RunInterrupted once it is true; none if `stop`
/// is empty.
[[nodiscard]] SystemWrapper interruptible(const std::function<bool()>& stop);

/// Finite elements that computed a run in the place of the scenario's law.
struct RunElements {
  std::string solver;  ///< name and version
  std::string mesh;
  std::size_t count = 0;                           ///< of elements
  std::vector<ContinuumDifference> differences{};  ///< of the law
};

/// A run with everything that its files show.
struct Run {
  CheckedScenario scenario;
  RunRecord record;
  IntegratorChoice integrator;
  std::vector<ClassSummary> classes;
  std::vector<std::string> skipped;
  std::vector<Sensitivity> sensitivities;
  Timings timings;
  std::optional<RunElements> elements{};  ///< none: the law computed the run
};

/// Runs a checked scenario. History and events get the header lines that make their files self-describing.
/// @param wrapped  if given, wraps the system of the scene before the run
[[nodiscard]] Run run_scenario(const CheckedScenario& scenario, const SystemWrapper& wrapped = {});

/// Digest of a text, e.g. "xxh128:3f...".
[[nodiscard]] std::string text_digest(std::string_view text);

/// Digest of a scenario's text, its overrides and the files its options name.
[[nodiscard]] std::string scenario_digest(const CheckedScenario& scenario);

}  // namespace monograin
