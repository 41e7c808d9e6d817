/// Interface to codes that step without finding roots; the integrator `Stepped` locates events for them.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "engine/explicit_form.hpp"

namespace monograin {

/// First step that a code tries (step coordinates).
inline constexpr double k_first_step = 1e-3;

/// The explicit form with every unknown over its own scale, so that one absolute tolerance serves all unknowns.
class ScaledForm {
 public:
  explicit ScaledForm(Equations& system)
      : form_(system),
        y_(form_.size()),
        dy_(form_.size()),
        begin_(system.unknowns().size()),
        last_on_curve_(system.unknowns().size()) {}

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

  /// Starts a segment at a complete state and puts the scaled integrated part of that state into z.
  void begin(std::span<const double> complete, std::span<double> z) {
    form_.begin(complete, y_);
    begin_step(0.0, complete);
    for (std::size_t k = 0; k < size(); ++k) z[k] = y_[k] / form_.unknown(k).scale;
  }

  /// Copies to z the differential unknowns that completing has moved by more than round-off.
  /// @return true if there are any
  [[nodiscard]] bool take_correction(std::span<const double> complete, std::span<double> z) {
    scale_back(z);
    if (!form_.take_correction(complete, y_)) return false;
    for (std::size_t k = 0; k < size(); ++k) z[k] = y_[k] / form_.unknown(k).scale;
    return true;
  }

  /// Keeps the beginning of a step, with its complete state, as the first guess for states in the step.
  void begin_step(double xi, std::span<const double> complete) {
    std::ranges::copy(complete, begin_.begin());
    std::ranges::copy(complete, last_on_curve_.begin());
    last_on_curve_xi_ = last_rates_xi_ = xi;
  }

  /// Completes a state on the solution curve; the result guides the states after it.
  void complete(double xi, std::span<const double> z, std::span<double> complete) {
    scale_back(z);
    guess_on_curve(xi);
    form_.complete(xi, y_, complete);
    std::ranges::copy(complete, last_on_curve_.begin());
    last_on_curve_xi_ = xi;
  }

  /// Completes a state on the curve to which rates have led, and from which they lead on. The search starts from the
  /// state of the last call of rates(), not from an earlier state on the curve.
  void complete_on_path(double xi, std::span<const double> z) {
    scale_back(z);
    std::ranges::copy(form_.complete(xi, y_), last_on_curve_.begin());
    last_on_curve_xi_ = xi;
  }

  /// Gives the scaled rates d/dxi of a scaled state.
  /// @throws std::domain_error where the equations end, or have no finite rates
  void rates(double xi, std::span<const double> z, std::span<double> dz) {
    ++evaluations_;
    scale_back(z);
    // xi goes back from a stage or a rejected step, whose complete state may lie far from the curve.
    if (xi < last_rates_xi_) guess_on_curve(xi);
    last_rates_xi_ = xi;
    form_.rates(xi, y_, dy_);
    if (!all_finite(dy_)) throw std::domain_error("the rates of the equations are not finite");
    for (std::size_t k = 0; k < size(); ++k) dz[k] = dy_[k] / form_.unknown(k).scale;
  }

 private:
  void scale_back(std::span<const double> z) {
    for (std::size_t k = 0; k < size(); ++k) y_[k] = z[k] * form_.unknown(k).scale;
  }

  /// Makes the last complete state on the curve before xi the first guess. Stages may lie far from the curve, where the
  /// equations have other solutions.
  void guess_on_curve(double xi) { form_.guess(xi < last_on_curve_xi_ ? begin_ : last_on_curve_); }

  ExplicitForm form_;
  std::vector<double> y_, dy_;
  std::vector<double> begin_;          ///< complete state at the beginning of the step
  std::vector<double> last_on_curve_;  ///< last complete state on the curve
  double last_on_curve_xi_ = 0.0;
  double last_rates_xi_ = 0.0;  ///< step coordinate of the last call of rates()
  long evaluations_ = 0;
};

/// Takes steps of one segment with a code that has no root finding.
class Stepper {
 public:
  virtual ~Stepper() = default;

  /// Starts a segment. @param z  scaled state
  virtual void begin(double xi, std::span<const double> z) = 0;
  /// Replaces the end of the last step by z, which differs from that end by errors of integration. Codes that remember
  /// earlier steps (GSL's multistep methods) ignore z.
  virtual void correct(std::span<const double> z) = 0;
  /// Takes one accepted step, which does not end beyond 1. @return where it ends
  /// @throws std::domain_error where the equations end; SolverError where the code gives up
  virtual double step() = 0;
  /// Gives the scaled state at xi within the last step.
  virtual void state_at(double xi, std::span<double> z) = 0;

  long rejections = 0;
  long jacobian_evaluations = 0;
  int order = 0;
};

[[nodiscard]] std::unique_ptr<Stepper> make_odeint(OdeintMethod method, ScaledForm& form, const Tolerances& tolerances);
[[nodiscard]] std::unique_ptr<Stepper> make_gsl(GslMethod method, ScaledForm& form, const Tolerances& tolerances);

/// d(rates)/dz and d(rates)/dxi by differences of second order: the error of first-order differences would cost a
/// linearly implicit method its order.
class DifferenceJacobian {
 public:
  explicit DifferenceJacobian(ScaledForm& form)
      : form_(form), base_(form.size()), shifted_(form.size()), beyond_(form.size()), point_(form.size()) {}

  /// Computes both derivatives at (xi, z).
  /// @param length    of the step for which they are meant; increments shrink with it, because a regime may be as short
  /// @param jacobian  receives d(rates)/dz, row by row
  /// @param by_xi     receives d(rates)/dxi
  void at(double xi, std::span<const double> z, double length, std::span<double> jacobian, std::span<double> by_xi);

 private:
  /// Evaluates the rates with unknown j increased (`shifted_`) and decreased (`beyond_`). A side on which rates jump or
  /// do not exist is replaced by the point itself.
  /// @param wanted  increment; made smaller where the equations end
  /// @return distance between the two states
  double sample_beside(double xi, std::size_t j, double wanted);

  ScaledForm& form_;
  std::vector<double> base_, shifted_, beyond_, point_;
};

}  // namespace monograin
