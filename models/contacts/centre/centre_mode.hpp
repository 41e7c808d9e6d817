/// Contacts around a free centre in a mode: position and velocity of the centre, the contacts that bear, and the guards
/// that end the mode. The functions of a law are listed in contacts/independent.hpp; lengths are over R0, forces over
/// the law's unit.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "contacts/centre/free_centre.hpp"
#include "contacts/centre/obstacles.hpp"
#include "contacts/guards.hpp"
#include "system/equations.hpp"

namespace monograin::contacts {

template <class Law>
class CentreMode {
 public:
  using Contact = WallContact<Law>;
  using Vector = FreeCentre::Vector;

  /// A law and its contacts at a state.
  struct State {
    const Law& law;
    std::span<const Contact> contacts;
    double xi;
    std::span<const double> y;

    [[nodiscard]] State later(double by) const { return {law, contacts, xi + by, y}; }
  };
  /// A law, its contacts and the log of their events where a mode begins.
  struct Beginning {
    Law& law;
    std::span<Contact> contacts;
    double xi;
    std::span<const double> y;
    std::vector<Event>& log;
  };

  /// Appends the unknowns of the centre.
  /// @param reach  largest displacement that is expected
  CentreMode(std::span<const ContactClass> classes, double reach, std::vector<Unknown>& unknowns)
      : centre_(classes), slot_(unknowns.size()), reach_(reach), roles_(classes.size()), rates_(classes.size()) {
    for (std::size_t k = 0; k < free_directions(); ++k) {
      unknowns.push_back({.name = k_centre_unknowns[k],
                          .kind = Unknown::Kind::algebraic,
                          .scale = reach,
                          .is_algebraic_in_residual = true,
                          .is_dependent = true});
    }
  }

  // --- where the centre is

  [[nodiscard]] Eigen::Vector3d in_space(std::span<const double> y) const { return centre_.in_space(position(y)); }
  /// n.c, by how much the centre has moved towards the walls of a class.
  [[nodiscard]] double approach_by_centre(std::size_t i, std::span<const double> y) const {
    return centre_.approach_by_centre(i, position(y));
  }
  /// Approach of wall and particle, the displacement that a law takes.
  /// @param d  displacement of the wall; of a touching wall under force control, the approach itself
  [[nodiscard]] double approach(const State& at, std::size_t i, double d) const {
    const Contact& c = at.contacts[i];
    const double opening = at.law.opening(c.branch());
    const double by_centre = approach_by_centre(i, at.y);
    if (c.is_force_controlled()) {
      // An open wall without load stays where it was left, until the particle pushes it.
      return c.touches() ? d : std::min(d + by_centre, opening);
    }
    const double overlap = d + by_centre - opening;
    const bool is_idle = c.touches() && std::abs(overlap) <= FreeCentre::k_bearing_overlap;
    return is_idle ? opening : opening + overlap;
  }
  /// Writes the position of the centre that balances the forces.
  void move(const Law& law, std::span<const Contact> contacts, double xi, std::span<double> y) {
    if (free_directions() == 0) return;
    write_position(centre_.equilibrium(Instant({law, contacts, xi, y}), roles_, rest_, position(y)), y);
  }
  /// Writes the rates of the centre, with which integrators begin: difference quotients, not singular at first touch.
  void write_rates(const State& at, std::span<double> dy) {
    const Vector now = position(at.y);
    const Vector then = centre_.equilibrium(Instant(at.later(ahead_)), roles_, rest_, now);
    for (std::size_t k = 0; k < free_directions(); ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      dy[slot_ + k] = (then[axis] - now[axis]) / ahead_;
    }
  }
  /// Rate of the work of one wall. A wall under force moves by the rate of its contact's displacement, less the motion
  /// of the centre towards it.
  /// @param now       slope of the contact's coordinate
  /// @param velocity  velocity of the centre
  [[nodiscard]] double power(const State& at, std::size_t i, const typename Contact::Slope& now,
                             const Vector& velocity) const {
    const Contact& c = at.contacts[i];
    if (c.is_force_controlled()) {
      const double force = c.prescribed_force(at.xi);
      return force > 0.0 ? c.power(at.law, at.xi, now) - force * centre_.approach_by_centre(i, velocity) : 0.0;
    }
    const double d = approach(at, i, c.drive().value(at.xi));
    return c.bears(at.law, d) ? at.law.force(c.branch(), d) * c.drive().rate() : 0.0;
  }
  /// Velocity of the centre.
  [[nodiscard]] Vector velocity(const State& at) {
    for (std::size_t i = 0; i < at.contacts.size(); ++i) {
      const Contact& c = at.contacts[i];
      rates_[i] = c.touches() || !c.is_force_controlled() ? c.drive().rate() : 0.0;
    }
    return centre_.velocity(Instant(at), roles_, rates_, position(at.y));
  }

