#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <memory>
#include <new>
#include <span>
#include <sstream>
#include <string_view>

#include "cli/commands.hpp"
#include "cli/terminal.hpp"
#include "history/run.hpp"
#include "scenario/hidden_path.hpp"
#include "scenario/scenario.hpp"
#include "scenario/words.hpp"

namespace {

using namespace monograin;

int fail_for_memory() {
  // Must not allocate.
  write_stream(
      stderr,
      "monograin: there is not enough memory; nothing more was written. Ask for fewer output points, steps, runs "
      "or threads\n");
  return k_solver_failure;
}

std::atomic<bool> has_run_out_of_memory{false};

int run_action(const Action& action) {
  try {
    return action();
  } catch (const ScenarioError& error) {
    // A parser that lacks memory may take it for a fault of the text.
    if (has_run_out_of_memory) return fail_for_memory();
    say("{}\n", error.what());
    return k_usage;
  } catch (const UsageError& error) {
    say("monograin: {}\n", error.what());
    return k_usage;
  } catch (const std::length_error&) {  // a container that cannot be that large
    return fail_for_memory();
  } catch (const std::logic_error& error) {
    say("monograin: this is a bug, please report it with the command and its files: {}\n", error.what());
    return k_unexpected;
  } catch (const std::bad_alloc&) {
    return fail_for_memory();
  } catch (const std::exception& error) {  // a file, a folder, or gnuplot
    say("monograin: {}\n", in_own_words(error));
    return k_usage;
  }
}

// --- the command line

/// Help in lines of at most 80 characters.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_description(const CLI::App* app) const override { return list_entry("", 0, app->get_description()); }
  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    const std::string head = fmt::format("  {}{}", make_option_name(option, is_positional), make_option_opts(option));
    return list_entry(head, get_column_width(), make_option_desc(option));
  }
  std::string make_subcommand(const CLI::App* command) const override {
    return list_entry("  " + command->get_name(), get_column_width(), command->get_description());
  }
};

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

std::vector<std::string> names_of(const std::vector<const CLI::App*>& commands) {
  std::vector<std::string> names;
  for (const CLI::App* command : commands) names.push_back(command->get_name());
  return names;
}

/// Values of an option as they were typed; the parser may have changed its own copies.
std::string values_on_line(const CLI::Option& option, std::span<char* const> words) {
  std::size_t left = std::max<std::size_t>(1, option.results().size());
  std::vector<std::string_view> values;
  bool is_its = false;
  for (const std::string_view word : words) {
    const std::size_t equals = word.find('=');
    if (word.starts_with('-') && option.check_name(std::string(word.substr(0, equals)))) {
      is_its = true;
      if (equals == std::string_view::npos) continue;
      values.push_back(word.substr(equals + 1));
    } else if (is_its) {
      values.push_back(word);
    } else {
      continue;
    }
    if (--left == 0) break;
  }
  return values.empty() ? fmt::format("{}", fmt::join(option.results(), " "))
                        : fmt::format("{}", fmt::join(values, " "));
}

/// Message that names the option at fault and what it expects; empty if no option is at fault.
std::string fault_of_option(const CLI::ParseError& error, const CLI::App& command, std::span<char* const> words) {
  const std::string text = error.what();
  if (dynamic_cast<const CLI::ExcludesError*>(&error) != nullptr) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options()) {
      if (option->count() > 0 && text.find(option->get_name()) != std::string::npos)
        names.push_back(option->get_name());
    }
    return fmt::format("{} exclude each other; expected one of them", fmt::join(names, " and "));
  }
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_name();
    if (option->get_required() && option->count() == 0 && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
      return fmt::format("{} is missing; expected: {}", name, option->get_description());
    }
    // The parser's message names the option and is not shown itself.
    const std::size_t at = text.find(name);
    if (at == std::string::npos || text.substr(0, at).ends_with('-') ||
        text.substr(at + name.size()).starts_with('-')) {
      continue;
    }
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr && option->count() <= 1) {
      return fmt::format("{} needs a value; expected: {}", name, option->get_description());
    }
    const std::string value = shown(values_on_line(*option, words));
    if (text.find("does not exist") != std::string::npos)
      return fmt::format("{} = {}: there is no such file", name, value);
    return fmt::format("{} = {} is not what it takes; expected: {}", name, value, option->get_description());
  }
  return {};
}

