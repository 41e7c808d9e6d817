// `monograin plot`, `monograin atlas`, `monograin compare` and `monograin regress`: figures and comparisons.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "cli/commands.hpp"
#include "cli/data_folder.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "exchange/vtk.hpp"
#include "figure/column_chart.hpp"
#include "figure/figure.hpp"
#include "figure/page.hpp"
#include "figure/run_curves.hpp"
#include "history/compare.hpp"
#include "history/profile.hpp"
#include "history/run_files.hpp"
#include "scenario/text_file.hpp"
#include "scenario/words.hpp"
#include "study/atlas/atlas.hpp"
#include "study/atlas/profile.hpp"
#include "study/calibrate/calibration.hpp"
#include "study/calibrate/data_report.hpp"
#include "system/resolution.hpp"
#include "verify/regress/regress.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

// --- plot

struct PlotOptions {
  std::vector<std::string> runs;
  std::string output;
  std::string format{figure::k_usual_format};
  std::optional<double> profile;  ///< [s]
  bool writes_vtk = false;
  figure::ColumnChoice columns;
  std::vector<std::string> data;

  [[nodiscard]] bool has_own_axes() const {
    return !columns.x.empty() || !columns.y.empty() || !columns.unit.empty() || !data.empty();
  }
};

/// Folder of a run that is named by itself or by its history.csv.
fs::path folder_of(const fs::path& run) { return fs::is_directory(run) ? run : run.parent_path(); }

/// The figure that -o names, or one of the chosen format.
fs::path figure_path(const PlotOptions& options, fs::path usual) {
  return options.output.empty() ? usual.replace_extension(options.format) : fs::path(options.output);
}

