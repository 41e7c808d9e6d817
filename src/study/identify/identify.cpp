#include "study/identify/identify.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "history/recorder.hpp"
#include "history/run.hpp"
#include "numerics/derivatives.hpp"
#include "scenario/faults.hpp"
#include "scenario/words.hpp"
#include "scene/scene.hpp"
#include "study/calibrate/calibration_language.hpp"
#include "study/calibrate/errors_in_x.hpp"
#include "study/calibrate/response.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

constexpr double k_fixed_instant = 1e-9;      // change of an instant with the relative change of a number, over the
                                              // duration, below which the instant is fixed
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

/// "step 2" or "steps 1, 3".
std::string named(const std::vector<std::size_t>& steps) {
  return fmt::format("step{} {}", steps.size() > 1 ? "s" : "", fmt::join(steps, ", "));
}

/// Program that goes through the displacements of a run: forces, and steps that a condition ends, are replaced by the
/// displacements to which they led. A fit goes along the measured displacement, too; at fixed forces the place of the
/// wall would depend on what is sought.
class DisplacementProgram {
 public:
  /// @param history  of a run of the scenario
  DisplacementProgram(const CheckedScenario& scenario, const Table& history)
      : scenario_(scenario), history_(history), scene_(make_scene(scenario)) {
    find_ends();
    is_replaced_.resize(ends_.size());
    for (const Channel& channel : scene_.channels) mark(channel.program);
    for (std::size_t k = 0; k < ends_.size(); ++k) {
      if (is_replaced_[k]) replaced_.push_back(k + 1);
    }
    if (!replaced_.empty() && !has_legs_) override_programs();
  }

  /// Numbers of the steps to be replaced, from 1.
  [[nodiscard]] const std::vector<std::size_t>& replaced() const noexcept { return replaced_; }
  /// Overrides of the scenario that make the program; empty if none makes it: walls that share their steps have gone
  /// different distances, a step that follows a table or a sine, or the model has no walls.
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

  /// Marks steps that prescribe a force or a stress, hold one, or end by a condition.
  void mark(const std::vector<Step>& program) {
    bool is_force = false;
    std::size_t number = 0;
    for (const Step& step : program) {
      if (step.leg.is_first()) ++number;
      has_legs_ = has_legs_ || !step.leg.is_last();
      const auto control = control_of(step.kind);
      if (control) is_force = *control == Control::force || *control == Control::stress;
      if (number <= ends_.size() && (is_force || !step.until.empty())) is_replaced_[number - 1] = true;
    }
  }

  void override_programs() {
    const std::vector<WallSpec>& walls = scenario_.loading.walls;
    std::vector<std::string> shared;  // programs of the channels that follow the steps of [loading]
    for (std::size_t c = 0; c < scene_.classes.size(); ++c) {
      const Channel& channel = scene_.channels[c];
      if (channel.program.empty()) continue;
      const std::string program = program_of(channel);
      if (walls.empty()) shared.push_back(program);
      for (const std::string& name : scene_.walls[c]) {
        const auto wall = std::ranges::find(walls, name, &WallSpec::name);
        if (wall == walls.end() || wall->is_fixed) continue;
        if (wall->steps.empty())
          shared.push_back(program);
        else
          overrides_.push_back(fmt::format("loading.wall[{}].steps = {}", wall - walls.begin(), program));
      }
    }
    if (!shared.empty()) overrides_.push_back("loading.steps = " + shared.front());
    if (std::ranges::adjacent_find(shared, std::not_equal_to()) != shared.end()) overrides_.clear();
  }

  /// The steps of a channel as a text. Steps that ended where they began are left out, in all channels alike.
  [[nodiscard]] std::string program_of(const Channel& channel) const {
    std::vector<std::string> texts;
    for (std::size_t k = 0; k < channel.program.size(); ++k) {
      const Step& step = channel.program[k];
      if (k >= ends_.size()) break;  // the run has ended before
      const double duration = duration_of(k);
      if (!(duration > 0.0)) continue;
      const bool is_ramp = step.kind == Step::Kind::displacement || is_replaced_[k];
      const std::string target = step.kind == Step::Kind::detach ? "detach = true"
                                 : is_ramp                       ? fmt::format("displacement = {}", end_of(channel, k))
                                                                 : "hold = true";
      const std::string pace = step.kind == Step::Kind::detach && step.rate ? fmt::format("rate = {}", *step.rate)
                                                                            : fmt::format("duration = {}", duration);
      texts.push_back(fmt::format("{{ {}, {} }}", target, pace));
    }
    return fmt::format("[{}]", fmt::join(texts, ", "));
  }

