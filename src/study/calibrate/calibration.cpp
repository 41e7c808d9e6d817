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

#include "numerics/derivatives.hpp"
#include "scenario/faults.hpp"
#include "study/calibrate/bad_fit.hpp"
#include "study/calibrate/fit_notes.hpp"
#include "study/calibrate/interval_search.hpp"
#include "study/calibrate/noise_model.hpp"
#include "study/calibrate/response.hpp"
#include "study/calibrate/thinning.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

constexpr std::size_t k_curve_points = 400;  // points of a fitted curve, about, if the data have fewer
constexpr int k_most_rounds = 50;            // repetitions of fit and estimate of its noise

constexpr std::size_t k_thinned = 400;  // rows that are left, about, if a search with many first thins the data

/// Number of parts into which the distance of two points is divided, so that a curve is smooth.
std::size_t parts_between_points(std::span<const double> x) {
  return std::max<std::size_t>(1, k_curve_points / x.size());
}

[[nodiscard]] std::vector<Response> responses_of(const Calibration& calibration) {
  std::vector<Response> responses;
  for (const MeasuredCurve& curve : calibration.curves) {
    DataPath path = path_through(curve.rows_of(calibration.x.values));
    std::vector<double> y = path.at_points(curve.rows_of(calibration.y.values));
    responses.emplace_back(calibration, curve, std::move(path), std::move(y));
  }
  return responses;
}

