#include "study/calibrate/calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "engine/drive.hpp"
#include "scenario/faults.hpp"
#include "scenario/integrators.hpp"
#include "study/calibrate/bad_fit.hpp"
#include "study/calibrate/calibration_language.hpp"
#include "system/undefined.hpp"

namespace monograin {
namespace {

constexpr double k_direct_noise = 1e-13;     // of a response without time integration
constexpr std::size_t k_curve_points = 400;  // of the curve between the data
constexpr double k_high_correlation = 0.95;  // of two parameters
constexpr double k_poor = 0.1;               // relative standard error

/// Relative error of the responses.
double noise_of(const CheckedScenario& scenario) {
  const Scene scene = make_scene(scenario);
  return choose_integrator(scenario.numerics.integrator, *scene.system).used == integrators::k_direct
             ? k_direct_noise
             : scenario.numerics.rtol;
}

/// Into how many parts a curve's pieces are divided, so that it is smooth.
std::size_t parts_of(std::span<const double> x) { return std::max<std::size_t>(1, k_curve_points / x.size()); }

/// x with further values in between.
std::vector<double> refined(std::span<const double> x, std::size_t parts) {
  std::vector<double> result{x.front()};
  for (std::size_t i = 1; i < x.size(); ++i) {
    for (std::size_t k = 1; k < parts; ++k) {
      result.push_back(std::lerp(x[i - 1], x[i], static_cast<double>(k) / static_cast<double>(parts)));
    }
    result.push_back(x[i]);
  }
  return result;
}

/// Displacements at the particle: those measured without what the machine adds under the forces.
std::vector<double> without_machine(const Machine& machine, std::vector<double> displacements,
                                    std::span<const double> forces) {
  for (std::size_t i = 0; i < displacements.size(); ++i) displacements[i] -= machine.addition(forces[i]);
  return displacements;
}

/// The response of one curve's scenario as the residuals of a problem, with the parameters of a fit.
class Response {
 public:
  /// @param x, y  what was measured
  Response(const Calibration& calibration, const MeasuredCurve& curve, std::vector<double> x, std::vector<double> y)
      : calibration_(calibration),
        curve_(curve),
        replay_(curve.scenario, {curve.driven, calibration.y.observable, curve.control, curve.start}, x),
        x_(std::move(x)),
        y_(std::move(y)) {}

  bool operator()(std::span<const double> parameters, std::span<double> response) {
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      const std::string& path = calibration_.free[k].key.path;
      if (!path.starts_with(calibration::k_data)) replay_.set(path, parameters[k]);
    }
    const Machine machine = calibration_.machine_of(curve_, parameters);
    const bool moves_x = calibration_.machine_moves_x();
    if (machine.is_rigid()) {
      if (is_moved_) replay_.follow(x_);
      is_moved_ = false;
    } else if (moves_x) {
      replay_.follow(without_machine(machine, x_, y_));
      is_moved_ = true;
    }
    if (!replay_.run(response)) return false;
    for (std::size_t i = 0; i < x_.size() && !moves_x && !machine.is_rigid(); ++i) {
      response[i] += machine.addition(x_[i]);
    }
    return true;
  }

  [[nodiscard]] const Replay& replay() const noexcept { return replay_; }

