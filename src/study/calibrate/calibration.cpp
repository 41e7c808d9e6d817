#include "study/calibrate/calibration.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <numeric>
#include <utility>

#include "history/branches.hpp"
#include "numerics/derivatives.hpp"
#include "scenario/faults.hpp"
#include "study/calibrate/bad_fit.hpp"
#include "study/calibrate/errors_in_x.hpp"
#include "study/calibrate/fit_notes.hpp"
#include "study/calibrate/response.hpp"
#include "study/calibrate/thinning.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

constexpr std::size_t k_curve_points = 400;  // points of a fitted curve, about, if the data have fewer
constexpr int k_most_rounds = 50;            // repetitions of fit and estimate of its noise
constexpr int k_most_better = 3;             // better fits that the search for intervals may find
constexpr double k_least_size = 0.1;         // of the fit that noise is in proportion to, over the datum
constexpr double k_same_weight = 1e-6;       // relative change of weights that counts as none
constexpr double k_margin_of_round_off = 1e3;
constexpr double k_bad_condition = 1e3;  // a correlation of 1 - 2e-6
constexpr std::size_t k_bootstrap_samples = 400;
constexpr std::uint64_t k_seed = 20260101;
constexpr double k_narrow = 0.2;  // of a bootstrap's standard error over that by the covariance

constexpr std::size_t k_dense = 800;    // rows; a search with more of them first thins the data
constexpr std::size_t k_thinned = 400;  // approximate number of rows that are left

/// Number of parts into which each piece of a curve is divided, so that the curve is smooth.
std::size_t parts_of(std::span<const double> x) { return std::max<std::size_t>(1, k_curve_points / x.size()); }

/// Values of one curve, out of values that are stored row by row.
template <class T>
std::span<T> rows_of(std::vector<T>& values, const MeasuredCurve& curve) {
  return std::span(values).subspan(curve.begin, curve.end - curve.begin);
}

class Fit {
 public:
  /// @param prior_weight  factor of the priors' residuals, if it is known
  Fit(const Calibration& calibration, const LeastSquaresProblem::Progress& progress, double prior_weight = 1.0)
      : calibration_(calibration),
        procedures_(model_fits(calibration)),
        response_(calibration.x.values.size()),
        noise_of_y_(calibration.weights.size()),
        excesses_(calibration.x.values.size()),
        weights_(calibration.weights),
        trial_weights_(calibration.weights),
        prior_weight_(prior_weight) {
    std::ranges::transform(weights_, noise_of_y_.begin(), [](double weight) { return 1.0 / weight; });
    for (const MeasuredCurve& curve : calibration.curves) {
      DataPath path = path_through(x_of(calibration, curve));
      std::vector<double> y = path.at_points(y_of(calibration, curve));
      if (curve.noise.x > 0.0) errors_in_x_.push_back({responses_.size(), ErrorsInX(calibration, curve, path)});
      responses_.emplace_back(calibration, curve, std::move(path), std::move(y));
    }
    for (std::size_t row = 0; row < calibration.weights.size(); ++row) {
      if (calibration.weights[row] > 0.0) rows_.push_back(row);
    }
    problem_.parameters.assign(calibration.free.begin(), calibration.free.end());
    begin_at(procedures_.starts);
    for (std::size_t k = 0; k < calibration.free.size(); ++k) {
      if (calibration.free[k].prior && calibration.free[k].prior->is_residual()) priors_.push_back(k);
    }
    set_shared_errors();
    problem_.residual_count = residual_count();
    problem_.plain_count = residual_count() - rows_.size();
    problem_.loss = calibration.loss;
    problem_.noise = noise_of(calibration);
    problem_.progress = progress;
    problem_.residuals = [this](std::span<const double> parameters, std::span<double> residuals) {
      if (failing(parameters) < responses_.size()) return false;
      weigh_by_slopes();
      for (std::size_t i = 0; i < rows_.size(); ++i) {
        const std::size_t row = rows_[i];
        residuals[i] = trial_weights_[row] * (calibration_.y.values[row] - response_[row] - excesses_[row]);
      }
      for (std::size_t j = 0; j < priors_.size(); ++j) {
        const std::size_t k = priors_[j];
        residuals[rows_.size() + j] = prior_weight_ * calibration_.free[k].prior->deviation(parameters[k]);
      }
      take_shared_errors(Eigen::Map<Eigen::VectorXd>(residuals.data(), static_cast<Eigen::Index>(residuals.size())));
      return true;
    };
  }
  Fit(const Fit&) = delete;
  Fit& operator=(const Fit&) = delete;

