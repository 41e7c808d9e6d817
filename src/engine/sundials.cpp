#include "engine/sundials.hpp"

#include <fmt/format.h>
#include <sunlinsol/sunlinsol_dense.h>

#include <algorithm>

#include "engine/linear_algebra_clock.hpp"

namespace monograin::sundials_boundary {

LinearSolver make_dense_solver(N_Vector y, SUNMatrix matrix, SUNContext context) {
  LinearSolver solver(SUNLinSol_Dense(y, matrix, context));
  if (LinearAlgebraClock::running() == nullptr) return solver;
  solver->ops->setup = [](SUNLinearSolver self, SUNMatrix of) {
    LinearAlgebraClock* clock = LinearAlgebraClock::running();
    return clock == nullptr ? SUNLinSolSetup_Dense(self, of)
                            : clock->time([&] { return SUNLinSolSetup_Dense(self, of); });
  };
  solver->ops->solve = [](SUNLinearSolver self, SUNMatrix of, N_Vector x, N_Vector b, realtype tolerance) {
    LinearAlgebraClock* clock = LinearAlgebraClock::running();
    return clock == nullptr ? SUNLinSolSolve_Dense(self, of, x, b, tolerance)
                            : clock->time([&] { return SUNLinSolSolve_Dense(self, of, x, b, tolerance); });
  };
  return solver;
}

std::string worst_components(std::span<const Unknown> unknowns, std::span<const double> weights,
                             std::span<const double> errors) {
  std::vector<std::pair<double, std::string_view>> ranking;
  for (std::size_t k = 0; k < weights.size(); ++k)
    ranking.emplace_back(std::abs(weights[k] * errors[k]), unknowns[k].name);
  std::ranges::sort(ranking, std::greater<>{});
  std::string text;
  for (std::size_t k = 0; k < std::min<std::size_t>(3, ranking.size()); ++k) {
    text +=
        fmt::format("{}{} ({:.2g})", k == 0 ? "; largest local errors: " : ", ", ranking[k].second, ranking[k].first);
  }
  return text;
}

}  // namespace monograin::sundials_boundary