 private:
  const Calibration& calibration_;
  const MeasuredCurve& curve_;
  Replay replay_;
  std::vector<double> x_;
  std::vector<double> y_;
  bool is_moved_ = false;  ///< the replay follows other values than x
};

/// A curve's share of values that are kept row by row.
template <class T>
std::span<T> rows_of(std::vector<T>& values, const MeasuredCurve& curve) {
  return std::span(values).subspan(curve.begin, curve.end - curve.begin);
}

std::vector<double> x_of(const Calibration& calibration, const MeasuredCurve& curve) {
  const auto begin = calibration.x.values.begin();
  return {begin + static_cast<std::ptrdiff_t>(curve.begin), begin + static_cast<std::ptrdiff_t>(curve.end)};
}

std::vector<double> y_of(const Calibration& calibration, const MeasuredCurve& curve) {
  const auto begin = calibration.y.values.begin();
  return {begin + static_cast<std::ptrdiff_t>(curve.begin), begin + static_cast<std::ptrdiff_t>(curve.end)};
}

class Fit {
 public:
  Fit(const Calibration& calibration, const LeastSquaresProblem::Progress& progress)
      : calibration_(calibration), procedures_(model_fits(calibration)), response_(calibration.x.values.size()) {
    for (const MeasuredCurve& curve : calibration.curves) {
      responses_.emplace_back(calibration, curve, x_of(calibration, curve), y_of(calibration, curve));
    }
    for (std::size_t row = 0; row < calibration.weights.size(); ++row) {
      if (calibration.weights[row] > 0.0) rows_.push_back(row);
    }
    problem_.parameters.assign(calibration.free.begin(), calibration.free.end());
    begin_at(procedures_.starts);
    problem_.residual_count = rows_.size();
    problem_.loss = calibration.loss;
    problem_.noise = noise_of(calibration.scenario);
    problem_.progress = progress;
    problem_.residuals = [this](std::span<const double> parameters, std::span<double> residuals) {
      if (failing(parameters) < responses_.size()) return false;
      for (std::size_t i = 0; i < rows_.size(); ++i) {
        const std::size_t row = rows_[i];
        residuals[i] = calibration_.weights[row] * (calibration_.y.values[row] - response_[row]);
      }
      return true;
    };
  }
  Fit(const Fit&) = delete;
  Fit& operator=(const Fit&) = delete;

  /// How much the best fit explains.
  TrialFit explain() {
    const auto solution = minimise(problem_);
    if (!solution) return {k_nan, {}};
    return {explained_share(calibration_, solution->cost), solution->parameters};
  }

  /// @param trial  for the cause where there is no fit
  CalibrationResult run(const FitTrial& trial) {
    auto solution = minimise(problem_);
    if (!solution) no_response(trial);
    CalibrationResult result;
    result.solution = std::move(*solution);
    const std::vector<double>& parameters = result.solution.parameters;
    result.procedures = procedures_;
    if (!procedures_.fits.empty()) {
      result.procedures.fits.push_back(measured_fit(calibration_, procedures_, parameters));
    }
    result.uncertainty = uncertainty_of(problem_, result.solution, residual_jacobian(problem_, parameters),
                                        rows_.size(), calibration_.confidence);
    for (const MeasuredCurve& curve : calibration_.curves) {
      const std::vector<double> x = x_of(calibration_, curve);
      const std::vector<double> y = y_of(calibration_, curve);
      append(curve_through(curve, x, y, result), result.fit);
      result.curves.push_back(curve_through(curve, refined(x, parts_of(x)), refined(y, parts_of(x)), result));
      add_particle(curve, result);
    }
    result.points = rows_.size();
    for (const Response& response : responses_) {
      result.program_steps += response.replay().scenario().loading.steps.size();
    }
    add_statistics(result);
    add_notes(result);
    return result;
  }

 private:
  /// Further places to begin at, where the user has not given one.
  void begin_at(const std::map<std::string, double>& starts) {
    for (std::size_t k = 0; k < problem_.parameters.size(); ++k) {
      BoundedParameter& parameter = problem_.parameters[k];
      const auto found = starts.find(calibration_.free[k].key.path);
      if (found == starts.end() || parameter.start) continue;
      if (found->second >= parameter.lower && found->second <= parameter.upper) parameter.start = found->second;
    }
  }

  /// Runs all curves. @return the first that cannot be followed; their number where all can
  std::size_t failing(std::span<const double> parameters) {
    for (std::size_t c = 0; c < responses_.size(); ++c) {
      if (!responses_[c](parameters, rows_of(response_, calibration_.curves[c]))) return c;
    }
    return responses_.size();
  }

  static void append(const FittedCurve& part, FittedCurve& whole) {
    whole.x.insert(whole.x.end(), part.x.begin(), part.x.end());
    whole.y.insert(whole.y.end(), part.y.begin(), part.y.end());
    whole.band.insert(whole.band.end(), part.band.begin(), part.band.end());
  }

