// `monograin check`.

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.hpp"
#include "cli/terminal.hpp"
#include "history/run.hpp"
#include "scenario/document.hpp"
#include "scenario/faults.hpp"
#include "scenario/remarks.hpp"
#include "study/atlas/definition.hpp"
#include "study/calibrate/calibration.hpp"
#include "study/identify/identify_file.hpp"
#include "study/sweep/sweep_file.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

struct CheckOptions {
  std::vector<std::string> files;
  std::vector<std::string> overrides;
};

void check_scenario(const NamedText& source, const std::vector<std::string>& overrides) {
  const CheckedScenario scenario = parse_scenario(source.text, source.file.string(), overrides);
  check_integrator(scenario);
  std::vector<std::string> remarks = remarks_on(scenario);
  if (auto remark = remark_on_times(scenario)) remarks.push_back(std::move(*remark));
  for (const std::string& remark : remarks) say("{}: warning: {}\n", scenario.name, remark);
}

/// Checks a file, and returns its kind in a word.
/// @throws ScenarioError with the faults of the file
std::string_view check_content(DocumentType type, NamedText source, const std::vector<std::string>& overrides) {
  switch (type) {
    case DocumentType::scenario:
      check_scenario(source, overrides);
      break;
    case DocumentType::sweep:
      return parse_sweep(std::move(source)).results.empty() ? "sweep" : "sensitivity";
    case DocumentType::experiment_plan:
      static_cast<void>(parse_experiment_plan(std::move(source)));
      return "design";
    case DocumentType::calibration:
      static_cast<void>(parse_calibration(std::move(source)));
      return "calibration";
    case DocumentType::figure: {
      FaultList faults;
      static_cast<void>(read_definition(source.file, faults));
      faults.throw_if_any();
      return "figure definition";
    }
  }
  return "scenario";
}

/// Checks a file, and prints its kind and whether it is valid. Adds its faults to a list.
void check_file(const std::string& file, const CheckOptions& options, std::vector<Fault>& faults) {
  NamedText source = read_named_text(file, "a scenario file, or one of another command");
  const std::string name = source.file.string();
  const DocumentType type = type_of(parse_document(source.text, name)).value_or(DocumentType::scenario);
  if (type != DocumentType::scenario && !options.overrides.empty()) {
    throw UsageError(fmt::format("--set overrides keys of scenarios; {} is {}", name, kind_of(type).noun));
  }
  try {
    print_data("{}: {}, valid\n", name, check_content(type, std::move(source), options.overrides));
  } catch (const ScenarioError& error) {
    const std::size_t count = error.faults().size();
    const std::string_view noun = kind_of(type).noun;
    print_data("{}: {}, {} fault{}\n", name, noun.substr(noun.find(' ') + 1), count, count == 1 ? "" : "s");
    faults.insert(faults.end(), error.faults().begin(), error.faults().end());
  }
}

/// Checks all files; the faults of all of them are reported together.
int check(const CheckOptions& options) {
  std::vector<Fault> faults;
  for (const std::string& file : options.files) {
    try {
      check_file(file, options, faults);
    } catch (const ScenarioError& error) {  // no TOML, or no file
      faults.insert(faults.end(), error.faults().begin(), error.faults().end());
    }
  }
  if (!faults.empty()) throw ScenarioError(std::move(faults));
  return k_success;
}

}  // namespace

void add_check_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command =
      app.add_subcommand("check", "Check files of every kind without running them, and say which kind each one is");
  command
      ->add_option("FILE", options->files,
                   "Scenarios, sweeps, sensitivities, calibrations, designs, figure definitions (TOML)")
      ->required();
  command->add_option("--set", options->overrides, "Override a key of scenarios: key=value")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all();
  command->footer("Example: monograin check scenarios/die.toml");
  command->callback([options, &action] { action = [options] { return check(*options); }; });
}

}  // namespace monograin
