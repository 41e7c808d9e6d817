/// One contact class by a law: what it remembers, where it is at an instant, and its transitions. The functions of a
/// law are listed in contacts/independent.hpp; displacements are over R0, forces over the law's unit.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "contacts/wall_drive.hpp"
#include "system/hybrid_system.hpp"

namespace monograin::contacts {

/// End of a part of the primary loading branch.
struct Boundary {
  double position = 0.0;              ///< displacement over R0; still belongs to the part before
  std::string_view event{};           ///< empty: nothing is seen of it
  std::optional<LimitPoint> limit{};  ///< the law ends here
};

template <class Law>
class WallContact {
 public:
  using Branch = typename Law::Branch;

  WallContact() = default;
  /// An open wall at a displacement.
  WallContact(int index, double at) : index_(index), drive_({at, at, Control::displacement}, 1.0), resting_(at) {}

  [[nodiscard]] const WallDrive& drive() const noexcept { return drive_; }
  [[nodiscard]] const Branch& branch() const noexcept { return branch_; }
  [[nodiscard]] bool touches() const noexcept { return touches_; }
  [[nodiscard]] bool has_touched() const noexcept { return has_touched_; }
  [[nodiscard]] bool is_force_controlled() const noexcept { return drive_.is_force_controlled(); }

  // --- at an instant

  [[nodiscard]] double displacement_under(const Law& law, double force) const {
    if (!touches_) return resting_;
    return force > 0.0 ? law.displacement(branch_, force) : law.opening(branch_);
  }
  [[nodiscard]] double displacement(const Law& law, double xi) const {
    return is_force_controlled() ? displacement_under(law, drive_.value(xi)) : drive_.value(xi);
  }
  /// Rate of the work of one wall: F dd, which is F dF/(dF/dd) where the force is prescribed.
  [[nodiscard]] double power(const Law& law, double xi) const {
    if (!touches_) return 0.0;
    const double prescribed = drive_.value(xi);
    if (!is_force_controlled()) return drive_.rate() * law.force(branch_, prescribed);
    if (!(prescribed > 0.0)) return 0.0;
    return drive_.rate() * prescribed / law.slope(branch_, law.displacement(branch_, prescribed));
  }
  /// True if the contact bears a force that can be told from none. A prescribed displacement is known but for
  /// round-off: a wall that stands where it meets the particle, or parts from it, is not pressed by that.
  [[nodiscard]] bool bears(const Law& law, double d) const {
    constexpr double k_round_off = 4.0 * std::numeric_limits<double>::epsilon();
    if (!touches_) return false;
    const double least = is_force_controlled() ? 0.0 : k_round_off * std::max(drive_.size(), largest_);
    return d - law.opening(branch_) > least;
  }
  /// Force on a particle that the wall may have left, or not met, within round-off.
  [[nodiscard]] double visible_force(const Law& law, double xi) const {
    const double prescribed = drive_.value(xi);
    if (is_force_controlled()) return touches_ ? std::max(prescribed, 0.0) : 0.0;
    return bears(law, prescribed) ? law.force(branch_, prescribed) : 0.0;
  }

  /// The boundary ahead of a contact that is pressed on: below its largest displacement, that.
  [[nodiscard]] std::optional<Boundary> next(const Law& law) const {
    if (!is_on_primary_branch_) return Boundary{largest_, "reload"};
    if constexpr (requires { law.next(branch_); }) return law.next(branch_);
    return std::nullopt;
  }
  /// What the program prescribes the contact at a boundary.
  [[nodiscard]] double prescribed_at(const Law& law, const Boundary& boundary) const {
    if (!is_force_controlled()) return boundary.position;
    return is_on_primary_branch_ ? law.force(branch_, boundary.position) : largest_force_;
  }

  // --- transitions

  void take_up(const WallDrive& drive) noexcept { drive_ = drive; }

  /// Decides the branch at the start of a step, where the wall is at d.
  /// @param is_seen  a contact that is made then is an event
  std::optional<DomainEnd> begin_step(Law& law, double d, bool is_seen, std::vector<Event>& log) {
    const bool goes_in = drive_.direction() > 0;
    if (!touches_) {
      resting_ = d;
      const bool is_pressed = is_force_controlled() && drive_.start() > 0.0;
      const bool meets = goes_in && (is_force_controlled() || d >= law.opening(branch_));
      if (is_pressed || meets) make(law, is_seen, log);
    } else if (drive_.direction() < 0) {
      // A wall that has only touched leaves no dent.
      if (is_on_primary_branch_ && d > law.opening(branch_)) turn(law, d, log);
      if (is_force_controlled() ? drive_.start() <= 0.0 : d <= law.opening(branch_)) lose(law, log);
    }
    return touches_ && goes_in ? pass_reached(law, 0.0, log) : std::nullopt;
  }

  void make(Law& law, bool is_seen, std::vector<Event>& log) {
    touches_ = has_touched_ = true;
    if (is_seen) log.push_back({made_event(law), index_});
  }
  void lose(Law& law, std::vector<Event>& log) {
    touches_ = false;
    resting_ = law.opening(branch_);
    log.push_back({"contact-lost", index_});
  }
  /// Goes beyond a boundary.
  std::optional<DomainEnd> pass(Law& law, const Boundary& boundary, std::vector<Event>& log) {
    const Event event{boundary.event, index_};
    if (!event.name.empty()) log.push_back(event);
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
  /// Goes beyond all boundaries that a rising wall has reached. At the end of the law it may stand, but not go on.
  std::optional<DomainEnd> pass_reached(Law& law, double xi, std::vector<Event>& log) {
    while (const auto ahead = next(law)) {
      const double at = prescribed_at(law, *ahead);
      if (!drive_.has_reached(at, xi) || (ahead->limit && !drive_.goes_beyond(at))) break;
      if (const auto end = pass(law, *ahead, log)) return end;
    }
    return std::nullopt;
  }

  [[nodiscard]] std::string_view made_event(const Law& law) const {
    if constexpr (requires { law.made_event(branch_); }) return law.made_event(branch_);
    return "contact-made";
  }

  /// A contact as far along its primary branch as a displacement or a force takes it, and not beyond the law's end.
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
  static constexpr bool k_has_boundaries = requires(Law & law, Branch& b) {
    law.next(b);
    law.pass(b);
  };

  void turn(Law& law, double d, std::vector<Event>& log) {
    largest_ = d;
    largest_force_ = is_force_controlled() ? drive_.start() : law.force(branch_, d);
    is_on_primary_branch_ = false;
    if constexpr (requires { law.turn(branch_, d); }) law.turn(branch_, d);
    log.push_back({"load-reversal", index_});
  }

  int index_ = 0;
  WallDrive drive_;
  Branch branch_{};
  bool touches_ = false;
  bool has_touched_ = false;
  bool is_on_primary_branch_ = true;  ///< at its largest displacement
  double largest_ = 0.0;              ///< off the primary branch: displacement at which it was left
  double largest_force_ = 0.0;        ///< and the force there
  double resting_ = 0.0;              ///< displacement at which an open wall without load was left
};

}  // namespace monograin::contacts
