// `monograin sweep` and `monograin sensitivity`.

#include "study/sweep/sweep.hpp"

#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <filesystem>
#include <memory>

#include "cli/commands.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "scenario/text_file.hpp"
#include "study/sweep/bands.hpp"
#include "study/sweep/sensitivity.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

struct SweepCommandOptions {
  std::string file;
  std::string output;
  std::string shard = "1/1";
  std::string format;
  std::string figure_format{figure::k_usual_format};
  int threads = 0;
  bool makes_design_only = false;
  bool is_quiet = false;
};

/// Reads a shard `i/n`, 1 <= i <= n. @throws UsageError
SweepShard parse_shard(const std::string& text) {
  SweepShard shard{0, 0};
  const char* const end = text.data() + text.size();
  const auto [slash, error] = std::from_chars(text.data(), end, shard.index);
  if (error == std::errc{} && slash != end && *slash == '/') {
    const auto [last, second_error] = std::from_chars(slash + 1, end, shard.count);
    if (second_error == std::errc{} && last == end && shard.index >= 1 && shard.index <= shard.count) return shard;
  }
  throw UsageError(fmt::format("--shard {}: expected i/n with i from 1 to n, for example 2/8", text));
}

/// Writes the runs of a sweep to design.csv and prints the criterion psi, without running anything.
/// @throws std::runtime_error if the file cannot be written
int make_design(const Sweep& sweep, const fs::path& folder) {
  const fs::path file = folder / "design.csv";
  expect_own_file(file, file);
  fs::create_directories(folder);
  write_text_file(file, design_text(sweep));
  if (sweep.points.size() > 0 && sweep.results.empty()) {
    Design continuous = sweep.points;
    continuous.level_count = 0;
    print_data("psi: {:.10g}\n", maxpro_criterion(sweep.points));
    if (sweep.points.level_count > 0) print_data("psi_continuous: {:.10g}\n", maxpro_criterion(continuous));
  }
  say("{}: {} runs -> {}\n", sweep.name, sweep.runs.size(), file.string());
  return k_success;
}

void report(const Sweep& sweep, const SweepOutcome& outcome, double seconds) {
  std::string text = fmt::format("{}: {} runs", sweep.name, outcome.runs_now);
  if (outcome.runs_now > 0) {
    text += fmt::format(" in {:.3g} s ({:.4g} runs/s)", seconds, static_cast<double>(outcome.runs_now) / seconds);
  }
  if (outcome.runs_before > 0) text += fmt::format(", {} were there already", outcome.runs_before);
  if (outcome.runs_ended_early > 0) text += "; " + early_ends_text(sweep, outcome);
  text += outcome.runs_missing > 0
              ? fmt::format("; {} of {} are left to other shards", outcome.runs_missing, sweep.runs.size())
              : fmt::format(" -> {}", outcome.results.string());
  say("{}\n", text);
}

