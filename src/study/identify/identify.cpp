#include "study/identify/identify.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "history/run.hpp"
#include "scenario/faults.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

constexpr double k_fixed_instant = 1e-9;      // change of an instant with the relative change of a number, over the
                                              // duration, below which the instant is fixed
constexpr double k_direct_error = 1e-13;      // relative error of runs whose states are solved for
constexpr double k_integrated_error = 1e-10;  // relative error of runs that are integrated
constexpr double k_level = 0.95;

std::string derivative_name(std::string_view column, std::string_view key) {
  return fmt::format("d({})/d({})", column, key);
}

/// Measured instants: the middles of equal spans, so that none coincides with the beginning or end of the program.
std::vector<double> measured_instants(double duration, int points) {
  std::vector<double> instants;
  for (int k = 0; k < points; ++k) instants.push_back(duration * (k + 0.5) / points);
  return instants;
}

/// Finds the rows of a history that stay at their instants when a free number changes.
class Instants {
 public:
  Instants(const ExperimentPlan& plan, const Table& history) : plan_(plan), history_(history) {
    for (const FreeParameter& parameter : plan.free) {
      columns_.push_back(*history.find(derivative_name("time", parameter.key.path)));
    }
    if (history.row_count() > 0) duration_ = history.at(history.row_count() - 1, 0);
  }

  /// True if the instant of a row depends on no free number; false where a derivative is undefined.
  [[nodiscard]] bool is_fixed(std::size_t row) const {
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const double change = history_.at(row, columns_[k]) * plan_.values[k];
      if (!(std::abs(change) <= k_fixed_instant * duration_)) return false;
    }
    return true;
  }

 private:
  const ExperimentPlan& plan_;
  const Table& history_;
  std::vector<std::size_t> columns_;
  double duration_ = 0.0;
};

/// Program that goes through the displacements of a run: forces, and steps that a condition ends, are replaced by the
/// displacements to which they led. A fit goes along the measured displacement, too; at fixed forces the place of the
/// wall would depend on what is sought.
class DisplacementProgram {
 public:
  /// @param history  of a run of the scenario
  DisplacementProgram(const CheckedScenario& scenario, const Table& history) : history_(history) {
    find_ends();
    const std::vector<Step>& shared = scenario.loading.steps;
    const std::vector<WallSpec>& walls = scenario.loading.walls;
    is_replaced_.resize(ends_.size());
    const auto mark = [this](const std::vector<Step>& steps) {
      for (std::size_t k = 0; k < std::min(steps.size(), ends_.size()); ++k) {
        const bool asks = steps[k].kind == Step::Kind::force || !steps[k].until.empty();
        if (asks && duration_of(k) > 0.0) is_replaced_[k] = true;
      }
    };
    mark(shared);
    for (const WallSpec& wall : walls) mark(wall.steps);
    if (walls.empty()) add("loading.steps", "axial", shared);
    for (std::size_t i = 0; i < walls.size(); ++i) {
      if (walls[i].is_fixed) continue;
      add(fmt::format("loading.wall[{}].steps", i), walls[i].name, walls[i].steps.empty() ? shared : walls[i].steps);
    }
  }

  /// Numbers of the replaced steps, from 1; empty if there are none, or a wall has no column of its displacement.
  [[nodiscard]] std::vector<std::size_t> replaced() const {
    std::vector<std::size_t> numbers;
    for (std::size_t k = 0; k < is_replaced_.size() && has_columns_; ++k) {
      if (is_replaced_[k]) numbers.push_back(k + 1);
    }
    return numbers;
  }
  /// Overrides of the scenario that make the program.
  [[nodiscard]] const std::vector<std::string>& overrides() const noexcept { return overrides_; }

 private:
  /// Finds the last row of each step.
  void find_ends() {
    const std::size_t step = *history_.find("step");
    for (std::size_t row = 0; row < history_.row_count(); ++row) {
      const auto number = static_cast<std::size_t>(history_.at(row, step));
      if (number > ends_.size()) ends_.resize(number, row);
      if (number > 0) ends_[number - 1] = row;
    }
  }

  [[nodiscard]] double duration_of(std::size_t step) const {
    const std::size_t time = *history_.find("time");
    return history_.at(ends_[step], time) - (step > 0 ? history_.at(ends_[step - 1], time) : 0.0);
  }

  void add(const std::string& key, const std::string& contact_class, const std::vector<Step>& steps) {
    const auto column = history_.find(contact_class + ".displacement");
    if (!column) {
      has_columns_ = false;
      return;
    }
    std::vector<std::string> texts;
    for (std::size_t k = 0; k < steps.size(); ++k) {
      const bool is_replaced = k < is_replaced_.size() && is_replaced_[k];
      texts.push_back(
          is_replaced && control_of(steps[k].kind)
              ? fmt::format("{{ displacement = {}, duration = {} }}", history_.at(ends_[k], *column), duration_of(k))
              : text_of(steps[k], is_replaced ? std::optional(duration_of(k)) : steps[k].duration));
    }
    overrides_.push_back(fmt::format("{} = [{}]", key, fmt::join(texts, ", ")));
  }

