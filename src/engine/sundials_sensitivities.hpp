/// Forward sensitivities inside CVODES and IDAS: their vectors, and the libraries' functions for them.
#pragma once

#include <cvodes/cvodes.h>
#include <idas/idas.h>

#include <cstddef>
#include <span>
#include <vector>

#include "engine/forward_sensitivities.hpp"
#include "engine/sundials.hpp"

namespace monograin {

/// CVODES' functions under the names that SundialsSensitivities uses.
struct CvodesCalls {
  using Function = CVSensRhs1Fn;
  static constexpr bool is_implicit = false;
  static constexpr auto switch_off = CVodeSensToggleOff;
  static constexpr auto set_parameters = CVodeSetSensParams;
  static constexpr auto set_tolerances = CVodeSensSVtolerances;
  static constexpr auto set_error_control = CVodeSetSensErrCon;
  static constexpr auto set_corrector = CVodeSetNonlinearSolverSensSim;
  static constexpr auto derivative = CVodeGetSensDky;

  static int init(void* memory, int count, Function function, N_Vector* s, N_Vector*) {
    return CVodeSensInit1(memory, count, CV_SIMULTANEOUS, function, s);
  }
  static int reinit(void* memory, N_Vector* s, N_Vector*) { return CVodeSensReInit(memory, CV_SIMULTANEOUS, s); }
};

/// IDAS' functions under the names that SundialsSensitivities uses. Its sensitivities have rates, too.
struct IdasCalls {
  using Function = IDASensResFn;
  static constexpr bool is_implicit = true;
  static constexpr auto switch_off = IDASensToggleOff;
  static constexpr auto set_parameters = IDASetSensParams;
  static constexpr auto set_tolerances = IDASensSVtolerances;
  static constexpr auto set_error_control = IDASetSensErrCon;
  static constexpr auto set_corrector = IDASetNonlinearSolverSensStg;
  static constexpr auto derivative = IDAGetSensDky;

  static int init(void* memory, int count, Function function, N_Vector* s, N_Vector* ds) {
    return IDASensInit(memory, count, IDA_STAGGERED, function, s, ds);
  }
  static int reinit(void* memory, N_Vector* s, N_Vector* ds) { return IDASensReInit(memory, IDA_STAGGERED, s, ds); }
};

/// Sensitivities of a run that CVODES or IDAS integrates. They take part in the error test, each over the magnitude of
/// its number. CVODES corrects them together with the state (the simultaneous method): the staggered method takes 1.2
/// times as many evaluations. IDAS corrects them after the state: its simultaneous method does not test their errors
/// (6.4.1).
template <class Library>
class SundialsSensitivities {
 public:
  /// @param rtol, atol       tolerances of the integrated unknowns in a step
  /// @param has_fixed_point  the state is corrected by fixed-point iteration instead of Newton's method
  SundialsSensitivities(ForwardSensitivities& of, double rtol, N_Vector atol, bool has_fixed_point, SUNContext context);

  /// Takes s from the ForwardSensitivities where a segment begins. @param y  complete state there
  void take_state(double xi, std::span<const double> y);
  /// Keeps s, and its rates, where a step begins.
  void keep();
  /// Goes back to the kept s.
  void restore();
  /// Replaces the kept s and its rates by those that follow from a complete state. No effect with CVODES.
  void correct_begin(double xi, std::span<const double> y);

  // Each returns the library's flag.

  /// Starts the library at the present s.
  /// @param function  gives rates or residuals of s; the library passes it the integrator's user data
  int start(void* memory, typename Library::Function function);
  /// Takes s at the end of the last step from the library.
  int get(void* memory, double end);
  /// Stores s at any xi in the last step in the ForwardSensitivities.
  int put(void* memory, double xi, double end);

  [[nodiscard]] ForwardSensitivities& of() noexcept { return of_; }

 private:
  using Vectors = std::vector<sundials_boundary::NVector>;

  void raise_tolerances(std::size_t number, std::span<const double> y);

  ForwardSensitivities& of_;
  bool has_fixed_point_;
  SUNContext context_;
  double rtol_ = 0.0;
  Vectors s_, begin_, between_, atol_;
  Vectors ds_, begin_rates_;  ///< used by the implicit form only
  std::vector<double> magnitudes_;
  sundials_boundary::NonlinearSolver nonlinear_;
  void* initialized_ = nullptr;  ///< the library's memory in which the sensitivities have been set up
};

}  // namespace monograin