/// Makes the runs of a sweep that are still missing, as far as they belong to the shard.
/// @param options  without progress
SweepOutcome run_all(const Sweep& plan, SweepOptions options, bool is_quiet = false) {
  const auto start = std::chrono::steady_clock::now();
  const SweepOutcome outcome = [&] {
    ProgressBar bar("runs");
    options.progress = [&](std::size_t done, std::size_t of) {
      if (!is_quiet) bar.show(done, of);
    };
    return run_sweep(plan, options);
  }();
  say_warnings(plan.name, outcome.warnings);
  if (is_quiet && outcome.runs_ended_early > 0) say("warning: {}: {}\n", plan.name, early_ends_text(plan, outcome));
  if (is_quiet) return outcome;
  report(plan, outcome, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  return outcome;
}

int sweep(const SweepCommandOptions& options) {
  const SweepShard shard = parse_shard(options.shard);
  const Sweep plan = read_sweep(options.file);
  say_warnings(plan.name, plan.doubts);
  const fs::path folder = folder_of(plan, options.output);
  if (plan.left_out > 0 && !options.is_quiet) {
    say("{}: {} points of the design do not meet the constraints\n", plan.name, plan.left_out);
  }
  if (options.makes_design_only) return make_design(plan, folder);
  const SweepOptions runs{.folder = folder,
                          .threads = options.threads,
                          .shard = shard,
                          .progress = {},
                          .format = results_format(options.format),
                          .figure_format = options.figure_format};
  if (run_all(plan, runs, options.is_quiet).runs_missing > 0 || !plan.bands) return k_success;
  const std::string no_figure = write_bands(plan, bands_of(plan, folder), folder, options.figure_format);
  if (!no_figure.empty()) say("warning: no figure: {}\n", no_figure);
  if (!options.is_quiet) say("{}: bands -> {}\n", plan.name, (folder / "bands.csv").string());
  return k_success;
}

// --- sensitivity

struct SensitivityOptions {
  std::string file;
  std::string output;
  double confidence = 0.95;
  int threads = 0;
  std::string format{figure::k_usual_format};
};

int sensitivity(const SensitivityOptions& options) {
  const Sweep plan = read_sweep(options.file);
  say_warnings(plan.name, plan.doubts);
  if (const std::string why_not = why_no_sensitivities(plan); !why_not.empty()) {
    throw UsageError(fmt::format("{}: {}", options.file, why_not));
  }
  const fs::path folder = folder_of(plan, options.output);
  const SweepOutcome outcome = run_all(
      plan,
      {.folder = folder, .threads = options.threads, .shard = {}, .progress = {}, .figure_format = options.format});
  const std::vector<ResultSensitivity> found = sensitivities_of(plan, outcome.results, options.confidence);
  const std::string no_figure = write_sensitivities(plan, found, folder, options.format);
  print_data("{}", sensitivity_text(plan, found));
  for (const ResultSensitivity& result : found) {
    for (const std::string& warning : result.warnings) say("warning: {}\n", warning);
  }
  if (!no_figure.empty()) say("warning: no figure: {}\n", no_figure);
  say("{}: sensitivities -> {}\n", plan.name, folder.string());
  return k_success;
}

}  // namespace

void add_sweep_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<SweepCommandOptions>();
  CLI::App* command = app.add_subcommand(
      "sweep",
      "Run one scenario many times over a grid, a table or a space-filling design, or continue a stopped sweep");
  command->add_option("FILE", options->file, "Sweep file (TOML)")->required();
  command->add_option("-j,--jobs", options->threads, "Number of threads, 1 to 1024 [one for each core that it may use]")
      ->check(CLI::Range(1, 1024));
  command->add_option("--shard", options->shard, "Do every n-th run only, from the i-th; the last shard to end merges")
      ->type_name("i/n");
  command
      ->add_option("--format", options->format,
                   "Format of the results, csv or hdf5 [that of results that are there, else csv]")
      ->type_name("FORMAT")
      ->check(CLI::IsMember(k_results_formats));
  add_figure_format(*command, options->figure_format)
      ->description("Format of the figure of the bands: svg, pdf or png [svg]");
  command->add_flag("--design-only", options->makes_design_only,
                    "Write the runs to design.csv and print the criterion psi; run nothing");
  command->add_option("-o,--output", options->output, "Folder of the results [runs/NAME]");
  command->add_flag("--quiet", options->is_quiet, "Print warnings and errors only");
  command->footer("Example: monograin sweep scenarios/sweeps/poisson.toml -j 4");
  command->callback([options, &action] { action = [options] { return sweep(*options); }; });
}

void add_sensitivity_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<SensitivityOptions>();
  CLI::App* command = app.add_subcommand(
      "sensitivity",
      "Estimate the share of the results' variance that each key causes: Sobol indices, Morris screening");
  command->add_option("FILE", options->file, "Sweep file (TOML) with design = \"saltelli\" or \"morris\"")->required();
  command->add_option("-j,--jobs", options->threads, "Number of threads, 1 to 1024 [one for each core that it may use]")
      ->check(CLI::Range(1, 1024));
  command->add_option("--confidence", options->confidence, "Level of the two-sided intervals, between 0 and 1 [0.95]")
      ->check(CLI::Range(1e-6, 1.0 - 1e-6))
      ->check(is_no_nan());
  command->add_option("-o,--output", options->output, "Folder of the results [runs/NAME]");
  add_figure_format(*command, options->format);
  command->footer("Example: monograin sensitivity scenarios/sweeps/sobol-indices.toml");
  command->callback([options, &action] { action = [options] { return sensitivity(*options); }; });
}

}  // namespace monograin
