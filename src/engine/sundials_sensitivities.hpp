/// Forward sensitivities inside of CVODES and IDAS: their vectors, and the libraries' calls for them.
#pragma once

#include <cvodes/cvodes.h>
#include <idas/idas.h>

#include <cstddef>
#include <span>
#include <vector>

#include "engine/forward_sensitivities.hpp"
#include "engine/sundials.hpp"

namespace monograin {

/// CVODES under names that both libraries share.
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

/// IDAS, whose sensitivities have rates beside them.
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

/// They have their share in the control of errors, each over the magnitude of its number. CVODES corrects them together
/// with the state of a step (the simultaneous method): the staggered one takes 1.2 times as many evaluations. IDAS
/// corrects them after the state: its simultaneous method does not test their errors (6.4.1).
template <class Library>
class SundialsSensitivities {
 public:
  /// @param rtol, atol       of the integrated unknowns in a step
  /// @param has_fixed_point  the state is corrected by fixed-point iteration, not by Newton's
  SundialsSensitivities(ForwardSensitivities& of, double rtol, N_Vector atol, bool has_fixed_point, SUNContext context);

  /// Takes s from where the drive stands. @param y  complete
  void take_state(double xi, std::span<const double> y);
  /// Keeps s where a step begins.
  void keep();
  void restore();
  /// Takes what a complete state says of s, and their rates, where a step begins: what restore() goes back to.
  void correct_begin(double xi, std::span<const double> y);

  // Each returns the library's flag.

  /// Begins at the present s. @param function  gives their rates or residuals, with the integrator's user data
  int start(void* memory, typename Library::Function function);
  /// s at the end of the last step.
  int get(void* memory, double end);
  /// Hands s anywhere in the last step to the drive.
  int put(void* memory, double xi, double end);

  [[nodiscard]] ForwardSensitivities& of() noexcept { return of_; }

 private:
  using Vectors = std::vector<sundials_boundary::NVector>;

  void raise_tolerances(std::size_t number);

  ForwardSensitivities& of_;
  bool has_fixed_point_;
  SUNContext context_;
  double rtol_;
  Vectors s_, begin_, between_, atol_;
  Vectors ds_, begin_rates_;  ///< of an implicit form
  std::vector<double> magnitudes_;
  sundials_boundary::NonlinearSolver nonlinear_;
  void* initialized_ = nullptr;  ///< the memory that knows of them
};

}  // namespace monograin