int plot_profile(const PlotOptions& options) {
  if (options.runs.size() != 1) throw UsageError("--profile takes one run");
  const fs::path run = options.runs.front();
  const fs::path folder = folder_of(run);
  const fs::path output = figure_path(options, folder / "profile");
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

/// Writes the particle of each run for ParaView, into the folder vtk of the run or the folder of -o.
int plot_vtk(const PlotOptions& options) {
  if (!options.output.empty() && options.runs.size() != 1) throw UsageError("-o takes the particle of one run");
  for (const fs::path run : options.runs) {
    const fs::path folder = folder_of(run);
    const fs::path output = options.output.empty() ? folder / "vtk" : fs::path(options.output);
    const CheckedScenario scenario = scenario_of_run(folder);
    const Table history = figure::read_table(folder / k_run_tables.front());
    or_usage_error(run.string(), [&] { save_vtk(scenario, history, output); });
    say("particle -> {}\n", (output / k_vtk_series).string());
  }
  return k_success;
}

/// Notes data with the machine's part over a run of a scenario that was fitted without it.
void note_machine(const std::vector<fs::path>& runs, const std::string& data) {
  for (const fs::path& run : runs) {
    const std::string text = read_text_file(folder_of(run) / "run.json", k_largest_data).text;
    if (text.find(k_without_machine) == std::string::npos) continue;
    say("note: {} is a run of the particle alone; '{}' is drawn as recorded, with what the machine adds. The folder of "
        "the calibration, after --data, has the data without it\n",
        run.string(), data);
  }
}

/// Chart of chosen columns, with measured data.
figure::ColumnChart column_chart_of(const PlotOptions& options, const std::vector<fs::path>& runs) {
  try {
    figure::ColumnChart chart = figure::column_chart(runs, options.columns);
    for (const std::string& file : options.data) {
      const DataChoice choice{{}, {}, chart.x.dimension, chart.y.dimension};
      const bool is_calibration = fs::is_regular_file(fs::path(file) / k_calibration_marker);
      if (!is_calibration) note_machine(runs, file);
      DataReport data = is_calibration ? report_of_calibration(file, choice) : report_of_file(file, choice);
      const auto axis = [](DataAxis& read) {
        return figure::MeasuredPoints::Axis{read.name, read.unit, std::move(read.values)};
      };
      figure::add_points(chart, {figure::verbatim_text(fs::path(file).stem().string()), axis(data.x), axis(data.y)});
    }
    return chart;
  } catch (const FigureError& error) {
    throw UsageError(error.what());
  }
}

int plot(const PlotOptions& options) {
  std::vector<fs::path> runs(options.runs.begin(), options.runs.end());
  for (const fs::path& run : runs) {
    if (!fs::exists(run)) throw UsageError(fmt::format("{}: no such run", run.string()));
    if (run.extension() == ".toml") {
      throw UsageError(
          fmt::format("{}: expected the folder of a run; 'monograin run --plot' draws a scenario", run.string()));
    }
  }
  if (options.profile && options.has_own_axes()) throw UsageError("--profile has axes of its own");
  if (options.writes_vtk && (options.profile || options.has_own_axes())) {
    throw UsageError("--vtk writes the particle and takes no other choice but -o");
  }
  if (options.profile) return plot_profile(options);
  if (options.writes_vtk) return plot_vtk(options);
  const fs::path output = figure_path(options, folder_of(runs.front()) / "figure");
  if (options.has_own_axes() || std::ranges::any_of(runs, figure::is_sweep)) {
    figure::draw_chart(column_chart_of(options, runs).chart, "columns of runs", output);
  } else {
    draw_runs(runs, output);
  }
  say("figure -> {}\n", output.string());
  return k_success;
}

// --- atlas

struct AtlasOptions {
  std::vector<std::string> names;
  std::string definitions;
  std::string output;
  std::string format;
  bool only_lists = false;
};

/// Folders of definitions and figures. Without -o, figures go beside the definitions if the user works in a checkout.
struct AtlasFolders {
  fs::path definitions;
  fs::path output;
};

AtlasFolders atlas_folders(const AtlasOptions& options) {
  AtlasFolders folders{options.definitions, options.output};
  const bool is_named = !options.definitions.empty();
  const DataFolder data = is_named ? DataFolder{} : find_data({"plots"});
  if (!is_named) folders.definitions = data.path("plots");
  if (options.output.empty()) folders.output = data.is_current() ? folders.definitions : fs::path("figures");
  return folders;
}

int list(const AtlasOptions& options) {
  const std::vector<AtlasEntry> entries = list_atlas(atlas_folders(options).definitions);
  std::size_t width = 0;
  for (const AtlasEntry& entry : entries) width = std::max(width, entry.name.size());
  for (const AtlasEntry& entry : entries) print_data("{:<{}}  {}\n", entry.name, width, entry.title);
  return k_success;
}

int draw_atlas(const AtlasOptions& options) {
  if (options.only_lists) return list(options);
  const AtlasFolders folders = atlas_folders(options);
  std::vector<AtlasFigure> figures = [&] {
    ProgressBar bar("figures");
    return make_atlas(folders.definitions, options.names, [&](auto done, auto of) { bar.show(done, of); });
  }();
  if (!options.format.empty()) {
    for (AtlasFigure& figure : figures) figure.format = options.format;
  }
  for (const fs::path& file : write_atlas(figures, folders.output)) say("-> {}\n", file.string());
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
  std::optional<double> tolerance;
};

/// Reads the history of a run folder, or the table of a CSV file.
Table read_curves(const fs::path& path) { return read_csv(fs::is_directory(path) ? path / "history.csv" : path); }

/// Compares the histories and the events of two run folders, or the tables of two files.
Comparison compare_files(const CompareOptions& options) {
  Comparison result = compare_tables(read_curves(options.reference), read_curves(options.other), options.x, options.y);
  const bool has_events = fs::is_directory(options.reference) && fs::is_directory(options.other);
  if (!has_events || !options.y.empty()) return result;
  const Comparison events = compare_events(read_csv(fs::path(options.reference) / "events.csv"),
                                           read_csv(fs::path(options.other) / "events.csv"));
  result.curves.insert(result.curves.end(), events.curves.begin(), events.curves.end());
  result.gaps.insert(result.gaps.end(), events.gaps.begin(), events.gaps.end());
  return result;
}

int compare(const CompareOptions& options) {
  if (options.reference == "-" && options.other == "-") throw UsageError("standard input, -, can be read once only");
  const Comparison comparison = [&] {
    try {
      return compare_files(options);
    } catch (const std::exception& error) {
      throw UsageError(in_own_words(error));
    }
  }();
  say("relative errors of {} against {}, the reference\n", options.other, options.reference);
  const std::string place = "at " + options.x;
  const std::size_t width = std::max<std::size_t>(10, place.size() + 2);
  std::size_t longest = 6;
  for (const CurveDifference& difference : comparison.curves) longest = std::max(longest, width_of(difference.y));
  print_data("{:<{}}{:>11}{:>{}}{:>9}{:>9}{:>9}{:>8}\n", "column", longest, "L-infinity", place, width, "L2", "area",
             "peak", "covered");
  bool is_above = false;
  for (const CurveDifference& d : comparison.curves) {
    print_data("{:<{}}{:>11.3g}{:>{}.5g}{:>9.3g}{:>9.3g}{:>9.3g}{:>6.1f} %\n", d.y, longest, d.linf, d.linf_at, width,
               d.l2, d.area_error, d.peak_error, 100.0 * d.coverage);
    is_above = is_above || !(d.linf <= options.tolerance.value_or(k_infinity));
  }
  for (const Gap& gap : comparison.gaps) print_data("{}: {} {}\n", options.other, gap.column, gap.problem);
  if (!options.y.empty() && comparison.curves.empty() && comparison.gaps.empty())
    print_data("{}: the same words\n", options.y);
  if (!options.tolerance) {
    if (comparison.curves.empty() && !comparison.gaps.empty()) throw UsageError("no column could be compared");
    return k_success;
  }
  if (is_above) say("monograin: the largest difference is above {:g}\n", *options.tolerance);
  if (!comparison.gaps.empty()) {
    say("monograin: {} does not have all of {}: {} {}{}\n", options.other, options.reference,
        comparison.gaps.front().column, comparison.gaps.front().problem,
        comparison.gaps.size() > 1 ? fmt::format(", and {} more", comparison.gaps.size() - 1) : "");
  }
  return is_above || !comparison.gaps.empty() ? k_differs : k_success;
}

// --- regress

struct RegressOptions {
  std::string scenarios;
  std::string curves;
  bool accepts = false;
};

/// Folder of scenarios and curves: the current folder if one of them is named or curves are stored anew, else the
/// program's data.
DataFolder regress_data(const RegressOptions& options) {
  const bool is_checkout = options.accepts || !options.scenarios.empty() || !options.curves.empty();
  return is_checkout ? DataFolder{} : find_data({"scenarios", "curves"});
}

int run_regress(const RegressOptions& options) {
  const DataFolder data = regress_data(options);
  const fs::path scenarios = options.scenarios.empty() ? data.path("scenarios") : fs::path(options.scenarios);
  const fs::path curves = options.curves.empty() ? data.path("curves") : fs::path(options.curves);
  const std::vector<RegressionResult> results =
      options.accepts ? accept_curves(scenarios, curves) : regress(scenarios, curves);
  print_data("{:<24}{:<14}{:>12}{:>12}{:>12}  {}\n", "scenario", "integrator", "curve", "event time", "tolerance", "");
  const auto measure = [](double value) { return std::isnan(value) ? "-" : fmt::format("{:.2e}", value); };
  std::size_t passed = 0;
  std::size_t stored = 0;
  for (const RegressionResult& r : results) {
    std::vector<std::string> notes;
    if (r.difference > r.tolerance) notes.push_back("differs in " + r.column);
    if (r.event_time > r.tolerance) notes.emplace_back("differs in event times");
    if (!r.fault.empty()) notes.push_back(r.fault);
    print_data("{:<24}{:<14}{:>12}{:>12}{:>12.0e}  {}\n", r.scenario, r.integrator, measure(r.difference),
               measure(r.event_time), r.tolerance, fmt::join(notes, "; "));
    if (r.passes()) ++passed;
    if (!r.integrator.empty()) ++stored;
  }
  if (options.accepts) {
    say("{} curves stored in {}; the differences above are to what was there before\n", stored, curves.string());
    return k_success;
  }
  say("{} of {} runs within their tolerance; \"curve\" is the largest difference of any column over its largest "
      "value\n",
      passed, results.size());
  return passed == results.size() ? k_success : k_differs;
}

}  // namespace

