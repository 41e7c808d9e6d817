/// What the adapters of CVODE and IDA share: ownership of SUNDIALS objects, checked calls, and words for failures.
#pragma once

#include <nvector/nvector_serial.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nonlinearsolver.h>
#include <sundials/sundials_context.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "engine/integrator.hpp"

namespace monograin::sundials_boundary {

template <auto Free>
struct HandleDeleter {
  template <class T>
  void operator()(T* handle) const noexcept {
    Free(handle);
  }
};
template <class H, auto Free>
using Handle = std::unique_ptr<std::remove_pointer_t<H>, HandleDeleter<Free>>;

using NVector = Handle<N_Vector, N_VDestroy>;
using Matrix = Handle<SUNMatrix, SUNMatDestroy>;
using LinearSolver = Handle<SUNLinearSolver, SUNLinSolFree>;
using NonlinearSolver = Handle<SUNNonlinearSolver, SUNNonlinSolFree>;

[[nodiscard]] inline std::span<double> view(N_Vector v) {
  return {N_VGetArrayPointer(v), static_cast<std::size_t>(N_VGetLength(v))};
}

[[nodiscard]] inline bool all_finite(std::span<const double> values) noexcept {
  for (const double value : values) {
    if (!std::isfinite(value)) return false;
  }
  return true;
}

/// Guards as an N_Vector-free root function sees them, and the bookkeeping that CVODE and IDA need around it.
struct RootList {
  std::vector<int> found;
  std::vector<std::size_t> fired;

  void collect() {
    fired.clear();
    for (std::size_t g = 0; g < found.size(); ++g) {
      if (found[g] != 0) fired.push_back(g);
    }
  }
};

/// What callbacks of both solvers do with exceptions: a domain error asks for a smaller step, anything else is kept and
/// rethrown once the solver has returned, because exceptions must not cross C.
class Pending {
 public:
  template <class Function>
  int guard(Function&& function) noexcept {
    try {
      return function() ? 0 : 1;
    } catch (const std::domain_error& error) {
      domain_end_ = error.what();
      return 1;
    } catch (...) {
      exception_ = std::current_exception();
      return -1;
    }
  }

  void forget() noexcept {
    exception_ = nullptr;
    domain_end_.clear();
  }
  void rethrow() {
    if (exception_) std::rethrow_exception(std::exchange(exception_, nullptr));
  }
  /// Why the equations ended at some trial since the last forget(); empty if they did not.
  [[nodiscard]] const std::string& domain_end() const noexcept { return domain_end_; }

 private:
  std::exception_ptr exception_;
  std::string domain_end_;
};

/// A step this short that has met the end of the equations has arrived there (step coordinates).
inline constexpr double k_least_progress = 1e-13;

/// Relative tolerance of one step for a wanted accuracy of the curve. Work and radius only ever grow, so the errors of
/// the steps have one sign and add up; a tenth keeps the curve's error within a few rtol over some hundred steps.
[[nodiscard]] inline double local_rtol(const Tolerances& tolerances) noexcept {
  return std::max(0.1 * tolerances.rtol, 1e-14);
}
/// Absolute tolerance of one step over an unknown's scale; finer than this, round-off keeps a corrector from
/// converging.
[[nodiscard]] inline double local_atol(const Tolerances& tolerances) noexcept {
  return std::max(tolerances.atol, 1e-14);
}

/// Quadratures counted anew from every segment's start: their relative tolerance then refers to the segment's own
/// share, and a hundred cycles of loading and unloading do not wear the total away.
class SegmentQuadratures {
 public:
  explicit SegmentQuadratures(std::span<const Unknown> unknowns) : offsets_(unknowns.size(), 0.0) {
    for (std::size_t k = 0; k < unknowns.size(); ++k) {
      if (unknowns[k].kind == Unknown::Kind::quadrature) places_.push_back(k);
    }
  }
  /// Takes the quadratures out of a segment's first state.
  void begin(std::span<double> y) {
    for (const std::size_t k : places_) offsets_[k] = std::exchange(y[k], 0.0);
  }
  void add_to(std::span<double> y) const {
    for (const std::size_t k : places_) y[k] += offsets_[k];
  }

 private:
  std::vector<std::size_t> places_;
  std::vector<double> offsets_;
};

/// Name of a return flag; frees the C string it comes in.
[[nodiscard]] inline std::string flag_name(char* text) {
  std::string name(text);
  std::free(text);  // SUNDIALS hands out malloc'ed names
  return name;
}

/// Keeps the last message instead of printing it.
inline void keep_message(int, const char*, const char*, char* message, void* sink) {
  *static_cast<std::string*>(sink) = message;
}

/// The unknowns with the largest weighted local errors, worst first, as "name (weighted error)".
[[nodiscard]] std::string worst_components(std::span<const Unknown> unknowns, std::span<const double> weights,
                                           std::span<const double> errors);

}  // namespace monograin::sundials_boundary
