/// Equations of a model: unknowns that follow an ODE or a DAE in the present regime, and the forms in which a system
/// gives them to integrators.
///
/// Time. All laws are rate independent, and a system knows no seconds. Within one leg of the program (in most cases a
/// whole step) its independent variable is the step coordinate xi, from 0 at the start of the leg to 1 at its end. The
/// scene converts xi to time.
///
/// Unknowns. One array y holds all unknowns, dimensionless and of order one: first the differential ones, then the
/// quadratures (their rates depend on the others, nothing depends on them), then the algebraic ones. A system has three
/// forms:
///   explicit  rates() gives the rates of differential unknowns and quadratures, complete() the algebraic unknowns
///   implicit  residual() = 0, with as many equations as unknowns
///   direct    solve() gives everything but the quadratures at one instant; closed_quadrature() gives a quadrature that
///             has a closed form
///
/// A system can be evaluated a little beyond the end of a regime (trial steps, root brackets). It throws
/// std::domain_error beyond the end of its equations; the caller then approaches that end with smaller steps.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <string_view>

#include "system/difficulty.hpp"
#include "system/resolution.hpp"

namespace monograin {

/// One entry of the array y of a system.
struct Unknown {
  enum class Kind { differential, quadrature, algebraic };
  std::string_view name;
  Kind kind = Kind::differential;
  double scale = 1.0;  ///< typical magnitude; absolute tolerances are relative to it
  /// In the implicit form this unknown is algebraic: a row of residual() determines its value. Its rate appears only in
  /// modes in which no row does.
  bool is_algebraic_in_residual = false;
  /// True for a dependent unknown: complete() and its row of residual() give it explicitly as a function of xi and the
  /// other unknowns. It has no integration error of its own, and may be singular in xi where the others are smooth.
  bool is_dependent = false;
  /// In some modes no equation determines the unknown; it then keeps its value.
  bool may_be_undetermined = false;
  double sum_scale = 0.0;  ///< magnitude of sums in its row of residual(): their round-off bounds its tolerance below
};

/// Rate, per step of the program, at which rates() draw an integrated state back to the equations (stabilization of the
/// constraints). Without it, accumulated errors would grow with the reciprocal of the margin towards a fold.
inline constexpr double k_stabilization = 20.0;

/// Equations of a system, as integrators evaluate them.
class Equations {
 public:
  /// Declares that this run needs no energies: `direct` then skips the work, and observe() gives NaN for them.
  virtual void leave_out_energies() noexcept { has_energies_ = false; }
  [[nodiscard]] bool has_energies() const noexcept { return has_energies_; }

  /// Unknowns in the order of the array y.
  [[nodiscard]] virtual std::span<const Unknown> unknowns() const noexcept = 0;

  /// True if some unknowns are dependent: these unknowns and their rates may be singular at the start of a segment.
  [[nodiscard]] bool has_dependent_unknowns() const noexcept {
    return std::ranges::any_of(unknowns(), &Unknown::is_dependent);
  }

  /// Computes the algebraic unknowns from the differential ones; their present values are the first guess. May correct
  /// the differential unknowns by their integration error, back onto a constraint of the exact solution.
  virtual void complete(double xi, std::span<double> y) = 0;

  /// True if complete() only removes integration error from the differential unknowns. Integrators may then continue
  /// from the corrected state; left in place, these errors accumulate.
  [[nodiscard]] virtual bool has_corrections() const noexcept { return false; }

  /// Computes d/dxi of differential unknowns and quadratures, for a y that complete() has completed.
  virtual void rates(double xi, std::span<const double> y, std::span<double> dy) = 0;

  /// Computes d/dxi of every unknown, algebraic ones included, as a consistent start for implicit integrators. These
  /// are the rates of rates() unless a system overrides this.
  virtual void all_rates(double xi, std::span<const double> y, std::span<double> dy) { rates(xi, y, dy); }

  /// Computes the residual of the implicit form, one value for each unknown.
  virtual void residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) = 0;

  /// True if residual() can be solved for the rates of the differential unknowns and the algebraic unknowns together.
  /// If false (an unknown with a rate has an equation without rates), all_rates() is consistent by itself.
  [[nodiscard]] virtual bool is_semi_explicit() const noexcept { return true; }

  /// Ratio of the relative error of the curves to that of the unknowns; above 1 if curves are small differences of
  /// unknowns. Integrators reduce their tolerances by this factor.
  [[nodiscard]] virtual double error_gain() const noexcept { return 1.0; }

  /// True if solve() finds the state at any instant of the program. If false, the direct form is not available.
  [[nodiscard]] virtual bool is_solvable() const noexcept { return true; }
  /// True if solve() finds the state at any instant until the mode changes, even if is_solvable() is false.
  /// closed_quadrature() then gives the work.
  [[nodiscard]] virtual bool is_solvable_here() const noexcept { return false; }

  /// Solves for everything but the quadratures at one instant; the present values are the first guess. If the system is
  /// not solvable, solves only for the unknowns that jump in a transition.
  /// @throws std::domain_error if there is no solution
  virtual void solve(double xi, std::span<double> y) = 0;

  /// Advances y along the solution past a point where its rates are infinite, or become infinite within the round-off
  /// of the step coordinate.
  /// @return the new xi, nearer to `xi` than integrators resolve; `xi` itself if there is no such point
  virtual double leave_singularity(double xi, std::span<double> /*y*/) { return xi; }

  /// Step coordinate of the first kink beyond `after`: a point where some derivative of the solution jumps although the
  /// mode stays, such as a sample of an interpolated curve. The state y at xi is extrapolated to it with its rates, so
  /// the result is exact if that state lies at the kink.
  /// @return infinity if no kink lies ahead
  [[nodiscard]] virtual double next_kink(double /*after*/, double /*xi*/, std::span<const double> /*y*/) {
    return k_infinity;
  }

  /// Primitive of the quadrature in the present mode, up to a constant; empty if it has no closed form.
  [[nodiscard]] virtual std::optional<double> closed_quadrature(double /*xi*/, std::span<const double> /*y*/) {
    return std::nullopt;
  }
  /// True if closed_quadrature() costs tens of evaluations of the law, because it integrates numerically.
  [[nodiscard]] virtual bool is_quadrature_costly() const noexcept { return false; }

  /// Largest change of each unknown between two calls of solve() that cannot skip a branch of solutions; infinite if
  /// the solution is unique.
  virtual void branch_reach(std::span<const double> /*y*/, std::span<double> reach) const {
    std::ranges::fill(reach, k_infinity);
  }

  /// Cause of the failure at a state where an integrator has given up; empty if the model knows none.
  [[nodiscard]] virtual std::optional<Difficulty> difficulty(double /*xi*/, std::span<const double> /*y*/) {
    return std::nullopt;
  }

 protected:
  Equations() = default;
  Equations(const Equations&) = default;
  Equations& operator=(const Equations&) = default;
  ~Equations() = default;

 private:
  bool has_energies_ = true;
};

}  // namespace monograin