/// Message on a fault of the command line, in the program's own words.
std::string fault_of_line(const CLI::ParseError& error, const CLI::App& app, std::span<char* const> words) {
  const std::vector<CLI::App*> named = app.get_subcommands();
  if (named.empty()) {
    return fmt::format("a command is missing; there are {}. 'monograin --help' says what they do",
                       fmt::join(names_of(commands_of(app)), ", "));
  }
  const CLI::App* deepest = named.front();
  std::string whole_name = deepest->get_name();
  while (!deepest->get_subcommands().empty()) {
    deepest = deepest->get_subcommands().front();
    whole_name += " " + deepest->get_name();
  }
  const CLI::App& command = *deepest;
  if (const auto kinds = commands_of(command); !kinds.empty()) {
    return fmt::format("{0}: expected one of {1}. 'monograin {0} --help' says more", whole_name,
                       fmt::join(names_of(kinds), ", "));
  }
  std::string fault;
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    // The parser keeps the words only in its message, the last one first.
    const std::string text = error.what();
    const std::string first = text.substr(text.rfind(' ') + 1);
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    const std::vector<std::string_view> known(names.begin(), names.end());
    const std::string name = first.substr(0, first.find('='));
    const bool is_too_early = std::ranges::find(names, name) != names.end();
    fault = fmt::format("'{}' is not expected here{}", shown(first),
                        is_too_early ? "; expected it after the command" : did_you_mean(name, known));
  } else {
    fault = fault_of_option(error, command, words);
  }
  if (fault.empty()) fault = "the arguments do not go together";
  return fmt::format("{0}: {1}. 'monograin {0} --help' says more", whole_name, fault);
}

/// True if the first word is no command of this version; prints a message, because the parser would only report a
/// missing command.
bool names_no_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return false;
  const std::vector<std::string> names = names_of(commands_of(app));
  if (std::ranges::find(names, argv[1]) != names.end()) return false;
  const std::string nearest = did_you_mean(argv[1], std::vector<std::string_view>(names.begin(), names.end()));
  say("monograin: this version has no command '{}'{}\n", shown(std::string_view(argv[1])),
      nearest.empty() ? fmt::format("; it has {}", fmt::join(names, ", ")) : nearest);
  return true;
}

/// Called if an allocation fails.
[[noreturn]] void fail_allocation() {
  has_run_out_of_memory = true;
  throw std::bad_alloc();
}

/// Ends the process if an exception meets a noexcept function of a library. After a failed allocation the process ends
/// with the usual message and exit code.
[[noreturn]] void end_at_once() {
  if (!has_run_out_of_memory) std::abort();
  std::_Exit(fail_for_memory());
}

int run_program(int argc, char** argv) {
  remove_hidden_paths_at_signals();
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond the limit of the system is a fault of writing like others
  CLI::App app("Workbench for the mechanics of a single particle under contact.", "monograin");
  app.set_version_flag("--version", fmt::format("monograin {}", version()));
  app.footer("Example: monograin run --plot");
  app.require_subcommand(1);
  app.formatter(std::make_shared<HelpFormatter>());

  Action action;
  add_run_command(app, action);
  add_check_command(app, action);
  add_models_command(app, action);
  add_cite_command(app, action);
  add_units_command(app, action);
  add_plot_command(app, action);
  add_atlas_command(app, action);
  add_compare_command(app, action);
  add_regress_command(app, action);
  add_calibrate_command(app, action);
  add_design_command(app, action);
  add_export_command(app, action);
  add_continuum_command(app, action);
  add_data_command(app, action);
  add_sweep_command(app, action);
  add_sensitivity_command(app, action);
  add_bench_command(app, action);
  add_stress_command(app, action);
  add_schema_command(app, action);

  if (names_no_command(app, argc, argv)) return k_usage;
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {  // --help, --version
    std::ostringstream text;
    app.exit(request, text, text);
    print_data("{}", text.str());
    return k_success;
  } catch (const CLI::ParseError& error) {
    say("monograin: {}\n", fault_of_line(error, app, {argv, static_cast<std::size_t>(argc)}));
    return k_usage;
  }
  // A stream in the parser of the command line may have swallowed it.
  if (has_run_out_of_memory) return fail_for_memory();
  return run_action(action);
}

}  // namespace

int main(int argc, char** argv) {
  prepare_standard_streams();
  std::set_new_handler(fail_allocation);
  std::set_terminate(end_at_once);
  int code = k_unexpected;
  try {
    code = run_program(argc, argv);
  } catch (const std::exception&) {  // too little memory to read the command line
    code = fail_for_memory();
  }
  if (is_output_written()) return code;
  write_stream(stderr, "monograin: standard output is closed or full; not everything was written to it\n");
  return code == k_success ? k_usage : code;
}
