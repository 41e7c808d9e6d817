/// Contacts that each depend on their own wall alone, as a hybrid system: all that such laws share. A law describes one
/// contact. Displacements are over the particle's radius R0, forces over the law's unit. The displacement d of a
/// contact is the approach of wall and particle: the displacement of the wall plus that of a free centre towards it.
///
/// A law has
///   Branch, k_regimes           memory of a contact (Branch{}: a fresh contact); words of its regimes
///   unit_force(R0)              [N]
///   force(b, d), slope(b, d)    on a branch, also a little beyond its ends; dF/dd > 0 inside
///   displacement(b, F)          the inverse of force, for F > 0
///   opening(b)                  displacement at which wall and particle part, and meet
///   regime(b, touches)          index of a word
/// and may have
///   work(b, d)                  primitive of the force up to a constant; without it the work is integrated
///   is_work_costly(b)           true if the work costs tens of evaluations of the force
///   stored(b, d)                energy that unloading gives back; has_stored_energy(): whether there is any
///   contact(b, d)               force and contact radius, where the law knows the contact area
///   next(b), pass(b)            boundary ahead on the primary loading branch; what changes there
///   turn(b, d), reload(b)       changes where unloading begins at d, and back there; without them unloading retraces
///                               loading
///   refuses_unloading()         advice if the law ends when a contact begins to unload; none if it does not
///   k_is_tested                 true if tests compare the functions with each other, so that model_of() need not
///   k_passed_at_end             which boundaries count as passed by a step that ends at them
///   made_event(b)               name of the event of touching, if it is not "contact-made"
///   surface(b, d)               points of the surface; pressures over unit_force/R0^2
///   follows(walls)              true for followers: contacts that do no work and follow the leader, the first contact
///                               that is no follower
///   follower(b, touches, d)     what a row shows of a follower, from branch and displacement of the leader
///   start(), note(d), warnings(walls)
///                               resets the memory of a run, notes a displacement of a row, gives the run's warnings;
///                               walls: how many have touched
/// and, where an inverse in closed form is missing or loses digits,
///   coordinate_power(b), is_integrated(b), force_and_slope(b, d), displacement(b, F, near)
///                               see the coordinates in contacts/wall_contact.hpp
///   slope_under(b, F)           dF/dd where the force is F
///   magnitudes(d)               see contacts/scales.hpp
///
/// Unknowns: a coordinate of every wall whose force is prescribed at some time, the work of the walls, and the position
/// of a free centre, which the balance of forces determines at every instant. With a fixed centre, guards are functions
/// of the program alone.
#pragma once

#include <optional>
#include <stdexcept>
#include <utility>

#include "contacts/centre/centre_mode.hpp"
#include "contacts/followers.hpp"
#include "contacts/guards.hpp"
#include "contacts/scales.hpp"
#include "contacts/visible.hpp"
#include "system/hybrid_system.hpp"
#include "system/resolution.hpp"

namespace monograin::contacts {

struct Settings {
  double initial_radius = 1.0;  ///< R0 [m], > 0
  /// Largest prescribed displacement [m] and force [N]; 0: unknown. Only the scales of the unknowns depend on it.
  Reach reach{};
  bool centre_is_free = false;  ///< the centre moves so that the forces balance
};

template <class Law>
class IndependentContacts final : public HybridSystem {
 public:
  IndependentContacts(Law law, const Settings& settings, std::vector<ContactClass> classes)
      : law_(std::move(law)),
        units_{settings.initial_radius, law_.unit_force(settings.initial_radius)},
        classes_(std::move(classes)),
        contacts_(classes_.size()),
        slots_(classes_.size()),
        approaches_(classes_.size()),
        followers_(law_, classes_),
        columns_({stores_energy(), k_has_contact_area<Law>, settings.centre_is_free}, Law::k_regimes, classes_),
        scales_(scales_of(law_, settings.reach.displacement / units_.length, settings.reach.force / units_.force)) {
    for (std::size_t i = 0; i < classes_.size(); ++i) {
      if (!classes_[i].takes_force) continue;
      slots_[i] = unknowns_.size();
      unknowns_.push_back({.name = classes_[i].name, .scale = scales_.coordinate, .is_algebraic_in_residual = true});
    }
    work_slot_ = unknowns_.size();
    unknowns_.push_back({.name = "work", .kind = Unknown::Kind::quadrature, .scale = scales_.magnitudes.work});
    if (settings.centre_is_free) centre_.emplace(classes_, scales_.reach, unknowns_);
    trial_.resize(unknowns_.size());
  }