  /// The best fit; none if no parameters that were tried have a response. If the noise is not known, the priors are
  /// weighted by the noise that the data's residuals show. Noise in proportion to y follows from the fit: a datum that
  /// noise makes small would otherwise weigh more.
  [[nodiscard]] std::optional<LeastSquaresSolution> search() {
    const bool seeks_prior_weight = !priors_.empty() && !calibration_.knows_noise();
    if (seeks_prior_weight) prior_weight_ = 0.0;
    auto solution = search_once();
    for (int round = 0; solution && round < k_most_rounds; ++round) {
      bool has_changed = has_noise_of_fit() && failing(solution->parameters) == responses_.size() &&
                         weigh_by_response(solution->parameters);
      if (seeks_prior_weight) has_changed = weigh_priors(*solution) || has_changed;
      if (!has_changed) break;
      auto next = round == 0 && seeks_prior_weight ? search_once() : minimise_near(problem_, solution->minima);
      if (!next) break;
      next->evaluations += solution->evaluations;
      next->failures += solution->failures;
      solution = std::move(next);
    }
    return solution;
  }

  [[nodiscard]] bool has_noise_of_fit() const {
    return std::ranges::any_of(calibration_.curves, [](const MeasuredCurve& curve) {
      return curve.noise.relative > 0.0 || curve.noise.x > 0.0;
    });
  }

  /// Weights the priors by the residuals of the data. @return true if that has changed
  bool weigh_priors(const LeastSquaresSolution& solution) {
    const double deviation = deviation_of(problem_, solution.residuals, rows_.size());
    const double before = std::exchange(prior_weight_, deviation > 0.0 ? deviation : 0.0);
    return std::abs(prior_weight_ - before) > k_same_number * prior_weight_;
  }

  /// Weighs rows with noise of x by the slope of the last response. Weights that stayed as they were would make slopes
  /// too small (Lybanon (1984), Am. J. Phys. 52, 22).
  void weigh_by_slopes() {
    for (auto& [c, errors] : errors_in_x_) {
      const MeasuredCurve& curve = calibration_.curves[c];
      errors.follow(responses_[c]);
      std::ranges::copy(errors.excesses(), rows_of(excesses_, curve).begin());
      for (std::size_t row = curve.begin; row < curve.end; ++row) {
        trial_weights_[row] = 1.0 / std::hypot(noise_of_y_[row], curve.noise.x * errors.slopes()[row - curve.begin]);
      }
    }
  }

  /// Sets what depends on the fit by the last response: noise in proportion to y, weights, and the effects of turns. A
  /// fit that is far below the datum, as before first touch, does not make its noise small.
  /// @return true if weights have changed
  bool weigh_by_response(std::span<const double> parameters) {
    for (const MeasuredCurve& curve : calibration_.curves) {
      if (!(curve.noise.relative > 0.0)) continue;
      for (std::size_t row = curve.begin; row < curve.end; ++row) {
        const double size = std::max(std::abs(response_[row]), k_least_size * std::abs(calibration_.y.values[row]));
        noise_of_y_[row] = std::hypot(curve.noise.absolute, curve.noise.relative * size);
        trial_weights_[row] = 1.0 / noise_of_y_[row];
      }
    }
    weigh_by_slopes();
    for (auto& [c, errors] : errors_in_x_) errors.move_turns(parameters, responses_[c]);
    const bool has_changed = !std::ranges::equal(trial_weights_, weights_, [](double trial, double weight) {
      return std::abs(trial - weight) <= k_same_weight * trial;
    });
    weights_ = trial_weights_;
    set_shared_errors();
    return has_changed;
  }

