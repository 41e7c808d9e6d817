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
  say_warnings(scenario.name, remarks);
}

/// Kind of a file in words.
std::string_view kind_in_words(DocumentType type, const toml::table& tree) {
  if (type == DocumentType::sweep && tree.contains("results")) return "sensitivity";
  const std::string_view noun = kind_of(type).noun;
  return noun.substr(noun.find(' ') + 1);
}

/// @throws ScenarioError with the faults of the file
void check_content(DocumentType type, NamedText source, const std::vector<std::string>& overrides) {
  switch (type) {
    case DocumentType::scenario:
      check_scenario(source, overrides);
      break;
    case DocumentType::sweep: {
      const Sweep sweep = parse_sweep(std::move(source));
      say_warnings(sweep.name, sweep.doubts);
      break;
    }
    case DocumentType::experiment_plan:
      static_cast<void>(parse_experiment_plan(std::move(source)));
      break;
    case DocumentType::calibration:
      static_cast<void>(parse_calibration(std::move(source)));
      break;
    case DocumentType::figure: {
      FaultList faults;
      static_cast<void>(parse_definition(std::move(source), faults));
      faults.throw_if_any();
    }
  }
}

/// Checks a file, and prints its kind and whether it is valid.
/// @throws ScenarioError with its faults
void check_file(const std::string& file, const CheckOptions& options) {
  NamedText source = read_named_text(file, "a scenario file, or one of another command");
  const std::string name = source.file.string();
  const toml::table tree = parse_document(source.text, name);
  const DocumentType type = type_of(tree).value_or(DocumentType::scenario);
  const std::string_view kind = kind_in_words(type, tree);
  try {
    if (type != DocumentType::scenario && !options.overrides.empty()) {
      throw_fault({name}, fmt::format("--set overrides keys of scenarios, and this is a {}", kind));
    }
    check_content(type, std::move(source), options.overrides);
    print_data("{}: {}, valid\n", name, kind);
  } catch (const ScenarioError& error) {
    const std::size_t count = error.faults().size();
    print_data("{}: {}, {} fault{}\n", name, kind, count, count == 1 ? "" : "s");
    throw;
  }
}

int check(const CheckOptions& options) {
  read_each(options.files, [&](const std::string& file) { check_file(file, options); });
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
  add_overrides(*command, options->overrides);
  command->footer("Example: monograin check scenarios/die.toml");
  command->callback([options, &action] { action = [options] { return check(*options); }; });
}

}  // namespace monograin