void add_plot_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<PlotOptions>();
  CLI::App* command = app.add_subcommand(
      "plot", "Draw recorded runs: force, pressure, contact area, apparent radius; or stress of a packing");
  command->add_option("RUN", options->runs, "Folders of runs, or their history.csv; or the folder of a sweep")
      ->required();
  command->add_option("-o,--output", options->output,
                      "Figure to write: .svg, .pdf or .png [figure.svg in the first run's folder]");
  CLI::Option* format = add_figure_format(*command, options->format);
  format->description("Format of the figure without -o: svg, pdf or png [svg]")->excludes("--output");
  command
      ->add_option(
          "--profile", options->profile,
          "Instant [s], 0 or later: draw pressure and surface under the contacts instead, and write them as CSV")
      ->check(CLI::NonNegativeNumber)
      ->check(is_no_nan());
  command->add_option(
      "--x", options->columns.x,
      "Column, with or without its unit, for one panel [displacement of the driven walls; each key of a sweep]");
  command->add_option("--y", options->columns.y,
                      "Column over it [force of the driven walls; the largest first force of a sweep]");
  command->add_option("--unit", options->columns.unit, "Unit of the column over it, e.g. kN [that of the file]");
  command
      ->add_option("--data", options->data,
                   "File of measured data to draw as points, read as by monograin data; its columns are found by "
                   "the dimensions of the axes. The folder of a calibration: its data without what the machine adds")
      ->allow_extra_args(false);
  command
      ->add_flag("--vtk", options->writes_vtk,
                 "Write particle and walls at up to 200 instants for ParaView instead [folder vtk in that of the run]")
      ->excludes(format);
  command->footer("Example: monograin plot runs/die -o die.pdf");
  command->callback([options, &action] { action = [options] { return plot(*options); }; });
}

