// `monograin continuum`.

#include <fmt/format.h>

#include <algorithm>
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
#include "figure/markdown.hpp"
#include "history/external_program.hpp"
#include "history/run_files.hpp"
#include "scenario/text_file.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

struct ContinuumCommand {
  std::string file;
  std::vector<std::string> overrides;
  std::string output;
  std::string mesh = std::string(ContinuumOptions{}.mesh);
  bool estimates_error = false;
  bool keeps_files = false;
};

fs::path find_calculix() {
  if (const auto ccx = find_program("ccx")) return *ccx;
  throw UsageError(
      "ccx was not found on the PATH; finite elements need CalculiX (on Debian: apt-get install calculix-ccx)");
}

std::string percent(double share) { return std::isnan(share) ? "-" : fmt::format("{:.1f} %", 100.0 * share); }

void print_differences(const ContinuumRun& result, bool has_error) {
  std::vector<MarkdownRow> rows{
      {"largest difference of " + result.run.scenario.model, "loading", "unloading and reloading"}};
  if (has_error) rows.front().push_back("error of the elements");
  for (const auto& [column, loading, unloading, mesh_error] : result.differences) {
    rows.push_back({column, percent(loading), percent(unloading)});
    if (has_error) rows.back().push_back(percent(mesh_error));
  }
  std::string text;
  append_markdown(text, rows);
  print_data("{}", text);
}

/// Removes files of CalculiX: all, or those that nobody wants.
void clear(const fs::path& folder, bool keeps_files) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  for (const fs::path& file : files) {
    const bool is_wanted = std::ranges::find(k_calculix_files, file.filename().string()) != k_calculix_files.end();
    if (!keeps_files || !is_wanted) fs::remove(file);
  }
}

int run_command(const ContinuumCommand& command) {
  const CheckedScenario scenario = read_scenario(command.file, command.overrides, FileKind::any);
  const ContinuumMaterial material = or_usage_error(command.file, [&] { return continuum_material_of(scenario); });
  ContinuumOptions options{
      .mesh = command.mesh, .estimates_error = command.estimates_error, .ccx = find_calculix(), .folder = {}};
  const fs::path folder =
      command.output.empty() ? fs::path("runs") / (folder_name(scenario) + "-continuum") : fs::path(command.output);
  std::vector<std::string_view> names(k_run_tables.begin(), k_run_tables.end());
  if (command.keeps_files) names.insert(names.end(), k_calculix_files.begin(), k_calculix_files.end());
  StagedFolder staged(folder, k_run_marker, names);
  options.folder = fs::absolute(staged.path());

  const Run law = run_scenario(scenario);
  for (const std::string& warning : law.record.warnings) say("warning: {}: {}\n", scenario.model, warning);
  for (const std::string& difference : material.differences) say("warning: {}\n", difference);
  say("{}: {}, {} rows; CalculiX computes on the mesh {}\n", scenario.name, to_string(law.record.status),
      law.record.history.row_count(), command.mesh);
  ContinuumRun result = [&] {
    ProgressBar bar("instants");
    options.progress = [&bar](std::size_t done, std::size_t of) { bar.show(done, of); };
    return or_usage_error(command.file, [&] { return run_continuum(law, options); });
  }();
  const RunRecord& record = result.run.record;
  clear(staged.path(), command.keeps_files);
  write_csv(staged.path() / k_run_tables[0], record.history);
  write_csv(staged.path() / k_run_tables[1], record.events);
  write_text_file(staged.path() / k_run_marker, continuum_json(result, command.mesh));
  staged.publish(staged.age());

  // The differences of the material were printed before CalculiX began.
  for (const std::string& warning : std::span(record.warnings).subspan(material.differences.size())) {
    say("warning: {}\n", warning);
  }
  print_differences(result, command.estimates_error);
  say("{}: {}, {} elements, {} rows -> {}\n", scenario.name, to_string(record.status), result.elements,
      record.history.row_count(), folder.string());
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
