#include <fmt/format.h>

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
  } catch (const std::exception& error) {
    fmt::print(stderr, "monograin: {}\n", error.what());
    return k_unexpected;
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Workbench for the mechanics of a single particle under contact.", "monograin");
  app.set_version_flag("--version", fmt::format("monograin {}", version()));
  app.footer("Example: monograin run --plot");
  app.require_subcommand(1);

  Action action;
  add_run_command(app, action);
  add_check_command(app, action);
  add_models_command(app, action);
  add_plot_command(app, action);
  add_compare_command(app, action);
  add_regress_command(app, action);
  add_schema_command(app, action);

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