  [[nodiscard]] std::span<const Unknown> unknowns() const noexcept override { return unknowns_; }
  [[nodiscard]] std::span<const ContactClass> classes() const noexcept override { return classes_; }
  [[nodiscard]] std::span<const Guard> guards() const noexcept override { return guards_.list(); }
  [[nodiscard]] std::span<const Observable> observables() const noexcept override { return columns_.observables(); }
  [[nodiscard]] bool is_open(int contact_class) const noexcept override {
    const auto i = static_cast<std::size_t>(contact_class);
    const Contact& c = contacts_[followers_.leading(i)];
    return followers_.follows(i) ? law_.regime(c.branch(), c.touches()) == 0 : !c.touches();
  }
  [[nodiscard]] std::function<void()> checkpoint() override {
    return [this, then = *this] { *this = then; };
  }

  void start(std::span<double> y) override {
    std::ranges::fill(y, 0.0);
    has_begun_ = false;
    if constexpr (requires(Law & law) { law.start(); }) law_.start();
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      contacts_[i] = Contact(static_cast<int>(i), -classes_[i].gap / units_.length, scales_.force_per_coordinate,
                             followers_.of(i));
    }
    solve(0.0, y);
  }

  void begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) override {
    std::vector<double> begin(contacts_.size());  // approaches
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      const bool is_by_force = ramps[i].control == Control::force;
      const WallDrive drive(ramps[i], is_by_force ? units_.force : units_.length);
      begin[i] = contacts_[i].set_drive(law_, drive, left_at(i, y), classes_[i].takes_force, approach_by_centre(i, y));
      // y takes the coordinates of this step even if the step cannot begin, so that the last row shows its start.
      if (classes_[i].takes_force) y[slots_[i]] = contacts_[i].coordinate(law_, 0.0, begin[i]);
    }
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      if (followers_.follows(i) || depends_on_centre(i)) continue;
      if (const auto end = contacts_[i].begin_step(law_, begin[i], is_seen(i), log, approach_by_centre(i, y)))
        throw CannotBegin(*end);
    }
    if (centre_) centre_->begin_step(law_, contacts_, y);
    if (const auto end = find_mode(0.0, y, log, {})) throw CannotBegin(*end);
    has_begun_ = true;
    solve(0.0, y);
    arm_guards(0.0, y);
  }

  void complete(double xi, std::span<double> y) override { solve_for(xi, y, false); }
  void solve(double xi, std::span<double> y) override { solve_for(xi, y, true); }

  void rates(double xi, std::span<const double> y, std::span<double> dy) override {
    const FreeCentre::Vector velocity = centre_velocity(xi, y);
    dy[work_slot_] = sum([&](std::size_t i) {
      const auto now = contacts_[i].slope(law_, coordinate(i, y));
      if (classes_[i].takes_force) dy[slots_[i]] = contacts_[i].rate(now);
      return power(i, xi, y, now, velocity);
    });
  }
  void all_rates(double xi, std::span<const double> y, std::span<double> dy) override {
    rates(xi, y, dy);
    if (centre_) centre_->write_rates(state(xi, y), dy);
  }

  void residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) override {
    // The balance of forces gives the position of the centre, so that a trial's own position does not enter the work.
    std::ranges::copy(y, trial_.begin());
    if (centre_) centre_->move(law_, contacts_, xi, trial_);
    for (std::size_t k = work_slot_ + 1; k < y.size(); ++k) res[k] = y[k] - trial_[k];
    const FreeCentre::Vector velocity = centre_velocity(xi, trial_);
    res[work_slot_] = dy[work_slot_] - sum([&](std::size_t i) {
                        const auto now = contacts_[i].slope(law_, coordinate(i, y));
                        if (classes_[i].takes_force)
                          res[slots_[i]] = contacts_[i].residual(law_, xi, y[slots_[i]], now);
                        return power(i, xi, trial_, now, velocity);
                      });
  }

  [[nodiscard]] std::optional<double> closed_quadrature(double xi, std::span<const double> y) override {
    if constexpr (k_has_work) {
      // With a free centre the sum still is the work of the walls: the forces on the centre balance, so that its motion
      // does no work.
      return sum([&](std::size_t i) {
        if (!contacts_[i].touches()) return 0.0;
        const Branch& branch = contacts_[i].branch();
        // In the instant in which the centre jumps, a touching contact may lie below its opening, where it bears
        // nothing.
        return law_.work(branch, std::max(approach(i, xi, y), law_.opening(branch)));
      });
    } else {
      return std::nullopt;
    }
  }

  [[nodiscard]] bool is_quadrature_costly() const noexcept override {
    if constexpr (requires(const Law& law, const Branch& b) { law.is_work_costly(b); }) {
      return std::ranges::any_of(contacts_,
                                 [&](const Contact& c) { return c.touches() && law_.is_work_costly(c.branch()); });
    } else {
      return false;
    }
  }

  void guard_values(double xi, std::span<const double> y, std::span<double> values) override {
    const bool asks_for_velocity = centre_ && guards_.has(k_retreat);
    const FreeCentre::Vector velocity = asks_for_velocity ? centre_velocity(xi, y) : FreeCentre::Vector::Zero();
    for (std::size_t g = 0; g < guards_.list().size(); ++g) {
      const Guard& guard = guards_.list()[g];
      const double target = guards_.target(g);
      const std::size_t i = guard.list_index();
      if (depends_on_centre(i)) {
        values[g] = centre_->guard_value(state(xi, y), guard, target, velocity);
        continue;
      }
      // The length of the ramp is the scale, so that guards of a small overlap have all their digits.
      const WallDrive& ramp = contacts_[i].drive();
      values[g] = (ramp.value(xi) - target) / ramp.size();
    }
  }

  std::optional<DomainEnd> fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                std::vector<Event>& log) override {
    for (const std::size_t g : fired) {
      const Guard& guard = guards_.list()[g];
      const std::size_t i = guard.list_index();
      Contact& c = contacts_[i];
      std::optional<DomainEnd> end;
      if (guard.kind == k_made)
        c.make(law_, true, log);
      else if (guard.kind == k_lost)
        c.lose(law_, log, approach_by_centre(i, y));
      else if (guard.kind == k_retreat)
        c.turn(law_, approach(i, xi, y), guard.name, log);
      else if (guard.kind == k_boundary)
        end = c.pass(law_, *c.next(law_), log);
      // The next boundary may lie within the round-off of the ramp, as with the opening of a dent near the resolution:
      // it is passed at once.
      const bool is_pressed_on = guard.kind == k_made || guard.kind == k_boundary;
      if (!end && is_pressed_on && !depends_on_centre(i)) end = c.pass_reached(law_, xi, log);
      if (end) return end;
    }
    if (const auto end = find_mode(xi, y, log, fired)) return end;
    solve(xi, y);
    arm_guards(xi, y);
    return std::nullopt;
  }

  void observe(double xi, std::span<const double> y, std::span<double> values) override {
    for (std::size_t i = 0; i < contacts_.size(); ++i) approaches_[i] = approach(i, xi, y);
    if constexpr (requires(Law & law) { law.note(1.0); })
      std::ranges::for_each(approaches_, [&](double d) { law_.note(d); });
    columns_.write(
        has_energies() ? energies(y[work_slot_]) : k_no_energies, contacts_.size(),
        [&](std::size_t i) { return visible(i, xi, approaches_[followers_.leading(i)], approach_by_centre(i, y)); },
        values);
    if (centre_) write_centre_columns(centre_->in_space(y) * units_.length, values);
  }

  /// @throws std::logic_error for what the law does not have
  [[nodiscard]] double quantity(Quantity quantity, int contact_class, double xi, std::span<const double> y) override {
    const bool is_of_area = quantity == Quantity::pressure || quantity == Quantity::contact_radius;
    if (is_of_area && !k_has_contact_area<Law>) throw std::logic_error("no such quantity at a wall of this model");
    const auto i = static_cast<std::size_t>(contact_class);
    const VisibleContact shown = visible(i, xi, approach(followers_.leading(i), xi, y), approach_by_centre(i, y));
    return quantity_of(wall_of(shown, units_.length), quantity);
  }
  /// Present value of what a control prescribes, where a ramp begins. For an integrated displacement, gives the exact
  /// one under the prescribed force, without the integrator's error.
  [[nodiscard]] double controlled(Control control, int contact_class, double xi, std::span<const double> y) override {
    const auto i = static_cast<std::size_t>(contact_class);
    if (control == Control::force) return quantity(Quantity::force, contact_class, xi, y);
    const double d = approach(i, xi, y);
    if (!contacts_[i].is_integrated(law_)) return (d - approach_by_centre(i, y)) * units_.length;
    return (contacts_[i].displacement_under(law_, contacts_[i].drive().value(xi), d) - approach_by_centre(i, y)) *
           units_.length;
  }

  [[nodiscard]] std::vector<SurfacePoint> surface(int contact_class, double xi, std::span<const double> y) override {
    std::vector<SurfacePoint> points;
    if constexpr (requires(Law & law, const Branch& b) { law.surface(b, 1.0); }) {
      const auto i = static_cast<std::size_t>(contact_class);
      const double d = approach(i, xi, y);
      if (contacts_[i].bears(law_, d)) points = law_.surface(contacts_[i].branch(), d);
      for (SurfacePoint& point : points) point = units_.in_si(point);
    }
    return points;
  }

  /// Judges the whole program, not the present state: every contact is below resolution when it is made.
  [[nodiscard]] std::optional<Difficulty> difficulty(double /*xi*/, std::span<const double> /*y*/) override {
    return scales_.reach <= k_resolution ? std::optional(Difficulty::below_resolution) : std::nullopt;
  }

  [[nodiscard]] std::vector<Diagnostic> warnings() const override {
    if constexpr (requires(const Law& law) { law.warnings(0.0); })
      return law_.warnings(sum([&](std::size_t i) { return contacts_[i].has_touched() ? 1.0 : 0.0; }));
    else
      return {};
  }

 private:
  using Branch = typename Law::Branch;
  using Contact = WallContact<Law>;
  static constexpr bool k_has_work = requires(Law & law, const Branch& b) { law.work(b, 1.0); };
  static constexpr bool k_can_store_energy = requires(Law & law, const Branch& b) { law.stored(b, 1.0); };

  using Centre = CentreMode<Law>;

  /// Solves for the centre and for the coordinates of contacts.
  /// @param with_integrated  false: not for coordinates that integrators advance
  void solve_for(double xi, std::span<double> y, bool with_integrated) {
    if (centre_) centre_->move(law_, contacts_, xi, y);
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      if (classes_[i].takes_force && (with_integrated || !contacts_[i].is_integrated(law_)))
        y[slots_[i]] = contacts_[i].coordinate_next_to(law_, xi, y[slots_[i]]);
    }
  }
  /// @param work  over the force unit and R0
  [[nodiscard]] Energies energies(double work) {
    double stored = 0.0;
    if constexpr (k_can_store_energy) {
      if (stores_energy()) {
        stored = sum([&](std::size_t i) {
          const double d = approaches_[i];
          return contacts_[i].bears(law_, d) ? law_.stored(contacts_[i].branch(), d) : 0.0;
        });
      }
    }
    return {work * units_.energy(), stored * units_.energy()};
  }
  [[nodiscard]] bool stores_energy() const {
    if constexpr (requires(const Law& law) { law.has_stored_energy(); }) return law_.has_stored_energy();
    return k_can_store_energy;
  }

  /// Sum over all walls that do work.
  template <class OfContact>
  [[nodiscard]] double sum(OfContact&& of_contact) const {
    double total = 0.0;
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      if (!followers_.follows(i)) total += classes_[i].multiplicity() * of_contact(i);
    }
    return total;
  }

  /// Approach of wall and particle, the displacement of a contact: that of its wall, plus the displacement of a free
  /// centre towards this wall.
  [[nodiscard]] double approach(std::size_t i, double xi, std::span<const double> y) const {
    const double d = contacts_[i].displacement(law_, xi, coordinate(i, y));
    return centre_ ? centre_->approach(state(xi, y), i, d) : d;
  }

  /// Coordinate of a contact; 0 for a class that never takes a force, and has none.
  [[nodiscard]] double coordinate(std::size_t i, std::span<const double> y) const {
    return classes_[i].takes_force ? y[slots_[i]] : 0.0;
  }

  /// Displacement of a contact at the end of the last step.
  [[nodiscard]] double left_at(std::size_t i, std::span<const double> y) const {
    const double d = contacts_[i].displacement_of(law_, coordinate(i, y));
    return depends_on_centre(i) ? d + approach_by_centre(i, y) : d;
  }

  [[nodiscard]] typename Centre::State state(double xi, std::span<const double> y) const {
    return {law_, contacts_, xi, y};
  }
  /// True for a contact whose displacement depends on where a free centre is.
  [[nodiscard]] bool depends_on_centre(std::size_t i) const noexcept {
    return centre_.has_value() && !contacts_[i].is_force_controlled();
  }
  /// By how much a free centre has moved towards the walls of a class.
  [[nodiscard]] double approach_by_centre(std::size_t i, std::span<const double> y) const {
    return centre_ ? centre_->approach_by_centre(i, y) : 0.0;
  }
  /// True if touching is an event; it is none for a wall that touches the fresh particle from the start.
  [[nodiscard]] bool is_seen(std::size_t i) const noexcept { return has_begun_ || classes_[i].gap > 0.0; }
  /// Rate of the work of one wall.
  /// @param now  slope of the contact's coordinate
  [[nodiscard]] double power(std::size_t i, double xi, std::span<const double> y, const typename Contact::Slope& now,
                             const FreeCentre::Vector& velocity) const {
    if (!centre_) return contacts_[i].power(law_, xi, now);
    return centre_->power(state(xi, y), i, now, velocity);
  }
  [[nodiscard]] FreeCentre::Vector centre_velocity(double xi, std::span<const double> y) {
    return centre_ ? centre_->velocity(state(xi, y)) : FreeCentre::Vector::Zero();
  }
  /// Decides the mode around a free centre.
  /// @param fired  guards that have just fired, and so have decided about their contacts
  std::optional<DomainEnd> find_mode(double xi, std::span<const double> y, std::vector<Event>& log,
                                     std::span<const std::size_t> fired) {
    if (!centre_) return std::nullopt;
    const auto is_decided = [&](std::size_t i) {
      return std::ranges::any_of(fired, [&](std::size_t g) { return guards_.list()[g].list_index() == i; });
    };
    return centre_->find({law_, contacts_, xi, y, log}, is_decided, [this](std::size_t i) { return is_seen(i); });
  }

  // --- columns

  /// Numbers of a contact in a row, in SI.
  /// @param d          displacement of the contact, or of the leader that it follows
  /// @param by_centre  by how much a free centre has moved towards the wall
  [[nodiscard]] VisibleContact visible(std::size_t i, double xi, double d, double by_centre) {
    const Contact& c = contacts_[i];
    if (followers_.follows(i)) {
      VisibleContact shown = visible_follower(law_, contacts_[followers_.leader()], d);
      shown.displacement = c.drive().value(xi);
      return units_.in_si(shown);
    }
    VisibleContact shown = visible_contact(law_, c, xi, d);
    shown.displacement = shown.overlap - by_centre;
    return units_.in_si(shown);
  }

  /// Lists the guards that may fire before the end of the step.
  void arm_guards(double xi, std::span<const double> y) {
    guards_.clear();
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      if (depends_on_centre(i)) {
        centre_->arm_guards(state(xi, y), i, guards_);
      } else if (!followers_.follows(i)) {
        arm_wall(law_, contacts_[i], i, guards_);
      }
    }
  }

  Law law_;
  Units units_;
  std::vector<ContactClass> classes_;
  std::vector<Contact> contacts_;
  std::vector<std::size_t> slots_;  ///< index in y of the coordinate of each class that takes a force
  std::vector<double> approaches_;  ///< of the contacts in a row
  Followers<Law> followers_;
  Columns columns_;
  Scales scales_;
  std::vector<Unknown> unknowns_;
  std::size_t work_slot_ = 0;
  std::optional<Centre> centre_;  ///< none: the centre is fixed
  std::vector<double> trial_;     ///< work space
  bool has_begun_ = false;
  Guards guards_;
};

}  // namespace monograin::contacts