  /// Effects of the shared errors, those of turns of noisy x, on the response in every row.
  [[nodiscard]] Eigen::MatrixXd effects_of_turns() const {
    Eigen::Index count = 0;
    for (const auto& [c, errors] : errors_in_x_) count += errors.of_turns().cols();
    Eigen::MatrixXd effects = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(response_.size()), count);
    Eigen::Index turn = 0;
    for (const auto& [c, errors] : errors_in_x_) {
      const Eigen::MatrixXd& part = errors.of_turns();
      effects.block(static_cast<Eigen::Index>(calibration_.curves[c].begin), turn, part.rows(), part.cols()) = part;
      turn += part.cols();
    }
    return effects;
  }

  /// Sets the shared errors by their effects on weighted residuals.
  void set_shared_errors() {
    const Eigen::MatrixXd effects = effects_of_turns();
    Eigen::MatrixXd weighted(static_cast<Eigen::Index>(rows_.size()), effects.cols());
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const std::size_t row = rows_[i];
      weighted.row(static_cast<Eigen::Index>(i)) = weights_[row] * effects.row(static_cast<Eigen::Index>(row));
    }
    shared_ = SharedErrors(std::move(weighted));
  }

  [[nodiscard]] std::size_t residual_count() const {
    return rows_.size() + priors_.size() + static_cast<std::size_t>(shared_.count());
  }

  /// Takes the most probable shared errors out of the residuals, whose last ones become these errors.
  void take_shared_errors(Eigen::Ref<Eigen::VectorXd> residuals) const {
    if (shared_.count() == 0) return;
    residuals.tail(shared_.count()) = shared_.take_from(residuals.head(static_cast<Eigen::Index>(rows_.size())));
  }

  /// One search with fixed weights. For many rows, the search begins with a fit to thinned data.
  [[nodiscard]] std::optional<LeastSquaresSolution> search_once() {
    if (calibration_.x.values.size() <= k_dense) return minimise(problem_);
    const Calibration thin = thinned(calibration_, k_thinned);
    if (thin.counted() <= calibration_.free.size()) return minimise(problem_);
    const double share = static_cast<double>(thin.counted()) / static_cast<double>(rows_.size());
    const auto near = Fit(thin, problem_.progress, prior_weight_ * std::sqrt(share)).search_once();
    if (!near) return minimise(problem_);
    auto solution = minimise_near(problem_, near->minima);
    if (!solution) return minimise(problem_);
    solution->evaluations += near->evaluations;
    solution->failures += near->failures;
    return solution;
  }

  /// Share of the data that the best fit explains.
  TrialFit explain() {
    const auto solution = search();
    if (!solution) return {.explained = k_nan, .parameters = {}};
    const auto tests = test_residuals(std::span(solution->residuals).first(rows_.size()));
    return {.explained = explained_share(calibration_, weights_, cost_of_data(*solution)),
            .parameters = solution->parameters,
            .is_noise = !tests || tests->are_independent()};
  }

  /// Response of the best fit in every row; none if there is no fit.
  std::optional<std::vector<double>> respond() {
    const auto solution = search();
    if (!solution || failing(solution->parameters) < responses_.size()) return std::nullopt;
    return response_;
  }

  /// @param trial  finds the cause if there is no fit
  CalibrationResult run(const FitTrial& trial) {
    auto solution = search();
    if (!solution) no_response(trial);
    CalibrationResult result;
    result.solution = std::move(*solution);
    const Eigen::MatrixXd gradients = find_intervals(result);
    const std::vector<double>& parameters = result.solution.parameters;
    result.procedures = procedures_;
    if (!procedures_.fits.empty()) {
      result.procedures.fits.push_back(measured_fit(calibration_, procedures_, parameters));
    }
    fit_at_data(result, gradients);
    for (const MeasuredCurve& curve : calibration_.curves) result.curves.push_back(curve_through(curve, result));
    result.points = rows_.size();
    for (const Response& response : responses_) {
      result.program_steps += response.replay().scenario().loading.steps.size();
    }
    add_statistics(result);
    result.notes = notes_of(calibration_, result);
    std::ranges::copy(notes_, std::back_inserter(result.notes));
    return result;
  }

 private:
  /// Sets further starting values, where the user has given none.
  void begin_at(const std::map<std::string, double>& starts) {
    for (std::size_t k = 0; k < problem_.parameters.size(); ++k) {
      BoundedParameter& parameter = problem_.parameters[k];
      const auto found = starts.find(calibration_.free[k].key.path);
      if (found == starts.end() || parameter.start) continue;
      if (found->second >= parameter.lower && found->second <= parameter.upper) parameter.start = found->second;
    }
  }

  /// Runs all curves. @return the index of the first one that cannot be followed; their number if there is none
  std::size_t failing(std::span<const double> parameters) {
    for (std::size_t c = 0; c < responses_.size(); ++c) {
      if (!responses_[c](parameters, rows_of(response_, calibration_.curves[c]))) return c;
    }
    return responses_.size();
  }

  /// Throws because no drawn parameters have a response. Reports what happens in the middle of the bounds.
  [[noreturn]] void no_response(const FitTrial& trial) {
    std::vector<double> middle;
    for (const FreeParameter& parameter : calibration_.free)
      middle.push_back(std::midpoint(parameter.lower, parameter.upper));
    // If the middle can be followed, only the corners could not: reports the first curve.
    const std::size_t failed = failing(middle) % responses_.size();
    const Replay& replay = responses_[failed].replay();
    const MeasuredCurve& curve = calibration_.curves[failed];
    const std::string cause = likely_cause(calibration_, trial);
    throw_fault(
        {curve.file, calibration_.lines[curve.begin + replay.failed_at()]},
        fmt::format("the scenario cannot follow the data beyond this row with any parameters that were tried ({}): {}; "
                    "expected other bounds, or data that model '{}' can follow{}",
                    bounds_text(), responses_[failed].problem(), calibration_.scenario.model,
                    cause.empty() ? "" : "; likely cause: " + cause));
  }

  /// The free parameters with their bounds: "'material.youngs_modulus' from 0.1 to 10 GPa".
  [[nodiscard]] std::string bounds_text() const {
    std::vector<std::string> texts;
    for (const FreeParameter& parameter : calibration_.free) texts.push_back(parameter.bounds_text());
    return fmt::format("{}", fmt::join(texts, ", "));
  }

  // --- intervals

  /// Finds errors and intervals. If that search finds a better fit, continues from there.
  /// @return derivatives of the response in all rows
  Eigen::MatrixXd find_intervals(CalibrationResult& result) {
    for (int round = 0;; ++round) {
      Eigen::MatrixXd gradients = response_jacobian(result.solution.parameters);
      result.uncertainty = uncertainty_of(problem_, result.solution, weighted(gradients, result.solution.parameters),
                                          rows_.size(), calibration_.confidence,
                                          calibration_.knows_noise() ? std::optional(1.0) : std::nullopt, deviations());
      const std::optional<LocalMinimum> better = choose_intervals(result);
      if (!better || round == k_most_better) return gradients;
      auto solution = minimise_near(problem_, {&*better, 1});
      if (!solution || !(solution->cost < result.solution.cost)) return gradients;
      solution->evaluations += result.solution.evaluations;
      solution->failures += result.solution.failures;
      solution->minima.insert(solution->minima.end(), result.solution.minima.begin(), result.solution.minima.end());
      result.solution = std::move(*solution);
    }
  }

  /// Standard deviations of the weighted residuals, with a mean square of one, where weights are not those of the
  /// noise: "area" evens out the spacing of rows that are equally noisy. Empty otherwise.
  [[nodiscard]] std::vector<double> deviations() const {
    std::vector<double> result;
    if (calibration_.weighting != "area") return result;
    double squares = 0.0;
    for (const std::size_t row : rows_) squares += std::pow(weights_[row], 2);
    const double root_mean_square = std::sqrt(squares / static_cast<double>(rows_.size()));
    for (const std::size_t row : rows_) result.push_back(weights_[row] / root_mean_square);
    return result;
  }

  /// @return a better fit, if one was found
  std::optional<LocalMinimum> choose_intervals(CalibrationResult& result) {
    result.method = calibration_.intervals;
    result.method_reason = "asked for";
    std::optional<LocalMinimum> better;
    const bool has_size = result.uncertainty.standard_deviation > 0.0;
    if (!has_size || is_exact(result)) {
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

  /// True if the residuals are round-off.
  [[nodiscard]] bool is_exact(const CalibrationResult& result) const {
    double squares = 0.0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      squares += std::pow(weights_[rows_[i]] * calibration_.y.values[rows_[i]], 2);
    }
    const double share = k_margin_of_round_off * problem_.noise;
    return cost_of_data(result.solution) <= share * share * squares;
  }

  std::optional<LocalMinimum> choose_method(CalibrationResult& result) {
    using Bound = LeastSquaresSolution::Bound;
    const LeastSquaresSolution& solution = result.solution;
    is_kinked_ = false;
    const auto reason = [&result](IntervalMethod method, std::string text) {
      result.method = method;
      result.method_reason = std::move(text);
    };
    for (std::size_t k = 0; k < solution.bounds.size(); ++k) {
      if (solution.bounds[k] == Bound::none || !result.uncertainty.is_determined[k]) continue;
      reason(IntervalMethod::profile, fmt::format("'{}' sits at its bound", calibration_.free[k].key.path));
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
      const FreeParameter& parameter = calibration_.free[other->parameter];
      reason(IntervalMethod::profile,
             fmt::format("another fit is nearly as good, with '{}' = {:.4g} {}", parameter.key.path,
                         other->value / parameter.unit_factor, parameter.unit));
      return std::nullopt;
    }
    CostCheck check = check_cost(problem_, solution, result.uncertainty);
    result.solution.evaluations += check.evaluations;
    if (check.shape == CostShape::quadratic) {
      reason(IntervalMethod::covariance, "the sum of squares is quadratic within two standard errors");
      return check.better;
    }
    const bool is_finite = std::isfinite(check.ratio);
    const std::string place =
        fmt::format("{:.0f} standard error{} along '{}'", check.at, std::abs(check.at) == 1.0 ? "" : "s",
                    calibration_.free[check.parameter].key.path);
    is_kinked_ = is_finite && check.shape == CostShape::kinked;
    reason(IntervalMethod::profile,
           is_finite ? fmt::format("the sum of squares {} near the minimum: {} it rises {:.2g} times as far as the "
                                   "covariance says",
                                   is_kinked_ ? "has a kink" : "is not quadratic", place, check.ratio)
                     : fmt::format("the trial run {} from the minimum failed", place));
    return check.better;
  }

  static void covariance_intervals(CalibrationResult& result) {
    result.intervals.clear();
    for (std::size_t k = 0; k < result.solution.parameters.size(); ++k) {
      const double half = result.uncertainty.half_width(k);
      result.intervals.push_back(
          {.lower = result.solution.parameters[k] - half, .upper = result.solution.parameters[k] + half});
    }
  }

  std::optional<LocalMinimum> by_profile(CalibrationResult& result) {
    ProfileIntervals found = profile_intervals(problem_, result.solution, result.uncertainty);
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

  static void rescale(Uncertainty& uncertainty, std::size_t parameter, double factor) {
    const auto k = static_cast<Eigen::Index>(parameter);
    if (!std::isfinite(factor)) return;
    uncertainty.covariance.row(k) *= factor;
    uncertainty.covariance.col(k) *= factor;
  }

  void by_bootstrap(CalibrationResult& result) {
    notes_.clear();
    if (result.uncertainty.degrees_of_freedom == 0) return;
    const auto tests = test_residuals(std::span(result.solution.residuals).first(rows_.size()));
    const bool is_independent = !tests || tests->are_independent();
    const auto length =
        is_independent ? std::size_t{1} : static_cast<std::size_t>(std::cbrt(static_cast<double>(rows_.size())) + 0.5);
    const std::size_t block = calibration_.knows_noise() ? 0 : length;
    const Bootstrap drawn =
        bootstrap(problem_, result.solution, result.uncertainty, rows_.size(), block, k_bootstrap_samples, k_seed);
    result.solution.evaluations += drawn.evaluations;
    result.method_reason =
        fmt::format("asked for: {} samples of the {}{}", drawn.samples.size(), block > 0 ? "residuals" : "noise",
                    block > 1 ? fmt::format(" in blocks of {}", block) : "");
    if (drawn.samples.size() < k_bootstrap_samples / 2) return;
    for (std::size_t k = 0; k < result.intervals.size(); ++k) {
      if (!result.uncertainty.is_determined[k]) continue;
      result.intervals[k] = drawn.interval(k, calibration_.confidence);
      note_narrow(calibration_.free[k].key.path, drawn.standard_error(k) / result.uncertainty.standard_error(k));
      rescale(result.uncertainty, k, drawn.standard_error(k) / result.uncertainty.standard_error(k));
    }
  }

  /// Notes a bootstrap whose fits have hardly moved.
  /// @param share  its standard error over that by the covariance
  void note_narrow(const std::string& path, double share) {
    if (!(share < k_narrow)) return;
    notes_.push_back(fmt::format(
        "the bootstrap's standard error of '{}' is {:.2g} times that by the covariance: its fits stay where "
        "they begin, as at a kink of the sum of squares; use intervals = \"profile\"",
        path, share));
  }

  /// Derivatives of the response in all rows, including those that do not count.
  [[nodiscard]] Eigen::MatrixXd response_jacobian(std::span<const double> parameters) {
    LeastSquaresProblem problem = problem_;
    problem.residual_count = response_.size();
    problem.residuals = [this](std::span<const double> trial, std::span<double> response) {
      if (failing(trial) < responses_.size()) return false;
      std::ranges::copy(response_, response.begin());
      return true;
    };
    return residual_jacobian(problem, parameters);
  }

  /// Sum of rho over the data, without the priors.
  [[nodiscard]] double cost_of_data(const LeastSquaresSolution& solution) const {
    double cost = 0.0;
    for (std::size_t i = 0; i < rows_.size(); ++i) cost += problem_.loss.rho(solution.residuals[i]);
    return cost;
  }

  /// Jacobian of the weighted residuals.
  [[nodiscard]] Eigen::MatrixXd weighted(const Eigen::MatrixXd& gradients, std::span<const double> parameters) const {
    const auto count = static_cast<Eigen::Index>(problem_.residual_count);
    Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(count, gradients.cols());
    for (std::size_t j = 0; j < priors_.size(); ++j) {
      const std::size_t k = priors_[j];
      jacobian(static_cast<Eigen::Index>(rows_.size() + j), static_cast<Eigen::Index>(k)) =
          prior_weight_ * calibration_.free[k].prior->slope(parameters[k]);
    }
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      jacobian.row(static_cast<Eigen::Index>(i)) =
          -weights_[rows_[i]] * gradients.row(static_cast<Eigen::Index>(rows_[i]));
    }
    for (Eigen::Index k = 0; k < jacobian.cols(); ++k) take_shared_errors(jacobian.col(k));
    return jacobian;
  }

  void fit_at_data(CalibrationResult& result, const Eigen::MatrixXd& gradients) {
    static_cast<void>(failing(result.solution.parameters));
    weigh_by_slopes();
    result.fit = {calibration_.x.values, response_, bands(result, gradients)};
    const Eigen::Map<const Eigen::VectorXd> residuals(result.solution.residuals.data(),
                                                      static_cast<Eigen::Index>(result.solution.residuals.size()));
    Eigen::Map<Eigen::VectorXd>(result.fit.y.data(), static_cast<Eigen::Index>(result.fit.y.size())) +=
        effects_of_turns() * residuals.tail(shared_.count());
    std::ranges::transform(result.fit.y, excesses_, result.fit.y.begin(), std::plus<>());
    result.weights = weights_;
    if (!calibration_.has_machine()) return;
    for (const Response& response : responses_) {
      std::ranges::copy(response.particle(), std::back_inserter(result.particle));
    }
  }

  [[nodiscard]] static std::vector<double> bands(const CalibrationResult& result, const Eigen::MatrixXd& gradients) {
    std::vector<double> band;
    for (Eigen::Index i = 0; i < gradients.rows(); ++i) {
      band.push_back(result.uncertainty.half_width(gradients.row(i).transpose()));
    }
    return band;
  }

  /// The fit to one curve, with points between those of the data.
  [[nodiscard]] FittedCurve curve_through(const MeasuredCurve& measured, const CalibrationResult& result) {
    const std::vector<double> data_x = x_of(calibration_, measured);
    const std::size_t parts = parts_of(data_x);
    if (parts == 1) {
      const auto rows = [&measured](const std::vector<double>& values) {
        return std::vector(values.begin() + static_cast<std::ptrdiff_t>(measured.begin),
                           values.begin() + static_cast<std::ptrdiff_t>(measured.end));
      };
      return {data_x, rows(result.fit.y), rows(result.fit.band)};
    }
    const DataPath path = path_through(data_x);
    const std::vector<double> x = refined(path.x, parts);
    Response response_through(calibration_, measured, refined(path, parts),
                              refined(path.at_points(y_of(calibration_, measured)), parts));
    LeastSquaresProblem problem = problem_;
    problem.residual_count = x.size();
    problem.residuals = [&response_through](std::span<const double> parameters, std::span<double> response) {
      return response_through(parameters, response);
    };
    FittedCurve curve{x, std::vector<double>(x.size(), k_nan), std::vector<double>(x.size(), k_nan)};
    if (!response_through(result.solution.parameters, curve.y)) return curve;
    curve.band = bands(result, residual_jacobian(problem, result.solution.parameters));
    return curve;
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
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      result.sum_of_squares += result.solution.residuals[i] * result.solution.residuals[i];
    }
    for (std::size_t i = rows_.size() + priors_.size(); i < result.solution.residuals.size(); ++i) {
      result.sum_of_squares += std::pow(result.solution.residuals[i], 2);
    }
    result.noise_growth = shared_.log_determinant();
    for (const std::size_t row : rows_)
      result.noise_growth += 2.0 * std::log(calibration_.weights[row] / weights_[row]);
    result.rms = std::sqrt(about_fit / static_cast<double>(rows_.size()));
    result.r_squared = is_constant(calibration_) ? k_nan : 1.0 - about_fit / about_mean;
    result.explained = explained_share(calibration_, weights_, cost_of_data(result.solution));
    if (!is_exact(result)) {
      result.residual_tests = test_residuals(std::span(result.solution.residuals).first(rows_.size()));
    }
  }

  struct ErrorsOfCurve {
    std::size_t curve = 0;  ///< one with noise of x
    ErrorsInX errors;
  };

  const Calibration& calibration_;
  ModelFits procedures_;
  std::vector<Response> responses_;  ///< one for each curve
  std::vector<double> response_;     ///< in every row of the last run
  std::vector<double> noise_of_y_;   ///< standard deviation of y in every row, at the last fit if it is relative
  std::vector<double> excesses_;     ///< in every row, of the mean of y over the noise of x
  std::vector<ErrorsOfCurve> errors_in_x_;
  SharedErrors shared_;                ///< errors of turns, by their effects on weighted residuals
  std::vector<double> weights_;        ///< of every row, at the last fit
  std::vector<double> trial_weights_;  ///< of every row, at the last response
  std::vector<std::size_t> rows_;      ///< rows that count
  std::vector<std::size_t> priors_;    ///< indices of the parameters whose priors are residuals
  bool is_kinked_ = false;             ///< the sum of squares has a kink near its minimum
  double prior_weight_;                ///< standard deviation of weighted residuals
  std::vector<std::string> notes_;     ///< on the intervals
  LeastSquaresProblem problem_;
};

}  // namespace

CalibrationResult calibrate(const Calibration& calibration, const LeastSquaresProblem::Progress& progress) {
  const FitTrial trial = [&progress](const Calibration& changed) {
    return Fit(changed,
               [&progress](double /*done*/) {  // progress may throw, which stops the search
                 if (progress) progress(1.0);
               })
        .explain();
  };
  CalibrationResult result = Fit(calibration, progress).run(trial);
  result.warnings = warnings_of(calibration, result, trial);
  return result;
}

std::optional<std::vector<double>> best_response(const Calibration& calibration) {
  return Fit(calibration, {}).respond();
}

}  // namespace monograin
