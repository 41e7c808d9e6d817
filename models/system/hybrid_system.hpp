/// Interface between a model and the engine: continuous unknowns, a mode, guards alive in that mode, and transitions.
///
/// Time. All laws are rate independent, and a system knows no seconds. Within one step of the program its independent
/// variable is the step coordinate xi, from 0 at the start of the step to 1 at its end. The scene converts xi to time.
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
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "system/difficulty.hpp"
#include "system/limit.hpp"
#include "system/resolution.hpp"
#include "system/walls.hpp"

namespace monograin {

/// One entry of the array y of a HybridSystem.
struct Unknown {
  enum class Kind { differential, quadrature, algebraic };
  std::string_view name;
  Kind kind = Kind::differential;
  double scale = 1.0;  ///< typical magnitude; absolute tolerances are relative to it
  /// residual() contains the rate of this unknown only if no equation determines the unknown itself.
  bool is_implicitly_algebraic = false;
  /// True for a dependent unknown: complete() and its row of residual() give it explicitly as a function of xi and the
  /// other unknowns. It has no integration error of its own, and may be singular in xi where the others are smooth.
  bool is_dependent = false;
  /// In some modes no equation determines the unknown; it then keeps its value.
  bool may_be_undetermined = false;
  double sum_scale = 0.0;  ///< magnitude of sums that contain it: their round-off bounds its absolute tolerance below
};

/// Rate, per step of the program, at which rates() draw an integrated state back to the equations (stabilization of the
/// constraints). Without it, accumulated errors would grow with the reciprocal of the margin towards a fold.
inline constexpr double k_stabilization = 20.0;

/// A guard: a root function, scaled to order one, that is alive in the present mode.
struct Guard {
  int kind = 0;           ///< code of the guard, private to the system
  int index = 0;          ///< contact class, or pair of classes, that the guard belongs to
  int direction = 1;      ///< the guard fires when it crosses zero upwards (+1) or downwards (-1)
  std::string_view name;  ///< name of the event that the guard locates
  /// The guard changes the form of the equations but no observable: it leaves no rows in the history.
  bool is_silent = false;
  /// The guard marks an instant and changes neither mode nor state. The history shows it if fire() logs an event.
  bool is_mark = false;
  /// The guard is a function of the program only, free of integration error.
  bool is_exact = false;
  /// The guard ends a branch of solutions: rates, or their slopes, are unbounded towards its root. Just before the root
  /// other guards may cross zero and return within a vanishing interval of xi.
  bool is_branch_end = false;
  /// The guard is monotone over the rest of the step: its values at two instants show whether it crosses between them.
  bool is_monotone = false;

  /// `index` as a place in a list; 0 where there is none.
  [[nodiscard]] std::size_t place() const noexcept { return static_cast<std::size_t>(std::max(0, index)); }
};

/// A regime transition or other located instant.
struct Event {
  std::string_view name;
  int contact_class = -1;  ///< -1: the particle
  int other_class = -1;    ///< second class of an event of two
};

/// A warning for the user, with the value of the quantity that caused it.
struct Diagnostic {
  std::string message;
  std::string_view quantity;  ///< name of the quantity, e.g. "E/Y"
  double value = 0.0;
};

/// End of a run at a limit of the model: the event that ends the run, and the limit that it meets.
struct DomainEnd {
  Event event;
  LimitPoint point;
};

/// Thrown if the system cannot begin the next step of the program, because it meets a limit at the start of the step.
class CannotBegin : public DomainError {
 public:
  explicit CannotBegin(const DomainEnd& end) : DomainError(end.point), end_(end) {}
  [[nodiscard]] const DomainEnd& end() const noexcept { return end_; }

 private:
  DomainEnd end_;
};

/// A column of the history that the system computes.
struct Observable {
  std::string name;
  std::string unit;
  std::span<const std::string_view> words;  ///< if not empty, the value is an index into `words`
};

/// Quantities of a wall and its contact, in SI units.
struct AtWall {
  double force = 0.0;
  double displacement = 0.0;
  double pressure = 0.0;
  double contact_radius = 0.0;
  double apparent_radius = 0.0;
};

/// Selects one quantity of a wall, in SI units.
/// @throws std::logic_error for a quantity that walls do not have
[[nodiscard]] inline double quantity_of(const AtWall& wall, Quantity quantity) {
  switch (quantity) {
    case Quantity::force:
      return wall.force;
    case Quantity::displacement:
      return wall.displacement;
    case Quantity::pressure:
      return wall.pressure;
    case Quantity::contact_radius:
      return wall.contact_radius;
    case Quantity::apparent_radius:
      return wall.apparent_radius;
    default:
      throw std::logic_error("no such quantity at a wall");
  }
}

/// State of the particle's surface at one radius, under or around a contact.
struct SurfacePoint {
  double radius = 0.0;          ///< distance from the contact's middle [m]
  double pressure = 0.0;        ///< compression positive [Pa]
  double displacement = 0.0;    ///< displacement of the surface into the particle [m]
  double relaxed_height = 0.0;  ///< height of the unloaded surface relative to its middle [m]; NaN if unknown
};

/// Names of the observables that are energies: the work, the stored energy and the dissipation.
inline constexpr std::array<std::string_view, 3> k_energy_observables{"work", "stored_energy", "dissipation"};
/// True if the observable is the work, the stored energy or the dissipation.
[[nodiscard]] constexpr bool is_energy(std::string_view observable) noexcept {
  return std::ranges::find(k_energy_observables, observable) != k_energy_observables.end();
}

/// A model bound to a scene, as the engine runs it.
class HybridSystem {
 public:
  virtual ~HybridSystem() = default;