void add_atlas_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<AtlasOptions>();
  CLI::App* command = app.add_subcommand("atlas", "Make figures and tables anew from their definitions");
  command->add_option("NAME", options->names, "Figures to make [all]");
  command->add_option("--plots", options->definitions,
                      "Folder of the definitions [plots, or those that come with the program]");
  command->add_option("-o,--output", options->output,
                      "Folder to write to [that of the definitions; figures for those of the program]");
  add_figure_format(*command, options->format)
      ->description("Format of the figures: svg, pdf or png [that of the definition]");
  command->add_flag("-l,--list", options->only_lists, "List the figures there are");
  command->footer("Example: monograin atlas mdr-12-die -o figures");
  command->callback([options, &action] { action = [options] { return draw_atlas(*options); }; });
}

void add_compare_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command = app.add_subcommand("compare", "Error measures of one curve, or run, against another");
  command->add_option("A", options->reference, "Reference: a CSV file or the folder of a run")->required();
  command->add_option("B", options->other, "What to hold against it: a CSV file or the folder of a run")->required();
  command->add_option("--x", options->x, "Column to compare over [time]");
  command->add_option("--y", options->y, "Column to compare [all of A, and the events of runs]");
  command
      ->add_option("--tol", options->tolerance,
                   "Exit with 5 when a largest difference is above this (0 or more), or something is missing in B")
      ->check(CLI::NonNegativeNumber)
      ->check(is_no_nan());
  command->footer("Example: monograin compare runs/die runs/softer --tol 1e-6");
  command->callback([options, &action] { action = [options] { return compare(*options); }; });
}

void add_regress_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<RegressOptions>();
  CLI::App* command = app.add_subcommand("regress", "Run every ready scenario and compare with its stored curve");
  command->add_flag("--accept", options->accepts, "Store the curves of this version instead");
  command->add_option("--scenarios", options->scenarios,
                      "Folder of the scenarios [scenarios, or those that come with the program]");
  command->add_option("--curves", options->curves,
                      "Folder of the stored curves [tests/curves, or those that come with the program]");
  command->footer("Example: monograin regress");
  command->callback([options, &action] { action = [options] { return run_regress(*options); }; });
}

}  // namespace monograin
