#include "numerics/least_squares_problem.hpp"

#include <algorithm>

namespace monograin {

double cost_of(const LeastSquaresProblem& problem, std::span<const double> residuals) noexcept {
  double cost = 0.0;
  const std::size_t lossy = residuals.size() - problem.plain_count;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    cost += i < lossy ? problem.loss.rho(residuals[i]) : residuals[i] * residuals[i];
  }
  return cost;
}

LeastSquaresProblem with_held(const LeastSquaresProblem& problem, std::size_t k, double value) {
  LeastSquaresProblem held = problem;
  held.parameters.erase(held.parameters.begin() + static_cast<std::ptrdiff_t>(k));
  held.residuals = [&problem, k, value, all = std::vector<double>(problem.parameters.size())](
                       std::span<const double> others, std::span<double> residuals) mutable {
    const auto place = static_cast<std::ptrdiff_t>(k);
    std::copy(others.begin(), others.begin() + place, all.begin());
    all[k] = value;
    std::copy(others.begin() + place, others.end(), all.begin() + place + 1);
    return problem.residuals(all, residuals);
  };
  held.progress = {};
  return held;
}

}  // namespace monograin
