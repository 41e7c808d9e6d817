#include "engine/sundials.hpp"

#include <fmt/format.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "engine/linear_algebra_clock.hpp"
#include "system/resolution.hpp"

namespace monograin::sundials_boundary {
namespace {

// Accuracy of the libraries' roots, over the sum of the end and the length of the step.
constexpr double k_round_off_of_root = 100.0 * k_epsilon;

/// A guard, and where it crosses zero.
struct Crossing {
  double xi = 0.0;
  std::size_t guard = 0;
};

/// First crossing of a guard within a step that ends at the end of a branch, or none. The evaluations approach that
/// end.
std::optional<Crossing> crossing_before_branch_end(const GuardSet& guard_set, std::span<const std::size_t> fired,
                                                   double begin, double end, double tolerance,
                                                   const std::function<void(double, std::span<double>)>& values_at) {
  if (std::ranges::none_of(fired, [&](std::size_t g) { return guard_set.is_branch_end(g); })) return std::nullopt;
  const auto directions = guard_set.directions();
  std::vector<double> before(guard_set.size());
  std::vector<double> after(guard_set.size());
  std::vector<double> values(guard_set.size());
  std::optional<Crossing> first;
  try {
    values_at(begin, before);
    double last = begin;
    double distance = end - begin;
    for (std::size_t k = 0; k < k_evaluations_before_end && !first; ++k) {
      distance *= k_approach_to_end;
      if (distance < least_progress(end)) break;
      const double now = end - distance;
      values_at(now, after);
      for (std::size_t g = 0; g < directions.size(); ++g) {
        if (!crosses(directions[g], before[g], after[g], tolerance)) continue;
        double below = last;
        double above = now;
        while (above - below > least_progress(above)) {
          const double middle = std::midpoint(below, above);
          values_at(middle, values);
          (crosses(directions[g], before[g], values[g], tolerance) ? above : below) = middle;
        }
        if (!first || above < first->xi) first = {above, g};
      }
      last = now;
      std::swap(before, after);
    }
  } catch (const std::domain_error&) {
    return std::nullopt;  // no state there
  }
  return first;
}

/// Searches for the root within the accuracy of the libraries if a guard of the system exceeds the tolerance at the end
/// of the step. Conditions of the program need no such accuracy: no mode begins where they are met. A bisection finds
/// the first position at which all guards that fire are beyond zero; methods for the root of one function do not apply.
double polished_root(const GuardSet& guard_set, std::span<const std::size_t> fired, double begin, double end,
                     double tolerance, const std::function<void(double, std::span<double>)>& values_at) {
  std::vector<double> values(guard_set.size());
  try {
    values_at(end, values);
    const auto is_far = [&](std::size_t g) { return g < guard_set.system_guards() && std::abs(values[g]) > tolerance; };
    if (std::ranges::none_of(fired, is_far)) return end;
    const std::vector<double> beyond = values;
    const auto is_beyond = [&](double xi) {
      values_at(xi, values);
      return std::ranges::all_of(fired, [&](std::size_t g) { return values[g] * beyond[g] >= 0.0; });
    };
    double below = std::max(begin, end - 2.0 * k_round_off_of_root * (end + (end - begin)));
    if (is_beyond(below)) return end;
    double above = end;
    for (double middle = std::midpoint(below, above); below < middle && middle < above;
         middle = std::midpoint(below, above)) {
      (is_beyond(middle) ? above : below) = middle;
    }
    return above;
  } catch (const std::domain_error&) {
    return end;
  }
}

}  // namespace

DenseSolver make_dense_solver(N_Vector y, SUNContext context) {
  Matrix matrix(SUNDenseMatrix(N_VGetLength(y), N_VGetLength(y), context));
  LinearSolver solver(SUNLinSol_Dense(y, matrix.get(), context));
  if (LinearAlgebraClock::running() == nullptr) return {std::move(matrix), std::move(solver)};
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
  return {std::move(matrix), std::move(solver)};
}

double RootFunctions::locate(double begin, double end,
                             const std::function<void(double, std::span<double>)>& values_at) {
  if (const auto hidden = crossing_before_branch_end(guard_set_, fired_, begin, end, tolerance_, values_at)) {
    fired_.assign(1, hidden->guard);
    return hidden->xi;
  }
  return polished_root(guard_set_, fired_, begin, end, tolerance_, values_at);
}

std::string worst_components(std::span<const Unknown> unknowns, std::span<const double> weights,
                             std::span<const double> errors) {
  std::vector<std::pair<double, std::string_view>> ranking;
  for (std::size_t k = 0; k < weights.size(); ++k)
    ranking.emplace_back(std::abs(weights[k] * errors[k]), unknowns[k].name);
  std::ranges::sort(ranking, std::greater<>{});
  std::string text;
  for (std::size_t k = 0; k < std::min<std::size_t>(3, ranking.size()); ++k) {
    text += fmt::format("{}{} ({:.2g})", k == 0 ? "largest local errors: " : ", ", ranking[k].second, ranking[k].first);
  }
  return text;
}

}  // namespace monograin::sundials_boundary
