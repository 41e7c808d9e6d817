#include "monograin/run.hpp"

#include <optional>
#include <stdexcept>
#include <string>

#include "api/checked.hpp"
#include "api/untrapped.hpp"
#include "exchange/force_table.hpp"
#include "exchange/lammps.hpp"
#include "exchange/vtk.hpp"
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

std::string RunResult::json() const {
  const Untrapped untrapped;
  return run_json(*run_);
}

void RunResult::save(const std::filesystem::path& folder) const {
  const Untrapped untrapped;
  StagedFolder staged(folder);
  Run run = *run_;  // a copy, because write_run() notes the time of writing in the run
  write_run(run, staged);
}

History RunResult::profile(double time, const RunOptions& options) const {
  const Untrapped untrapped;
  if (run_->elements) throw std::runtime_error("finite elements have no profile; the run of the law may have one");
  return history_of(contact_profiles(run_->scenario, time, interruptible(options.stop)));
}

void RunResult::write_vtk(const std::filesystem::path& folder) const {
  const Untrapped untrapped;
  save_vtk(run_->scenario, run_->record.history, folder);
}

std::string RunResult::lammps_input() const {
  const Untrapped untrapped;
  const LammpsLaw law = lammps_law_of(run_->scenario);
  return monograin::lammps_input(run_->scenario, motion_of(run_->scenario, run_->record.history), law);
}

History RunResult::force_table(const std::string& contact_class) const {
  const Untrapped untrapped;
  const auto chosen = contact_class.empty() ? std::nullopt : std::optional(contact_class);
  return history_of(monograin::force_table(motion_of(run_->scenario, run_->record.history), chosen));
}

RunResult run(const Scenario& scenario, const RunOptions& options) {
  const Untrapped untrapped;
  return RunResult(std::make_shared<const Run>(run_scenario(checked(scenario), interruptible(options.stop))));
}

}  // namespace monograin
