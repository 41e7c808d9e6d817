/// One contact class under a law: its memory, its state at an instant, and its transitions. The functions of a law are
/// listed in contacts/independent.hpp; displacements are over R0, forces over the law's unit.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "contacts/wall_drive.hpp"
#include "system/regimes.hpp"
#include "system/resolution.hpp"

namespace monograin::contacts {

/// End of a part of the primary loading branch.
struct Boundary {
  double position = 0.0;              ///< last displacement over R0 of the part before it
  std::string_view event{};           ///< empty: no event
  std::optional<LimitPoint> limit{};  ///< the law ends here
  bool is_of_followers = false;       ///< the event belongs to the contacts that follow this one
  bool is_singular = false;           ///< second derivatives of the force are unbounded towards it
};

/// Force and contact radius of a contact that bears.
struct BearingContact {
  double force = 0.0;
  double contact_radius = 0.0;  ///< over R0
};

/// Which boundaries count as passed by a step that ends exactly at them. The next step passes others if it goes on.
enum class PassedAtEnd { none, opening, all };

template <class Law>
class WallContact {
 public:
  using Branch = typename Law::Branch;

  WallContact() = default;
  /// An open wall at a displacement.
  /// @param force_per_coordinate  force over coordinate, where the two are in proportion
  /// @param followers             classes of the contacts that follow this one
  WallContact(int index, double at, double force_per_coordinate = 1.0, std::vector<int> followers = {})
      : index_(index),
        force_per_coordinate_(force_per_coordinate),
        followers_(std::move(followers)),
        drive_({at, at, Control::displacement}, 1.0),
        resting_(at) {}

  [[nodiscard]] const WallDrive& drive() const noexcept { return drive_; }
  [[nodiscard]] const Branch& branch() const noexcept { return branch_; }
  [[nodiscard]] bool touches() const noexcept { return touches_; }
  [[nodiscard]] bool has_touched() const noexcept { return has_touched_; }
  [[nodiscard]] bool is_force_controlled() const noexcept { return drive_.is_force_controlled(); }
  [[nodiscard]] bool is_on_primary_branch() const noexcept { return is_on_primary_branch_; }

  // --- at an instant

  /// Force of a wall under force control, never negative: a state evaluated a little ahead may lie beyond the instant
  /// at which a falling force reaches zero.
  [[nodiscard]] double prescribed_force(double xi) const noexcept {
    return touches_ ? std::max(0.0, drive_.value(xi)) : 0.0;
  }
  /// Displacement under a prescribed force. An open wall stays; without load a contact is where it opens.
  /// @param near  displacement with which a law that iterates begins; 0: none is known
  [[nodiscard]] double displacement_under(const Law& law, double force, double near = 0.0) const {
    if (!touches_) return resting_;
    if (!(force > 0.0)) return law.opening(branch_);
    if constexpr (requires { law.displacement(branch_, force, near); }) return law.displacement(branch_, force, near);
    return law.displacement(branch_, force);
  }

  // Coordinate u of a wall whose force is prescribed at some time:
  //
  //   control                                 coordinate u                displacement d
  //   displacement                            d                           as prescribed
  //   force                                   F / force_per_coordinate    law.displacement(F)
  //   force, if the law names a power n       d^n                         u^(1/n)
  //
  // In the first two cases u is linear in the step coordinate, hence exact in every form of the equations, and not
  // singular at first touch or where a contact opens with an infinite compliance. A law whose inverse is costly names
  // the power n with which its force begins; u is then integrated if the law asks for that.

