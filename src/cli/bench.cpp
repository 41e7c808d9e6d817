// `monograin bench`: run time against error.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "cli/commands.hpp"
#include "cli/data_folder.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "figure/page.hpp"
#include "history/staged_folder.hpp"
#include "scenario/integrators.hpp"
#include "scenario/text_file.hpp"
#include "study/atlas/atlas.hpp"
#include "verify/bench/bench.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

struct BenchOptions {
  std::vector<std::string> scenes;
  std::string list;
  std::string definitions;
  std::string output;
  std::string measured;
  std::string format{figure::k_usual_format};
  std::vector<std::string> integrators;
  std::vector<double> tolerances;
  bool is_against_fe = false;
  bool profiles = false;
};

constexpr const char* k_fe_figure = "laws-fe";

/// Compares every law with finite-element curves.
int bench_against_fe(const BenchOptions& options) {
  std::vector<AtlasFigure> figures = make_atlas(options.definitions, {k_fe_figure});
  figures.front().format = options.format;
  for (const fs::path& file : write_atlas(figures, options.output)) say("-> {}\n", file.string());
  for (const AtlasFigure& figure : figures) print_data("{}\n", tables_text(figure));
  return exit_code_of(figures.front().status);
}

/// Scenes that are named, in the list or as scenario files; all scenes of the list if none is named.
std::vector<CheckedScenario> chosen_scenes(const BenchOptions& options, const std::vector<CheckedScenario>& listed) {
  if (options.scenes.empty()) return listed;
  std::vector<CheckedScenario> chosen;
  for (const std::string& name : options.scenes) {
    const auto found = std::ranges::find(listed, name, &CheckedScenario::name);
    if (found != listed.end()) {
      chosen.push_back(*found);
    } else if (fs::path(name).extension() == ".toml") {
      chosen.push_back(read_scenario(name, {}, FileKind::any));
    } else {
      std::string names;
      for (const CheckedScenario& scene : listed) names += (names.empty() ? "" : ", ") + scene.name;
      throw UsageError(
          fmt::format("{}: no such scene in {}, nor a scenario file (.toml); there are {}", name, options.list, names));
    }
  }
  return chosen;
}

/// Integrators by their present names.
std::vector<std::string> checked_integrators(std::vector<std::string> names) {
  for (std::string& name : names) {
    name = integrators::present_name(name);
    if (name == integrators::k_auto || std::ranges::find(integrator_names(), name) != integrator_names().end())
      continue;
    throw UsageError(fmt::format("no integrator is called '{}'; expected auto or one of {}", name,
                                 fmt::join(integrator_names(), ", ")));
  }
  return names;
}

constexpr const char* k_list = "scenarios/bench/scenes.toml";

/// Fills in options that were not given: the data that come with the program; for the result the folder plots of a
/// checkout, elsewhere bench.
BenchOptions with_defaults(BenchOptions options) {
  if (options.list.empty()) options.list = find_data({k_list}).path(k_list).string();
  if (options.definitions.empty()) options.definitions = find_data({"plots"}).path("plots").string();
  if (options.output.empty()) options.output = fs::exists(k_list) ? "plots" : "bench";
  return options;
}

int bench(const BenchOptions& named) {
  const BenchOptions options = with_defaults(named);
  if (options.is_against_fe) return bench_against_fe(options);
  if (!options.measured.empty()) {
    for (const fs::path& file : redraw_bench(options.measured, options.output, options.format)) {
      fmt::print(stderr, "-> {}\n", file.string());
    }
    return k_success;
  }
  const BenchSettings settings{.integrators = checked_integrators(options.integrators),
                               .tolerances = options.tolerances};
  const bool needs_list = options.scenes.empty() || std::ranges::any_of(options.scenes, [](const std::string& name) {
                            return fs::path(name).extension() != ".toml";
                          });
  if (needs_list && !fs::exists(options.list)) {
    throw std::runtime_error(fmt::format(
        "{}: no such file; run this in the project's folder, or name the list with --scenes", options.list));
  }
  const BenchList list = needs_list ? read_bench_list(options.list) : BenchList{};
  const std::vector<CheckedScenario> scenarios = chosen_scenes(options, list.scenes);
  prepare_folder(options.output);
  const fs::path output = options.output;
  for (const char* name : {"bench.csv", "bench.md"}) expect_own_file(output / name, output / "bench.csv");
  for (const CheckedScenario& scenario : scenarios) {
    figure::expect_own_figure(output / fmt::format("bench-{}.{}", scenario.name, options.format));
  }
  std::vector<BenchScene> scenes;
  std::vector<BenchProfile> profiles;
  {
    ProgressBar bar("scenes");
    for (const CheckedScenario& scenario : scenarios) {
      const std::size_t done = scenes.size();
      scenes.push_back(measure_scene(scenario, settings, [&] { bar.show(done, scenarios.size()); }));
      if (!options.profiles) continue;
      std::vector<std::string> integrators = settings.integrators;
      if (integrators.empty()) integrators = {integrators::k_auto, integrators::k_cvode_bdf, integrators::k_ida};
      for (const std::string& name : integrators) profiles.push_back(profile_scene(scenario, name));
    }
  }
  std::vector<BenchSaving> savings;
  if (options.scenes.empty()) savings = measure_savings(settings, list.savings);
  print_data("{}", bench_text(scenes, profiles, savings));
  for (const fs::path& file : write_bench(scenes, profiles, savings, options.output, options.format)) {
    say("-> {}\n", file.string());
  }
  return k_success;
}

}  // namespace

void add_bench_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<BenchOptions>();
  CLI::App* command = app.add_subcommand("bench", "Measure run time against error over integrators and tolerances");
  command->add_option("SCENE", options->scenes, "Scenes of the list, or scenario files [all of the list]");
  command->add_option("--scenes", options->list,
                      "List of scenes [scenarios/bench/scenes.toml, or that of the program]");
  command->add_option("--integrator", options->integrators, "Integrators to measure [auto and all there are]")
      ->type_name("NAME,...")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("--rtol", options->tolerances, "Relative tolerances, 1e-15 to 0.1 [1e-2 to 1e-13]")
      ->type_name("FLOAT,...")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(1e-15, 0.1))
      ->check(is_no_nan());
  command->add_flag("--profile", options->profiles, "Also tell where the time goes");
  command->add_flag("--against-fe", options->is_against_fe,
                    "Instead hold every law against finite-element curves: errors, slopes and a figure");
  command->add_option("--plots", options->definitions,
                      "Folder of the definition for --against-fe [plots, or that of the program]");
  command->add_option("--redraw", options->measured, "Instead draw the figures anew from an earlier bench.csv")
      ->check(CLI::ExistingFile)
      ->excludes("--against-fe");
  command->add_option("-o,--output", options->output,
                      "Folder of table, CSV and figures [plots in a checkout, else bench]");
  add_figure_format(*command, options->format);
  command->footer("Example: monograin bench mdr-die-50 --integrator auto,cvode-bdf -o bench");
  command->callback([options, &action] { action = [options] { return bench(*options); }; });
}

}  // namespace monograin