  static std::string text_of(const Step& step, std::optional<double> duration) {
    std::string text;
    switch (step.kind) {
      case Step::Kind::displacement:
        text = fmt::format("displacement = {}", step.target);
        break;
      case Step::Kind::force:
        text = fmt::format("force = {}", step.target);
        break;
      case Step::Kind::detach:
        text = "detach = true";
        break;
      default:
        text = "hold = true";
    }
    if (duration) text += fmt::format(", duration = {}", *duration);
    if (step.rate && !duration) text += fmt::format(", rate = {}", *step.rate);
    return "{ " + text + " }";
  }

  const Table& history_;
  std::vector<std::size_t> ends_;  ///< last row of each step
  std::vector<bool> is_replaced_;
  std::vector<std::string> overrides_;
  bool has_columns_ = true;
};

bool prescribes(const CheckedScenario& scenario, Step::Kind kind) {
  const auto has_kind = [kind](const std::vector<Step>& steps) {
    return std::ranges::find(steps, kind, &Step::kind) != steps.end();
  };
  return has_kind(scenario.loading.steps) || std::ranges::any_of(scenario.loading.walls, has_kind, &WallSpec::steps);
}

Eigen::MatrixXd stacked(const std::vector<FreeParameter>& free, std::span<const double> values,
                        std::span<const ProgramInformation* const> programs) {
  const auto p = static_cast<Eigen::Index>(free.size());
  std::vector<Eigen::RowVectorXd> rows;
  for (const ProgramInformation* program : programs) {
    for (const auto& row : program->jacobian.rowwise()) rows.emplace_back(row);
  }
  for (std::size_t k = 0; k < free.size(); ++k) {
    if (!free[k].prior || !free[k].prior->is_residual()) continue;
    rows.emplace_back(Eigen::RowVectorXd::Zero(p));
    rows.back()[static_cast<Eigen::Index>(k)] = free[k].prior->slope(values[k]);
  }
  // The decomposition of fewer rows than parameters would not return the undetermined directions.
  const auto count = std::max(static_cast<Eigen::Index>(rows.size()), p);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(count, p);
  for (std::size_t row = 0; row < rows.size(); ++row) jacobian.row(static_cast<Eigen::Index>(row)) = rows[row];
  return jacobian;
}

/// Index of the candidate with the least measure; none if that is infinite.
template <class Measure>
std::optional<std::size_t> best_of(const std::vector<CandidateErrors>& candidates, Measure measure) {
  const auto best = std::ranges::min_element(candidates, {}, measure);
  if (best == candidates.end() || !std::isfinite(measure(*best))) return {};
  return static_cast<std::size_t>(best - candidates.begin());
}

}  // namespace

ProgramInformation information_of(const ExperimentPlan& plan, const ExperimentProgram& program) {
  ProgramInformation information;
  CheckedScenario scenario = program.scenario;
  scenario.sensitivities.clear();
  scenario.output = {.points = 1, .times = {}};
  const Run first = run_scenario(scenario);
  const Table& rough = first.record.history;
  if (first.record.status != RunStatus::complete) {
    information.notes.push_back("the run ends early: " + first.record.message);
  }
  const double duration = rough.row_count() > 0 ? rough.at(rough.row_count() - 1, *rough.find("time")) : 0.0;

  const bool is_displacement = program.observable.ends_with(".displacement");
  if (is_displacement && prescribes(scenario, Step::Kind::displacement)) {
    information.notes.push_back(
        fmt::format("a step prescribes the measured quantity, {}, and tells nothing; expected forces in the program, "
                    "or y = a force",
                    program.observable));
  }
  if (!is_displacement) {
    const DisplacementProgram path(program.scenario, rough);
    if (const std::vector<std::size_t> replaced = path.replaced(); !replaced.empty()) {
      scenario = program.scenario.variants->with(path.overrides());
      information.notes.push_back(fmt::format(
          "step{} {} count{} as displacements, to where the force or condition leads: a fit follows the measured "
          "displacement",
          replaced.size() > 1 ? "s" : "", fmt::join(replaced, ", "), replaced.size() > 1 ? "" : "s"));
    }
  }
  scenario.sensitivities = program.scenario.sensitivities;
  scenario.output = {.points = 0, .times = measured_instants(duration, program.points)};
  const Run run = run_scenario(scenario);
  information.noise = run.integrator.is_direct() ? k_direct_error : k_integrated_error;
  const Table& history = run.record.history;
  const Instants instants(plan, history);
  const std::size_t time = *history.find("time");
  const std::size_t side = *history.find("row");
  const std::size_t y = *history.find(program.observable);
  std::vector<std::size_t> columns;
  for (const FreeParameter& parameter : plan.free) {
    columns.push_back(*history.find(derivative_name(program.observable, parameter.key.path)));
  }
  std::vector<Eigen::RowVectorXd> rows;
  for (std::size_t row = 0; row < history.row_count(); ++row) {
    if (history.at(row, side) != 0.0 || history.at(row, time) == 0.0) continue;
    Eigen::RowVectorXd derivatives(static_cast<Eigen::Index>(columns.size()));
    for (std::size_t k = 0; k < columns.size(); ++k) {
      derivatives[static_cast<Eigen::Index>(k)] = history.at(row, columns[k]);
    }
    const double value = history.at(row, y);
    if (!derivatives.allFinite() || !std::isfinite(value) || !instants.is_fixed(row)) {
      ++information.left_out;
      continue;
    }
    const double deviation = std::hypot(program.absolute_noise, program.relative_noise * value);
    if (!(deviation > 0.0)) {
      throw_fault(program.noise_at,
                  fmt::format("{} = 0 at {:.6g} s has no relative noise; expected an absolute part, too",
                              program.observable, history.at(row, time)));
    }
    information.largest = std::max(information.largest, std::abs(value) / deviation);
    rows.emplace_back(derivatives / deviation);
  }
  information.jacobian.resize(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t row = 0; row < rows.size(); ++row) {
    information.jacobian.row(static_cast<Eigen::Index>(row)) = rows[row];
  }
  for (const std::string& warning : run.record.warnings) information.notes.push_back(warning);
  if (information.left_out > 0) {
    information.notes.push_back(
        fmt::format("{} of {} rows left out: an event passes them as a parameter changes, and they have no derivative",
                    information.left_out, information.left_out + rows.size()));
  }
  return information;
}

