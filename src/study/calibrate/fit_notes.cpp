#include "study/calibrate/fit_notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <span>
#include <utility>

#include "history/turns.hpp"
#include "study/calibrate/calibration_language.hpp"
#include "study/calibrate/calibration_text.hpp"

namespace monograin {
namespace {

using Notes = std::vector<std::string>;

constexpr double k_improbable = 1e-3;        // probability below which a test counts as failed
constexpr double k_far_from_prior = 3.0;     // in standard deviations
constexpr double k_least_moved = 1e-6;       // share of a prior's variance that errors of the covariance hide
constexpr std::size_t k_few_rows = 10;       // fewer make the intervals of a bootstrap too narrow
constexpr double k_far_turn = 3.0;           // error of y at a turn, over the residuals
constexpr double k_silent_excess = 1.05;     // of the errors by rows that tell nothing of the noise
constexpr double k_high_correlation = 0.95;  // of two parameters
constexpr double k_poor = 0.1;               // relative standard error from which a parameter is determined poorly

/// Notes residuals that do not have the size of the given noise.
void note_chi_squared(const CalibrationResult& result, Notes& notes) {
  const auto degrees = static_cast<double>(result.uncertainty.degrees_of_freedom);
  if (degrees == 0.0) return;
  const boost::math::chi_squared distribution(degrees);
  const double above = boost::math::cdf(boost::math::complement(distribution, result.goodness.sum_of_squares));
  const double reduced = result.goodness.sum_of_squares / degrees;
  if (above < k_improbable) {
    notes.push_back(
        fmt::format("chi^2 over degrees of freedom is {:.3g}: the residuals are larger than the noise given, by the "
                    "law or by the data; the intervals are too narrow by a factor of about {:.2g}",
                    reduced, std::sqrt(reduced)));
  } else if (1.0 - above < k_improbable) {
    notes.push_back(
        fmt::format("chi^2 over degrees of freedom is {:.3g}: the noise given is larger than the residuals; the "
                    "intervals are too wide",
                    reduced));
  }
}

/// Notes rows without any noise, which make it look smaller than it is.
void note_silent_rows(const CalibrationResult& result, Notes& notes) {
  const std::size_t silent = result.uncertainty.silent_rows;
  if (silent >= result.uncertainty.degrees_of_freedom) return;
  const auto degrees = static_cast<double>(result.uncertainty.degrees_of_freedom);
  const double excess = std::sqrt(degrees / (degrees - static_cast<double>(silent)));
  if (!(excess > k_silent_excess)) return;
  notes.push_back(
      fmt::format("{} of {} rows are zero in data and fit, where nothing touches, and tell nothing of the noise: "
                  "without them standard errors are {:.2g} times as large",
                  silent, result.points, excess));
}

/// Notes priors that the data contradict.
void note_priors(const Calibration& calibration, const CalibrationResult& result, Notes& notes) {
  for (std::size_t k = 0; k < calibration.free.size(); ++k) {
    const FreeParameter& parameter = calibration.free[k];
    if (!parameter.prior || !parameter.prior->is_residual()) continue;
    const double value = result.solution.parameters[k];
    // The fit lies between data and prior: it moves from the prior by the share of the variance that the data remove.
    const auto place = static_cast<Eigen::Index>(k);
    const double kept = std::pow(parameter.prior->slope(value), 2) * result.uncertainty.cost_covariance(place, place);
    const double moved = std::sqrt(std::max(1.0 - kept, k_least_moved));
    const double deviation = std::abs(parameter.prior->deviation(value)) / (std::isfinite(kept) ? moved : 1.0);
    if (deviation <= k_far_from_prior) continue;
    notes.push_back(
        fmt::format("data and prior contradict each other: they differ in '{}' by {:.2g} standard deviations",
                    parameter.key.path, deviation));
  }
}

/// Notes residuals that are not independent, and what that means.
void note_residual_tests(const Calibration& calibration, const CalibrationResult& result, Notes& notes) {
  if (!result.residual_tests || result.residual_tests->are_independent()) return;
  const ResidualTests& tests = *result.residual_tests;
  std::string note = fmt::format(
      "the residuals are not independent: {} stretches of one sign where noise has {:.0f} (runs test, p = {:.2g}), "
      "correlation of neighbours {:.2f} (p = {:.2g}); the law, or the machine, differs from the data in a way "
      "that is not noise",
      tests.runs, tests.expected_runs, tests.runs_p, tests.correlation, tests.correlation_p);
  const bool draws_blocks = result.method == IntervalMethod::bootstrap && !calibration.knows_noise();
  if (tests.correlation > 0.0 && tests.correlation < 1.0 && !draws_blocks && result.has_intervals()) {
    note += fmt::format(", and intervals are too narrow, by a factor of about {:.2g}",
                        std::sqrt((1.0 + tests.correlation) / (1.0 - tests.correlation)));
  }
  if (!calibration.has_machine() && calibration.machine_moves_x()) {
    note +=
        "; whether it is the machine, a fit shows in which data.offset, data.force_offset and data.compliance are free";
  }
  notes.push_back(std::move(note));
}

void note_table_ends(const Calibration& calibration, const MeasuredCurve& curve, std::span<const double> x,
                     Notes& notes) {
  if (curve.machine.forces.empty()) return;
  const std::span<const double> forces = calibration.machine_moves_x() ? curve.rows_of(calibration.y.values) : x;
  const double largest = *std::ranges::max_element(forces);
  if (largest <= curve.machine.forces.back()) return;
  notes.push_back(fmt::format(
      "the table of the machine's displacement ends at {:.6g} N and is continued by its last piece to {:.6g} N",
      curve.machine.forces.back(), largest));
}

/// Notes the holds of noisy x.
void note_holds(const Calibration& calibration, const MeasuredCurve& curve, const std::vector<Turn>& turns,
                Notes& notes) {
  for (const Turn& turn : turns) {
    if (turn.held_rows() == 0) continue;
    notes.push_back(fmt::format("hold of {} rows, lines {} to {}: {} is taken as constant there, {:.6g} {}, their mean",
                                turn.held_rows(), calibration.lines[curve.begin + turn.held_begin],
                                calibration.lines[curve.begin + turn.held_end - 1], calibration.x.observable, turn.x,
                                calibration.x.si));
  }
}

/// Notes noise of x, and data that begin with unloading.
void note_path(const Calibration& calibration, const MeasuredCurve& curve, std::span<const double> x,
               const std::vector<Turn>& turns, Notes& notes) {
  const auto changed = std::ranges::find_if(x, [x](double value) { return value != x.front(); });
  if (const double noise = noise_in(x); noise > 0.0) {
    constexpr double k_apart = 3.0;  // ratio of noises from which on one of them is wrong
    std::string of_intervals =
        curve.noise.x > 0.0
            ? fmt::format("Weights and intervals contain the noise given, {:.2g} {}", curve.noise.x, calibration.x.si)
            : "Intervals do not contain it, nor the error of these points, and are too narrow where unloading is "
              "steep; give it with noise = { x = ... }";
    if (curve.noise.x > k_apart * noise || (curve.noise.x > 0.0 && curve.noise.x < noise / k_apart)) {
      of_intervals += ", which differs by far; check it and its unit";
    }
    notes.push_back(fmt::format(
        "{} has noise of about {:.2g} {} (standard deviation), which turns nothing; turning points lie where the rows "
        "beside them lead. {}",
        calibration.x.observable, noise, calibration.x.si, of_intervals));
    note_holds(calibration, curve, turns, notes);
  } else if (changed != x.end() && *changed < x.front() && x.front() > curve.start) {
    notes.push_back("the data begin with unloading; the particle is loaded to their first row from rest");
  }
}

/// Notes the turn that the rows have missed by most, or may have, if that changes y by more than its residuals.
void note_missed_turns(const Calibration& calibration, const CalibrationResult& result, const MeasuredCurve& curve,
                       std::span<const double> x, const std::vector<Turn>& turns, Notes& notes) {
  if (result.uncertainty.degrees_of_freedom == 0) return;
  const double deviation =
      std::sqrt(result.goodness.sum_of_squares / static_cast<double>(result.uncertainty.degrees_of_freedom));
  const bool has_noise = noise_in(x) > 0.0;  // rows then lie on both sides of the turn
  double largest = k_far_turn * deviation;
  std::string note;
  for (const Turn& turn : turns) {
    const std::size_t k = turn.last_row;
    const std::size_t row = curve.begin + k;
    if (k == 0 || k + 2 >= x.size() || (turn.is_known && has_noise)) continue;
    // Within the time between two rows x goes on at the speed before the turn and comes back at that after it.
    const double step_before = std::abs(x[k] - x[k - 1]);
    const double step_after = std::abs(x[k + 2] - x[k + 1]);
    const std::size_t extreme = std::abs(turn.x - x[k + 1]) < std::abs(turn.x - x[k]) ? k + 1 : k;
    const double missed =
        turn.is_known ? std::abs(turn.x - x[extreme]) : step_before * step_after / (step_before + step_after);
    const double slope = (calibration.y.values[row + 2] - calibration.y.values[row + 1]) / step_after;
    const double change = std::abs(missed * slope);
    if (!(result.weights[row] * change > largest)) continue;
    largest = result.weights[row] * change;
    const std::size_t line = calibration.lines[curve.begin + extreme];
    const std::string what =
        turn.is_known ? fmt::format(
                            "is taken to turn {:.2g} {} beyond line {}, where the equal steps of the rows before and "
                            "after it meet if the rows are at equal times",
                            missed, calibration.x.si, line)
                      : fmt::format(
                            "turns in line {}, or beside it by up to {:.2g} {}: the rows there have no equal steps, "
                            "which would show where",
                            line, missed, calibration.x.si);
    note = fmt::format(
        "{} {}. That changes {} by up to {:.2g} {}: {}", calibration.x.observable, what, calibration.y.observable,
        change, calibration.y.si,
        turn.is_known ? "if it turned in this line, repeat the line" : "record the turn, or rows at equal times");
  }
  if (!note.empty()) notes.push_back(std::move(note));
}

/// Notes pairs of parameters of which the data determine little more than a combination.
void note_correlations(const Calibration& calibration, const CalibrationResult& result, Notes& notes) {
  for (std::size_t i = 0; i < calibration.free.size(); ++i) {
    for (std::size_t j = i + 1; j < calibration.free.size(); ++j) {
      const double correlation = result.uncertainty.correlation(i, j);
      if (!(std::abs(correlation) > k_high_correlation)) continue;
      // The note names the parameter that the data determine less well.
      const auto relative = [&](std::size_t k) {
        const std::string& path = calibration.free[k].key.path;
        if (path == calibration::k_offset || path == calibration::k_force_offset) return 0.0;  // may well be zero
        return result.uncertainty.standard_error(k) / std::abs(result.solution.parameters[k]);
      };
      const std::size_t poor = relative(i) > relative(j) ? i : j;
      if (!(relative(poor) > k_poor)) continue;
      notes.push_back(fmt::format(
          "the data determine '{}' poorly, to {:.0f} %: its correlation with '{}' is {:.3f}; hold one of them if it "
          "is known otherwise",
          calibration.free[poor].key.path, 100.0 * relative(poor), calibration.free[i + j - poor].key.path,
          correlation));
    }
  }
}

/// Notes parameters that the data do not determine, or that sit at a bound.
void note_parameters(const Calibration& calibration, const CalibrationResult& result, Notes& notes) {
  for (std::size_t k = 0; k < calibration.free.size(); ++k) {
    const FreeParameter& parameter = calibration.free[k];
    const std::string& path = parameter.key.path;
    if (!result.uncertainty.has_derivative[k]) {
      notes.push_back(
          fmt::format("no error and no interval of '{}': trial runs on both sides of the fit failed, so that no "
                      "derivative is known; the data may determine it all the same",
                      path));
    } else if (!result.uncertainty.is_determined[k]) {
      notes.push_back(
          fmt::format("the data do not determine '{}': other values of it, alone or together with other parameters, "
                      "fit as well",
                      path));
    } else if (result.solution.bounds[k] != LeastSquaresSolution::Bound::none) {
      notes.push_back(
          fmt::format("'{}' sits at its {} bound; its interval ends there", path, word_of(result.solution.bounds[k])));
    } else if (result.uncertainty.half_width(k) > 0.5 * (parameter.upper - parameter.lower)) {
      notes.push_back(fmt::format("the data hardly determine '{}': its interval is wider than its bounds", path));
    }
  }
}

}  // namespace

std::vector<std::string> notes_of(const Calibration& calibration, const CalibrationResult& result) {
  const LeastSquaresSolution& solution = result.solution;
  Notes notes = calibration.notes;
  const auto note = [&notes](std::string text) { notes.push_back(std::move(text)); };
  note_parameters(calibration, result, notes);
  if (result.uncertainty.degrees_of_freedom == 0 && !calibration.knows_noise()) {
    note(
        fmt::format("{} parameters for {} points: the fit leaves nothing to estimate errors from; no errors and no "
                    "intervals",
                    calibration.free.size(), result.points));
  }
  if (result.method == IntervalMethod::bootstrap && !calibration.knows_noise() && result.points < k_few_rows) {
    note(
        fmt::format("a bootstrap of {} points gives intervals that are too narrow; expected {} or more, or another "
                    "method",
                    result.points, k_few_rows));
  }
  if (!calibration.knows_noise()) note_silent_rows(result, notes);
  if (calibration.knows_noise()) note_chi_squared(result, notes);
  note_priors(calibration, result, notes);
  if (!solution.has_converged) note("the search ended before its steps had vanished; the fit may not be the best");
  if (solution.failures > 0) {
    note(fmt::format("{} of {} trial runs ended early, outside the model's domain, and were passed over",
                     solution.failures, solution.evaluations));
  }
  for (const MeasuredCurve& curve : calibration.curves) {
    const std::span<const double> x = curve.rows_of(calibration.x.values);
    note_table_ends(calibration, curve, x, notes);
    const std::vector<Turn> turns = turns_of(x, turning_points(x));
    note_path(calibration, curve, x, turns, notes);
    note_missed_turns(calibration, result, curve, x, turns, notes);
  }
  note_correlations(calibration, result, notes);
  note_residual_tests(calibration, result, notes);
  return notes;
}

}  // namespace monograin