  /// n of the coordinate d^n; 0: the coordinate is in proportion to what is prescribed.
  [[nodiscard]] double coordinate_power(const Law& law) const {
    if constexpr (k_has_powers) return touches_ && is_force_controlled() ? law.coordinate_power(branch_) : 0.0;
    return 0.0;
  }
  /// True if integrators advance the coordinate; false if it follows from the prescribed value at every instant.
  [[nodiscard]] bool is_integrated(const Law& law) const {
    const bool has_power = coordinate_power(law) > 0.0;
    if constexpr (requires { law.is_integrated(branch_); }) return has_power && law.is_integrated(branch_);
    return has_power;
  }
  /// Displacement at a coordinate.
  [[nodiscard]] double displacement_of(const Law& law, double u) const {
    const double n = coordinate_power(law);
    if (n > 0.0) return std::copysign(std::pow(std::abs(u), 1.0 / n), u);
    return is_force_controlled() ? displacement_under(law, u * force_per_coordinate_) : u;
  }
  /// Displacement at an instant of the step.
  /// @param u  coordinate there; used only if it is a power of the displacement
  [[nodiscard]] double displacement(const Law& law, double xi, double u) const {
    if (!is_force_controlled()) return drive_.value(xi);
    return coordinate_power(law) > 0.0 ? displacement_of(law, u) : displacement_under(law, drive_.value(xi));
  }
  /// Coordinate at an instant of the step.
  /// @param near  displacement with which a law that iterates begins
  [[nodiscard]] double coordinate(const Law& law, double xi, double near) const {
    const double n = coordinate_power(law);
    if (n > 0.0) return std::pow(displacement_under(law, drive_.value(xi), near), n);
    return drive_.value(xi) / prescribed_per_coordinate();
  }
  /// Coordinate at an instant of the step.
  /// @param u  a coordinate nearby, with which a law that iterates begins
  [[nodiscard]] double coordinate_next_to(const Law& law, double xi, double u) const {
    return coordinate(law, xi, coordinate_power(law) > 0.0 ? displacement_of(law, u) : 0.0);
  }

  /// Prescribed quantity at a coordinate, and its derivatives by the coordinate and the displacement. Where coordinate
  /// and quantity are in proportion, only by_coordinate is set.
  struct Slope {
    double prescribed = 0.0;
    double by_coordinate = 0.0;
    double by_displacement = 0.0;
  };
  /// @param u  coordinate; used only if it is a power of the displacement
  [[nodiscard]] Slope slope(const Law& law, double u) const {
    if constexpr (k_has_powers) {
      if (const double n = coordinate_power(law); n > 0.0) return slope_of_power(law, n, u);
    }
    return {.by_coordinate = prescribed_per_coordinate()};
  }
  /// Rate of the coordinate.
  [[nodiscard]] double rate(const Slope& now) const noexcept { return drive_.rate() / now.by_coordinate; }
  /// Residual of the coordinate, in units of the coordinate, as integrators weigh it.
  [[nodiscard]] double residual(const Law& law, double xi, double u, const Slope& now) const {
    return is_integrated(law) ? (now.prescribed - drive_.value(xi)) / now.by_coordinate
                              : u - coordinate_next_to(law, xi, u);
  }
  /// Rate of the work of one wall: F dd, which is F dF/(dF/dd) where the force is prescribed.
  [[nodiscard]] double power(const Law& law, double xi, const Slope& now) const {
    if (!touches_) return 0.0;
    const double prescribed = drive_.value(xi);
    if (!is_force_controlled()) return drive_.rate() * law.force(branch_, prescribed);
    if (!(prescribed > 0.0)) return 0.0;
    const double slope = coordinate_power(law) > 0.0 ? now.by_displacement : slope_under(law, prescribed);
    return slope > 0.0 ? drive_.rate() * prescribed / slope : 0.0;
  }

  /// True if the contact bears a force that is not round-off. A prescribed displacement has round-off, which must not
  /// press a wall that stands exactly where it meets the particle or parts from it.
  [[nodiscard]] bool bears(const Law& law, double d) const {
    if (!touches_) return false;
    const double least = is_force_controlled() ? 0.0 : k_round_off * std::max(drive_.size(), largest_);
    return d - law.opening(branch_) > least;
  }
  /// The boundary ahead of a contact that is pressed further; off the primary branch, its largest displacement.
  [[nodiscard]] std::optional<Boundary> next(const Law& law) const {
    if (!is_on_primary_branch_) return Boundary{largest_, "reload"};
    if constexpr (requires { law.next(branch_); }) return law.next(branch_);
    return std::nullopt;
  }
  /// Value of the prescribed quantity, displacement or force, at a boundary.
  [[nodiscard]] double prescribed_at(const Law& law, const Boundary& boundary) const {
    if (!is_force_controlled()) return boundary.position;
    return is_on_primary_branch_ ? law.force(branch_, boundary.position) : largest_force_;
  }

  /// True if a rising ramp passes a boundary before the step ends.
  [[nodiscard]] bool passes(double prescribed) const noexcept {
    return k_passed_at_end == PassedAtEnd::all ? drive_.end() >= prescribed : drive_.goes_beyond(prescribed);
  }
  /// True if the wall meets, or leaves, the particle within the step. A force that ends at zero leaves no gap.
  [[nodiscard]] bool passes_opening(const Law& law) const {
    if (is_force_controlled()) return drive_.end() < 0.0;
    const double distance = drive_.direction() * (drive_.end() - law.opening(branch_));
    return k_passed_at_end == PassedAtEnd::none ? distance > 0.0 : distance >= 0.0;
  }

