/// The nonlocal particle in one mode, under one step of a program: its equations in the unknowns of the system.
///
/// The unknowns are those of the contacts (nonlocal/contacts.hpp), with s^(3/2) for a class under force
/// control, and the work of the walls. Lengths over R0, forces over E R0^2.
#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "nonlocal/contacts.hpp"
#include "nonlocal/equilibrium.hpp"
#include "nonlocal/rates.hpp"
#include "nonlocal/setup.hpp"
#include "nonlocal/support.hpp"
#include "system/difficulty.hpp"
#include "system/resolution.hpp"

namespace monograin::nonlocal {

/// State of the classes between two transitions.
struct Mode {
  std::vector<char> is_closed;  ///< in contact
  std::vector<char> touches;    ///< wall may move a free centre; if open, until its gap exceeds Scales::idle
};

class Particle {
 public:
  Particle(const Settings& settings, std::span<const ContactClass> classes);

  [[nodiscard]] const Settings& settings() const noexcept { return settings_; }
  [[nodiscard]] const Scales& scales() const noexcept { return scales_; }
  [[nodiscard]] Contacts& contacts() noexcept { return contacts_; }
  [[nodiscard]] const Contacts& contacts() const noexcept { return contacts_; }
  [[nodiscard]] std::size_t size() const noexcept { return ramps_.size(); }
  [[nodiscard]] bool has_free_centre() const noexcept { return contacts_.free_count() > 0; }
  /// Index of the work among the unknowns.
  [[nodiscard]] std::size_t work_slot() const noexcept { return contacts_.unknown_count(); }

  Mode mode{};

  // Program.

  /// Lets a wall rest at a displacement.
  void rest(std::size_t i, double displacement) { ramps_[i] = {displacement, displacement, Control::displacement}; }
  /// Sets the ramps [m, N] of a step, and converts the unknowns of walls whose control changes.
  void set_ramps(std::span<const Ramp> ramps, std::span<double> y);
  [[nodiscard]] const Ramp& ramp(std::size_t i) const noexcept { return ramps_[i]; }
  [[nodiscard]] bool is_force_controlled(std::size_t i) const noexcept { return ramps_[i].is_force_controlled(); }
  /// The xi at which a force falls to zero in this step; k_infinity if it does not.
  [[nodiscard]] double end_of_force(std::size_t i) const noexcept;
  /// @throws DomainError if a wall would have to pull just after an instant
  void require_pressing_walls(double xi) const;

  // States.

  /// Copies the unknowns to state() as contacts() expects them: s for classes under force control, too.
  /// @throws DomainError for a force that pulls
  std::span<double> evaluate(double xi, std::span<const double> y);
  /// Evaluates the unknowns in state(), and all contacts in that state in contact().
  void evaluate_contacts(double xi, std::span<const double> y) { contacts_.contacts(evaluate(xi, y), now_); }
  [[nodiscard]] std::span<const double> state() const noexcept { return state_; }
  [[nodiscard]] const ContactState& contact(std::size_t i) const noexcept { return now_[i]; }
  /// Displacement of a wall; as prescribed, or in the state of evaluate_contacts().
  [[nodiscard]] double displacement(std::size_t i, double xi) const noexcept {
    return is_force_controlled(i) ? now_[i].displacement : prescribed(i, xi);
  }
  /// Displacement of a wall towards the centre of the particle, wherever that is.
  [[nodiscard]] double depth(std::size_t i, double xi) const noexcept {
    return displacement(i, xi) + contacts_.approach_by_centre(i, state_);
  }
  /// Signed square of a class shortly after the state of evaluate(), as soon as it exceeds the touch tolerance on
  /// either side; 0 if it never does, none if no state exists before that.
  [[nodiscard]] std::optional<double> square_ahead(std::size_t i, double xi);
  /// True for a wall that just touches in the state of evaluate(), and goes nowhere.
  [[nodiscard]] bool comes_to_rest(std::size_t i, double xi) {
    return std::abs(state_[i]) <= scales_.touch && square_ahead(i, xi) == 0.0;
  }

  // Equations.

  void solve(double xi, std::span<double> y);
  /// At the beginning of a step, moves a loose particle with the walls whose forces begin to press it, to walls that
  /// can bear these forces. Does nothing if a contact is loaded, or if no wall is in the path.
  void carry_to_support(std::span<double> y);
  /// Recomputes the gaps, and the position of a free centre: their errors would close idle walls.
  void clear_centre(double xi, std::span<double> y);
  void rates(double xi, std::span<const double> y, std::span<double> dy);
  void residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res);
  /// Advances past the begin or the end of a force that contacts alone bear against a free centre. Their depth, and
  /// with it the centre's position, goes like the force to the power 2/3: its rate is infinite at zero force.
  [[nodiscard]] double leave_singularity(double xi, std::span<double> y);
  void branch_reach(std::span<const double> y, std::span<double> reach) const;
  [[nodiscard]] std::optional<Difficulty> difficulty(double xi, std::span<const double> y);

 private:
  [[nodiscard]] double prescribed(std::size_t i, double xi) const noexcept { return ramps_[i].value(xi); }
  [[nodiscard]] double square_under_force(std::size_t i, double xi) const;
  void or_report_pull(double xi, auto&& ask) const;
  void note(std::span<double> y) const;
  [[nodiscard]] double force_rate(std::size_t i) const;
  [[nodiscard]] double speed_under_force(std::size_t i) const;

  Settings settings_;
  Contacts contacts_;
  Scales scales_;
  std::vector<Ramp> ramps_;  ///< displacements over R0, forces over E R0^2
  EquilibriumSearch search_;
  Rates motion_;
  CentreSupport support_;
  /// A state a little later than state_.
  struct StateAhead {
    double xi = 0.0;
    std::vector<double> state;
  };
  std::vector<StateAhead> ahead_;  ///< states of square_ahead(), the same for all classes
  // Work space, so that nothing is allocated while integrating.
  std::vector<double> state_, rates_;  ///< unknowns of contacts_, and their rates
  std::vector<double> all_rates_;      ///< with that of the work
  std::vector<ContactState> now_;
  std::vector<Ramp> drawn_ramps_;
};

}  // namespace monograin::nonlocal
