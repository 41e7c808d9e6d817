/// Codes that step without finding roots, as the integrator that locates events for them wants them.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "engine/explicit_form.hpp"

namespace monograin {

/// The explicit form with every unknown over its own scale, so that one absolute tolerance serves all.
class ScaledForm {
 public:
  explicit ScaledForm(HybridSystem& system) : form_(system), y_(form_.size()), dy_(form_.size()) {}

  [[nodiscard]] std::size_t size() const noexcept { return form_.size(); }
  [[nodiscard]] bool has_slaves() const noexcept { return form_.has_slaves(); }
  [[nodiscard]] long evaluations() const noexcept { return evaluations_; }

  /// Takes up a segment's complete state; z is the integrated one.
  void begin(std::span<const double> complete, std::span<double> z) {
    form_.begin(complete, y_);
    for (std::size_t k = 0; k < size(); ++k) z[k] = y_[k] / form_.unknown(k).scale;
  }

  void complete(double xi, std::span<const double> z, std::span<double> complete) {
    scale_back(z);
    form_.complete(xi, y_, complete);
  }

  /// @throws std::domain_error where the equations end, or have no finite rates
  void rates(double xi, std::span<const double> z, std::span<double> dz) {
    ++evaluations_;
    scale_back(z);
    form_.rates(xi, y_, dy_);
    if (!all_finite(dy_)) throw std::domain_error("the rates of the equations are not finite");
    for (std::size_t k = 0; k < size(); ++k) dz[k] = dy_[k] / form_.unknown(k).scale;
  }

 private:
  void scale_back(std::span<const double> z) {
    for (std::size_t k = 0; k < size(); ++k) y_[k] = z[k] * form_.unknown(k).scale;
  }

  ExplicitForm form_;
  std::vector<double> y_, dy_;
  long evaluations_ = 0;
};

class Stepper {
 public:
  virtual ~Stepper() = default;

  /// Starts a segment. @param z  scaled state
  virtual void begin(double xi, std::span<const double> z) = 0;
  /// One accepted step that does not end beyond 1. @return where it ends
  /// @throws std::domain_error where the equations end; SolverError where the code gives up
  virtual double step() = 0;
  /// Scaled state in the last step.
  virtual void state_at(double xi, std::span<double> z) = 0;

  long rejections = 0;
  long jacobian_evaluations = 0;
  int order = 0;
};

[[nodiscard]] std::unique_ptr<Stepper> make_odeint(OdeintMethod method, ScaledForm& form, const Tolerances& tolerances);
[[nodiscard]] std::unique_ptr<Stepper> make_gsl(GslMethod method, ScaledForm& form, const Tolerances& tolerances);

/// d(rates)/dz and d(rates)/dxi by forward differences.
class DifferenceJacobian {
 public:
  explicit DifferenceJacobian(ScaledForm& form)
      : form_(form), base_(form.size()), shifted_(form.size()), point_(form.size()) {}

  /// @param length    of the step that it is for: a regime may be as short
  /// @param jacobian  row by row
  void at(double xi, std::span<const double> z, double length, std::span<double> jacobian, std::span<double> by_xi);

 private:
  template <class Shift>
  double differ(double step, Shift&& shift);

  ScaledForm& form_;
  std::vector<double> base_, shifted_, point_;
};

}  // namespace monograin
