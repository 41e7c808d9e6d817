/// What every model is to the engine: continuous unknowns, a mode, guards alive in that mode, and transitions.
///
/// Time. All laws here are rate independent, so a system knows no seconds: within one step of the program its
/// independent variable is the step coordinate xi, from 0 at the step's start to 1 at its end. The scene turns xi into
/// time.
///
/// Unknowns. They stand in one array y, dimensionless and of order one: first the differential ones, then the
/// quadratures (their rates depend on the others, nothing depends on them), then the algebraic ones. Three forms of the
/// same system:
///   explicit  rates() of differential unknowns and quadratures; complete() fills in the algebraic ones
///   implicit  residual() = 0, as many as there are unknowns
///   direct    solve() finds everything but the quadratures at one instant; closed_quadrature() where there is a closed
///   form
///
/// A system evaluates its equations a little beyond the end of a regime (trial steps, root brackets), and throws
/// std::domain_error where they end for good; the caller then comes nearer with smaller steps.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "system/difficulty.hpp"
#include "system/limit.hpp"
#include "system/walls.hpp"

namespace monograin {

struct Unknown {
  enum class Kind { differential, quadrature, algebraic };
  std::string_view name;
  Kind kind = Kind::differential;
  double scale = 1.0;  ///< typical magnitude; absolute tolerances are relative to it
  /// residual() contains its rate only where no equation determines the unknown itself.
  bool is_implicitly_algebraic = false;
  /// Its row of residual() gives it outright as a function of xi and the other unknowns, and so does complete(): it has
  /// no error of its own, and may be singular in xi where those are smooth.
  bool is_dependent = false;
  bool may_rest = false;   ///< nothing may determine it: then it stays where it was
  double sum_scale = 0.0;  ///< typical magnitude of the sums it stands in, whose rounding residual() shows as its own
};

/// A root function that is alive in the present mode. Scaled to order one.
struct Guard {
  int kind = 0;           ///< the system's own code
  int index = 0;          ///< contact class, or pair of classes, it belongs to
  int direction = 1;      ///< fires when it crosses zero upwards (+1) or downwards (-1)
  std::string_view name;  ///< of the event it stands for
  /// Changes the form of the equations and nothing that is seen: leaves no rows in the history.
  bool is_silent = false;
  /// Marks an instant and changes nothing: neither mode nor state. Shown if fire() logs an event.
  bool is_mark = false;
  /// A function of the program only, without any error of integration.
  bool is_exact = false;
  /// Rates, or their slopes, grow without bound towards it: just before it other guards may cross and come back within
  /// no time.
  bool is_branch_end = false;
  /// Goes one way over the rest of the step: its values at two instants show whether it crosses between them.
  bool is_monotone = false;
};

/// A regime transition or other located instant.
struct Event {
  std::string_view name;
  int contact_class = -1;  ///< -1: the particle
  int other_class = -1;    ///< second class of an event of two
};

/// Something the user should know, with the number that shows it.
struct Diagnostic {
  std::string_view message;
  std::string_view quantity;  ///< what the value is, e.g. "E/Y"
  double value = 0.0;
};

/// Why a system cannot go on: the event that ends the run, and the limit that is met.
struct DomainEnd {
  Event event;
  LimitPoint point;
};

/// The system cannot take up the step that begins.
class CannotBegin : public DomainError {
 public:
  explicit CannotBegin(const DomainEnd& end) : DomainError(end.point), end_(end) {}
  [[nodiscard]] const DomainEnd& end() const noexcept { return end_; }

 private:
  DomainEnd end_;
};

/// A column of the history that the system fills.
struct Observable {
  std::string name;
  std::string unit;
  std::span<const std::string_view> words;  ///< not empty: the value is an index into these
};

/// Quantities of a wall and its contact, in SI.
struct AtWall {
  double force = 0.0;
  double displacement = 0.0;
  double pressure = 0.0;
  double contact_radius = 0.0;
  double apparent_radius = 0.0;
};

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

/// The surface of the particle under and around a contact, at a distance from its middle. In SI.
struct SurfacePoint {
  double radius = 0.0;          ///< distance from the contact's middle [m]
  double pressure = 0.0;        ///< compression positive [Pa]
  double displacement = 0.0;    ///< of the surface, into the particle [m]
  double relaxed_height = 0.0;  ///< of the surface without load, from its middle [m]; NaN where it is not known
};

/// Observables that need the work, or what is stored of it.
inline constexpr std::array<std::string_view, 3> k_energy_observables{"work", "stored_energy", "dissipation"};
[[nodiscard]] constexpr bool is_energy(std::string_view observable) noexcept {
  return std::ranges::find(k_energy_observables, observable) != k_energy_observables.end();
}

class HybridSystem {
 public:
  virtual ~HybridSystem() = default;

  /// Says that nobody reads the energies of this run: observe() gives NaN for them, and `direct` does not compute the
  /// work.
  void leave_out_energies() noexcept { has_energies_ = false; }
  [[nodiscard]] bool has_energies() const noexcept { return has_energies_; }

  [[nodiscard]] virtual std::span<const Unknown> unknowns() const noexcept = 0;

  /// Whether there are unknowns that may be singular where a segment begins, and rates with them.
  [[nodiscard]] bool has_dependent_unknowns() const noexcept {
    return std::ranges::any_of(unknowns(), &Unknown::is_dependent);
  }
  /// Empty where the model knows no walls.
  [[nodiscard]] virtual std::span<const ContactClass> classes() const noexcept { return {}; }

  /// State before the first step.
  virtual void start(std::span<double> y) = 0;

