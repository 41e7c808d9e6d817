// `monograin stress`.

#include "verify/stress/stress.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "verify/stress/check/checks.hpp"

namespace monograin {
namespace {

struct CommandOptions {
  std::vector<std::string> files;
  std::vector<std::string> models;
  double seconds = 60.0;
  std::uint64_t seed = 1;
  std::size_t scenes = 0;
  std::uint64_t first = 0;
  int threads = 0;
  std::string output = "runs/stress";
};

/// Checks given scenarios, such as those that a stress test has written.
int check_files(const std::vector<std::string>& files) {
  int code = k_success;
  std::vector<CheckedScenario> scenarios;
  for (const std::string& file : files) scenarios.push_back(read_scenario(file, {}, FileKind::any));
  for (std::size_t i = 0; i < files.size(); ++i) {
    const StressVerdict verdict = check_scene(scenarios[i]);
    if (!verdict.violations.empty()) code = k_solver_failure;
    if (verdict.violations.empty()) print_data("{}: passes ({})\n", files[i], verdict.end);
    for (const Violation& violation : verdict.violations) {
      print_data("{}: {}: {}\n", files[i], violation.check, violation.detail);
    }
  }
  return code;
}

int stress(const CommandOptions& options) {
  if (!options.files.empty()) return check_files(options.files);
  DrawnModels models;
  for (const std::string& name : options.models) {
    const Model& model = model_named(name);
    if (model.draw == nullptr) {
      throw UsageError(fmt::format("--model {}: the model has no function `draw`, which draws its materials", name));
    }
    models.insert(&model);
  }
  const StressReport report = [&] {
    ProgressBar bar("scenes");
    return run_stress({.seed = options.seed,
                       .seconds = options.seconds,
                       .scenes = options.scenes,
                       .first = options.first,
                       .models = models,
                       .threads = options.threads,
                       .folder = options.output,
                       .progress = [&](auto done, auto of) { bar.show(done, of); }});
  }();
  print_data("{}", report.text());
  say("{} scenes, {} failures -> {}; the slowest, {}, took {:.1f} s\n", report.scenes, report.failures.size(),
      options.output, report.slowest, report.slowest_seconds);
  if (report.scenes == 0) throw UsageError("no scene was checked; give it more time with --time");
  return report.failures.empty() ? k_success : k_solver_failure;
}

}  // namespace

void add_stress_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<CommandOptions>();
  CLI::App* command = app.add_subcommand(
      "stress", "Run random and extreme scenes of every model, and check what must hold of their results");
  command->add_option("FILE", options->files, "Check these scenarios instead of drawn ones");
  const std::map<std::string, double> units{{"s", 1.0}, {"min", 60.0}, {"h", 3600.0}};
  command->add_option("--time", options->seconds, "How long: 60s, 5min, 1h [60s]")
      ->transform(CLI::AsNumberWithUnit(units, CLI::AsNumberWithUnit::CASE_SENSITIVE))
      ->check(CLI::PositiveNumber)
      ->type_name("TIME");
  command->add_option("--model", options->models, "Draw scenes of these models only, a sequence of their own [all]")
      ->type_name("NAME,...")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("--seed", options->seed, "Which sequence of scenes, a number from 0 [1]")
      ->check(CLI::NonNegativeNumber);
  command->add_option("-n,--scenes", options->scenes, "End after so many scenes [none: when the time is up]")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--first", options->first, "Index of the scene to begin with, from 0 [0]")
      ->check(CLI::NonNegativeNumber);
  command->add_option("-j,--jobs", options->threads, "Number of threads, 1 to 1024 [one for each core that it may use]")
      ->check(CLI::Range(1, 1024));
  command->add_option("-o,--output", options->output, "Folder of the report and the failing scenes [runs/stress]");
  command->footer("Example: monograin stress --time 20s --seed 7 --model hertz,mdr");
  command->callback([options, &action] { action = [options] { return stress(*options); }; });
}

}  // namespace monograin