  /// Displacement to which a step leads. A step that ends as the contact is lost stops short of that: whether it is
  /// lost within the step would depend on what is sought, and no row after it would have a derivative.
  [[nodiscard]] double end_of(const Channel& channel, std::size_t step) const {
    constexpr double k_short = 1e-3;  // share of the step
    const std::size_t displacement = *history_.find(channel.name + ".displacement");
    const std::size_t force = *history_.find(channel.name + ".force");
    const double end = history_.at(ends_[step], displacement);
    if (step == 0 || !is_replaced_[step] || history_.at(ends_[step], force) != 0.0) return end;
    return end + k_short * (history_.at(ends_[step - 1], displacement) - end);
  }

  const CheckedScenario& scenario_;
  const Table& history_;
  Scene scene_;
  std::vector<std::size_t> ends_;  ///< last row of each step
  bool has_legs_ = false;          ///< a step follows a table or a sine
  std::vector<bool> is_replaced_;
  std::vector<std::size_t> replaced_;
  std::vector<std::string> overrides_;
};

/// Steps, from 1, that prescribe a displacement of a class of walls.
std::vector<std::size_t> displacement_steps(const CheckedScenario& scenario, std::string_view contact_class) {
  std::vector<std::size_t> steps;
  const Scene scene = make_scene(scenario);
  for (const Channel& channel : scene.channels) {
    if (channel.name != contact_class) continue;
    std::size_t number = 0;
    for (const Step& step : channel.program) {
      if (!step.leg.is_first()) continue;
      ++number;
      if (step.kind == Step::Kind::displacement) steps.push_back(number);
    }
  }
  return steps;
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

/// The scenario of a program, driven as a fit drives it: along the displacements of its run, unless they are what is
/// measured.
/// @param rough  history of that run
/// @param notes  receives what is replaced, or cannot be
CheckedScenario driven_scenario(const ExperimentProgram& program, const Table& rough, std::vector<std::string>& notes) {
  constexpr std::string_view k_displacement = ".displacement";
  if (program.observable.ends_with(k_displacement)) {
    const std::string_view contact_class =
        std::string_view(program.observable).substr(0, program.observable.size() - k_displacement.size());
    if (const auto steps = displacement_steps(program.scenario, contact_class); !steps.empty()) {
      notes.push_back(
          fmt::format("the measured quantity, {}, is prescribed in {}, which tells nothing of the parameters",
                      program.observable, named(steps)));
    }
    return program.scenario;
  }
  const DisplacementProgram path(program.scenario, rough);
  if (!path.overrides().empty()) {
    notes.push_back(
        fmt::format("{}: replaced by the displacements to which forces or conditions lead, because a fit follows the "
                    "measured displacement",
                    named(path.replaced())));
    return program.scenario.variants->with(path.overrides());
  }
  if (!path.replaced().empty()) {
    notes.push_back(
        fmt::format("{}: forces, stresses, and ends by a condition count as measured, too; for errors of a fit along a "
                    "measured displacement or strain, prescribe that",
                    named(path.replaced())));
  }
  return program.scenario;
}

/// Standard deviation of a value of y.
double deviation_of_y(const ExperimentProgram& program, double value, double time) {
  const double deviation = std::hypot(program.absolute_noise, program.relative_noise * value);
  if (!(deviation > 0.0)) {
    throw_fault(program.noise_at,
                fmt::format("{} = 0 at {:.6g} s has no relative noise; expected an absolute part, too",
                            program.observable, time));
  }
  return deviation;
}

/// The rows that the machine records of a run, as a calibration has them.
Calibration recorded(const Table& history, const ExperimentPlan& plan, const ExperimentProgram& program) {
  Calibration fit;
  fit.scenario = program.scenario;
  fit.free = plan.free;
  fit.x.observable = program.driven.column;
  fit.y.observable = program.observable;
  const std::size_t x = *history.find(fit.x.observable);
  const std::size_t y = *history.find(fit.y.observable);
  const std::size_t time = *history.find("time");
  for (const std::size_t row : output_rows(history)) {
    if (history.at(row, time) == 0.0) continue;
    const bool moves_x = fit.machine_moves_x();
    const double force = history.at(row, moves_x ? y : x);
    const double displacement = history.at(row, moves_x ? x : y) + plan.machine.addition(force);
    const double shown_force = force + plan.machine.force_offset;
    fit.x.values.push_back(moves_x ? displacement : shown_force);
    fit.y.values.push_back(moves_x ? shown_force : displacement);
    fit.weights.push_back(1.0 / deviation_of_y(program, fit.y.values.back(), history.at(row, time)));
  }
  MeasuredCurve curve;
  curve.end = fit.x.values.size();
  curve.noise.x = program.noise_of_x;
  curve.machine = plan.machine;
  curve.scenario = program.scenario;
  curve.driven = program.driven.column;
  curve.control = program.driven.kind;
  curve.start = program.driven.start;
  fit.curves.push_back(std::move(curve));
  return fit;
}

/// Adds the effects of noise of x to the derivatives of recorded rows over the noise of y.
/// @param response  that has run with these values along this path
Eigen::MatrixXd with_errors_in_x(const Eigen::MatrixXd& jacobian, const Calibration& fit, const DataPath& path,
                                 std::span<const double> values, const Response& response) {
  ErrorsInX errors(fit, fit.curves.front(), path);
  errors.follow(response);
  errors.set_effects_of_turns(values, response);
  const Eigen::Index rows = jacobian.rows();
  Eigen::MatrixXd effects = errors.effects_of_turns();
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(rows + effects.cols(), jacobian.cols());
  for (Eigen::Index row = 0; row < rows; ++row) {
    const auto k = static_cast<std::size_t>(row);
    const double share = 1.0 / std::hypot(1.0, fit.weights[k] * fit.curves.front().noise.x * errors.slopes()[k]);
    result.row(row) = share * jacobian.row(row);
    effects.row(row) *= share * fit.weights[k];
  }
  const SharedErrors of_turns(std::move(effects));
  for (Eigen::Index k = 0; k < result.cols(); ++k) {
    result.col(k).tail(of_turns.count()) = of_turns.take_from(result.col(k).head(rows));
  }
  return result;
}

/// Takes the rows that the machine records of a run: derivatives of a calibration's response over the noise.
void collect_recorded_rows(const Table& history, const ExperimentPlan& plan, const ExperimentProgram& program,
                           ProgramInformation& information) {
  const Calibration fit = recorded(history, plan, program);
  const MeasuredCurve& curve = fit.curves.front();
  const DataPath path = path_through(fit.x.values);
  Response response(fit, curve, path, path.at_points(fit.y.values));
  LeastSquaresProblem problem;
  problem.parameters.assign(fit.free.begin(), fit.free.end());
  problem.residual_count = fit.weights.size();
  problem.noise = information.noise = noise_of(fit);
  problem.residuals = [&](std::span<const double> parameters, std::span<double> residuals) {
    if (!response(parameters, residuals)) return false;
    for (std::size_t row = 0; row < residuals.size(); ++row) residuals[row] *= fit.weights[row];
    return true;
  };
  std::vector<double> expected(problem.residual_count);
  if (!problem.residuals(plan.values, expected)) {
    throw_fault(program.noise_at, fmt::format("a fit cannot follow the rows of program '{}': {}", program.name,
                                              on_one_line(response.problem())));
  }
  for (const double value : expected) information.largest = std::max(information.largest, std::abs(value));
  information.jacobian = residual_jacobian(problem, plan.values);
  if (!(program.noise_of_x > 0.0)) return;
  static_cast<void>(problem.residuals(plan.values, expected));
  information.jacobian = with_errors_in_x(information.jacobian, fit, path, plan.values, response);
}

/// Takes the rows of a run that tell of the parameters: derivatives of the measured quantity over its noise.
void collect_rows(const Table& history, const ExperimentPlan& plan, const ExperimentProgram& program,
                  ProgramInformation& information) {
  const std::size_t time = *history.find("time");
  const std::size_t y = *history.find(program.observable);
  std::vector<std::size_t> columns;
  std::vector<std::size_t> instants;  // columns of the derivatives of the time
  for (const FreeParameter& parameter : plan.free) {
    columns.push_back(*history.find(derivative_name(program.observable, parameter.key.path)));
    instants.push_back(*history.find(derivative_name("time", parameter.key.path)));
  }
  // False where a derivative is undefined.
  const auto has_fixed_instant = [&](std::size_t row) {
    const double least = k_fixed_instant * history.at(history.row_count() - 1, time);
    for (std::size_t k = 0; k < instants.size(); ++k) {
      if (!(std::abs(history.at(row, instants[k]) * plan.values[k]) <= least)) return false;
    }
    return true;
  };
  std::vector<Eigen::RowVectorXd> rows;
  for (const std::size_t row : output_rows(history)) {
    if (history.at(row, time) == 0.0) continue;
    Eigen::RowVectorXd derivatives(static_cast<Eigen::Index>(columns.size()));
    for (std::size_t k = 0; k < columns.size(); ++k) {
      derivatives[static_cast<Eigen::Index>(k)] = history.at(row, columns[k]);
    }
    const double value = history.at(row, y);
    if (!derivatives.allFinite() || !std::isfinite(value) || !has_fixed_instant(row)) {
      ++information.left_out;
      continue;
    }
    const double deviation = deviation_of_y(program, value, history.at(row, time));
    information.largest = std::max(information.largest, std::abs(value) / deviation);
    rows.emplace_back(derivatives / deviation);
  }
  information.jacobian.resize(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t row = 0; row < rows.size(); ++row) {
    information.jacobian.row(static_cast<Eigen::Index>(row)) = rows[row];
  }
}

}  // namespace

