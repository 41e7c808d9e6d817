// `monograin run`.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <set>

#include "cli/commands.hpp"
#include "cli/terminal.hpp"
#include "figure/figure.hpp"
#include "history/run_files.hpp"
#include "scenario/words.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

struct RunOptions {
  std::vector<std::string> files;
  std::string output;
  std::vector<std::string> overrides;
  bool draws_figure = false;
  std::string format;
  bool is_quiet = false;
};

struct Job {
  CheckedScenario scenario;
  fs::path folder{};
  std::unique_ptr<StagedFolder> staged{};
  double parse_time = 0.0;
};

template <class Read>
Job make_job(Read&& read) {
  const auto start = std::chrono::steady_clock::now();
  Job job{.scenario = read(), .parse_time = 0.0};
  job.parse_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return job;
}

/// Reads all files before anything is run; faults of all of them are reported together.
std::vector<Job> read_jobs(const RunOptions& options) {
  std::vector<Job> jobs;
  if (options.files.empty()) {
    jobs.push_back(make_job([&] { return parse_scenario(default_scenario_text(), "die.toml", options.overrides); }));
    return jobs;
  }
  read_each(options.files, [&](const std::string& file) {
    jobs.push_back(make_job([&] { return read_scenario(file, options.overrides, FileKind::any); }));
  });
  return jobs;
}

/// Chooses and makes the folders of all jobs before any job runs, so that no result turns out to have no folder.
void choose_folders(std::vector<Job>& jobs, const std::string& output) {
  std::set<fs::path> taken;
  for (Job& job : jobs) {
    const bool is_own_folder = !output.empty() && jobs.size() == 1;
    const fs::path base = output.empty() ? fs::path("runs") : fs::path(output);
    job.folder = is_own_folder ? base : base / folder_name(job.scenario);
    if (!taken.insert(fs::weakly_canonical(job.folder)).second) {
      throw UsageError(
          fmt::format("two scenarios are named '{}' and would write to the same folder {}; run them one by one "
                      "with -o",
                      job.scenario.name, job.folder.string()));
    }
  }
  for (Job& job : jobs) job.staged = std::make_unique<StagedFolder>(job.folder, k_run_marker, k_run_tables);
}

/// Draws the figure of a run; warns if this fails, because a run must not fail for its figure.
void draw_figure(const fs::path& folder, std::string_view format) {
  try {
    draw_runs({folder}, folder / fmt::format("figure.{}", format));
  } catch (const std::exception& error) {
    say("warning: no figure: {}\n", in_own_words(error));
  }
}

void report(const Run& run, const fs::path& folder) {
  for (const Sensitivity& by : run.sensitivities) {
    say("derivatives by {}: {}, error {:.1g} of the largest\n", by.key,
        by.is_forward ? "integrated" : "differences of more runs", by.error);
  }
  say("{}: {}, {} rows, {} events -> {}\n", run.scenario.name, to_string(run.record.status),
      run.record.history.row_count(), run.record.events.row_count(), folder.string());
}

int run(const RunOptions& options) {
  std::vector<Job> jobs = read_jobs(options);
  choose_folders(jobs, options.output);
  std::function<void(const fs::path&)> draw;
  if (options.draws_figure || !options.format.empty()) {
    draw = [&](const fs::path& folder) {
      draw_figure(folder, options.format.empty() ? figure::k_usual_format : options.format);
    };
  }
  int worst = k_success;
  for (const Job& job : jobs) {
    Run result = run_scenario(job.scenario);
    result.timings.parse = job.parse_time;
    write_run(result, *job.staged, draw);
    if (!options.is_quiet) {
      for (const std::string& warning : result.record.warnings) say("warning: {}\n", warning);
      report(result, job.folder);
    }
    if (!result.record.message.empty()) {
      say("{}: {}: {}\n", result.scenario.name, to_string(result.record.status), result.record.message);
    }
    worst = std::max(worst, exit_code_of(result.record.status));
  }
  return worst;
}

}  // namespace

std::string folder_name(const CheckedScenario& scenario) {
  if (scenario.overrides.empty()) return scenario.name;
  std::vector<std::string> overrides = scenario.overrides;
  // The order of overrides matters only among those of one key.
  std::ranges::stable_sort(overrides, {}, [](const std::string& text) { return text.substr(0, text.find('=')); });
  const std::string digest = text_digest(fmt::format("{}", fmt::join(overrides, "\n")));
  constexpr std::size_t k_digits = 8;
  return fmt::format("{}-{}", scenario.name, digest.substr(digest.find(':') + 1, k_digits));
}

void add_overrides(CLI::App& command, std::vector<std::string>& overrides) {
  command.add_option("--set", overrides, "Override a key: key=value, e.g. material.yield_stress='30 MPa'")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

CLI::Option* add_figure_format(CLI::App& command, std::string& format) {
  return command.add_option("--figure", format, "Format of the figure: svg, pdf or png [svg]")
      ->type_name("FORMAT")
      ->check(CLI::IsMember(std::vector<std::string>(figure::k_formats.begin(), figure::k_formats.end())));
}

int exit_code_of(RunStatus status) {
  switch (status) {
    case RunStatus::complete:
      return k_success;
    case RunStatus::stopped:
      return k_left_domain;
    case RunStatus::failed:
      return k_solver_failure;
  }
  return k_unexpected;
}

void read_each(const std::vector<std::string>& files, const std::function<void(const std::string&)>& read) {
  std::vector<Fault> faults;
  for (const std::string& file : files) {
    try {
      read(file);
    } catch (const ScenarioError& error) {
      faults.insert(faults.end(), error.faults().begin(), error.faults().end());
    }
  }
  if (!faults.empty()) throw ScenarioError(std::move(faults));
}

void add_run_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command =
      app.add_subcommand("run", "Run scenarios; without a file: the die compaction that comes with the program");
  command->add_option("FILE", options->files, "Scenario files (TOML)");
  command->add_option(
      "-o,--output", options->output,
      "Folder of the run (of several files: the folder that holds theirs) [runs/NAME, with --set runs/NAME-DIGEST]");
  add_overrides(*command, options->overrides);
  command->add_flag("--plot", options->draws_figure, "Draw figure.svg beside the curves");
  add_figure_format(*command, options->format)->description("Draw the figure in this format: svg, pdf or png");
  command->add_flag("--quiet", options->is_quiet, "Print errors only");
  command->footer("Example: monograin run scenarios/die.toml --set loading.steps[0].displacement='0.3 R0' --plot");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace monograin
