// `monograin plot`, `monograin compare` and `monograin regress`: what is done with recorded runs.

#include <fmt/format.h>

#include <cstdio>
#include <limits>
#include <memory>

#include "cli/commands.hpp"
#include "figure/figure.hpp"
#include "history/compare.hpp"
#include "study/regress.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

// --- plot

struct PlotOptions {
  std::vector<std::string> runs;
  std::string output;
};

int plot(const PlotOptions& options) {
  std::vector<fs::path> runs(options.runs.begin(), options.runs.end());
  for (const fs::path& run : runs) {
    if (!fs::exists(run)) throw UsageError(fmt::format("{}: no such run", run.string()));
  }
  const fs::path first = fs::is_directory(runs.front()) ? runs.front() : runs.front().parent_path();
  const fs::path output = options.output.empty() ? first / "figure.svg" : fs::path(options.output);
  draw_runs(runs, output);
  fmt::print(stderr, "figure -> {}\n", output.string());
  return k_success;
}

// --- compare

struct CompareOptions {
  std::string reference;
  std::string other;
  std::string x = "time";
  std::string y;
  double tolerance = std::numeric_limits<double>::infinity();
};

int compare(const CompareOptions& options) {
  const auto differences = [&] {
    try {
      return compare_tables(read_csv(options.reference), read_csv(options.other), options.x, options.y);
    } catch (const std::exception& error) {
      throw UsageError(error.what());
    }
  }();
  fmt::print("{:<28}{:>12}{:>14}{:>12}{:>12}{:>12}{:>10}\n", "column", "L-infinity", "at " + options.x, "L2",
             "area error", "peak error", "covered");
  bool is_above = false;
  for (const CurveDifference& d : differences) {
    fmt::print("{:<28}{:>12.4e}{:>14.6g}{:>12.4e}{:>12.4e}{:>12.4e}{:>9.1f}%\n", d.y, d.linf, d.linf_at, d.l2,
               d.area_error, d.peak_error, 100.0 * d.coverage);
    is_above = is_above || !(d.linf <= options.tolerance);
  }
  if (!is_above) return k_success;
  fmt::print(stderr, "monograin: the largest difference is above {:g}\n", options.tolerance);
  return k_differs;
}

// --- regress

struct RegressOptions {
  std::string scenarios = "scenarios";
  std::string curves = "tests/curves";
  bool accepts = false;
};

int run_regress(const RegressOptions& options) {
  const std::vector<RegressionResult> results =
      options.accepts ? accept_curves(options.scenarios, options.curves) : regress(options.scenarios, options.curves);
  fmt::print("{:<24}{:<14}{:>12}{:>12}{:>12}  {}\n", "scenario", "integrator", "curve", "event time", "tolerance", "");
  bool all_pass = true;
  for (const RegressionResult& r : results) {
    const std::string note = !r.fault.empty() ? r.fault : r.passes() ? "" : "differs in " + r.column;
    fmt::print("{:<24}{:<14}{:>12.2e}{:>12.2e}{:>12.0e}  {}\n", r.scenario, r.integrator, r.difference, r.event_time,
               r.tolerance, note);
    all_pass = all_pass && r.passes();
  }
  if (options.accepts) {
    fmt::print(stderr, "{} curves stored in {}; the differences above are to what was there before\n", results.size(),
               options.curves);
    return k_success;
  }
  return all_pass ? k_success : k_differs;
}

}  // namespace

void add_plot_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<PlotOptions>();
  CLI::App* command = app.add_subcommand("plot", "Draw recorded runs: force, pressure, contact area, apparent radius");
  command->add_option("RUN", options->runs, "Folders of runs, or their history.csv")->required();
  command->add_option("-o,--output", options->output,
                      "Figure to write: .svg, .pdf or .png [figure.svg in the first run's folder]");
  command->footer("Example: monograin plot runs/die -o die.pdf");
  command->callback([options, &action] { action = [options] { return plot(*options); }; });
}

void add_compare_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command = app.add_subcommand("compare", "Error measures of one curve against another");
  command->add_option("A", options->reference, "Reference (CSV)")->required()->check(CLI::ExistingFile);
  command->add_option("B", options->other, "Curve to hold against it (CSV)")->required()->check(CLI::ExistingFile);
  command->add_option("--x", options->x, "Column to compare over [time]");
  command->add_option("--y", options->y, "Column to compare [all that both have]");
  command->add_option("--tol", options->tolerance, "Exit with 5 when a largest difference is above this")
      ->check(CLI::NonNegativeNumber);
  command->footer("Example: monograin compare a/history.csv b/history.csv --y axial.force --tol 1e-6");
  command->callback([options, &action] { action = [options] { return compare(*options); }; });
}

void add_regress_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<RegressOptions>();
  CLI::App* command = app.add_subcommand("regress", "Run every ready scenario and compare with its stored curve");
  command->add_flag("--accept", options->accepts, "Store the curves of this version instead");
  command->add_option("--scenarios", options->scenarios, "Folder of the scenarios [scenarios]");
  command->add_option("--curves", options->curves, "Folder of the stored curves [tests/curves]");
  command->footer("Example: monograin regress");
  command->callback([options, &action] { action = [options] { return run_regress(*options); }; });
}

}  // namespace monograin