  /// Takes up the next step and decides the mode at its start; what changes there is logged.
  /// @param ramps  one per channel of the scene: per contact class where there are walls
  /// @throws CannotBegin
  virtual void begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) = 0;

  /// Fills the algebraic unknowns for given differential ones; their present values are the first guess. May move the
  /// differential ones by their own error, to where the exact solution would keep them.
  virtual void complete(double xi, std::span<double> y) = 0;

  /// Whether all that complete() takes from the differential unknowns is error, so that integrators may begin the next
  /// step where it has moved them: errors that are left there add up.
  [[nodiscard]] virtual bool has_corrections() const noexcept { return false; }

  /// d/dxi of differential unknowns and quadratures; y is complete.
  virtual void rates(double xi, std::span<const double> y, std::span<double> dy) = 0;

  /// d/dxi of every unknown, algebraic ones included, as a consistent start for implicit integrators.
  virtual void all_rates(double xi, std::span<const double> y, std::span<double> dy) = 0;

  virtual void residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) = 0;

  /// Whether residual() can be solved for the rates of the differential unknowns and the algebraic ones together. If
  /// not (an equation without rates that belongs to an unknown with one), all_rates() has to be consistent by itself.
  [[nodiscard]] virtual bool is_semi_explicit() const noexcept { return true; }

  /// How many times the relative error of the unknowns that of the curves may be, because these show small differences
  /// of them: so much more accurately the unknowns are integrated.
  [[nodiscard]] virtual double error_gain() const noexcept { return 1.0; }

  /// Whether solve() finds the state at any instant of the program. If not, the direct form is not offered.
  [[nodiscard]] virtual bool is_solvable() const noexcept { return true; }
  /// Whether a system that is not solvable always is so until its mode changes. closed_quadrature() then gives the
  /// work.
  [[nodiscard]] virtual bool is_solvable_here() const noexcept { return false; }
  /// A function that brings the system back to its present mode and memory, after a step has been rehearsed. Not to be
  /// called when the system is gone.
  [[nodiscard]] virtual std::function<void()> checkpoint() = 0;

  /// Solves for everything but the quadratures; the present values are the first guess. Of a system that is not
  /// solvable: for what jumps in a transition.
  /// @throws std::domain_error where there is no solution
  virtual void solve(double xi, std::span<double> y) = 0;

  /// Takes the state past a point where its rates are infinite, or become so within the round-off of the step
  /// coordinate.
  /// @return where it then is: no farther than no integrator need resolve
  virtual double leave_singularity(double xi, std::span<double> /*y*/) { return xi; }

  /// Primitive of the quadrature along the present mode, up to a constant, where it has a closed form.
  [[nodiscard]] virtual std::optional<double> closed_quadrature(double xi, std::span<const double> y) = 0;
  /// Whether that primitive costs tens of evaluations of the law, because it is itself computed by quadrature.
  [[nodiscard]] virtual bool is_quadrature_costly() const noexcept { return false; }

  /// Guards alive until the next transition or the end of the step, in the order in which they are applied.
  [[nodiscard]] virtual std::span<const Guard> guards() const noexcept = 0;
  virtual void guard_values(double xi, std::span<const double> y, std::span<double> values) = 0;

  /// Applies the transitions of the guards with these indices, decides the mode anew, and logs all that changed. What
  /// jumps because of that stands in y as it was just before; solve() then lets it jump.
  /// @return the reason to stop, if the system ends here
  virtual std::optional<DomainEnd> fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                        std::vector<Event>& log) = 0;

  [[nodiscard]] virtual std::span<const Observable> observables() const noexcept = 0;
  virtual void observe(double xi, std::span<const double> y, std::span<double> values) = 0;

  /// One quantity of one channel, in SI.
  /// @throws std::logic_error for a quantity that the language does not offer with this model
  [[nodiscard]] virtual double quantity(Quantity quantity, int channel, double xi, std::span<const double> y) = 0;
  /// Present value, in SI, of what a control prescribes a channel: a ramp starts there when it takes control. That of
  /// walls under displacement is where they stand, counted towards the place where the centre started.
  /// @throws std::logic_error for a control that the language does not offer with this model
  [[nodiscard]] virtual double controlled(Control control, int channel, double xi, std::span<const double> y) = 0;
  /// Pressure and surface under a contact, from its middle outwards; empty where it is open, or the model has none.
  [[nodiscard]] virtual std::vector<SurfacePoint> surface(int /*contact_class*/, double /*xi*/,
                                                          std::span<const double> /*y*/) {
    return {};
  }
  /// Whether the walls of a class do not touch the particle.
  [[nodiscard]] virtual bool is_open(int /*contact_class*/) const noexcept { return false; }

  /// Whether a contact may pull: its force then passes through zero while it is closed.
  [[nodiscard]] virtual bool contacts_adhere() const noexcept { return false; }

  /// What makes the equations hard where an integrator has given up; none where nothing is known.
  [[nodiscard]] virtual std::optional<Difficulty> difficulty(double /*xi*/, std::span<const double> /*y*/) {
    return std::nullopt;
  }

  /// What the user should know about this run, collected so far.
  [[nodiscard]] virtual std::vector<Diagnostic> warnings() const = 0;

  /// Largest change of each unknown between two calls of solve() that cannot skip a branch of solutions; infinite where
  /// there is only one.
  virtual void branch_reach(std::span<const double> /*y*/, std::span<double> reach) const {
    std::ranges::fill(reach, std::numeric_limits<double>::infinity());
  }

 private:
  bool has_energies_ = true;
};

}  // namespace monograin