  // --- transitions

  /// Sets the drive of the wall for a step. Values that differ by round-off count as equal: a wall at rest goes on from
  /// where it is, a wall at its dent is not pressed in again, and a ramp between two equal values lets the wall rest.
  /// @param left_at      displacement of the contact at the end of the last step; used if the ramp is one of force
  /// @param takes_force  false: no force has ever moved the wall
  /// @param approach_by_centre  by how much a free centre has moved towards the wall
  /// @return displacement of the contact
  double set_drive(const Law& law, WallDrive drive, double left_at, bool takes_force, double approach_by_centre) {
    const bool is_by_force = drive.is_force_controlled();
    if (drive_.direction() == 0 && is_force_controlled() == is_by_force) drive.start_at(drive_.end());
    if (!touches_ && !is_by_force) {
      const double opening = law.opening(branch_);
      if (std::abs(drive.start() + approach_by_centre - opening) <= k_same_value * opening)
        drive.start_at(opening - approach_by_centre);
    }
    const double d = is_by_force ? left_at : drive.start() + approach_by_centre;
    double size = drive.size();
    if (touches_ && takes_force && d > law.opening(branch_)) size += size_of_reached(law, d, is_by_force);
    if (std::abs(drive.rate()) <= k_same_value * size) drive.rest();
    // An integrated displacement has an error: the step begins at the exact displacement under its first force.
    const bool is_integrated_on = is_by_force && is_integrated(law);
    drive_ = drive;
    return is_integrated_on ? displacement_under(law, drive_.start(), d) : d;
  }

  /// Decides the branch at the start of a step, where the wall is at d.
  /// @param is_seen  true: a contact that is made then is an event
  /// @param approach_by_centre  by how much a free centre has moved towards the wall
  std::optional<DomainEnd> begin_step(Law& law, double d, bool is_seen, std::vector<Event>& log,
                                      double approach_by_centre) {
    const bool goes_in = drive_.direction() > 0;
    if (!touches_) {
      resting_ = d - approach_by_centre;
      const bool is_pressed = is_force_controlled() && drive_.start() > 0.0;
      const bool meets = goes_in && (is_force_controlled() || d >= law.opening(branch_));
      if (is_pressed || meets) make(law, is_seen, log);
    } else if (drive_.direction() < 0) {
      // A wall that has only touched leaves no dent.
      if (is_on_primary_branch_ && d > law.opening(branch_)) turn(law, d, "load-reversal", log);
      if (is_force_controlled() ? drive_.start() <= 0.0 : d <= law.opening(branch_)) lose(law, log, approach_by_centre);
    }
    return touches_ && goes_in ? pass_reached(law, 0.0, log) : std::nullopt;
  }

  /// Begins to unload at d.
  /// @throws DomainError for a law without unloading
  void turn(Law& law, double d, std::string_view event, std::vector<Event>& log) {
    if constexpr (requires { law.refuses_unloading(); }) {
      if (const auto remark = law.refuses_unloading())
        throw DomainError({Limit::no_unloading_law, index_, "displacement/R0", d}, *remark);
    }
    largest_ = d;
    largest_force_ = is_force_controlled() ? drive_.start() : law.force(branch_, d);
    is_on_primary_branch_ = false;
    if constexpr (requires { law.turn(branch_, d); }) law.turn(branch_, d);
    log.push_back({event, index_});
  }
  void make(Law& law, bool is_seen, std::vector<Event>& log) {
    touches_ = has_touched_ = true;
    if (is_seen) log.push_back({made_event(law), index_});
  }
  void lose(Law& law, std::vector<Event>& log, double approach_by_centre) {
    touches_ = false;
    resting_ = law.opening(branch_) - approach_by_centre;
    log.push_back({"contact-lost", index_});
  }
  /// Takes the contact beyond a boundary.
  /// @return the reason to stop, if the law ends there
  std::optional<DomainEnd> pass(Law& law, const Boundary& boundary, std::vector<Event>& log) {
    const Event event{boundary.event, index_};
    if (!event.name.empty() && !boundary.is_of_followers) log.push_back(event);
    for (const int follower : followers_) {
      if (!event.name.empty() && boundary.is_of_followers) log.push_back({event.name, follower});
    }
    if (boundary.limit) {
      DomainEnd end{event, *boundary.limit};
      end.point.contact_class = index_;
      return end;
    }
    if (is_on_primary_branch_) {
      if constexpr (requires { law.pass(branch_); }) law.pass(branch_);
    } else {
      is_on_primary_branch_ = true;
      if constexpr (requires { law.reload(branch_); }) law.reload(branch_);
    }
    return std::nullopt;
  }
  /// Takes the contact beyond all boundaries that a rising ramp has reached. A wall may stand at the end of the law,
  /// but not go on.
  /// @return the reason to stop, if the wall would go on beyond the end of the law
  std::optional<DomainEnd> pass_reached(Law& law, double xi, std::vector<Event>& log) {
    while (const auto ahead = next(law)) {
      const double at = prescribed_at(law, *ahead);
      if (!drive_.has_reached(at, xi) || (ahead->limit && !passes(at))) break;
      if (const auto end = pass(law, *ahead, log)) return end;
    }
    return std::nullopt;
  }

