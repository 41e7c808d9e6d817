/// Fits of curves y(x) with few parameters.
#pragma once

#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "numerics/derivatives.hpp"
#include "numerics/least_squares.hpp"
#include "numerics/uncertainty.hpp"

namespace monograin::curve_fit {

/// Fits y over x by a function of some parameters.
template <class Model>
[[nodiscard]] LeastSquaresProblem problem_of(const std::vector<double>& x, const std::vector<double>& y,
                                             std::vector<BoundedParameter> parameters, Model model) {
  LeastSquaresProblem problem;
  problem.parameters = std::move(parameters);
  problem.residual_count = x.size();
  problem.residuals = [x, y, model](std::span<const double> p, std::span<double> residuals) {
    for (std::size_t i = 0; i < x.size(); ++i) residuals[i] = y[i] - model(x[i], p);
    return true;
  };
  return problem;
}

template <class Model>
[[nodiscard]] std::vector<double> values_of(const std::vector<double>& x, const std::vector<double>& p, Model model) {
  std::vector<double> y;
  for (const double at : x) y.push_back(model(at, std::span<const double>(p)));
  return y;
}

[[nodiscard]] inline Uncertainty uncertainty_at(const LeastSquaresProblem& problem,
                                                const LeastSquaresSolution& solution, double level) {
  return uncertainty_of(problem, solution, residual_jacobian(problem, solution.parameters), problem.residual_count,
                        level);
}

inline constexpr auto k_line = [](double x, std::span<const double> p) { return p[0] + p[1] * x; };
inline constexpr auto k_decay = [](double x, std::span<const double> p) { return p[0] * std::exp(-p[1] * x); };
inline const std::vector<double> k_six{0.0, 0.2, 0.4, 0.6, 0.8, 1.0};

}  // namespace monograin::curve_fit