ExpectedErrors expected_errors(const std::vector<FreeParameter>& free, std::span<const double> values,
                               std::span<const ProgramInformation* const> programs) {
  LeastSquaresProblem problem;
  problem.parameters.assign(free.begin(), free.end());
  LeastSquaresSolution solution;
  solution.parameters.assign(values.begin(), values.end());
  solution.bounds.assign(free.size(), LeastSquaresSolution::Bound::none);
  const Eigen::MatrixXd jacobian = stacked(free, values, programs);
  solution.residuals.assign(static_cast<std::size_t>(jacobian.rows()), 0.0);
  // Rows are scaled to y of order one, so that the error of derivatives can be compared with them.
  double scale = 0.0;
  for (const ProgramInformation* program : programs) {
    scale = std::max(scale, program->largest);
    problem.noise = std::max(problem.noise, program->noise);
  }
  if (scale == 0.0) scale = 1.0;
  ExpectedErrors expected;
  expected.uncertainty =
      uncertainty_of(problem, solution, jacobian / scale, solution.residuals.size(), k_level, 1.0 / scale);
  expected.log_determinant = expected.relative_variances = k_infinity;
  if (std::ranges::count(expected.uncertainty.is_determined, false) > 0) return expected;
  const Eigen::Map<const Eigen::VectorXd> sizes(values.data(), static_cast<Eigen::Index>(values.size()));
  const Eigen::VectorXd inverse = sizes.cwiseInverse();
  const Eigen::MatrixXd relative = inverse.asDiagonal() * expected.uncertainty.covariance * inverse.asDiagonal();
  expected.relative_variances = relative.trace();
  const Eigen::MatrixXd factor = relative.llt().matrixL();
  expected.log_determinant = 2.0 * factor.diagonal().array().log().sum();
  return expected;
}

IdentifyResult identify(const ExperimentPlan& plan, const std::function<void()>& before_run) {
  IdentifyResult result;
  for (const ExperimentProgram& program : plan.programs) {
    if (before_run) before_run();
    result.programs.push_back(information_of(plan, program));
  }
  std::vector<const ProgramInformation*> planned;
  for (std::size_t k = 0; k < plan.programs.size(); ++k) {
    if (plan.programs[k].is_planned) planned.push_back(&result.programs[k]);
  }
  const bool has_prior =
      std::ranges::any_of(plan.free, [](const auto& free) { return free.prior && free.prior->is_residual(); });
  if (!planned.empty() || has_prior) result.planned = expected_errors(plan.free, plan.values, planned);
  const double before = result.planned ? result.planned->log_determinant : k_infinity;
  for (std::size_t k = 0; k < plan.programs.size(); ++k) {
    if (plan.programs[k].is_planned) continue;
    std::vector<const ProgramInformation*> together = planned;
    together.push_back(&result.programs[k]);
    CandidateErrors candidate{.program = k, .errors = expected_errors(plan.free, plan.values, together)};
    candidate.volume = std::isfinite(before) ? std::exp(0.5 * (candidate.errors.log_determinant - before)) : k_nan;
    result.candidates.push_back(std::move(candidate));
  }
  result.best_by_volume =
      best_of(result.candidates, [](const CandidateErrors& each) { return each.errors.log_determinant; });
  result.best_by_variances =
      best_of(result.candidates, [](const CandidateErrors& each) { return each.errors.relative_variances; });
  return result;
}

}  // namespace monograin
