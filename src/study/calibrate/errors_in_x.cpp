#include "study/calibrate/errors_in_x.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "history/turns.hpp"

namespace monograin {

ErrorsInX::ErrorsInX(const Calibration& calibration, const MeasuredCurve& curve, const DataPath& path)
    : calibration_(calibration),
      curve_(curve),
      path_(path),
      noise_(curve.noise.x),
      branch_of_(path.point_of.size()),
      is_held_(path.point_of.size()),
      moved_(path.point_of.size()),
      slopes_(path.point_of.size()),
      curvature_biases_(path.point_of.size()) {
  const std::span<const double> x = curve.rows_of(calibration.x.values);
  if (x.size() < 2) {
    of_turns_ = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(x.size()), 0);
    return;
  }
  const std::vector<Turn> turns = turns_of(x, turning_points(x));
  std::size_t row = 0;
  for (std::size_t branch = 0; branch < path.ends.size(); ++branch) {
    const Turn& turn = turns[branch + 1];
    for (; row <= turn.last_row; ++row) {
      branch_of_[row] = branch;
      is_held_[row] = row >= turn.held_begin && row < turn.held_end;
    }
    if (branch + 1 == path.ends.size()) break;
    const std::size_t point = path.ends[branch];
    const double deviation = noise_ / std::sqrt(static_cast<double>(std::max<std::size_t>(turn.held_rows(), 1)));
    turns_.push_back({point, path.x[point] > path.x[beginning_of(branch)] ? deviation : -deviation});
  }
  of_turns_ = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(x.size()), static_cast<Eigen::Index>(turns_.size()));
}

void ErrorsInX::set_slope_and_bias(std::size_t row, std::span<const double> y) {
  const std::size_t point = path_.point_of[row];
  const std::size_t branch = branch_of_[row];
  std::size_t before = point;
  std::size_t after = point;
  const std::vector<double>& x = path_.x;
  while (before > beginning_of(branch) && std::abs(x[before] - x[point]) < noise_) --before;
  while (after < path_.ends[branch] && std::abs(x[after] - x[point]) < noise_) ++after;
  const double behind = x[point] - x[before];
  const double ahead = x[after] - x[point];
  slopes_[row] = x[after] == x[before] ? 0.0 : (y[after] - y[before]) / (x[after] - x[before]);
  // Where the branch ends within the noise, x has no errors beyond the end.
  curvature_biases_[row] =
      std::min(std::abs(behind), std::abs(ahead)) < noise_
          ? 0.0
          : noise_ * noise_ * ((y[after] - y[point]) / ahead - (y[point] - y[before]) / behind) / (ahead + behind);
}

bool ErrorsInX::respond_with(std::span<const double> parameters, std::size_t point, double error,
                             const std::vector<double>& measured) {
  DataPath moved = path_;
  moved.x[point] += error;
  Response response(calibration_, curve_, std::move(moved), measured);
  return response(parameters, moved_);
}

void ErrorsInX::follow(const Response& response) {
  for (std::size_t row = 0; row < slopes_.size(); ++row) {
    if (!is_held_[row]) set_slope_and_bias(row, response.at_points());
  }
}

void ErrorsInX::set_effects_of_turns(std::span<const double> parameters, const Response& response) {
  const std::span<const double> y = response.at_points();
  const std::vector<double> measured = path_.at_points(curve_.rows_of(calibration_.y.values));
  for (std::size_t turn = 0; turn < turns_.size(); ++turn) {
    const auto [end, error] = turns_[turn];
    auto column = of_turns_.col(static_cast<Eigen::Index>(turn));
    column.setZero();
    for (const double side : {1.0, -1.0}) {  // outwards first; inwards if the scenario cannot follow that
      if (!respond_with(parameters, end, side * error, measured)) continue;
      for (std::size_t row = 0; row < slopes_.size(); ++row) {
        const std::size_t point = path_.point_of[row];
        // A row that lies at the turn without being held there stays behind.
        const double left_behind = point == end ? error * slopes_[row] : 0.0;
        column[static_cast<Eigen::Index>(row)] = side * (moved_[row] - y[point]) - left_behind;
      }
      break;
    }
  }
}

SharedErrors::SharedErrors(Eigen::MatrixXd effects) : effects_(std::move(effects)) {
  const Eigen::Index count = effects_.cols();
  factor_.compute(Eigen::MatrixXd::Identity(count, count) + effects_.transpose() * effects_);
}

double SharedErrors::log_determinant() const {
  // det(1 + G G^T) = det(1 + G^T G), whose Cholesky factor is at hand.
  return count() > 0 ? 2.0 * factor_.matrixLLT().diagonal().array().log().sum() : 0.0;
}

Eigen::VectorXd SharedErrors::take_from(Eigen::Ref<Eigen::VectorXd> residuals) const {
  Eigen::VectorXd errors = factor_.solve(effects_.transpose() * residuals);
  residuals -= effects_ * errors;
  return errors;
}

}  // namespace monograin
