// `monograin export`.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/terminal.hpp"
#include "exchange/force_table.hpp"
#include "exchange/lammps.hpp"
#include "exchange/motion.hpp"
#include "history/run.hpp"
#include "scenario/text_file.hpp"

namespace monograin {
namespace {

struct ExportOptions {
  std::string file;
  std::vector<std::string> overrides;
  std::string output;
  std::optional<std::string> wall;
};

/// Runs a scenario, and gives the motion of its walls.
Motion motion_of_run(const CheckedScenario& scenario, RunStatus& status) {
  const Run run = run_scenario(scenario);
  for (const std::string& warning : run.record.warnings) say("warning: {}\n", warning);
  if (!run.record.message.empty()) {
    say("{}: {}: {}\n", scenario.name, to_string(run.record.status), run.record.message);
  }
  status = run.record.status;
  return motion_of(scenario, run.record.history);
}

/// Prints a text, or writes it to the file of -o.
void put(const std::string& text, const std::string& output) {
  if (output.empty()) {
    print_data("{}", text);
    return;
  }
  write_text_file(output, text);
  say("-> {}\n", output);
}

/// Makes the text of a scenario; its faults are faults of the command line.
template <class Make>
int export_scenario(const ExportOptions& options, Make&& make) {
  if (!options.output.empty()) expect_own_file(options.output, options.output);
  const CheckedScenario scenario = read_scenario(options.file, options.overrides, FileKind::any);
  RunStatus status = RunStatus::complete;
  try {
    put(make(scenario, status), options.output);
  } catch (const std::invalid_argument& error) {
    throw UsageError(options.file + ": " + error.what());
  }
  return exit_code_of(status);
}

int export_lammps(const ExportOptions& options) {
  return export_scenario(options, [](const CheckedScenario& scenario, RunStatus& status) {
    const LammpsLaw law = lammps_law_of(scenario);
    return lammps_input(scenario, motion_of_run(scenario, status), law);
  });
}

int export_table(const ExportOptions& options) {
  return export_scenario(options, [&](const CheckedScenario& scenario, RunStatus& status) {
    return csv_text(force_table(motion_of_run(scenario, status), options.wall));
  });
}

CLI::App* add_export(CLI::App& parent, const std::string& name, const std::string& description,
                     const std::shared_ptr<ExportOptions>& options) {
  CLI::App* command = parent.add_subcommand(name, description);
  command->add_option("FILE", options->file, "Scenario file (TOML)")->required();
  command->add_option("--set", options->overrides, "Override a key: key=value, e.g. material.yield_stress='30 MPa'")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all();
  command->add_option("-o,--output", options->output, "File to write [standard output]");
  return command;
}

}  // namespace

void add_export_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* command = app.add_subcommand("export", "Write a scenario's test for other programs");
  command->require_subcommand(1);
  command->footer("Example: monograin export lammps scenarios/die.toml -o in.die");
  CLI::App* lammps = add_export(
      *command, "lammps", "Input file of LAMMPS for the same test, with its line pair_coeff for the material", options);
  lammps->footer("Example: monograin export lammps scenarios/die.toml -o in.die");
  lammps->callback([options, &action] { action = [options] { return export_lammps(*options); }; });
  CLI::App* table = add_export(*command, "table", "Force over displacement of a wall as CSV", options);
  table->add_option("--wall", options->wall, "Contact class [the first that moves]");
  table->footer("Example: monograin export table scenarios/uniaxial.toml -o force.csv");
  table->callback([options, &action] { action = [options] { return export_table(*options); }; });
}

}  // namespace monograin
