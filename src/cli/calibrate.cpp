// `monograin calibrate` and `monograin data`.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "cli/commands.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "history/staged_folder.hpp"
#include "scenario/text_file.hpp"
#include "study/calibrate/calibration.hpp"
#include "study/calibrate/data_report.hpp"
#include "study/calibrate/model_comparison.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

struct CalibrateOptions {
  std::vector<std::string> files;
  std::string output;
  std::optional<double> confidence;
  std::string format{figure::k_usual_format};
  bool is_quiet = false;
  bool is_strict = false;
  bool has_report = false;
};

Calibration read(const std::string& file, const CalibrateOptions& options) {
  Calibration calibration = read_calibration(file);
  if (options.confidence) calibration.confidence = *options.confidence;
  return calibration;
}

/// Fits a calibration, and writes the results into a folder.
CalibrationResult run_calibration(const Calibration& calibration, const fs::path& folder,
                                  const CalibrateOptions& options) {
  StagedFolder staged(folder, k_calibration_marker, k_calibration_tables);
  CalibrationResult result = [&] {
    ProgressBar bar("of the search");
    return calibrate(calibration, [&](double done) {
      if (!options.is_quiet) bar.show(done);
    });
  }();
  const std::string no_figure = write_calibration(calibration, result, staged, options.has_report, options.format);
  print_data("{}", calibration_text(calibration, result));
  if (!no_figure.empty()) say("warning: no figure: {}\n", no_figure);
  for (const std::string& warning : result.warnings) say("warning: {}\n", warning);
  if (options.is_quiet) return result;
  for (const std::string& note : result.notes) say("note: {}\n", note);
  say("{}: the data drive the particle, in {} step{}; the scenario's own steps were not run, and are kept in "
      "fitted.toml\n"
      "{}: {} trial runs -> {}\n",
      calibration.name, result.program_steps, result.program_steps == 1 ? "" : "s", calibration.name,
      result.solution.evaluations, folder.string());
  return result;
}

int run_calibrations(const CalibrateOptions& options) {
  std::vector<Calibration> calibrations;
  for (const std::string& file : options.files) calibrations.push_back(read(file, options));
  const bool has_several = calibrations.size() > 1;
  if (has_several) check_comparable(calibrations);
  const fs::path named = options.output;
  const fs::path runs = "runs";
  const fs::path together = named.empty() ? runs / "comparison" : named;
  const fs::path alone = named.empty() ? runs / calibrations.front().name : named;
  std::optional<StagedFolder> staged;
  if (has_several) staged.emplace(together, k_comparison_marker);
  std::vector<CalibrationResult> results;
  for (const Calibration& calibration : calibrations) {
    if (!results.empty()) print_data("\n");
    if (has_several) print_data("{}\n", calibration.name);
    results.push_back(run_calibration(calibration, has_several ? together / calibration.name : alone, options));
  }
  if (staged) {
    const ModelComparison comparison = [&] {
      ProgressBar bar("of the comparison");
      return compare_models(calibrations, results, [&](double done) {
        if (!options.is_quiet) bar.show(done);
      });
    }();
    print_data("\n{}", comparison_text(calibrations, results, comparison));
    const std::string no_figure =
        write_comparison(calibrations, results, comparison, *staged, options.has_report, options.format);
    if (!no_figure.empty()) say("warning: no figure: {}\n", no_figure);
    if (!options.is_quiet) say("comparison -> {}\n", together.string());
  }
  const auto is_bad = [](const CalibrationResult& result) { return !result.warnings.empty(); };
  return options.is_strict && std::ranges::any_of(results, is_bad) ? k_differs : k_success;
}

// --- data

struct DataOptions {
  std::string file;
  DataChoice choice;
  std::string output;
  std::string format;
  bool draws = false;
};

/// Path of the figure. @throws UsageError if the figure or a file beside it would replace data
fs::path figure_of(const DataOptions& options, const std::vector<DataReport>& reports) {
  const std::string stem = name_of_file(options.file).stem().string();
  const std::string_view format = options.format.empty() ? figure::k_usual_format : options.format;
  const fs::path output =
      options.output.empty() ? fs::path(fmt::format("{}-data.{}", stem, format)) : fs::path(options.output);
  for (const DataReport& report : reports) {
    for (const char* extension : {"", ".gp", ".dat"}) {
      fs::path written = output;
      if (*extension != '\0') written.replace_extension(extension);
      std::error_code none;
      if (fs::equivalent(written, report.file, none)) {
        throw UsageError(
            fmt::format("{}: the figure would take the place of the data; name another one with -o", written.string()));
      }
    }
  }
  return output;
}

int show_data(const DataOptions& options) {
  const bool is_calibration = fs::path(options.file).extension() == ".toml";
  if (is_calibration && !(options.choice.x.empty() && options.choice.y.empty())) {
    throw UsageError("--x and --y are for a file of data; a calibration file says what x and y are");
  }
  const std::vector<DataReport> reports = is_calibration ? reports_of(read_calibration(options.file))
                                                         : std::vector{report_of_file(options.file, options.choice)};
  for (std::size_t k = 0; k < reports.size(); ++k) print_data("{}{}", k > 0 ? "\n" : "", data_text(reports[k]));
  if (!options.draws && options.output.empty() && options.format.empty()) return k_success;
  const fs::path output = figure_of(options, reports);
  draw_data(reports, output);
  say("figure -> {}\n", output.string());
  return k_success;
}

}  // namespace

void add_data_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<DataOptions>();
  CLI::App* command = app.add_subcommand("data", "Show what is read from a file of measured data");
  command->add_option("FILE", options->file, "File of a testing machine, or a calibration file (TOML)")->required();
  command->add_option("--x", options->choice.x, "Column: heading or number [the first length, else the first numbers]");
  command->add_option("--y", options->choice.y, "Column: heading or number [the first force, else the next numbers]");
  command->add_flag("--plot", options->draws, "Draw y over x, loading and unloading apart");
  command->add_option("-o,--output", options->output, "Figure to write: .svg, .pdf or .png [NAME-data.svg]");
  add_figure_format(*command, options->format)
      ->description("Draw NAME-data in this format: svg, pdf or png")
      ->excludes("--output");
  command->footer("Example: monograin data scenarios/calibrate/uniaxial.csv --plot");
  command->callback([options, &action] { action = [options] { return show_data(*options); }; });
}

void add_calibrate_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<CalibrateOptions>();
  CLI::App* command =
      app.add_subcommand("calibrate", "Fit numbers of a scenario to measured data, with confidence intervals");
  command
      ->add_option("FILE", options->files,
                   "Calibration file (TOML): scenario, data, free parameters and bounds; several of common data are "
                   "compared")
      ->required();
  command->add_option("-o,--output", options->output, "Folder of the results [runs/NAME, or runs/comparison]");
  command
      ->add_option("--confidence", options->confidence,
                   "Level of the two-sided intervals, between 0 and 1, e.g. 0.99 [the file's, or 0.95]")
      ->check(CLI::Range(1e-6, 1.0 - 1e-6))
      ->check(is_no_nan());
  add_figure_format(*command, options->format);
  command->add_flag("--report", options->has_report,
                    "Leave report.md and report.pdf, too: data, figure, intervals, residuals, warnings");
  command->add_flag("--quiet", options->is_quiet, "Print the result, warnings and errors only");
  command->add_flag("--strict", options->is_strict, "Exit with 5 where the fit is bad and a warning says so");
  command->footer("Example: monograin calibrate scenarios/calibrate/uniaxial.toml");
  command->callback([options, &action] { action = [options] { return run_calibrations(*options); }; });
}

}  // namespace monograin