  /// No place of the scan has a response: says what happens in the middle of the bounds.
  [[noreturn]] void no_response(const FitTrial& trial) {
    std::vector<double> middle;
    for (const FreeParameter& parameter : calibration_.free)
      middle.push_back(std::midpoint(parameter.lower, parameter.upper));
    // Where the middle can be followed, the corners could not.
    const std::size_t failed = failing(middle) % responses_.size();
    const Replay& replay = responses_[failed].replay();
    const MeasuredCurve& curve = calibration_.curves[failed];
    const std::string cause = likely_cause(calibration_, trial);
    throw_fault(
        {curve.file, calibration_.lines[curve.begin + replay.failed_at()]},
        fmt::format("the scenario cannot follow the data beyond this row with any parameters that were tried: {}; "
                    "expected other bounds, or data that model '{}' can follow{}",
                    replay.problem(), calibration_.scenario.model, cause.empty() ? "" : "; likely cause: " + cause));
  }

  [[nodiscard]] FittedCurve curve_through(const MeasuredCurve& measured, const std::vector<double>& x,
                                          const std::vector<double>& y, const CalibrationResult& result) {
    Response response_through(calibration_, measured, x, y);
    LeastSquaresProblem problem = problem_;
    problem.residual_count = x.size();
    problem.residuals = [&response_through](std::span<const double> parameters, std::span<double> response) {
      return response_through(parameters, response);
    };
    FittedCurve curve{x, std::vector<double>(x.size(), k_nan), std::vector<double>(x.size(), k_nan)};
    if (!response_through(result.solution.parameters, curve.y)) return curve;
    const Eigen::MatrixXd gradients = residual_jacobian(problem, result.solution.parameters);
    for (std::size_t i = 0; i < x.size(); ++i) {
      curve.band[i] = result.uncertainty.half_width(gradients.row(static_cast<Eigen::Index>(i)).transpose());
    }
    return curve;
  }

  /// Displacements at the particle, where they are not those measured.
  void add_particle(const MeasuredCurve& curve, CalibrationResult& result) const {
    const Machine machine = calibration_.machine_of(curve, result.solution.parameters);
    const bool is_in_use = std::ranges::any_of(calibration_.curves, [&](const MeasuredCurve& other) {
      return !calibration_.machine_of(other, result.solution.parameters).is_rigid();
    });
    if (!is_in_use) return;
    const std::vector<double> x = x_of(calibration_, curve);
    const std::vector<double> y = y_of(calibration_, curve);
    const std::vector<double> particle =
        calibration_.machine_moves_x() ? without_machine(machine, x, y) : without_machine(machine, y, x);
    result.particle.insert(result.particle.end(), particle.begin(), particle.end());
  }

  void add_statistics(CalibrationResult& result) const {
    const std::vector<double>& y = calibration_.y.values;
    double mean = 0.0;
    for (const std::size_t row : rows_) mean += y[row] / static_cast<double>(rows_.size());
    double about_mean = 0.0;
    double about_fit = 0.0;
    for (const std::size_t row : rows_) {
      const double residual = y[row] - result.fit.y[row];
      about_mean += (y[row] - mean) * (y[row] - mean);
      about_fit += residual * residual;
      if (std::abs(residual) <= result.largest) continue;
      result.largest = std::abs(residual);
      result.largest_at = row;
    }
    for (const double r : result.solution.residuals) result.sum_of_squares += r * r;
    result.rms = std::sqrt(about_fit / static_cast<double>(rows_.size()));
    result.r_squared = is_constant(calibration_) ? k_nan : 1.0 - about_fit / about_mean;
    result.explained = explained_share(calibration_, result.solution.cost);
  }

