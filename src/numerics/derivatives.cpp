#include "numerics/derivatives.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace monograin {
namespace {

constexpr double k_jump_share = 0.7;  // a one-sided difference below this share of the central one has no jump

}  // namespace

double difference_step(const LeastSquaresProblem& problem, std::span<const double> parameters, std::size_t k) {
  const double range = problem.parameters[k].upper - problem.parameters[k].lower;
  const double scale = parameters[k] == 0.0 ? range : std::min(std::abs(parameters[k]), range);
  return std::cbrt(problem.noise) * scale;
}

Eigen::MatrixXd residual_jacobian(const LeastSquaresProblem& problem, std::span<const double> parameters) {
  const auto rows = static_cast<Eigen::Index>(problem.residual_count);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(parameters.size()));
  std::vector<double> trial(parameters.begin(), parameters.end());
  const auto at = [&](Eigen::VectorXd& residuals) {
    return problem.residuals(trial, {residuals.data(), problem.residual_count});
  };
  Eigen::VectorXd present(rows);
  if (!at(present)) return jacobian;
  Eigen::VectorXd above(rows);
  Eigen::VectorXd below(rows);
  for (std::size_t k = 0; k < trial.size(); ++k) {
    const double step = difference_step(problem, parameters, k);
    const double right = std::min(parameters[k] + step, problem.parameters[k].upper) - parameters[k];
    const double left = parameters[k] - std::max(parameters[k] - step, problem.parameters[k].lower);
    const auto moved = [&](double distance, Eigen::VectorXd& residuals) {
      trial[k] = parameters[k] + distance;
      const bool has_residuals = distance != 0.0 && at(residuals);
      trial[k] = parameters[k];
      return has_residuals;
    };
    const bool has_right = moved(right, above);
    const bool has_left = moved(-left, below);
    auto column = jacobian.col(static_cast<Eigen::Index>(k));
    if (has_right && has_left) {
      column = (above - below) / (right + left);
      for (Eigen::Index i = 0; i < rows; ++i) {
        for (const double one_sided : {(above[i] - present[i]) / right, (present[i] - below[i]) / left}) {
          if (std::abs(one_sided) < k_jump_share * std::abs(column[i])) column[i] = one_sided;
        }
      }
    } else if (has_right) {
      column = (above - present) / right;
    } else if (has_left) {
      column = (present - below) / left;
    } else {
      column.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
  return jacobian;
}

}  // namespace monograin