ProgramInformation information_of(const ExperimentPlan& plan, const ExperimentProgram& program) {
  ProgramInformation information;
  CheckedScenario scenario = program.scenario;
  scenario.sensitivities.clear();
  scenario.output = {.points = 1};
  const Run first = run_scenario(scenario);
  const Table& rough = first.record.history;
  if (first.record.status != RunStatus::complete) {
    information.notes.push_back("the run ends early: " + first.record.message);
  }
  const double duration = rough.row_count() > 0 ? rough.at(rough.row_count() - 1, *rough.find("time")) : 0.0;
  const bool is_recorded = plan.has_machine() || program.noise_of_x > 0.0;
  if (!is_recorded) {
    scenario = driven_scenario(program, rough, information.notes);
    scenario.sensitivities = program.scenario.sensitivities;
  }
  scenario.output = {.points = 0, .times = measured_instants(duration, program.points)};
  const Run run = run_scenario(scenario);
  if (is_recorded) {
    collect_recorded_rows(run.record.history, plan, program, information);
  } else {
    information.noise = run.integrator.is_direct() ? k_direct_noise : k_integrated_error;
    collect_rows(run.record.history, plan, program, information);
  }
  for (const std::string& warning : run.record.warnings) information.notes.push_back(warning);
  if (information.left_out > 0) {
    const auto kept = static_cast<std::size_t>(information.jacobian.rows());
    information.notes.push_back(
        fmt::format("{} of {} rows left out: an event passes them as a parameter changes, and they have no derivative",
                    information.left_out, information.left_out + kept));
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
  // Rows are scaled to y of order one at most, so that the error of derivatives can be compared with them.
  double scale = 1.0;
  for (const ProgramInformation* program : programs) {
    scale = std::max(scale, program->largest);
    problem.noise = std::max(problem.noise, program->noise);
  }
  ExpectedErrors expected;
  expected.uncertainty =
      uncertainty_of(problem, solution, jacobian / scale, solution.residuals.size(), k_level, 1.0 / scale);
  expected.log_determinant = expected.relative_variances = k_infinity;
  std::vector<Eigen::Index> own;  // indices of the scenario's parameters
  for (std::size_t k = 0; k < free.size(); ++k) {
    if (free[k].is_of_machine()) continue;
    if (!expected.uncertainty.is_determined[k]) return expected;
    own.push_back(static_cast<Eigen::Index>(k));
  }
  const Eigen::Map<const Eigen::VectorXd> sizes(values.data(), static_cast<Eigen::Index>(values.size()));
  const Eigen::VectorXd inverse = sizes(own).cwiseInverse();
  const Eigen::MatrixXd relative =
      inverse.asDiagonal() * expected.uncertainty.covariance(own, own) * inverse.asDiagonal();
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
