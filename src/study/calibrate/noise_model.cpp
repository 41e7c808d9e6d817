#include "study/calibrate/noise_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace monograin {
namespace {

constexpr double k_least_size = 0.1;    // of the fit that noise is in proportion to, over the datum
constexpr double k_same_weight = 1e-6;  // relative change of weights that counts as none

}  // namespace

NoiseModel::NoiseModel(const Calibration& calibration, std::span<const Response> responses)
    : calibration_(calibration),
      rows_(calibration.counted_rows()),
      noise_of_y_(calibration.weights.size()),
      curvature_biases_(calibration.weights.size()),
      weights_(calibration.weights),
      trial_weights_(calibration.weights) {
  std::ranges::transform(weights_, noise_of_y_.begin(), [](double weight) { return 1.0 / weight; });
  for (std::size_t c = 0; c < calibration.curves.size(); ++c) {
    const MeasuredCurve& curve = calibration.curves[c];
    if (curve.noise.x > 0.0) errors_in_x_.push_back({c, ErrorsInX(calibration, curve, responses[c].replay().path())});
  }
  set_shared_errors();
}

bool NoiseModel::depends_on_fit() const {
  return std::ranges::any_of(calibration_.curves, [](const MeasuredCurve& curve) {
    return curve.noise.relative > 0.0 || curve.noise.x > 0.0;
  });
}

void NoiseModel::follow_slopes(std::span<const Response> responses) {
  for (auto& [c, errors] : errors_in_x_) {
    const MeasuredCurve& curve = calibration_.curves[c];
    errors.follow(responses[c]);
    std::ranges::copy(errors.curvature_biases(), curve.rows_of(curvature_biases_).begin());
    for (std::size_t row = curve.begin; row < curve.end; ++row) {
      trial_weights_[row] = 1.0 / std::hypot(noise_of_y_[row], curve.noise.x * errors.slopes()[row - curve.begin]);
    }
  }
}

bool NoiseModel::follow_fit(std::span<const double> parameters, std::span<const Response> responses,
                            std::span<const double> response) {
  for (const MeasuredCurve& curve : calibration_.curves) {
    if (!(curve.noise.relative > 0.0)) continue;
    for (std::size_t row = curve.begin; row < curve.end; ++row) {
      const double size = std::max(std::abs(response[row]), k_least_size * std::abs(calibration_.y.values[row]));
      noise_of_y_[row] = std::hypot(curve.noise.absolute, curve.noise.relative * size);
      trial_weights_[row] = 1.0 / noise_of_y_[row];
    }
  }
  follow_slopes(responses);
  for (auto& [c, errors] : errors_in_x_) errors.set_effects_of_turns(parameters, responses[c]);
  const bool has_changed = !std::ranges::equal(trial_weights_, weights_, [](double trial, double weight) {
    return std::abs(trial - weight) <= k_same_weight * trial;
  });
  weights_ = trial_weights_;
  set_shared_errors();
  return has_changed;
}

Eigen::MatrixXd NoiseModel::effects_of_turns() const {
  Eigen::Index count = 0;
  for (const auto& [c, errors] : errors_in_x_) count += errors.effects_of_turns().cols();
  Eigen::MatrixXd effects = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(weights_.size()), count);
  Eigen::Index turn = 0;
  for (const auto& [c, errors] : errors_in_x_) {
    const Eigen::MatrixXd& part = errors.effects_of_turns();
    effects.block(static_cast<Eigen::Index>(calibration_.curves[c].begin), turn, part.rows(), part.cols()) = part;
    turn += part.cols();
  }
  return effects;
}

void NoiseModel::set_shared_errors() {
  const Eigen::MatrixXd effects = effects_of_turns();
  Eigen::MatrixXd weighted(static_cast<Eigen::Index>(rows_.size()), effects.cols());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const std::size_t row = rows_[i];
    weighted.row(static_cast<Eigen::Index>(i)) = weights_[row] * effects.row(static_cast<Eigen::Index>(row));
  }
  shared_ = SharedErrors(std::move(weighted));
}

}  // namespace monograin
