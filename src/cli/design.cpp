// `monograin design`.

#include <filesystem>
#include <memory>
#include <string>

#include "cli/commands.hpp"
#include "cli/terminal.hpp"
#include "history/staged_folder.hpp"
#include "study/identify/identify_files.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

struct DesignOptions {
  std::string file;
  std::string output;
  std::string format{figure::k_usual_format};
};

int design(const DesignOptions& options) {
  const ExperimentPlan plan = read_experiment_plan(options.file);
  const fs::path folder = options.output.empty() ? fs::path("runs") / plan.name : fs::path(options.output);
  StagedFolder staged(folder, k_identify_marker);
  const IdentifyResult result = identify(plan);
  const std::string no_figure = write_identify(plan, result, staged, options.format);
  print_data("{}", identify_text(plan, result));
  if (!no_figure.empty()) say("warning: no figure: {}\n", no_figure);
  for (std::size_t k = 0; k < plan.programs.size(); ++k) {
    for (const std::string& note : result.programs[k].notes) say("note: {}: {}\n", plan.programs[k].name, note);
  }
  say("{}: expected errors -> {}\n", plan.name, folder.string());
  return k_success;
}

}  // namespace

void add_design_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<DesignOptions>();
  CLI::App* command = app.add_subcommand(
      "design", "Say which errors of parameters to expect of an experiment, and which program of loads helps most");
  command->add_option("FILE", options->file, "Plan of an experiment (TOML): scenario, free parameters, programs, noise")
      ->required();
  command->add_option("-o,--output", options->output, "Folder of the results [runs/NAME]");
  add_figure_format(*command, options->format);
  command->footer("Example: monograin design scenarios/design/uniaxial.toml");
  command->callback([options, &action] { action = [options] { return design(*options); }; });
}

}  // namespace monograin