  // --- the mode

  /// Reads the ramps of a step, sets how far ahead the modes of the step are decided, and carries a loose particle
  /// to walls that can bear the prescribed forces.
  void begin_step(const Law& law, std::span<const Contact> contacts, std::span<double> y) {
    fastest_wall_ = 0.0;
    for (const Contact& c : contacts) {
      if (!c.is_force_controlled()) fastest_wall_ = std::max(fastest_wall_, std::abs(c.drive().rate()));
    }
    ahead_ = std::clamp(1e3 * k_resolution / fastest_wall_, k_least_ahead, k_most_ahead);
    if (const auto c = support_of_loose_particle(law, contacts, y)) write_position(*c, y);
  }
  /// Decides which walls touch, which contacts bear and which ones turn in the mode that begins, by evaluating a little
  /// ahead. Contacts depend on each other through the centre: the search assumes a mode, evaluates and corrects it, and
  /// repeats that until it is consistent.
  /// @param is_decided  contact -> whether a guard has just decided about it
  /// @param is_seen     contact -> whether touching is an event
  /// @return the reason to stop, if a contact reaches the end of its law
  /// @throws DomainError if no mode is consistent
  template <class IsDecided, class IsSeen>
  std::optional<DomainEnd> find(const Beginning& begin, IsDecided&& is_decided, IsSeen&& is_seen) {
    const auto& [law, contacts, xi, y, log] = begin;
    const State at{law, contacts, xi, y};
    const State ahead = at.later(ahead_);
    rest_ = position(y);
    // Each contact changes a few times at most; beyond that, contacts alternate.
    for (std::size_t round = 0; round <= 4 * contacts.size() + 8; ++round) {
      Vector then = rest_;
      centre_.find_roles(Instant(at), Instant(ahead), then, roles_);
      bool has_changed = false;
      for (std::size_t i = 0; i < contacts.size(); ++i) {
        Contact& c = contacts[i];
        if (c.is_force_controlled() || is_decided(i)) continue;
        Change change{.now = overlap(at, i, rest_),
                      .then = overlap_as_touching(ahead, i, then),
                      .approach_by_centre = centre_.approach_by_centre(i, rest_),
                      .turning = xi == 0.0 ? "load-reversal" : "retreat"};
        find_touch(law, c, change, is_seen(i), log);
        if (const auto end = find_branch(law, c, change, log, has_changed)) return end;
      }
      if (!has_changed) return std::nullopt;
    }
    throw DomainError(Limit::no_consistent_regimes);
  }

  // --- guards of the contacts that depend on where the centre is

