/// The commands of the program. Each command adds itself to the command line, and returns the exit code of the process.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/drive.hpp"

namespace monograin {

struct CheckedScenario;
struct Model;

/// Exit codes that scripts rely on.
enum ExitCode : int {
  k_success = 0,
  k_unexpected = 1,      ///< a bug
  k_usage = 2,           ///< command line, scenario or file fault; nothing was run or written
  k_left_domain = 3,     ///< a run left its model's domain; the history up to there is kept
  k_solver_failure = 4,  ///< a solver gave up; the history up to there is kept
  k_differs = 5          ///< a comparison was above its tolerance, or a fit is bad
};

/// Name of a run's folder below `runs` or below -o. A digest of the overrides lets runs of one scenario with different
/// overrides have folders of their own.
[[nodiscard]] std::string folder_name(const CheckedScenario& scenario);

/// Exit code of the process after a run that has ended with a status.
[[nodiscard]] int exit_code_of(RunStatus status);

/// A fault in the command line; what() is shown to the user.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Value of a call whose invalid arguments come from the command line.
/// @param subject  file or run that a fault is of
/// @throws UsageError if the call throws std::invalid_argument
template <class Call>
auto or_usage_error(const std::string& subject, Call&& call) {
  try {
    return call();
  } catch (const std::invalid_argument& error) {
    throw UsageError(subject + ": " + error.what());
  }
}

/// Adds the option --set, which overrides keys of a scenario.
void add_overrides(CLI::App& command, std::vector<std::string>& overrides);

/// Adds the option --figure, which chooses the format of the figures that a command leaves.
/// @param format  keeps its value without the option
CLI::Option* add_figure_format(CLI::App& command, std::string& format);

/// The model of a name given on the command line.
/// @throws UsageError if there is no such model; the message lists the models
[[nodiscard]] const Model& model_named(const std::string& name);

/// Check of an option that takes a number: refuses nan, which the ranges of CLI11 accept.
[[nodiscard]] CLI::Validator is_no_nan();

/// Reads files one after another, and reports the faults of all of them together.
/// @throws ScenarioError with these faults
void read_each(const std::vector<std::string>& files, const std::function<void(const std::string&)>& read);

/// Prints what every law makes of a scenario's scene, and how far it is from finite elements. Returns the exit code.
[[nodiscard]] int show_laws_for(const std::string& file);

/// Runs the command that was named, which sets it; returns the exit code.
using Action = std::function<int()>;

void add_run_command(CLI::App& app, Action& action);
void add_check_command(CLI::App& app, Action& action);
void add_models_command(CLI::App& app, Action& action);
void add_cite_command(CLI::App& app, Action& action);
void add_units_command(CLI::App& app, Action& action);
void add_plot_command(CLI::App& app, Action& action);
void add_atlas_command(CLI::App& app, Action& action);
void add_compare_command(CLI::App& app, Action& action);
void add_regress_command(CLI::App& app, Action& action);
void add_calibrate_command(CLI::App& app, Action& action);
void add_design_command(CLI::App& app, Action& action);
void add_data_command(CLI::App& app, Action& action);
void add_export_command(CLI::App& app, Action& action);
void add_continuum_command(CLI::App& app, Action& action);
void add_sweep_command(CLI::App& app, Action& action);
void add_sensitivity_command(CLI::App& app, Action& action);
void add_bench_command(CLI::App& app, Action& action);
void add_stress_command(CLI::App& app, Action& action);
void add_schema_command(CLI::App& app, Action& action);

}  // namespace monograin
