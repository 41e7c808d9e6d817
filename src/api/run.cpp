#include "monograin/run.hpp"

#include "api/checked.hpp"
#include "history/profile.hpp"
#include "history/run.hpp"
#include "history/run_files.hpp"

namespace monograin {
namespace {

/// A history over a table of the run; it keeps the run alive.
History part_of(const std::shared_ptr<const Run>& run, const Table& table) {
  return History(std::shared_ptr<const Table>(run, &table));
}

}  // namespace

RunResult::RunResult(std::shared_ptr<const Run> run)
    : status(run->record.status),
      message(run->record.message),
      limit(run->record.limit ? code(*run->record.limit) : ""),
      warnings(run->record.warnings),
      integrator(run->integrator.used),
      history(part_of(run, run->record.history)),
      events(part_of(run, run->record.events)),
      run_(std::move(run)) {}

std::string RunResult::json() const { return run_json(*run_); }

void RunResult::save(const std::filesystem::path& folder) const {
  StagedFolder staged(folder);
  Run run = *run_;  // a copy, because write_run() notes the time of writing in the run
  write_run(run, staged);
}

History RunResult::profile(double time, const RunOptions& options) const {
  return history_of(contact_profiles(run_->scenario, time, interruptible(options.stop)));
}

RunResult run(const Scenario& scenario, const RunOptions& options) {
  return RunResult(std::make_shared<const Run>(run_scenario(checked(scenario), interruptible(options.stop))));
}

}  // namespace monograin