  /// Declares that this run needs no energies: observe() then gives NaN for them, and `direct` skips the work.
  virtual void leave_out_energies() noexcept { has_energies_ = false; }
  [[nodiscard]] bool has_energies() const noexcept { return has_energies_; }

  /// Unknowns in the order of the array y.
  [[nodiscard]] virtual std::span<const Unknown> unknowns() const noexcept = 0;

  /// True if some unknowns are dependent: these unknowns and their rates may be singular at the start of a segment.
  [[nodiscard]] bool has_dependent_unknowns() const noexcept {
    return std::ranges::any_of(unknowns(), &Unknown::is_dependent);
  }
  /// Contact classes of the scene; empty if the model has no walls.
  [[nodiscard]] virtual std::span<const ContactClass> classes() const noexcept { return {}; }

  /// Sets y to the state before the first step.
  virtual void start(std::span<double> y) = 0;

  /// Begins the next step of the program, resolves the mode at its start, and logs the events that happen there.
  /// @param ramps  one for each channel of the scene; with walls, one for each contact class
  /// @throws CannotBegin if the system meets a limit at the start of the step
  virtual void begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) = 0;

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
  /// Returns a function that restores the present mode and memory of the system, for use after a rehearsed step. The
  /// function must not outlive the system.
  [[nodiscard]] virtual std::function<void()> checkpoint() = 0;

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

  /// Guards alive until the next transition or the end of the step, in the order in which they are applied.
  [[nodiscard]] virtual std::span<const Guard> guards() const noexcept = 0;
  /// Computes the value of every guard, in the order of guards().
  virtual void guard_values(double xi, std::span<const double> y, std::span<double> values) = 0;

  /// Applies the transitions of the guards with these indices, resolves the mode, and logs the events. Unknowns that
  /// jump keep their values from before the event in y; the next solve() sets the values after it.
  /// @return the limit that ends the run here; empty if the run goes on
  virtual std::optional<DomainEnd> fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                        std::vector<Event>& log) = 0;

  /// Columns of the history that this system computes.
  [[nodiscard]] virtual std::span<const Observable> observables() const noexcept = 0;
  /// Computes the value of every observable in its unit, in the order of observables(); NaN if it is undefined.
  virtual void observe(double xi, std::span<const double> y, std::span<double> values) = 0;

  /// Present value of one quantity of one channel, in SI units.
  /// @throws std::logic_error for a quantity that scenarios cannot ask of this model
  [[nodiscard]] virtual double quantity(Quantity quantity, int channel, double xi, std::span<const double> y) = 0;
  /// Present value, in SI units, of the quantity that a control prescribes for a channel; a new ramp starts from it.
  /// The displacement of a wall is its position, counted towards the initial position of the centre.
  /// @throws std::logic_error for a control that scenarios cannot use with this model
  [[nodiscard]] virtual double controlled(Control control, int channel, double xi, std::span<const double> y) = 0;
  /// Pressure and surface under a contact, from its middle outwards; empty if it is open, or the model has no surface.
  [[nodiscard]] virtual std::vector<SurfacePoint> surface(int /*contact_class*/, double /*xi*/,
                                                          std::span<const double> /*y*/) {
    return {};
  }
  /// True if the walls of a class do not touch the particle.
  [[nodiscard]] virtual bool is_open(int /*contact_class*/) const noexcept { return false; }

  /// True if contacts adhere: the force of a closed contact may then pass through zero and pull.
  [[nodiscard]] virtual bool contacts_adhere() const noexcept { return false; }

  /// Cause of the failure at a state where an integrator has given up; empty if the model knows none.
  [[nodiscard]] virtual std::optional<Difficulty> difficulty(double /*xi*/, std::span<const double> /*y*/) {
    return std::nullopt;
  }

  /// Warnings for the user that this run has collected so far.
  [[nodiscard]] virtual std::vector<Diagnostic> warnings() const { return {}; }

  /// Largest change of each unknown between two calls of solve() that cannot skip a branch of solutions; infinite if
  /// the solution is unique.
  virtual void branch_reach(std::span<const double> /*y*/, std::span<double> reach) const {
    std::ranges::fill(reach, k_infinity);
  }

 private:
  bool has_energies_ = true;
};

}  // namespace monograin