  void add_notes(CalibrationResult& result) const {
    using Bound = LeastSquaresSolution::Bound;
    const LeastSquaresSolution& solution = result.solution;
    const auto note = [&result](std::string text) { result.notes.push_back(std::move(text)); };
    result.notes = calibration_.notes;
    for (std::size_t k = 0; k < calibration_.free.size(); ++k) {
      const FreeParameter& parameter = calibration_.free[k];
      const std::string& path = parameter.key.path;
      if (!result.uncertainty.is_determined[k]) {
        note(
            fmt::format("the data do not determine '{}': other values of it, alone or together with other parameters, "
                        "fit as well",
                        path));
      } else if (solution.bounds[k] != Bound::none) {
        note(fmt::format("'{}' sits at its {} bound; it has no interval there", path,
                         solution.bounds[k] == Bound::lower ? "lower" : "upper"));
      } else if (result.uncertainty.half_width(k) > 0.5 * (parameter.upper - parameter.lower)) {
        note(fmt::format("the data hardly determine '{}': its interval is wider than its bounds", path));
      }
    }
    if (result.uncertainty.degrees_of_freedom == 0) {
      note(
          fmt::format("{} parameters for {} points: the fit leaves nothing to estimate errors from; no errors and no "
                      "intervals",
                      calibration_.free.size(), rows_.size()));
    }
    if (!solution.has_converged) note("the search ended before its steps had vanished; the fit may not be the best");
    if (solution.failures > 0) {
      note(fmt::format("{} of {} trial runs ended early, outside the model's domain, and were passed over",
                       solution.failures, solution.evaluations));
    }
    for (const MeasuredCurve& curve : calibration_.curves) {
      const std::vector<double> x = x_of(calibration_, curve);
      note_table_ends(curve, x, result);
      const auto changed = std::ranges::find_if(x, [&x](double value) { return value != x.front(); });
      if (changed != x.end() && *changed < x.front() && x.front() > curve.start) {
        note("the data begin with unloading; the particle is loaded to their first row from rest");
      }
    }
    note_correlations(result);
  }

  void note_table_ends(const MeasuredCurve& curve, const std::vector<double>& x, CalibrationResult& result) const {
    if (curve.machine.forces.empty()) return;
    const std::vector<double> forces = calibration_.machine_moves_x() ? y_of(calibration_, curve) : x;
    const double largest = *std::ranges::max_element(forces);
    if (largest <= curve.machine.forces.back()) return;
    result.notes.push_back(fmt::format(
        "the table of the machine's displacement ends at {:.6g} N and is continued by its last piece to {:.6g} N",
        curve.machine.forces.back(), largest));
  }

  /// Pairs of parameters of which the data tell little more than a combination.
  void note_correlations(CalibrationResult& result) const {
    for (std::size_t i = 0; i < calibration_.free.size(); ++i) {
      for (std::size_t j = i + 1; j < calibration_.free.size(); ++j) {
        const double correlation = result.uncertainty.correlation(i, j);
        if (!(std::abs(correlation) > k_high_correlation)) continue;
        // The one of which the data know less.
        const auto relative = [&](std::size_t k) {
          return result.uncertainty.standard_error(k) / std::abs(result.solution.parameters[k]);
        };
        const std::size_t poor = relative(i) > relative(j) ? i : j;
        if (!(relative(poor) > k_poor)) continue;
        result.notes.push_back(fmt::format(
            "the data determine '{}' poorly, to {:.0f} %: its correlation with '{}' is {:.3f}; hold one of them if it "
            "is known otherwise",
            calibration_.free[poor].key.path, 100.0 * relative(poor), calibration_.free[i + j - poor].key.path,
            correlation));
      }
    }
  }

  const Calibration& calibration_;
  ModelFits procedures_;
  std::vector<Response> responses_;  ///< of the curves
  std::vector<double> response_;     ///< in every row
  std::vector<std::size_t> rows_;    ///< that take part
  LeastSquaresProblem problem_;
};

}  // namespace

CalibrationResult calibrate(const Calibration& calibration, const LeastSquaresProblem::Progress& progress) {
  const FitTrial trial = [&progress](const Calibration& changed) {
    return Fit(changed,
               [&progress](double /*done*/) {  // a caller stops a search in its progress
                 if (progress) progress(1.0);
               })
        .explain();
  };
  CalibrationResult result = Fit(calibration, progress).run(trial);
  result.warnings = warnings_of(calibration, result, trial);
  return result;
}

}  // namespace monograin
