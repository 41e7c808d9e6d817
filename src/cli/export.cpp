// `monograin export`.

#include <filesystem>
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
#include "history/staged_folder.hpp"
#include "scenario/text_file.hpp"

namespace monograin {
namespace {

struct ExportOptions {
  std::string file;
  std::vector<std::string> overrides;
  std::string output;
  std::optional<std::string> wall;
};

bool goes_to_standard_output(const ExportOptions& options) {
  return options.output.empty() || options.output == "-" || options.output == "/dev/stdout";
}

/// Runs a scenario, and prints its text or writes it to the file of -o.
/// @param make  (motion of the scenario's run) -> text
template <class Make>
int export_run(const ExportOptions& options, const CheckedScenario& scenario, Make&& make) {
  const Run run = run_scenario(scenario);
  for (const std::string& warning : run.record.warnings) say("warning: {}\n", warning);
  if (!run.record.message.empty()) {
    say("{}: {}: {}\n", scenario.name, to_string(run.record.status), run.record.message);
  }
  const std::string text = or_usage_error(options.file, [&] { return make(motion_of(scenario, run.record.history)); });
  if (goes_to_standard_output(options)) {
    print_data("{}", text);
  } else {
    write_text_file(destination_of(options.output), text);
    say("-> {}\n", options.output);
  }
  return exit_code_of(run.record.status);
}

CheckedScenario scenario_of(const ExportOptions& options) {
  if (!goes_to_standard_output(options)) {
    const std::filesystem::path file = destination_of(options.output);  // a link stays
    expect_own_file(file, file);
  }
  return read_scenario(options.file, options.overrides, FileKind::any);
}

int export_lammps(const ExportOptions& options) {
  const CheckedScenario scenario = scenario_of(options);
  const LammpsLaw law = or_usage_error(options.file, [&] { return lammps_law_of(scenario); });
  return export_run(options, scenario, [&](const Motion& motion) { return lammps_input(scenario, motion, law); });
}

int export_table(const ExportOptions& options) {
  return export_run(options, scenario_of(options),
                    [&](const Motion& motion) { return csv_text(force_table(motion, options.wall)); });
}

CLI::App* add_export(CLI::App& parent, const std::string& name, const std::string& description,
                     const std::shared_ptr<ExportOptions>& options) {
  CLI::App* command = parent.add_subcommand(name, description);
  command->add_option("FILE", options->file, "Scenario file (TOML)")->required();
  add_overrides(*command, options->overrides);
  command->add_option("-o,--output", options->output, "File to write; - is standard output [-]");
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
