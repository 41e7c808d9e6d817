// `monograin continuum`.

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "continuum/continuum.hpp"
#include "continuum/continuum_folder.hpp"
#include "figure/markdown.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

struct ContinuumCommand {
  std::string file;
  std::vector<std::string> overrides;
  std::string output;
  std::string mesh = std::string(ElementOptions{}.mesh);
  bool estimates_error = false;
  bool keeps_files = false;
};

std::string percent(double share) { return std::isnan(share) ? "-" : fmt::format("{:.1f} %", 100.0 * share); }

void print_differences(const Run& result, bool has_error) {
  std::vector<MarkdownRow> rows{
      {"largest difference of " + result.scenario.model, "loading", "unloading and reloading"}};
  if (has_error) rows.front().push_back("error of the elements");
  for (const auto& [column, loading, unloading, mesh_error] : result.elements->differences) {
    rows.push_back({column, percent(loading), percent(unloading)});
    if (has_error) rows.back().push_back(percent(mesh_error));
  }
  std::string text;
  append_markdown(text, rows);
  print_data("{}", text);
}

int run_command(const ContinuumCommand& command) {
  const CheckedScenario scenario = read_scenario(command.file, command.overrides, FileKind::any);
  const ContinuumMaterial material = or_usage_error(command.file, [&] { return continuum_material_of(scenario); });
  ElementOptions options{
      .mesh = command.mesh, .estimates_error = command.estimates_error, .ccx = find_calculix(), .folder = {}};
  const fs::path target =
      command.output.empty() ? fs::path("runs") / (folder_name(scenario) + "-continuum") : fs::path(command.output);
  ContinuumFolder folder(target, command.keeps_files);
  options.folder = folder.path();

  const Run law = run_scenario(scenario);
  for (const std::string& warning : law.record.warnings) say("warning: {}: {}\n", scenario.model, warning);
  for (const std::string& difference : material.differences) say("warning: {}\n", difference);
  say("{}: {}, {} rows; CalculiX computes on the mesh {}\n", scenario.name, to_string(law.record.status),
      law.record.history.row_count(), command.mesh);
  Run result = [&] {
    ProgressBar bar("instants");
    options.progress = [&bar](std::size_t done, std::size_t of) { bar.show(done, of); };
    return or_usage_error(command.file, [&] { return run_continuum(law, options); });
  }();
  const RunRecord& record = result.record;
  folder.publish(result);

  // The differences of the material were printed before CalculiX began.
  for (const std::string& warning : std::span(record.warnings).subspan(material.differences.size())) {
    say("warning: {}\n", warning);
  }
  print_differences(result, command.estimates_error);
  say("{}: {}, {} elements, {} rows -> {}\n", scenario.name, to_string(record.status), result.elements->count,
      record.history.row_count(), target.string());
  if (!record.message.empty()) say("{}: {}: {}\n", scenario.name, to_string(record.status), record.message);
  return exit_code_of(record.status);
}

}  // namespace

void add_continuum_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<ContinuumCommand>();
  CLI::App* command =
      app.add_subcommand("continuum", "Compute a scenario's particle by finite elements (CalculiX), beside its law");
  command->add_option("FILE", options->file, "Scenario file (TOML)")->required();
  command->add_option("--mesh", options->mesh, "Mesh: coarse, medium, fine")
      ->check(CLI::IsMember(std::vector<std::string>(k_continuum_meshes.begin(), k_continuum_meshes.end())))
      ->capture_default_str();
  command->add_flag("--error", options->estimates_error, "Compute on a coarser mesh as well, and state the error");
  command->add_flag("--keep", options->keeps_files, "Keep the files of CalculiX beside the history");
  add_overrides(*command, options->overrides);
  command->add_option("-o,--output", options->output,
                      "Folder of the results [runs/NAME-continuum, with --set runs/NAME-DIGEST-continuum]");
  command->footer("Example: monograin continuum scenarios/uniaxial.toml --mesh coarse");
  command->callback([options, &action] { action = [options] { return run_command(*options); }; });
}

}  // namespace monograin
