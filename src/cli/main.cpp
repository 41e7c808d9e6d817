#include <fmt/format.h>
#include <fmt/ranges.h>

#include <csignal>
#include <cstdio>
#include <exception>

#include "cli/commands.hpp"
#include "history/run.hpp"
#include "scenario/scenario.hpp"

namespace {

using namespace monograin;

int run_action(const Action& action) {
  try {
    return action();
  } catch (const ScenarioError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return k_usage;
  } catch (const UsageError& error) {
    fmt::print(stderr, "monograin: {}\n", error.what());
    return k_usage;
  } catch (const std::logic_error& error) {
    fmt::print(stderr, "monograin: this is a bug, please report it with the command and its files: {}\n", error.what());
    return k_unexpected;
  } catch (const std::exception& error) {  // a file, a folder, or gnuplot
    fmt::print(stderr, "monograin: {}\n", error.what());
    return k_usage;
  }
}

/// Whether the first word is no command of this version; says so, which "a subcommand is required" would not.
bool names_no_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return false;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == argv[1]) return false;
    names.push_back(command->get_name());
  }
  fmt::print(stderr, "monograin: this version has no command '{}'; it has {}\n", argv[1], fmt::join(names, ", "));
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond the limit of the system is a fault of writing like others
  CLI::App app("Workbench for the mechanics of a single particle under contact.", "monograin");
  app.set_version_flag("--version", fmt::format("monograin {}", version()));
  app.footer("Example: monograin run --plot");
  app.require_subcommand(1);

  Action action;
  add_run_command(app, action);
  add_check_command(app, action);
  add_models_command(app, action);
  add_plot_command(app, action);
  add_atlas_command(app, action);
  add_compare_command(app, action);
  add_regress_command(app, action);
  add_calibrate_command(app, action);
  add_sweep_command(app, action);
  add_bench_command(app, action);
  add_stress_command(app, action);
  add_schema_command(app, action);

  if (names_no_command(app, argc, argv)) return k_usage;
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {  // --help, --version
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    app.exit(error);
    return k_usage;
  }
  return run_action(action);
}
