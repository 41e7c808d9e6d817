// `monograin calibrate`.

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "cli/commands.hpp"
#include "cli/terminal.hpp"
#include "history/staged_folder.hpp"
#include "study/calibrate/calibration.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

struct CalibrateOptions {
  std::string file;
  std::string output;
  std::optional<double> confidence;
  bool is_quiet = false;
  bool is_strict = false;
};

/// A line that tells how far a search has come, on a terminal.
class ProgressLine {
 public:
  explicit ProgressLine(bool is_wanted) : is_shown_(is_wanted && isatty(STDERR_FILENO) == 1) {}
  ~ProgressLine() {
    if (percent_ >= 0) say("\r{:20}\r", "");
  }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(double done) {
    const int percent = static_cast<int>(std::floor(100.0 * done));
    if (!is_shown_ || percent == percent_) return;
    percent_ = percent;
    say("\rsearching {:3} %", percent);
  }

 private:
  bool is_shown_;
  int percent_ = -1;
};

int run_calibration(const CalibrateOptions& options) {
  Calibration calibration = read_calibration(options.file);
  if (options.confidence) calibration.confidence = *options.confidence;
  const fs::path folder = options.output.empty() ? fs::path("runs") / calibration.name : fs::path(options.output);
  StagedFolder staged(folder, k_calibration_marker);
  const CalibrationResult result = [&] {
    ProgressLine line(!options.is_quiet);
    return calibrate(calibration, [&line](double done) { line.show(done); });
  }();
  const std::string no_figure = write_calibration(calibration, result, staged);
  print_data("{}", calibration_text(calibration, result));
  if (!no_figure.empty()) say("warning: no figure: {}\n", no_figure);
  for (const std::string& warning : result.warnings) say("warning: {}\n", warning);
  const int code = options.is_strict && !result.warnings.empty() ? k_differs : k_success;
  if (options.is_quiet) return code;
  for (const std::string& note : result.notes) say("note: {}\n", note);
  say("{}: the data drive the particle, in {} step{}; the scenario's own steps were not run, and are kept in "
      "fitted.toml\n"
      "{}: {} trial runs -> {}\n",
      calibration.name, result.program_steps, result.program_steps == 1 ? "" : "s", calibration.name,
      result.solution.evaluations, folder.string());
  return code;
}

}  // namespace

void add_calibrate_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<CalibrateOptions>();
  CLI::App* command =
      app.add_subcommand("calibrate", "Fit numbers of a scenario to measured data, with confidence intervals");
  command->add_option("FILE", options->file, "Calibration file (TOML): scenario, data, free parameters and bounds")
      ->required();
  command->add_option("-o,--output", options->output, "Folder of the results [runs/NAME]");
  command
      ->add_option("--confidence", options->confidence,
                   "Level of the two-sided intervals, between 0 and 1, e.g. 0.99 [the file's, or 0.95]")
      ->check(CLI::Range(1e-6, 1.0 - 1e-6));
  command->add_flag("--quiet", options->is_quiet, "Say nothing but the result, warnings and errors");
  command->add_flag("--strict", options->is_strict, "Exit with 5 where the fit is bad and a warning says so");
  command->footer("Example: monograin calibrate scenarios/calibrate/uniaxial.toml");
  command->callback([options, &action] { action = [options] { return run_calibration(*options); }; });
}

}  // namespace monograin
