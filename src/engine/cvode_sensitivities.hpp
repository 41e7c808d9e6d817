/// Forward sensitivities inside of CVODES: their vectors, and its calls for them.
#pragma once

#include <cvodes/cvodes.h>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "engine/forward_sensitivities.hpp"
#include "engine/sundials.hpp"

namespace monograin {

/// They have their share in the control of errors, each over the magnitude of its number, and are corrected together
/// with the state of a step (the simultaneous method): the staggered one takes 1.2 times as many evaluations.
class CvodeSensitivities {
 public:
  /// @param rtol, atol  of the integrated unknowns in a step
  CvodeSensitivities(ForwardSensitivities& of, double rtol, N_Vector atol, bool has_fixed_point, SUNContext context);

  /// Takes s from where the drive stands.
  void take_state();
  /// Keeps s where a step begins.
  void keep();
  void restore();

  // Each returns the library's flag.

  /// Begins at the present s. @param function  gives the derivatives of s, with the integrator's user data
  int start(void* memory, CVSensRhs1Fn function);
  /// s at the end of the last step.
  int get(void* memory, double end);
  /// Hands s anywhere in the last step to the drive.
  int put(void* memory, double xi, double end);

  void rates(std::size_t number, double xi, std::span<const double> y, std::span<const double> guess,
             std::span<const double> s, std::span<double> ds) {
    of_.rates(number, xi, y, guess, s, ds);
  }

 private:
  ForwardSensitivities& of_;
  bool has_fixed_point_;
  SUNContext context_;
  double rtol_;
  std::vector<sundials_boundary::NVector> s_, begin_, between_, atol_;
  std::vector<double> magnitudes_;
  sundials_boundary::NonlinearSolver nonlinear_;
  void* initialized_ = nullptr;  ///< the memory that knows of them
};

}  // namespace monograin
