/// What the adapters of CVODE and IDA share: ownership of SUNDIALS objects, checked calls, and words for failures.
#pragma once

#include <nvector/nvector_serial.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nonlinearsolver.h>
#include <sundials/sundials_context.hpp>

#include <cstdlib>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/c_library.hpp"
#include "engine/explicit_form.hpp"
#include "engine/guard_set.hpp"

namespace monograin::sundials_boundary {

using NVector = Handle<N_Vector, N_VDestroy>;
using Matrix = Handle<SUNMatrix, SUNMatDestroy>;
using LinearSolver = Handle<SUNLinearSolver, SUNLinSolFree>;
using NonlinearSolver = Handle<SUNNonlinearSolver, SUNNonlinSolFree>;

[[nodiscard]] inline std::span<double> view(N_Vector v) {
  return {N_VGetArrayPointer(v), static_cast<std::size_t>(N_VGetLength(v))};
}

/// Guards as an N_Vector-free root function sees them, and the bookkeeping that CVODE and IDA need around it.
struct RootList {
  std::vector<int> directions;
  std::vector<int> found;
  std::vector<std::size_t> fired;
  long evaluations = 0;  ///< counted here: the libraries' own counters are not set before a first step

  void collect() {
    fired.clear();
    for (std::size_t g = 0; g < found.size(); ++g) {
      if (found[g] != 0) fired.push_back(g);
    }
  }
};

/// Name of a return flag; frees the C string it comes in.
[[nodiscard]] inline std::string flag_name(char* text) {
  std::string name(text);
  std::free(text);  // SUNDIALS hands out malloc'ed names
  return name;
}

/// Keeps a library from printing its own messages; its return codes say the same.
inline void ignore_message(int, const char*, const char*, char*, void*) {}

/// A solver of small dense systems; timed where a LinearAlgebraClock runs.
[[nodiscard]] LinearSolver make_dense_solver(N_Vector y, SUNMatrix matrix, SUNContext context);

/// Error tests and corrections that one step may fail. After a first step the next may be 1e4 times as long; where
/// rates are singular at the beginning, the libraries' 7 and 10 do not always lead back from there.
inline constexpr int k_most_failures = 50;

/// A corrector's tolerance over the sums in a residual: above their rounding.
inline constexpr double k_above_rounding = 64.0 * std::numeric_limits<double>::epsilon();

/// What a step is made shorter by that has met the end of the equations.
inline constexpr double k_retreat = 0.1;

/// One step. Where its trials, or its guards, leave the domain, it is tried anew, shorter than the library itself
/// would.
/// @param evolve        takes the step and returns the library's flag
/// @param current_step  puts the step that the library would take next into its argument, and returns its flag
/// @param restart       begins anew where the step began, with this first step
/// @throws std::domain_error where no step gets anywhere
template <class Evolve, class CurrentStep, class Restart>
int step_within_domain(Pending& pending, double begin, Evolve&& evolve, CurrentStep&& current_step, Restart&& restart) {
  pending.forget();
  int flag = evolve();
  for (double step = 0.0; flag < 0 && pending.nearest_domain_end(); flag = evolve()) {
    // Before its first step the library has none.
    if (step == 0.0 && (current_step(&step) != 0 || !(step > 0.0))) step = 1.0;
    step = k_retreat * std::min(step, 1.0 - begin);
    if (!(step > least_progress(begin))) throw *pending.nearest_domain_end();
    restart(step);
  }
  return flag;
}

/// Whether a step that ends at no guard shows that ever smaller ones would never get to the end of the equations. Where
/// only difference quotients have met that end, steps have to become smaller: the first one of a segment may be as
/// short by itself.
/// @param previous  length of the step before; 0 for a segment's first one
[[nodiscard]] inline bool is_stuck_at_end(const Pending& pending, double begin, double end, double previous) {
  if (end - begin >= least_progress(begin)) return false;
  return pending.domain_end() || (pending.nearest_domain_end() && end - begin < previous);
}

/// Where a step has to end that a library has ended at fired guards. Just before a branch ends, others may cross and
/// come back, which it does not see: it looks at guards where its steps end. And it knows a root to a hundred roundings
/// of the step coordinate only, in which a guard may go far.
/// @param fired       in: the guards found at the end; out: the one that crosses before, if there is one
/// @param begin, end  of the step
/// @param tolerance   what of a guard counts as zero
/// @param values_at   xi, values: the guards at a place of the step
[[nodiscard]] double root_of_step(const HybridSystem& system, const GuardSet& guard_set,
                                  std::vector<std::size_t>& fired, double begin, double end, double tolerance,
                                  const std::function<void(double, std::span<double>)>& values_at);

/// The unknowns with the largest weighted local errors, worst first, as "name (weighted error)".
[[nodiscard]] std::string worst_components(std::span<const Unknown> unknowns, std::span<const double> weights,
                                           std::span<const double> errors);

}  // namespace monograin::sundials_boundary