  [[nodiscard]] std::string_view made_event(const Law& law) const {
    if constexpr (requires { law.made_event(branch_); }) return law.made_event(branch_);
    return "contact-made";
  }

  /// Contact on its primary branch after every boundary below the larger of a displacement and a force.
  [[nodiscard]] static WallContact pressed_to(Law& law, double displacement, double force) {
    WallContact c(0, 0.0);
    c.touches_ = true;
    for (auto ahead = c.next(law); ahead && !ahead->limit; ahead = c.next(law)) {
      if (!(displacement > ahead->position || force > law.force(c.branch_, ahead->position))) break;
      if constexpr (requires { law.pass(c.branch_); }) law.pass(c.branch_);
    }
    return c;
  }

 private:
  static constexpr bool k_has_powers = requires(const Law& law, const Branch& b) { law.coordinate_power(b); };
  static constexpr PassedAtEnd k_passed_at_end = [] {
    if constexpr (requires { Law::k_passed_at_end; }) return Law::k_passed_at_end;
    return PassedAtEnd::opening;
  }();

  /// Magnitude whose round-off a ramp has that begins where another control has led: a force that holds a wall has the
  /// round-off of the wall's displacement, a displacement reached under a force that of the force.
  [[nodiscard]] double size_of_reached(const Law& law, double d, bool is_by_force) const {
    const double slope = law.slope(branch_, d);
    if (is_by_force) return slope * std::abs(d);
    return slope > 0.0 ? law.force(branch_, d) / slope + std::abs(d) : 0.0;
  }
  [[nodiscard]] double prescribed_per_coordinate() const noexcept {
    return is_force_controlled() ? force_per_coordinate_ : 1.0;
  }
  /// dF/dd where the contact bears a force > 0.
  [[nodiscard]] double slope_under(const Law& law, double force) const {
    if constexpr (requires { law.slope_under(branch_, force); }) return law.slope_under(branch_, force);
    return law.slope(branch_, law.displacement(branch_, force));
  }
  /// Slope for the coordinate u = d^n. Odd in u, so that a trial step below zero stays smooth.
  [[nodiscard]] Slope slope_of_power(const Law& law, double n, double u) const {
    // Up to this displacement, where powers of it underflow, the force is linear in u.
    constexpr double k_nearest = 1e-100;
    const double d = std::pow(std::abs(u), 1.0 / n);
    const double by_displacement_of_u = n * std::pow(d, n - 1.0);
    if (d <= k_nearest) {
      const double by_coordinate = law.force(branch_, k_nearest) / std::pow(k_nearest, n);
      return {by_coordinate * u, by_coordinate, by_coordinate * by_displacement_of_u};
    }
    const auto [force, by_displacement] = law.force_and_slope(branch_, d);
    return {std::copysign(force, u), by_displacement / by_displacement_of_u, by_displacement};
  }

  int index_ = 0;
  double force_per_coordinate_ = 1.0;
  std::vector<int> followers_;
  WallDrive drive_;
  Branch branch_{};
  bool touches_ = false;
  bool has_touched_ = false;
  bool is_on_primary_branch_ = true;  ///< the contact is at its largest displacement
  double largest_ = 0.0;              ///< off the primary branch: displacement at which it was left
  double largest_force_ = 0.0;        ///< off the primary branch: force where it was left
  double resting_ = 0.0;              ///< displacement of the wall at which it was left open, without load
};

}  // namespace monograin::contacts
