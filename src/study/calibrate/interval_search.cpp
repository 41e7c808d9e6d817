#include "study/calibrate/interval_search.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace monograin {
namespace {

constexpr int k_most_better = 3;               // better fits that the search for intervals may find
constexpr double k_margin_of_round_off = 1e3;  // residuals up to this many times the solver's noise are round-off
constexpr double k_bad_condition = 1e3;        // a correlation of 1 - 2e-6
constexpr std::size_t k_bootstrap_samples = 400;
constexpr std::uint64_t k_seed = 20260101;
constexpr double k_narrow = 0.2;  // largest ratio of a bootstrap's standard error to the covariance's that gets a note

void covariance_intervals(CalibrationResult& result) {
  result.intervals.clear();
  for (std::size_t k = 0; k < result.solution.parameters.size(); ++k) {
    const double half = result.uncertainty.half_width(k);
    result.intervals.push_back(
        {.lower = result.solution.parameters[k] - half, .upper = result.solution.parameters[k] + half});
  }
}

void rescale(Uncertainty& uncertainty, std::size_t parameter, double factor) {
  const auto k = static_cast<Eigen::Index>(parameter);
  if (!std::isfinite(factor)) return;
  uncertainty.covariance.row(k) *= factor;
  uncertainty.covariance.col(k) *= factor;
}

}  // namespace

double DataFit::cost(const LeastSquaresSolution& solution) const {
  double cost = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) cost += problem.loss.rho(solution.residuals[i]);
  return cost;
}

bool DataFit::is_exact(const LeastSquaresSolution& solution) const {
  double squares = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    squares += std::pow(weights[rows[i]] * calibration.y.values[rows[i]], 2);
  }
  const double share = k_margin_of_round_off * problem.noise;
  return cost(solution) <= share * share * squares;
}

Eigen::MatrixXd IntervalSearch::run(CalibrationResult& result) {
  for (int round = 0;; ++round) {
    FitDerivatives derivatives = derivatives_(result.solution.parameters);
    result.uncertainty = uncertainty_of(
        fit_.problem, result.solution, derivatives.residuals, fit_.rows.size(), fit_.calibration.confidence,
        fit_.calibration.knows_noise() ? std::optional(1.0) : std::nullopt, relative_deviations());
    const std::optional<LocalMinimum> better = choose_intervals(result);
    if (!better || round == k_most_better) return std::move(derivatives.response);
    auto solution = minimise_near(fit_.problem, {&*better, 1});
    if (!solution || !(solution->cost < result.solution.cost)) return std::move(derivatives.response);
    solution->evaluations += result.solution.evaluations;
    solution->failures += result.solution.failures;
    solution->minima.insert(solution->minima.end(), result.solution.minima.begin(), result.solution.minima.end());
    result.solution = std::move(*solution);
  }
}

/// Standard deviations of the weighted residuals, with a mean square of one, where weights are not those of the
/// noise: "area" evens out the spacing of rows that are equally noisy. Empty otherwise.
std::vector<double> IntervalSearch::relative_deviations() const {
  std::vector<double> result;
  if (fit_.calibration.weighting != "area") return result;
  double squares = 0.0;
  for (const std::size_t row : fit_.rows) squares += std::pow(fit_.weights[row], 2);
  const double root_mean_square = std::sqrt(squares / static_cast<double>(fit_.rows.size()));
  for (const std::size_t row : fit_.rows) result.push_back(fit_.weights[row] / root_mean_square);
  return result;
}

/// @return a better fit, if one was found
std::optional<LocalMinimum> IntervalSearch::choose_intervals(CalibrationResult& result) {
  result.method = fit_.calibration.intervals;
  result.method_reason = "asked for";
  std::optional<LocalMinimum> better;
  const bool has_size = result.uncertainty.standard_deviation > 0.0;
  if (!has_size || fit_.is_exact(result.solution)) {
    result.method = IntervalMethod::covariance;
    result.method_reason = has_size ? "the fit is exact" : "nothing is left to estimate errors from";
  } else if (result.method == IntervalMethod::automatic) {
    better = choose_method(result);
  }
  covariance_intervals(result);
  if (better) return better;
  if (result.method == IntervalMethod::profile) return by_profile(result);
  if (result.method == IntervalMethod::bootstrap) by_bootstrap(result);
  return std::nullopt;
}