  /// Arms the guards of a contact. The target of a boundary is a displacement, those of the others are overlaps. A wall
  /// within k_touch of touching has to leave that band on the other side, so that its guard does not begin at a root.
  void arm_guards(const State& at, std::size_t i, Guards& guards) const {
    const Contact& c = at.contacts[i];
    const double present = overlap(at, i, position(at.y));
    const auto add = [&](GuardKind kind, int direction, std::string_view name, double target) {
      guards.add({.kind = kind, .index = static_cast<int>(i), .direction = direction, .name = name}, target);
    };
    if (!c.touches()) {
      add(k_made, 1, c.made_event(at.law), present >= -k_touch ? k_touch : 0.0);
      return;
    }
    add(k_lost, -1, "contact-lost", present <= k_touch ? -k_touch : 0.0);
    if (const auto ahead = c.next(at.law)) add(k_boundary, 1, ahead->event, ahead->position);
    if (c.is_on_primary_branch() && roles_[i] == Role::bearing) add(k_retreat, -1, "retreat", 0.0);
  }
  /// Value of a guard that arm_guards() has listed.
  /// @param velocity  velocity of the centre; only guards of retreat use it
  [[nodiscard]] double guard_value(const State& at, const Guard& guard, double target, const Vector& velocity) {
    const std::size_t i = guard.list_index();
    const WallDrive& drive = at.contacts[i].drive();
    if (guard.kind == k_retreat) {
      // The dent of a contact near the resolution would vanish with it, and round-off decides which of several such
      // contacts carry the centre. The positive value does not fire.
      if (overlap(at, i, position(at.y)) <= 10.0 * k_touch) return k_at_rest / reach_;
      // The rate of a contact at rest is round-off.
      const double fastest = std::max(velocity.norm(), fastest_wall_);
      return (drive.rate() + centre_.approach_by_centre(i, velocity) + k_at_rest * fastest) / reach_;
    }
    if (guard.kind == k_boundary) return (drive.value(at.xi) + approach_by_centre(i, at.y) - target) / reach_;
    return (overlap_as_touching(at, i, position(at.y)) - target) / reach_;
  }

 private:
  /// Bounds of the time (in step coordinates) by which a mode is decided ahead; briefer modes are missed. The slower
  /// the walls, the farther ahead, so that the fastest wall moves by a thousand times the resolution, which is more
  /// than round-off of the balance; the fixed k_ahead serves where a mode is read from rates or one contact alone.
  static constexpr double k_least_ahead = 1e-6;
  static constexpr double k_most_ahead = 1e-3;
  /// Change of an overlap (over R0), from an instant to the one ahead, that is round-off.
  static constexpr double k_no_change = k_zero_guard;
  /// Gap or overlap (over R0) up to which wall and particle just meet; a contact is lost when its gap becomes larger.
  static constexpr double k_touch = k_resolution;

  /// The walls around the centre at one instant.
  class Instant final : public CentreWalls {
   public:
    explicit Instant(const State& at) : law_(at.law), contacts_(at.contacts), xi_(at.xi) {}
    [[nodiscard]] std::optional<double> prescribed_force(std::size_t i) const override {
      const Contact& c = contacts_[i];
      return c.is_force_controlled() ? std::optional(c.prescribed_force(xi_)) : std::nullopt;
    }
    [[nodiscard]] double overlap(std::size_t i) const override {
      return contacts_[i].drive().value(xi_) - law_.opening(contacts_[i].branch());
    }
    [[nodiscard]] Force force(std::size_t i, double overlap) const override {
      const auto& branch = contacts_[i].branch();
      const double d = law_.opening(branch) + overlap;
      return {law_.force(branch, d), law_.slope(branch, d)};
    }
    [[nodiscard]] double overlap_under(std::size_t i, double force) const override {
      const Contact& c = contacts_[i];
      const auto& branch = c.branch();
      const auto end = c.next(law_);
      const bool is_beyond = end && force >= law_.force(branch, end->position);
      return (is_beyond ? end->position : law_.displacement(branch, force)) - law_.opening(branch);
    }

   private:
    const Law& law_;
    std::span<const Contact> contacts_;
    double xi_;
  };

  /// Overlap of a contact where a mode begins, and a little later.
  struct Change {
    double now = 0.0;
    double then = 0.0;
    double approach_by_centre = 0.0;  ///< where the mode begins
    std::string_view turning{};       ///< event of beginning to unload
  };