class Fit {
 public:
  /// @param prior_weight  factor of the priors' residuals, if it is known
  Fit(const Calibration& calibration, const LeastSquaresProblem::Progress& progress, double prior_weight = 1.0)
      : calibration_(calibration),
        procedures_(model_fits(calibration)),
        responses_(responses_of(calibration)),
        response_(calibration.x.values.size()),
        noise_(calibration, responses_),
        rows_(noise_.rows()),
        prior_weight_(prior_weight) {
    problem_.parameters.assign(calibration.free.begin(), calibration.free.end());
    begin_at(procedures_.starts);
    for (std::size_t k = 0; k < calibration.free.size(); ++k) {
      if (calibration.free[k].prior && calibration.free[k].prior->is_residual()) priors_.push_back(k);
    }
    problem_.residual_count = residual_count();
    problem_.plain_count = residual_count() - rows_.size();
    problem_.loss = calibration.loss;
    problem_.noise = noise_of(calibration);
    problem_.progress = progress;
    problem_.residuals = [this](std::span<const double> parameters, std::span<double> residuals) {
      if (!run_curves(parameters)) return false;
      noise_.follow_slopes(responses_);
      for (std::size_t i = 0; i < rows_.size(); ++i) {
        const std::size_t row = rows_[i];
        const double error = calibration_.y.values[row] - response_[row] - noise_.curvature_biases()[row];
        residuals[i] = noise_.trial_weights()[row] * error;
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
      bool has_changed = noise_.depends_on_fit() && run_curves(solution->parameters) &&
                         noise_.follow_fit(solution->parameters, responses_, response_);
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

  /// Weights the priors by the residuals of the data. @return true if that has changed
  bool weigh_priors(const LeastSquaresSolution& solution) {
    const double deviation = deviation_of(problem_, solution.residuals, rows_.size());
    const double before = std::exchange(prior_weight_, deviation > 0.0 ? deviation : 0.0);
    return std::abs(prior_weight_ - before) > k_same_number * prior_weight_;
  }

  [[nodiscard]] std::size_t residual_count() const {
    return rows_.size() + priors_.size() + static_cast<std::size_t>(noise_.shared_errors().count());
  }

  /// Takes the most probable shared errors out of the residuals, whose last ones become these errors.
  void take_shared_errors(Eigen::Ref<Eigen::VectorXd> residuals) const {
    const SharedErrors& shared = noise_.shared_errors();
    if (shared.count() == 0) return;
    residuals.tail(shared.count()) = shared.take_from(residuals.head(static_cast<Eigen::Index>(rows_.size())));
  }

  /// One search with fixed weights. For many rows, the search begins with a fit to thinned data.
  [[nodiscard]] std::optional<LeastSquaresSolution> search_once() {
    if (calibration_.x.values.size() <= 2 * k_thinned) return minimise(problem_);
    const Calibration thin = thinned(calibration_, k_thinned);
    const double share = static_cast<double>(thin.counted()) / static_cast<double>(rows_.size());
    const auto near = thin.counted() > calibration_.free.size()
                          ? Fit(thin, problem_.progress, prior_weight_ * std::sqrt(share)).search_once()
                          : std::nullopt;
    auto solution = near ? minimise_near(problem_, near->minima) : std::nullopt;
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
    return {.explained = explained_share(calibration_, noise_.weights(), data_fit().cost(*solution)),
            .parameters = solution->parameters,
            .is_noise = !tests || tests->are_independent()};
  }

  /// Response of the best fit in every row; none if there is no fit.
  std::optional<std::vector<double>> respond() {
    const auto solution = search();
    if (!solution || !run_curves(solution->parameters)) return std::nullopt;
    return response_;
  }

  /// @param trial  finds the cause if there is no fit
  CalibrationResult run(const FitTrial& trial) {
    auto solution = search();
    if (!solution) no_response(trial);
    CalibrationResult result;
    result.solution = std::move(*solution);
    IntervalSearch intervals(data_fit(), [this](std::span<const double> parameters) {
      Eigen::MatrixXd response = response_jacobian(parameters);
      Eigen::MatrixXd residuals = weighted(response, parameters);
      return FitDerivatives{std::move(response), std::move(residuals)};
    });
    const Eigen::MatrixXd gradients = intervals.run(result);
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
    result.goodness = goodness_of(result.solution, result.fit.y);
    if (!data_fit().is_exact(result.solution)) {
      result.residual_tests = test_residuals(std::span(result.solution.residuals).first(rows_.size()));
    }
    result.notes = notes_of(calibration_, result);
    std::ranges::copy(intervals.notes(), std::back_inserter(result.notes));
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

  /// Computes the response of one curve. @return false if its scenario cannot follow the data
  bool run_curve(std::size_t curve, std::span<const double> parameters) {
    return responses_[curve](parameters, calibration_.curves[curve].rows_of(response_));
  }

  /// Computes response_, curve by curve. @return false if a curve cannot be followed; later ones are not computed
  bool run_curves(std::span<const double> parameters) {
    for (std::size_t c = 0; c < responses_.size(); ++c) {
      if (!run_curve(c, parameters)) return false;
    }
    return true;
  }

  [[nodiscard]] DataFit data_fit() const { return {calibration_, problem_, rows_, noise_.weights()}; }

  /// Throws because no drawn parameters have a response. Reports what happens in the middle of the bounds.
  [[noreturn]] void no_response(const FitTrial& trial) {
    std::vector<double> middle;
    for (const FreeParameter& parameter : calibration_.free)
      middle.push_back(std::midpoint(parameter.lower, parameter.upper));
    std::size_t failed = 0;
    while (failed < responses_.size() && run_curve(failed, middle)) ++failed;
    // If the middle can be followed, only the corners could not: reports the first curve.
    if (failed == responses_.size()) failed = 0;
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

  /// Derivatives of the response in all rows, including those that do not count.
  [[nodiscard]] Eigen::MatrixXd response_jacobian(std::span<const double> parameters) {
    LeastSquaresProblem problem = problem_;
    problem.residual_count = response_.size();
    problem.residuals = [this](std::span<const double> trial, std::span<double> response) {
      if (!run_curves(trial)) return false;
      std::ranges::copy(response_, response.begin());
      return true;
    };
    return residual_jacobian(problem, parameters);
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
          -noise_.weights()[rows_[i]] * gradients.row(static_cast<Eigen::Index>(rows_[i]));
    }
    for (Eigen::Index k = 0; k < jacobian.cols(); ++k) take_shared_errors(jacobian.col(k));
    return jacobian;
  }

  void fit_at_data(CalibrationResult& result, const Eigen::MatrixXd& gradients) {
    run_curves(result.solution.parameters);
    noise_.follow_slopes(responses_);
    result.fit = {calibration_.x.values, response_, bands(result, gradients)};
    const Eigen::Map<const Eigen::VectorXd> residuals(result.solution.residuals.data(),
                                                      static_cast<Eigen::Index>(result.solution.residuals.size()));
    Eigen::Map<Eigen::VectorXd>(result.fit.y.data(), static_cast<Eigen::Index>(result.fit.y.size())) +=
        noise_.effects_of_turns() * residuals.tail(noise_.shared_errors().count());
    std::ranges::transform(result.fit.y, noise_.curvature_biases(), result.fit.y.begin(), std::plus<>());
    result.weights = noise_.weights();
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
    const std::span<const double> data_x = measured.rows_of(calibration_.x.values);
    const std::size_t parts = parts_between_points(data_x);
    if (parts == 1) {
      const auto rows = [&measured](const std::vector<double>& values) {
        const std::span<const double> own = measured.rows_of(values);
        return std::vector(own.begin(), own.end());
      };
      return {rows(calibration_.x.values), rows(result.fit.y), rows(result.fit.band)};
    }
    const DataPath path = path_through(data_x);
    const std::vector<double> x = refined(path.x, parts);
    Response response_through(calibration_, measured, refined(path, parts),
                              refined(path.at_points(measured.rows_of(calibration_.y.values)), parts));
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

  [[nodiscard]] GoodnessOfFit goodness_of(const LeastSquaresSolution& solution, std::span<const double> fit) const {
    GoodnessOfFit goodness;
    const std::vector<double>& y = calibration_.y.values;
    double mean = 0.0;
    for (const std::size_t row : rows_) mean += y[row] / static_cast<double>(rows_.size());
    double about_mean = 0.0;
    double about_fit = 0.0;
    for (const std::size_t row : rows_) {
      const double residual = y[row] - fit[row];
      about_mean += (y[row] - mean) * (y[row] - mean);
      about_fit += residual * residual;
      if (std::abs(residual) <= goodness.largest) continue;
      goodness.largest = std::abs(residual);
      goodness.largest_at = row;
    }
    for (std::size_t i = 0; i < solution.residuals.size(); ++i) {
      const bool is_of_prior = i >= rows_.size() && i < rows_.size() + priors_.size();
      if (!is_of_prior) goodness.sum_of_squares += std::pow(solution.residuals[i], 2);
    }
    goodness.noise_growth = noise_.shared_errors().log_determinant();
    for (const std::size_t row : rows_)
      goodness.noise_growth += 2.0 * std::log(calibration_.weights[row] / noise_.weights()[row]);
    goodness.rms = std::sqrt(about_fit / static_cast<double>(rows_.size()));
    goodness.r_squared = is_constant(calibration_) ? k_nan : 1.0 - about_fit / about_mean;
    goodness.explained = explained_share(calibration_, noise_.weights(), data_fit().cost(solution));
    return goodness;
  }

  const Calibration& calibration_;
  ModelFits procedures_;
  std::vector<Response> responses_;  ///< one for each curve
  std::vector<double> response_;     ///< in every row of the last run
  NoiseModel noise_;
  const std::vector<std::size_t>& rows_;  ///< rows that count
  std::vector<std::size_t> priors_;       ///< indices of the parameters whose priors are residuals
  /// Factor of the priors' residuals: the standard deviation of the data's weighted residuals, so that both have noise
  /// of one size; 1 if the noise is known.
  double prior_weight_;
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
