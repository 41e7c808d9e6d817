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
  explicit ScaledForm(HybridSystem& system)
      : form_(system),
        y_(form_.size()),
        dy_(form_.size()),
        begin_(system.unknowns().size()),
        seen_(system.unknowns().size()) {}

  [[nodiscard]] std::size_t size() const noexcept { return form_.size(); }
  [[nodiscard]] double change_of_rates(std::span<const double> before, std::span<const double> after) const {
    return monograin::change_of_rates(before, after, [](std::size_t) { return 1.0; });
  }
  [[nodiscard]] bool is_quadrature(std::size_t k) const noexcept {
    return form_.unknown(k).kind == Unknown::Kind::quadrature;
  }
  [[nodiscard]] bool has_dependent_unknowns() const noexcept { return form_.has_dependent_unknowns(); }
  [[nodiscard]] bool has_corrections() const noexcept { return form_.has_corrections(); }
  [[nodiscard]] long evaluations() const noexcept { return evaluations_; }

  /// Takes up a segment's complete state; z is the integrated one.
  void begin(std::span<const double> complete, std::span<double> z) {
    form_.begin(complete, y_);
    begin_step(0.0, complete);
    for (std::size_t k = 0; k < size(); ++k) z[k] = y_[k] / form_.unknown(k).scale;
  }

  /// Takes over what completing has moved by more than rounding. @return whether that is anything
  [[nodiscard]] bool take_correction(std::span<const double> complete, std::span<double> z) {
    scale_back(z);
    if (!form_.take_correction(complete, y_)) return false;
    for (std::size_t k = 0; k < size(); ++k) z[k] = y_[k] / form_.unknown(k).scale;
    return true;
  }

  /// Where a step begins, and the state there.
  void begin_step(double xi, std::span<const double> complete) {
    std::ranges::copy(complete, begin_.begin());
    std::ranges::copy(complete, seen_.begin());
    seen_xi_ = last_xi_ = xi;
  }

  /// A state on the curve.
  void complete(double xi, std::span<const double> z, std::span<double> complete) {
    scale_back(z);
    guess_on_curve(xi);
    form_.complete(xi, y_, complete);
    std::ranges::copy(complete, seen_.begin());
    seen_xi_ = xi;
  }

  /// Rates have led there, and on from there: a state on the curve, from those that they were asked for last.
  void reach(double xi, std::span<const double> z) {
    scale_back(z);
    std::ranges::copy(form_.complete(xi, y_), seen_.begin());
    seen_xi_ = xi;
  }

  /// @throws std::domain_error where the equations end, or have no finite rates
  void rates(double xi, std::span<const double> z, std::span<double> dz) {
    ++evaluations_;
    scale_back(z);
    // Back from a stage, or from a step that came to nothing.
    if (xi < last_xi_) guess_on_curve(xi);
    last_xi_ = xi;
    form_.rates(xi, y_, dy_);
    if (!all_finite(dy_)) throw std::domain_error("the rates of the equations are not finite");
    for (std::size_t k = 0; k < size(); ++k) dz[k] = dy_[k] / form_.unknown(k).scale;
  }

 private:
  void scale_back(std::span<const double> z) {
    for (std::size_t k = 0; k < size(); ++k) y_[k] = z[k] * form_.unknown(k).scale;
  }

  /// Stages may lie far from the curve, where the equations have other solutions; of its own states the next one before
  /// xi is the first guess.
  void guess_on_curve(double xi) { form_.guess(xi < seen_xi_ ? begin_ : seen_); }

  ExplicitForm form_;
  std::vector<double> y_, dy_;
  std::vector<double> begin_, seen_;  ///< complete states: at the beginning of the step, and the last one on the curve
  double seen_xi_ = 0.0;
  double last_xi_ = 0.0;  ///< where rates were last asked for
  long evaluations_ = 0;
};

class Stepper {
 public:
  virtual ~Stepper() = default;

  /// Starts a segment. @param z  scaled state
  virtual void begin(double xi, std::span<const double> z) = 0;
  /// Goes on from this state, which differs from the end of the last step by its errors. A code that remembers steps
  /// goes on from what it remembers.
  virtual void correct(std::span<const double> z) = 0;
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

/// d(rates)/dz and d(rates)/dxi by differences of second order: what those of first order leave would cost a linearly
/// implicit method its order.
class DifferenceJacobian {
 public:
  explicit DifferenceJacobian(ScaledForm& form)
      : form_(form), base_(form.size()), shifted_(form.size()), beyond_(form.size()), point_(form.size()) {}

  /// How far from xi the derivatives look for a step of that length: a regime may be as short.
  [[nodiscard]] static double reach(double xi, double length) noexcept;
  /// @param length    of the step that it is for
  /// @param jacobian  row by row
  void at(double xi, std::span<const double> z, double length, std::span<double> jacobian, std::span<double> by_xi);

 private:
  /// Rates for more of an unknown, in `shifted_`, and for less of it, in `beyond_`; those at the point itself in place
  /// of a side that does not count. @return how far apart the two are
  double look_beside(double xi, std::size_t j, double wanted);

  ScaledForm& form_;
  std::vector<double> base_, shifted_, beyond_, point_;
};

}  // namespace monograin
