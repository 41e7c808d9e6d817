// `monograin plot`, `monograin atlas`, `monograin compare` and `monograin regress`: figures and comparisons.

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "cli/commands.hpp"
#include "cli/terminal.hpp"
#include "figure/figure.hpp"
#include "history/compare.hpp"
#include "history/run_files.hpp"
#include "study/atlas.hpp"
#include "study/profile.hpp"
#include "study/regress.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

// --- plot

struct PlotOptions {
  std::vector<std::string> runs;
  std::string output;
  std::optional<double> profile;  ///< [s]
};

int plot_profile(const PlotOptions& options) {
  if (options.runs.size() != 1) throw UsageError("--profile takes one run");
  const fs::path run = options.runs.front();
  const fs::path folder = fs::is_directory(run) ? run : run.parent_path();
  const fs::path output = options.output.empty() ? folder / "profile.svg" : fs::path(options.output);
  const Table profiles = [&] {
    try {
      return contact_profiles(scenario_of_run(folder), *options.profile);
    } catch (const std::runtime_error& error) {
      throw UsageError(error.what());
    }
  }();
  const fs::path csv = draw_profiles(profiles, output);
  say("figure -> {}\nprofiles -> {}\n", output.string(), csv.string());
  return k_success;
}

int plot(const PlotOptions& options) {
  std::vector<fs::path> runs(options.runs.begin(), options.runs.end());
  for (const fs::path& run : runs) {
    if (!fs::exists(run)) throw UsageError(fmt::format("{}: no such run", run.string()));
  }
  if (options.profile) return plot_profile(options);
  const fs::path first = fs::is_directory(runs.front()) ? runs.front() : runs.front().parent_path();
  const fs::path output = options.output.empty() ? first / "figure.svg" : fs::path(options.output);
  draw_runs(runs, output);
  say("figure -> {}\n", output.string());
  return k_success;
}

// --- atlas

struct AtlasOptions {
  std::vector<std::string> names;
  std::string definitions = "plots";
  std::string output;
  bool only_lists = false;
};

int list(const AtlasOptions& options) {
  const std::vector<AtlasEntry> entries = list_atlas(options.definitions);
  std::size_t width = 0;
  for (const AtlasEntry& entry : entries) width = std::max(width, entry.name.size());
  for (const AtlasEntry& entry : entries) print_data("{:<{}}  {}\n", entry.name, width, entry.title);
  return k_success;
}

int draw_atlas(const AtlasOptions& options) {
  if (options.only_lists) return list(options);
  const std::vector<AtlasFigure> figures = make_atlas(options.definitions, options.names);
  const fs::path folder = options.output.empty() ? options.definitions : options.output;
  for (const fs::path& file : write_atlas(figures, folder)) say("-> {}\n", file.string());
  auto status = RunStatus::complete;
  for (const AtlasFigure& figure : figures) {
    if (const std::string tables = tables_text(figure); !tables.empty()) print_data("{}\n", tables);
    for (const std::string& stop : figure.stops) say("{}: {}\n", figure.name, stop);
    status = std::max(status, figure.status);
  }
  return exit_code_of(status);
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
  print_data("{:<28}{:>12}{:>14}{:>12}{:>12}{:>12}{:>10}\n", "column", "L-infinity", "at " + options.x, "L2",
             "area error", "peak error", "covered");
  bool is_above = false;
  for (const CurveDifference& d : differences) {
    print_data("{:<28}{:>12.4e}{:>14.6g}{:>12.4e}{:>12.4e}{:>12.4e}{:>9.1f}%\n", d.y, d.linf, d.linf_at, d.l2,
               d.area_error, d.peak_error, 100.0 * d.coverage);
    is_above = is_above || !(d.linf <= options.tolerance);
  }
  if (!is_above) return k_success;
  say("monograin: the largest difference is above {:g}\n", options.tolerance);
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
  print_data("{:<24}{:<14}{:>12}{:>12}{:>12}  {}\n", "scenario", "integrator", "curve", "event time", "tolerance", "");
  bool all_pass = true;
  for (const RegressionResult& r : results) {
    const std::string note = !r.fault.empty() ? r.fault : r.passes() ? "" : "differs in " + r.column;
    print_data("{:<24}{:<14}{:>12.2e}{:>12.2e}{:>12.0e}  {}\n", r.scenario, r.integrator, r.difference, r.event_time,
               r.tolerance, note);
    all_pass = all_pass && r.passes();
  }
  if (options.accepts) {
    say("{} curves stored in {}; the differences above are to what was there before\n", results.size(), options.curves);
    return k_success;
  }
  return all_pass ? k_success : k_differs;
}

}  // namespace

void add_plot_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<PlotOptions>();
  CLI::App* command = app.add_subcommand(
      "plot", "Draw recorded runs: force, pressure, contact area, apparent radius; or stress of a packing");
  command->add_option("RUN", options->runs, "Folders of runs, or their history.csv")->required();
  command->add_option("-o,--output", options->output,
                      "Figure to write: .svg, .pdf or .png [figure.svg in the first run's folder]");
  command
      ->add_option(
          "--profile", options->profile,
          "Instant [s], 0 or later: draw pressure and surface under the contacts instead, and write them as CSV")
      ->check(CLI::NonNegativeNumber);
  command->footer("Example: monograin plot runs/die -o die.pdf");
  command->callback([options, &action] { action = [options] { return plot(*options); }; });
}

void add_atlas_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<AtlasOptions>();
  CLI::App* command = app.add_subcommand("atlas", "Make figures and tables anew from their definitions");
  command->add_option("NAME", options->names, "Figures to make [all]");
  command->add_option("--plots", options->definitions, "Folder of the definitions [plots]");
  command->add_option("-o,--output", options->output, "Folder to write to [that of the definitions]");
  command->add_flag("-l,--list", options->only_lists, "List the figures there are");
  command->footer("Example: monograin atlas mdr-12-die -o figures");
  command->callback([options, &action] { action = [options] { return draw_atlas(*options); }; });
}

void add_compare_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command = app.add_subcommand("compare", "Error measures of one curve against another");
  command->add_option("A", options->reference, "Reference (CSV)")->required();
  command->add_option("B", options->other, "Curve to hold against it (CSV)")->required();
  command->add_option("--x", options->x, "Column to compare over [time]");
  command->add_option("--y", options->y, "Column to compare [all that both have]");
  command
      ->add_option("--tol", options->tolerance,
                   "Exit with 5 when a largest difference is above this (0 or more), or something is missing in B")
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