std::optional<LocalMinimum> IntervalSearch::choose_method(CalibrationResult& result) {
  const LeastSquaresSolution& solution = result.solution;
  is_kinked_ = false;
  const auto reason = [&result](IntervalMethod method, std::string text) {
    result.method = method;
    result.method_reason = std::move(text);
  };
  for (std::size_t k = 0; k < solution.bounds.size(); ++k) {
    if (solution.bounds[k] == LeastSquaresSolution::Bound::none || !result.uncertainty.is_determined[k]) continue;
    reason(IntervalMethod::profile, fmt::format("'{}' sits at its bound", fit_.calibration.free[k].key.path));
    return std::nullopt;
  }
  if (result.uncertainty.condition > k_bad_condition) {
    reason(IntervalMethod::profile,
           fmt::format("the data tell a combination of parameters {:.2g} times as well as another one, and the "
                       "covariance loses its digits",
                       result.uncertainty.condition));
    return std::nullopt;
  }
  if (const auto other = value_beside(solution, result.uncertainty)) {
    const FreeParameter& parameter = fit_.calibration.free[other->parameter];
    reason(IntervalMethod::profile,
           fmt::format("another fit is nearly as good, with '{}' = {:.4g} {}", parameter.key.path,
                       other->value / parameter.unit_factor, parameter.unit));
    return std::nullopt;
  }
  CostCheck check = check_cost(fit_.problem, solution, result.uncertainty);
  result.solution.evaluations += check.evaluations;
  if (check.shape == CostShape::quadratic) {
    reason(IntervalMethod::covariance, "the sum of squares is quadratic within two standard errors");
    return check.better;
  }
  const bool is_finite = std::isfinite(check.ratio);
  const std::string place =
      fmt::format("{:.0f} standard error{} along '{}'", check.at, std::abs(check.at) == 1.0 ? "" : "s",
                  fit_.calibration.free[check.parameter].key.path);
  is_kinked_ = is_finite && check.shape == CostShape::kinked;
  reason(IntervalMethod::profile,
         is_finite ? fmt::format("the sum of squares {} near the minimum: {} it rises {:.2g} times as far as the "
                                 "covariance says",
                                 is_kinked_ ? "has a kink" : "is not quadratic", place, check.ratio)
                   : fmt::format("the trial run {} from the minimum failed", place));
  return check.better;
}

std::optional<LocalMinimum> IntervalSearch::by_profile(CalibrationResult& result) {
  ProfileIntervals found = profile_intervals(fit_.problem, result.solution, result.uncertainty);
  result.solution.evaluations += found.evaluations;
  if (found.better) return found.better;
  result.intervals = std::move(found.intervals);
  // At a kink, the covariance's errors and bands are those of one side: they are rescaled to the intervals.
  for (std::size_t k = 0; is_kinked_ && k < result.intervals.size(); ++k) {
    const Interval& interval = result.intervals[k];
    if (interval.is_cut_below || interval.is_cut_above || !std::isfinite(interval.upper - interval.lower)) continue;
    rescale(result.uncertainty, k, 0.5 * (interval.upper - interval.lower) / result.uncertainty.half_width(k));
  }
  return std::nullopt;
}

void IntervalSearch::by_bootstrap(CalibrationResult& result) {
  notes_.clear();
  if (result.uncertainty.degrees_of_freedom == 0) return;
  const auto tests = test_residuals(std::span(result.solution.residuals).first(fit_.rows.size()));
  const bool is_independent = !tests || tests->are_independent();
  const auto length = is_independent ? std::size_t{1}
                                     : static_cast<std::size_t>(std::cbrt(static_cast<double>(fit_.rows.size())) + 0.5);
  const std::size_t block = fit_.calibration.knows_noise() ? 0 : length;
  const Bootstrap drawn = bootstrap(fit_.problem, result.solution, result.uncertainty, fit_.rows.size(), block,
                                    k_bootstrap_samples, k_seed);
  result.solution.evaluations += drawn.evaluations;
  result.method_reason =
      fmt::format("asked for: {} samples of the {}{}", drawn.samples.size(), block > 0 ? "residuals" : "noise",
                  block > 1 ? fmt::format(" in blocks of {}", block) : "");
  if (drawn.samples.size() < k_bootstrap_samples / 2) return;
  for (std::size_t k = 0; k < result.intervals.size(); ++k) {
    if (!result.uncertainty.is_determined[k]) continue;
    result.intervals[k] = drawn.interval(k, fit_.calibration.confidence);
    const double share = drawn.standard_error(k) / result.uncertainty.standard_error(k);
    note_narrow(fit_.calibration.free[k].key.path, share);
    rescale(result.uncertainty, k, share);
  }
}

/// Notes a bootstrap whose fits have hardly moved.
/// @param share  its standard error over that by the covariance
void IntervalSearch::note_narrow(const std::string& path, double share) {
  if (!(share < k_narrow)) return;
  notes_.push_back(
      fmt::format("the bootstrap's standard error of '{}' is {:.2g} times that by the covariance: its fits stay where "
                  "they begin, as at a kink of the sum of squares; use intervals = \"profile\"",
                  path, share));
}

}  // namespace monograin
