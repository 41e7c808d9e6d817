#include "study/calibrate/errors_in_x.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "history/branches.hpp"

namespace monograin {

ErrorsInX::ErrorsInX(const Calibration& calibration, const MeasuredCurve& curve, const DataPath& path)
    : path_(path),
      noise_(curve.noise.x),
      branch_of_(path.point_of.size()),
      is_held_(path.point_of.size()),
      moved_(path.point_of.size()),
      slopes_(path.point_of.size()) {
  const std::vector<double> x = x_of(calibration, curve);
  const std::vector<double> y = path.at_points(y_of(calibration, curve));
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
    const std::size_t begin = branch > 0 ? path.ends[branch - 1] : 0;
    const double deviation = noise_ / std::sqrt(static_cast<double>(std::max<std::size_t>(turn.held_rows(), 1)));
    const double error = path.x[point] > path.x[begin] ? deviation : -deviation;
    DataPath moved = path;
    moved.x[point] += error;
    turns_.push_back({error, Response(calibration, curve, std::move(moved), y)});
  }
  of_turns_ = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(x.size()), static_cast<Eigen::Index>(turns_.size()));
}

double ErrorsInX::slope_at(std::size_t point, std::size_t branch, std::span<const double> y) const {
  std::size_t before = point;
  std::size_t after = point;
  const std::size_t begin = branch > 0 ? path_.ends[branch - 1] : 0;
  const std::vector<double>& x = path_.x;
  while (before > begin && std::abs(x[before] - x[point]) < noise_) --before;
  while (after < path_.ends[branch] && std::abs(x[after] - x[point]) < noise_) ++after;
  return x[after] == x[before] ? 0.0 : (y[after] - y[before]) / (x[after] - x[before]);
}

void ErrorsInX::linearise(std::span<const double> parameters, const Response& response) {
  const std::span<const double> y = response.at_points();
  for (std::size_t row = 0; row < slopes_.size(); ++row) {
    slopes_[row] = is_held_[row] ? 0.0 : slope_at(path_.point_of[row], branch_of_[row], y);
  }
  for (std::size_t turn = 0; turn < turns_.size(); ++turn) {
    if (!turns_[turn].response(parameters, moved_)) {
      of_turns_.col(static_cast<Eigen::Index>(turn)).setZero();
      continue;
    }
    for (std::size_t row = 0; row < slopes_.size(); ++row) {
      const std::size_t point = path_.point_of[row];
      // A row that lies at the turn without being held there stays behind.
      const double left_behind = point == path_.ends[turn] ? turns_[turn].error * slopes_[row] : 0.0;
      of_turns_(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(turn)) = moved_[row] - y[point] - left_behind;
    }
  }
}

SharedErrors::SharedErrors(Eigen::MatrixXd effects) : effects_(std::move(effects)) {
  const Eigen::Index count = effects_.cols();
  factor_.compute(Eigen::MatrixXd::Identity(count, count) + effects_.transpose() * effects_);
}

Eigen::VectorXd SharedErrors::take_from(Eigen::Ref<Eigen::VectorXd> residuals) const {
  Eigen::VectorXd errors = factor_.solve(effects_.transpose() * residuals);
  residuals -= effects_ * errors;
  return errors;
}

}  // namespace monograin
