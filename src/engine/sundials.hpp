/// Common parts of the adapters of CVODE and IDA: ownership of SUNDIALS objects, steps within the domain of the
/// equations, roots, and words for failures.
#pragma once

#include <fmt/format.h>
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

/// The guards as root functions of a library, and those that have fired at the end of the last step.
class RootFunctions {
 public:
  RootFunctions(GuardSet& guard_set, const Tolerances& tolerances)
      : guard_set_(guard_set), tolerance_(guard_tolerance_of(tolerances)) {}

  /// Magnitude below which a guard counts as zero.
  [[nodiscard]] double tolerance() const noexcept { return tolerance_; }
  [[nodiscard]] std::span<const std::size_t> fired() const noexcept { return fired_; }
  void forget_fired() noexcept { fired_.clear(); }

  /// Lists the guards alive with the library. Unlisting all guards first makes the library forget which ones it had
  /// switched off.
  /// @return the library's flag
  template <class Library, class Function>
  int list(void* memory, Function function) {
    found_.assign(guard_set_.size(), 0);
    int flag = Library::init_roots(memory, 0, nullptr);
    if (flag < 0 || found_.empty()) return flag;
    flag = Library::init_roots(memory, static_cast<int>(found_.size()), function);
    // The libraries copy the directions.
    if (flag >= 0) flag = Library::set_root_direction(memory, const_cast<int*>(guard_set_.directions().data()));
    return flag < 0 ? flag : Library::set_no_inactive_root_warning(memory);
  }

  void values(double xi, std::span<const double> state, double* values) {
    guard_set_.values(xi, state, {values, guard_set_.size()});
  }

  /// Takes the guards that have fired from a library that has ended a step at a root. @return the library's flag
  template <class Library>
  int collect(void* memory) {
    const int flag = Library::root_info(memory, found_.data());
    for (std::size_t g = 0; g < found_.size(); ++g) {
      if (found_[g] != 0) fired_.push_back(g);
    }
    return flag;
  }

  /// Corrects the end of a step that a library has ended at a root. Just before a branch ends, other guards may cross
  /// zero and return; the library misses them, because it evaluates guards only at the ends of its steps. The library
  /// also locates a root only to a hundred times the round-off of xi, within which a guard may change much. If another
  /// guard crosses zero before, it replaces those that have fired.
  /// @param begin, end  of the step, as step coordinates
  /// @param values_at   (xi, values): evaluates the guards at xi within the step
  /// @return step coordinate where the step has to end
  [[nodiscard]] double locate(double begin, double end,
                              const std::function<void(double, std::span<double>)>& values_at);

 private:
  GuardSet& guard_set_;
  double tolerance_;
  std::vector<int> found_;
  std::vector<std::size_t> fired_;
};

/// Name of a return flag; frees the C string it comes in.
[[nodiscard]] inline std::string flag_name(char* text) {
  std::string name(text);
  std::free(text);  // SUNDIALS hands out malloc'ed names
  return name;
}

/// Keeps a library from printing its own messages; its return codes carry the same information.
inline void ignore_message(int, const char*, const char*, char*, void*) {}

/// A solver of small dense systems, and the matrix that it factorizes.
struct DenseSolver {
  Matrix matrix;
  LinearSolver solver;
};
/// Makes a solver for vectors like y; timed where a LinearAlgebraClock runs.
[[nodiscard]] DenseSolver make_dense_solver(N_Vector y, SUNContext context);

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

/// The unknowns with the largest weighted local errors, worst first, as "name (weighted error)".
[[nodiscard]] std::string worst_components(std::span<const Unknown> unknowns, std::span<const double> weights,
                                           std::span<const double> errors);

/// Gives up after a function of a library has failed.
/// @param call  name of the function
/// @param flag  returned by it
/// @param y     any vector of the integrated unknowns, the first ones of `unknowns`
/// @throws SolverError with the largest local errors of the last step
template <class Library>
[[noreturn]] void give_up(const char* call, int flag, void* memory, N_Vector y, std::span<const Unknown> unknowns,
                          double xi) {
  double step = 0.0;
  std::string details;
  const NVector weights(N_VClone(y));
  const NVector errors(N_VClone(y));
  // Weights and errors exist once a step has been tried.
  if (memory != nullptr && Library::current_step(memory, &step) == 0 &&
      Library::error_weights(memory, weights.get()) == 0 && Library::local_errors(memory, errors.get()) == 0) {
    details = worst_components(unknowns, view(weights.get()), view(errors.get()));
  }
  throw SolverError(Failure::no_step, xi, step, details,
                    fmt::format("{}: {}", call, flag_name(Library::flag_name(flag))));
}

/// Counts of a library since it was started, without evaluations of rates or residuals.
template <class Library>
[[nodiscard]] Statistics counts_since_start(void* memory, bool has_jacobian) {
  Statistics counts;
  Library::steps(memory, &counts.steps);
  if (has_jacobian) Library::jacobian_evaluations(memory, &counts.jacobian_evaluations);
  Library::error_test_failures(memory, &counts.error_test_failures);
  Library::convergence_failures(memory, &counts.convergence_failures);
  counts.last_order = Library::last_order(memory);
  Library::last_step(memory, &counts.last_step);
  return counts;
}

}  // namespace monograin::sundials_boundary
