/// Common parts of the adapters of CVODE and IDA: ownership of SUNDIALS objects, steps within the domain of the
/// equations, roots, and words for failures.
#pragma once

#include <nvector/nvector_serial.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nonlinearsolver.h>
#include <sundials/sundials_context.hpp>

#include <cstdlib>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/c_library.hpp"
#include "engine/explicit_form.hpp"
#include "engine/guard_set.hpp"
#include "system/resolution.hpp"

namespace monograin::sundials_boundary {

using NVector = Handle<N_Vector, N_VDestroy>;
using Matrix = Handle<SUNMatrix, SUNMatDestroy>;
using LinearSolver = Handle<SUNLinearSolver, SUNLinSolFree>;
using NonlinearSolver = Handle<SUNNonlinearSolver, SUNNonlinSolFree>;

[[nodiscard]] inline std::span<double> view(N_Vector v) {
  return {N_VGetArrayPointer(v), static_cast<std::size_t>(N_VGetLength(v))};
}

/// Guards as CVODE and IDA handle them: directions, roots found, and the guards that have fired.
struct RootList {
  std::vector<int> directions;
  std::vector<int> found;
  std::vector<std::size_t> fired;
  long evaluations = 0;  ///< of the guards; the libraries' own counters are not set before a first step

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

/// Keeps a library from printing its own messages; its return codes carry the same information.
inline void ignore_message(int, const char*, const char*, char*, void*) {}

/// A solver of small dense systems; timed where a LinearAlgebraClock runs.
[[nodiscard]] LinearSolver make_dense_solver(N_Vector y, SUNMatrix matrix, SUNContext context);

/// Failures of error tests and of corrections that one step may have. The second step of a segment may be tried 1e4
/// times as long as the first. If rates are singular at the beginning, the libraries' own limits (7 and 10) do not
/// always suffice to make that step short enough.
inline constexpr int k_most_failures = 50;

/// Least tolerance of a corrector, over the sums in a residual: above their round-off.
inline constexpr double k_above_round_off = 64.0 * k_epsilon;

/// Factor on the length of a step in which the equations end.
inline constexpr double k_shorter_step = 0.1;

/// Takes one step. If the trials or guards of the step leave the domain of the equations, tries it again with a shorter
/// step than the library would choose.
/// @param begin         step coordinate where the step begins
/// @param evolve        takes the step and returns the library's flag
/// @param current_step  puts the step that the library would take next into its argument, and returns its flag
/// @param restart       restarts the library at `begin` with the given first step
/// @return the library's flag
/// @throws std::domain_error if even the shortest step leaves the domain
template <class Evolve, class CurrentStep, class Restart>
int step_within_domain(Pending& pending, double begin, Evolve&& evolve, CurrentStep&& current_step, Restart&& restart) {
  pending.forget();
  int flag = evolve();
  for (double step = 0.0; flag < 0 && pending.nearest_domain_end(); flag = evolve()) {
    // Before its first step the library has no current step.
    if (step == 0.0 && (current_step(&step) != 0 || !(step > 0.0))) step = 1.0;
    step = k_shorter_step * std::min(step, 1.0 - begin);
    if (!(step > least_progress(begin))) throw *pending.nearest_domain_end();
    restart(step);
  }
  return flag;
}

/// True if a step that ends at no guard is so short that ever smaller steps would approach the end of the equations
/// without arriving. If only difference quotients have met that end, the step must also be shorter than the previous
/// one: the first step of a segment may be that short by itself.
/// @param previous  length of the step before; 0 for a segment's first one
[[nodiscard]] inline bool is_stuck_at_end(const Pending& pending, double begin, double end, double previous) {
  if (end - begin >= least_progress(begin)) return false;
  return pending.domain_end() || (pending.nearest_domain_end() && end - begin < previous);
}

/// Corrects the end of a step that a library has ended at a root. Just before a branch ends, other guards may cross
/// zero and return; the library misses them, because it evaluates guards only at the ends of its steps. The library
/// also locates a root only to a hundred times the round-off of xi, within which a guard may change much.
/// @param fired       in: the guards found at the end; out: the guard that crosses zero before, if there is one
/// @param begin, end  of the step, as step coordinates
/// @param tolerance   magnitude below which a guard counts as zero
/// @param values_at   (xi, values): evaluates the guards at xi within the step
/// @return step coordinate where the step has to end
[[nodiscard]] double root_of_step(const GuardSet& guard_set, std::vector<std::size_t>& fired, double begin, double end,
                                  double tolerance, const std::function<void(double, std::span<double>)>& values_at);

/// The unknowns with the largest weighted local errors, worst first, as "name (weighted error)".
[[nodiscard]] std::string worst_components(std::span<const Unknown> unknowns, std::span<const double> weights,
                                           std::span<const double> errors);

}  // namespace monograin::sundials_boundary