  [[nodiscard]] std::size_t free_directions() const noexcept {
    return static_cast<std::size_t>(centre_.free_directions());
  }
  [[nodiscard]] Vector position(std::span<const double> y) const noexcept {
    Vector c = Vector::Zero();
    for (std::size_t k = 0; k < free_directions(); ++k) c[static_cast<Eigen::Index>(k)] = y[slot_ + k];
    return c;
  }
  void write_position(const Vector& c, std::span<double> y) const noexcept {
    for (std::size_t k = 0; k < free_directions(); ++k) y[slot_ + k] = c[static_cast<Eigen::Index>(k)];
  }
  /// Position at which a particle that no contact holds comes to rest under the forces that begin with a step: between
  /// walls that bear them. No force resists the motion, which takes no time.
  /// @return none if a contact bears already, if no force begins, or if no wall is in the path
  [[nodiscard]] std::optional<Vector> support_of_loose_particle(const Law& law, std::span<const Contact> contacts,
                                                                std::span<const double> y) const {
    const Vector rest = position(y);
    Vector push = Vector::Zero();
    double sum = 0.0;
    std::vector<Obstacle> walls;
    std::vector<char> touches;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      const Contact& c = contacts[i];
      const Vector& mean_normal = centre_.lines().mean_normal(i);
      if (c.is_force_controlled()) {
        if (c.prescribed_force(0.0) > 0.0) return std::nullopt;
        const double force = centre_.wall_count(i) * c.prescribed_force(1.0);
        push += force * mean_normal;
        sum += force;
        continue;
      }
      const double overlap = c.drive().start() - law.opening(c.branch());
      const double now = overlap + centre_.approach_by_centre(i, rest);
      if (now > k_touch) return std::nullopt;
      if (!centre_.lines().acts(i)) continue;
      walls.push_back({i, mean_normal, overlap});
      touches.push_back(now >= -k_touch);
    }
    if (!(push.norm() > k_round_off * sum)) return std::nullopt;
    return carried_to_support(push, walls, touches, rest);
  }
  /// Overlap of a contact with the centre at c; negative for a gap.
  [[nodiscard]] double overlap(const State& at, std::size_t i, const Vector& c) const {
    const Contact& contact = at.contacts[i];
    return contact.drive().value(at.xi) + centre_.approach_by_centre(i, c) - at.law.opening(contact.branch());
  }
  /// Overlap of a contact; negative for a gap. The overlap of an idle wall stays zero while the wall pushes the centre:
  /// for that, gives the overlap that it would have if it did not push.
  [[nodiscard]] double overlap_as_touching(const State& at, std::size_t i, const Vector& c) {
    if (roles_[i] != Role::idle) return overlap(at, i, c);
    return centre_.unpushed_overlap(i, Instant(at), roles_, rest_, c);
  }
  /// Makes or loses a contact whose wall and particle just meet, by its overlap a little later.
  static void find_touch(Law& law, Contact& c, const Change& change, bool is_seen, std::vector<Event>& log) {
    const bool will_touch = change.then > k_no_change;
    if (will_touch && !c.touches() && change.now >= -k_touch) c.make(law, is_seen, log);
    if (!will_touch && c.touches() && change.now <= k_touch) c.lose(law, log, change.approach_by_centre);
  }
  /// Turns a contact that is about to unload, or takes it beyond the boundaries that it is about to pass.
  /// @return the reason to stop, if the contact reaches the end of its law
  static std::optional<DomainEnd> find_branch(Law& law, Contact& c, const Change& change, std::vector<Event>& log,
                                              bool& has_changed) {
    if (!c.touches()) return std::nullopt;
    const double opening = law.opening(c.branch());
    if (change.then < change.now - k_no_change && c.is_on_primary_branch() && change.now > k_no_change) {
      c.turn(law, opening + change.now, change.turning, log);
      has_changed = true;
    } else if (change.then > change.now + k_no_change) {
      while (const auto ahead = c.next(law)) {
        const double overlap = ahead->position - opening;
        if (!(change.then > overlap) || change.now < overlap - k_no_change) break;
        if (const auto end = c.pass(law, *ahead, log)) return end;
        has_changed = true;
      }
    }
    return std::nullopt;
  }

  FreeCentre centre_;
  std::size_t slot_ = 0;  ///< index in y of the first coordinate of the centre
  double reach_ = 1.0;
  Vector rest_ = Vector::Zero();  ///< position of the centre when the present mode began
  std::vector<Role> roles_;
  double fastest_wall_ = 0.0;  ///< rate of the fastest wall under displacement control
  double ahead_ = k_least_ahead;
  std::vector<double> rates_;  ///< rates of the prescribed displacements and forces
};

}  // namespace monograin::contacts
