/// Contacts that each depend on their own wall alone, as a hybrid system: all that such laws share. A law says what one
/// contact does. Displacements are over the particle's radius R0, forces over the law's unit.
///
/// A law has
///   Branch, k_regimes           what a contact remembers of its branch (Branch{}: a fresh contact); words
///   unit_force(R0)              [N]
///   force(b, d), slope(b, d)    on a branch, also a little beyond its ends; dF/dd > 0 inside
///   displacement(b, F)          the inverse of force, for F > 0
///   opening(b)                  displacement at which wall and particle part, and meet
///   regime(b, touches)          index of a word
/// and may have
///   work(b, d)                  primitive of the force up to a constant; without it the work is integrated
///   stored(b, d)                energy that unloading gives back; has_stored_energy(): whether there is any
///   contact(b, d)               force and contact radius, where the law knows the contact area
///   next(b), pass(b)            boundary ahead on the primary loading branch; what changes there
///   turn(b, d), reload(b)       begins to unload at d; is back there. Without them a contact goes back as it came
///   refuses_unloading()         none, or what to do against the limit that a contact meets which begins to unload
///   k_passed_at_end             which boundaries a step has passed that ends at them
///   made_event(b)               name of the event of touching, if it is not "contact-made"
///   surface(b, d)               points of the surface; pressures over unit_force/R0^2
///   follows(walls)              true for contacts that follow the first one that does not, and do no work
///   follower(b, touches, d)     what is seen of them beside that one
///   start(), note(d), warnings(walls)
///                               forgets, notes a displacement in a row, tells; walls: how many have touched
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

#include <array>
#include <cmath>
#include <concepts>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>

#include "contacts/centre/free_centre.hpp"
#include "contacts/columns.hpp"
#include "contacts/scales.hpp"
#include "contacts/wall_contact.hpp"

namespace monograin::contacts {

struct Settings {
  double initial_radius = 1.0;  ///< R0 [m], > 0
  /// Largest displacement [m] and force [N] the program asks of a wall: how large the unknowns become, which absolute
  /// tolerances are relative to. 0: not said.
  double largest_displacement = 0.0;
  double largest_force = 0.0;
  bool centre_is_free = false;  ///< the centre moves so that the forces balance
};

template <class Law>
class IndependentContacts final : public HybridSystem {
 public:
  IndependentContacts(Law law, const Settings& settings, std::vector<ContactClass> classes)
      : law_(std::move(law)),
        length_(settings.initial_radius),
        force_unit_(law_.unit_force(length_)),
        classes_(std::move(classes)),
        contacts_(classes_.size()),
        slots_(classes_.size()),
        displacements_(classes_.size()),
        columns_(has_stored_energy(), k_has_contact_area, Law::k_regimes, classes_, settings.centre_is_free),
        scales_(scales_of(law_, settings.largest_displacement / length_, settings.largest_force / force_unit_)) {
    for (std::size_t i = 0; i < classes_.size(); ++i) {
      if constexpr (k_has_followers) is_follower_.push_back(law_.follows(classes_[i]));
      if (!classes_[i].takes_force) continue;
      slots_[i] = unknowns_.size();
      unknowns_.push_back({classes_[i].name, Unknown::Kind::differential, scales_.coordinate, true});
    }
    while (leader_ < classes_.size() && is_follower(leader_)) ++leader_;
    work_slot_ = unknowns_.size();
    unknowns_.push_back({"work", Unknown::Kind::quadrature, scales_.magnitudes.work, false});
    if (settings.centre_is_free) add_centre();
    trial_.resize(unknowns_.size());
  }
  /// Makes the law, and the Settings, of a model's own settings.
  template <class OfModel>
  requires std::constructible_from<Law, OfModel> IndependentContacts(const OfModel& settings,
                                                                     std::vector<ContactClass> classes)
      : IndependentContacts(
            Law(settings),
            {settings.initial_radius, settings.largest_displacement, settings.largest_force, settings.centre_is_free},
            std::move(classes)) {}

  [[nodiscard]] std::span<const Unknown> unknowns() const noexcept override { return unknowns_; }
  [[nodiscard]] std::span<const ContactClass> classes() const noexcept override { return classes_; }
  [[nodiscard]] std::span<const Guard> guards() const noexcept override { return guards_; }
  [[nodiscard]] std::span<const Observable> observables() const noexcept override { return columns_.observables(); }
  [[nodiscard]] bool is_open(int contact_class) const noexcept override {
    const auto i = static_cast<std::size_t>(contact_class);
    const Contact& c = contacts_[leading(i)];
    return is_follower(i) ? law_.regime(c.branch(), c.touches()) == 0 : !c.touches();
  }
  [[nodiscard]] std::function<void()> checkpoint() override {
    return [this, then = *this] { *this = then; };
  }

  void start(std::span<double> y) override {
    std::ranges::fill(y, 0.0);
    has_begun_ = false;
    if constexpr (requires(Law & law) { law.start(); }) law_.start();
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      std::vector<int> followers;
      for (std::size_t k = 0; i == leader_ && k < contacts_.size(); ++k) {
        if (is_follower(k)) followers.push_back(static_cast<int>(k));
      }
      contacts_[i] =
          Contact(static_cast<int>(i), -classes_[i].gap / length_, scales_.force_per_coordinate, std::move(followers));
    }
    solve(0.0, y);
  }

  void begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) override {
    std::vector<double> at(contacts_.size());
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      const bool is_by_force = ramps[i].control == Control::force;
      const double stood = is_by_force ? contacts_[i].displacement_at(law_, y[slots_[i]]) : 0.0;
      const WallDrive drive(ramps[i], is_by_force ? force_unit_ : length_);
      at[i] = contacts_[i].take_up(law_, drive, stood, classes_[i].takes_force, carried(i, y));
      // A step that cannot begin is shown where it would have, in its own coordinates.
      if (classes_[i].takes_force) y[slots_[i]] = contacts_[i].coordinate(law_, 0.0, at[i]);
    }
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      if (is_follower(i) || follows_centre(i)) continue;
      if (const auto end = contacts_[i].begin_step(law_, at[i], is_seen(i), log, carried(i, y)))
        throw CannotBegin(*end);
    }
    if (centre_) {
      ahead_ = std::clamp(k_distance_ahead / fastest_wall(), k_least_ahead, k_most_ahead);
      if (const auto end = find_mode(0.0, y, log)) throw CannotBegin(*end);
    }
    has_begun_ = true;
    solve(0.0, y);
    arm_guards(0.0);
  }

  void complete(double xi, std::span<double> y) override {
    if (unknowns_.size() == 1) return;  // the work
    move_centre(xi, y);
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      if (classes_[i].takes_force && !contacts_[i].is_integrated(law_))
        y[slots_[i]] = contacts_[i].coordinate_near(law_, xi, y[slots_[i]]);
    }
  }
  void solve(double xi, std::span<double> y) override {
    if (unknowns_.size() == 1) return;  // the work
    move_centre(xi, y);
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      if (classes_[i].takes_force) y[slots_[i]] = contacts_[i].coordinate_near(law_, xi, y[slots_[i]]);
    }
  }

  void rates(double xi, std::span<const double> y, std::span<double> dy) override {
    const Vector velocity = centre_velocity(xi, y);
    dy[work_slot_] = sum([&](std::size_t i) {
      const auto now = contacts_[i].slope(law_, y[slots_[i]]);
      if (classes_[i].takes_force) dy[slots_[i]] = contacts_[i].rate(now);
      return power(i, xi, y, now, velocity);
    });
  }
  void all_rates(double xi, std::span<const double> y, std::span<double> dy) override {
    rates(xi, y, dy);
    if (!centre_) return;
    // A quotient of differences is all that integrators need to begin with: it has no singularity at first touch.
    const Vector now = centre_position(y);
    const Vector then = centre_->equilibrium(Instant(*this, xi + ahead_), roles_, rest_, now);
    for (std::size_t k = centre_slot_; k < unknowns_.size(); ++k) {
      const auto axis = static_cast<Eigen::Index>(k - centre_slot_);
      dy[k] = (then[axis] - now[axis]) / ahead_;
    }
  }

  void residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) override {
    // The centre stands where the balance of forces puts it, so that a trial's own position does not enter the work.
    std::ranges::copy(y, trial_.begin());
    move_centre(xi, trial_);
    const Vector velocity = centre_velocity(xi, trial_);
    res[work_slot_] = dy[work_slot_] - sum([&](std::size_t i) {
                        const auto now = contacts_[i].slope(law_, y[slots_[i]]);
                        if (classes_[i].takes_force)
                          res[slots_[i]] = contacts_[i].residual(law_, xi, y[slots_[i]], now);
                        return power(i, xi, trial_, now, velocity);
                      });
    for (std::size_t k = centre_slot_; centre_ && k < unknowns_.size(); ++k) res[k] = y[k] - trial_[k];
  }

  [[nodiscard]] std::optional<double> closed_quadrature(double xi, std::span<const double> y) override {
    if constexpr (k_has_work) {
      return sum([&](std::size_t i) {
        if (!contacts_[i].touches()) return 0.0;
        return law_.work(contacts_[i].branch(), displacement(i, xi, y));
      });
    } else {
      return std::nullopt;
    }
  }

  void guard_values(double xi, std::span<const double> y, std::span<double> values) override {
    for (std::size_t g = 0; g < guards_.size(); ++g) {
      if (follows_centre(static_cast<std::size_t>(guards_[g].index))) {
        values[g] = value_with_centre(g, xi, y);
        continue;
      }
      // Ramps are as short as contacts are shallow.
      const WallDrive& ramp = drive(static_cast<std::size_t>(guards_[g].index));
      values[g] = (ramp.value(xi) - targets_[g]) / ramp.size();
    }
  }

  std::optional<DomainEnd> fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                std::vector<Event>& log) override {
    for (const std::size_t g : fired) {
      const auto i = static_cast<std::size_t>(guards_[g].index);
      Contact& c = contacts_[i];
      std::optional<DomainEnd> end;
      if (guards_[g].kind == k_made)
        c.make(law_, true, log);
      else if (guards_[g].kind == k_lost)
        c.lose(law_, log, carried(i, y));
      else if (guards_[g].kind == k_retreat)
        c.turn(law_, displacement(i, xi, y), guards_[g].name, log);
      else
        end = c.pass(law_, *c.next(law_), log);
      // A dent may be shallower than the round-off of a ramp, and so may be what lies beyond a boundary.
      const bool is_pressed_on = guards_[g].kind == k_made || guards_[g].kind == k_boundary;
      if (!end && is_pressed_on && !follows_centre(i)) end = c.pass_reached(law_, xi, log);
      if (end) return end;
    }
    if (centre_) {
      if (const auto end = find_mode(xi, y, log, fired)) return end;
    }
    solve(xi, y);
    arm_guards(xi);
    return std::nullopt;
  }

  void observe(double xi, std::span<const double> y, std::span<double> values) override {
    const double energy_unit = force_unit_ * length_;
    Energies energies{.work = y[work_slot_] * energy_unit};
    for (std::size_t i = 0; i < contacts_.size(); ++i) displacements_[i] = displacement(i, xi, y);
    if constexpr (requires(Law & law) { law.note(1.0); })
      std::ranges::for_each(displacements_, [&](double d) { law_.note(d); });
    if constexpr (k_can_store_energy) {
      if (has_stored_energy()) {
        energies.stored = energy_unit * sum([&](std::size_t i) {
                            const double d = displacements_[i];
                            return contacts_[i].bears(law_, d) ? law_.stored(contacts_[i].branch(), d) : 0.0;
                          });
      }
      energies.dissipation = energies.work - energies.stored;
    }
    columns_.write(
        energies, contacts_.size(),
        [&](std::size_t i) { return visible(i, xi, displacements_[leading(i)], carried(i, y)); }, values);
    if (!centre_) return;
    const Eigen::Vector3d centre = centre_->in_space(centre_position(y)) * length_;
    std::ranges::copy(centre, values.end() - centre.size());
  }

  /// @throws std::logic_error for what the law does not have
  [[nodiscard]] double quantity(Quantity quantity, int contact_class, double xi, std::span<const double> y) override {
    const bool is_of_area = quantity == Quantity::pressure || quantity == Quantity::contact_radius;
    if (is_of_area && !k_has_contact_area) throw std::logic_error("no such quantity at a wall of this model");
    const auto i = static_cast<std::size_t>(contact_class);
    const VisibleContact shown = visible(i, xi, displacement(leading(i), xi, y), carried(i, y));
    return quantity_of({.force = shown.force,
                        .displacement = shown.displacement,
                        .pressure = shown.pressure,
                        .contact_radius = shown.contact_radius,
                        .apparent_radius = length_},
                       quantity);
  }
  /// A ramp of displacement begins where a force has taken the wall, without an integrator's error.
  [[nodiscard]] double controlled(Control control, int contact_class, double xi, std::span<const double> y) override {
    const auto i = static_cast<std::size_t>(contact_class);
    if (control == Control::force) return quantity(Quantity::force, contact_class, xi, y);
    const double d = displacement(i, xi, y);
    if (!contacts_[i].is_integrated(law_)) return (d - carried(i, y)) * length_;
    return (contacts_[i].displacement_under(law_, drive(i).value(xi), d) - carried(i, y)) * length_;
  }

  [[nodiscard]] std::vector<SurfacePoint> surface(int contact_class, double xi, std::span<const double> y) override {
    std::vector<SurfacePoint> points;
    if constexpr (requires(Law & law, const Branch& b) { law.surface(b, 1.0); }) {
      const auto i = static_cast<std::size_t>(contact_class);
      const double d = displacement(i, xi, y);
      if (contacts_[i].bears(law_, d)) points = law_.surface(contacts_[i].branch(), d);
      for (SurfacePoint& point : points) {
        point.radius *= length_;
        point.pressure *= stress_unit();
        point.displacement *= length_;
        point.relaxed_height *= length_;
      }
    }
    return points;
  }

  /// The whole program is below resolution, because every contact is as shallow when it is made.
  [[nodiscard]] std::optional<Difficulty> difficulty(double /*xi*/, std::span<const double> /*y*/) override {
    constexpr double k_least_depth = 1e-12;
    return scales_.reach <= k_least_depth ? std::optional(Difficulty::below_resolution) : std::nullopt;
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
  static constexpr bool k_has_contact_area = requires(Law & law, const Branch& b) { law.contact(b, 1.0); };

  static constexpr bool k_has_followers = requires(Law & law, const ContactClass& walls) { law.follows(walls); };

  enum GuardKind : int { k_made, k_boundary, k_lost, k_retreat };

  using Vector = FreeCentre::Vector;
  static constexpr std::array<std::string_view, 3> k_centre_names{"centre displacement 1", "centre displacement 2",
                                                                  "centre displacement 3"};
  /// How far ahead of an instant, in step coordinates, the mode that begins there is decided: briefer ones are not
  /// seen. Farther where walls hardly move, so that they go by more than round-off.
  static constexpr double k_least_ahead = 1e-6;
  static constexpr double k_most_ahead = 1e-3;
  static constexpr double k_distance_ahead = 1e-9;  ///< over R0
  /// Changes of displacements over that which are round-off.
  static constexpr double k_no_change = 1e-14;

  /// Gap or overlap of a wall that is where it meets the particle: it is lost where the gap would be larger.
  static constexpr double k_touch = 1e-12;
  /// Rate of a contact's displacement over the fastest one that is round-off.
  static constexpr double k_at_rest = 1e-9;

  /// The walls around the centre at one instant.
  class Instant final : public CentreWalls {
   public:
    Instant(const IndependentContacts& system, double xi) : system_(system), xi_(xi) {}
    [[nodiscard]] std::optional<double> prescribed_force(std::size_t i) const override {
      const Contact& c = system_.contacts_[i];
      if (!c.is_force_controlled()) return std::nullopt;
      return c.touches() ? c.drive().value(xi_) : 0.0;
    }
    [[nodiscard]] double overlap(std::size_t i) const override {
      const Contact& c = system_.contacts_[i];
      return c.drive().value(xi_) - system_.law_.opening(c.branch());
    }
    [[nodiscard]] Force force(std::size_t i, double overlap) const override {
      const Branch& branch = system_.contacts_[i].branch();
      const double d = system_.law_.opening(branch) + overlap;
      return {system_.law_.force(branch, d), system_.law_.slope(branch, d)};
    }
    [[nodiscard]] double overlap_under(std::size_t i, double force) const override {
      const Branch& branch = system_.contacts_[i].branch();
      return system_.law_.displacement(branch, force) - system_.law_.opening(branch);
    }

   private:
    const IndependentContacts& system_;
    double xi_;
  };

  [[nodiscard]] const WallDrive& drive(std::size_t i) const noexcept { return contacts_[i].drive(); }
  [[nodiscard]] bool is_follower(std::size_t i) const noexcept { return k_has_followers && is_follower_[i]; }
  /// The contact itself, or the leader that it follows.
  [[nodiscard]] std::size_t leading(std::size_t i) const noexcept { return is_follower(i) ? leader_ : i; }
  [[nodiscard]] double stress_unit() const noexcept { return force_unit_ / (length_ * length_); }
  [[nodiscard]] bool has_stored_energy() const {
    if constexpr (requires(const Law& law) { law.has_stored_energy(); }) return law_.has_stored_energy();
    return k_can_store_energy;
  }

  /// Sum over all walls that do work.
  template <class OfContact>
  [[nodiscard]] double sum(OfContact&& of_contact) const {
    double total = 0.0;
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      if (!is_follower(i)) total += classes_[i].multiplicity() * of_contact(i);
    }
    return total;
  }

  /// Displacement of a contact: of its wall, and by how much a free centre has moved towards that.
  [[nodiscard]] double displacement(std::size_t i, double xi, std::span<const double> y) const {
    const double d = contacts_[i].displacement(law_, xi, y[slots_[i]]);
    return centre_ ? displacement_with_centre(i, d, y) : d;
  }

  // --- a free centre

  /// True for a contact whose displacement depends on where a free centre is.
  [[nodiscard]] bool follows_centre(std::size_t i) const noexcept {
    return centre_.has_value() && !contacts_[i].is_force_controlled();
  }
  void add_centre() {
    centre_.emplace(classes_);
    centre_slot_ = unknowns_.size();
    roles_.resize(classes_.size());
    rates_.resize(classes_.size());
    for (std::size_t k = 0; k < static_cast<std::size_t>(centre_->dimension()); ++k) {
      unknowns_.push_back({.name = k_centre_names[k],
                           .kind = Unknown::Kind::algebraic,
                           .scale = scales_.reach,
                           .is_implicitly_algebraic = true,
                           .is_dependent = true});
    }
  }
  [[nodiscard]] bool is_seen(std::size_t i) const noexcept {
    // A wall that touches the fresh particle is in contact from the start, without an event.
    return has_begun_ || classes_[i].gap > 0.0;
  }
  [[nodiscard]] Vector centre_position(std::span<const double> y) const noexcept {
    Vector c = Vector::Zero();
    for (std::size_t k = centre_slot_; centre_ && k < unknowns_.size(); ++k)
      c[static_cast<Eigen::Index>(k - centre_slot_)] = y[k];
    return c;
  }
  [[nodiscard]] double carried(std::size_t i, std::span<const double> y) const noexcept {
    return centre_ ? centre_->along(i, centre_position(y)) : 0.0;
  }
  /// @param d  displacement with the centre where it started; under force control, where it is
  [[nodiscard]] double displacement_with_centre(std::size_t i, double d, std::span<const double> y) const {
    const Contact& c = contacts_[i];
    const double opening = law_.opening(c.branch());
    if (c.is_force_controlled()) {
      // An open wall without load stays where it was left, until the particle pushes it.
      return c.touches() ? d : std::min(d + carried(i, y), opening);
    }
    const double overlap = d + carried(i, y) - opening;
    const bool only_touches = c.touches() && std::abs(overlap) <= FreeCentre::k_resolution;
    return only_touches ? opening : opening + overlap;
  }
  void move_centre(double xi, std::span<double> y) {
    if (!centre_ || centre_->dimension() == 0) return;
    const Vector c = centre_->equilibrium(Instant(*this, xi), roles_, rest_, centre_position(y));
    for (std::size_t k = centre_slot_; k < unknowns_.size(); ++k) y[k] = c[static_cast<Eigen::Index>(k - centre_slot_)];
  }
  [[nodiscard]] Vector centre_velocity(double xi, std::span<const double> y) {
    if (!centre_) return Vector::Zero();
    for (std::size_t i = 0; i < contacts_.size(); ++i) rates_[i] = drive(i).rate();
    return centre_->velocity(Instant(*this, xi), roles_, rates_, centre_position(y));
  }
  /// Rate of the fastest wall under displacement control.
  [[nodiscard]] double fastest_wall() const noexcept {
    double fastest = 0.0;
    for (const Contact& c : contacts_) {
      if (!c.is_force_controlled()) fastest = std::max(fastest, std::abs(c.drive().rate()));
    }
    return fastest;
  }
  /// Rate of the work of one wall.
  [[nodiscard]] double power(std::size_t i, double xi, std::span<const double> y, const typename Contact::Slope& now,
                             const Vector& velocity) const {
    const Contact& c = contacts_[i];
    if (!centre_) return c.power(law_, xi, now);
    if (c.is_force_controlled()) {
      const double force = c.touches() ? std::max(0.0, drive(i).value(xi)) : 0.0;
      return force > 0.0 ? c.power(law_, xi, now) - force * centre_->along(i, velocity) : 0.0;
    }
    const double d = displacement(i, xi, y);
    return c.bears(law_, d) ? law_.force(c.branch(), d) * drive(i).rate() : 0.0;
  }

  /// Decides which walls touch, which bear and which contacts turn in the mode that begins, by looking a little ahead:
  /// these depend on each other through the centre, so assume, look, correct, and repeat.
  /// @param fired  guards that have just decided that for their contacts
  std::optional<DomainEnd> find_mode(double xi, std::span<double> y, std::vector<Event>& log,
                                     std::span<const std::size_t> fired = {}) {
    rest_ = centre_position(y);
    std::vector<bool> is_decided(contacts_.size(), false);
    for (const std::size_t g : fired) is_decided[static_cast<std::size_t>(guards_[g].index)] = true;
    for (std::size_t round = 0; round <= 4 * contacts_.size() + 8; ++round) {
      Vector ahead = rest_;
      centre_->find_roles(Instant(*this, xi), Instant(*this, xi + ahead_), ahead, roles_);
      bool has_changed = false;
      for (std::size_t i = 0; i < contacts_.size(); ++i) {
        if (!follows_centre(i)) continue;
        const double d = drive(i).value(xi) + centre_->along(i, rest_);
        const double then = law_.opening(contacts_[i].branch()) + overlap_as_touching(i, xi + ahead_, ahead);
        const std::string_view turning = xi == 0.0 ? "load-reversal" : "retreat";
        if (const auto end = find_branch(i, d, then, is_decided[i], turning, log, has_changed)) return end;
      }
      if (!has_changed) return std::nullopt;
    }
    throw DomainError(Limit::no_consistent_regimes);
  }
  /// Decides the branch of a contact.
  /// @param d           its displacement
  /// @param then        and a little later
  /// @param is_decided  a guard has just changed it
  /// @param turning     name of the event of beginning to unload
  std::optional<DomainEnd> find_branch(std::size_t i, double d, double then, bool is_decided, std::string_view turning,
                                       std::vector<Event>& log, bool& has_changed) {
    Contact& c = contacts_[i];
    const double opening = law_.opening(c.branch());
    // Farther away, a guard tells when that is.
    const bool will_touch = then - opening > k_no_change;
    if (!is_decided && will_touch && !c.touches() && d - opening >= -k_touch) c.make(law_, is_seen(i), log);
    if (!is_decided && !will_touch && c.touches() && d - opening <= k_touch) c.lose(law_, log);
    if (!c.touches() || is_decided) return std::nullopt;
    if (then < d - k_no_change && c.is_on_primary_branch() && d - opening > k_no_change) {
      c.turn(law_, d, turning, log);
      has_changed = true;
    } else if (then > d + k_no_change) {
      while (const auto ahead = c.next(law_)) {
        if (!(then > ahead->position) || d < ahead->position - k_no_change) break;
        if (const auto end = c.pass(law_, *ahead, log)) return end;
        has_changed = true;
      }
    }
    return std::nullopt;
  }

  /// How far a contact is past where wall and particle meet. An idle wall that touches has an overlap of nothing: it
  /// shows by the one that it would have if it did not push.
  [[nodiscard]] double overlap_as_touching(std::size_t i, double xi, const Vector& c) {
    if (roles_[i] == Role::idle) return centre_->unpushed_overlap(i, Instant(*this, xi), roles_, rest_, c);
    return drive(i).value(xi) + centre_->along(i, c) - law_.opening(contacts_[i].branch());
  }
  /// Value of the guard of a contact that follows the centre.
  [[nodiscard]] double value_with_centre(std::size_t g, double xi, std::span<const double> y) {
    const auto i = static_cast<std::size_t>(guards_[g].index);
    const Vector c = centre_position(y);
    if (guards_[g].kind == k_retreat) {
      const Vector velocity = centre_velocity(xi, y);
      // A contact at rest has a rate of round-off.
      const double fastest = std::max(velocity.norm(), fastest_wall());
      return (drive(i).rate() + centre_->along(i, velocity) + k_at_rest * fastest) / scales_.reach;
    }
    if (guards_[g].kind == k_boundary) return (drive(i).value(xi) + centre_->along(i, c) - targets_[g]) / scales_.reach;
    return (overlap_as_touching(i, xi, c) - targets_[g]) / scales_.reach;
  }
  void arm_guards_with_centre(std::size_t i, double xi) {
    const Contact& c = contacts_[i];
    const double overlap = drive(i).value(xi) + centre_->along(i, rest_) - law_.opening(c.branch());
    if (!c.touches()) {
      add_guard_with_centre(k_made, i, 1, c.made_event(law_), overlap >= -k_touch ? k_touch : 0.0);
      return;
    }
    add_guard_with_centre(k_lost, i, -1, "contact-lost", overlap <= k_touch ? -k_touch : 0.0);
    if (const auto ahead = c.next(law_)) add_guard_with_centre(k_boundary, i, 1, ahead->event, ahead->position);
    if (c.is_on_primary_branch() && roles_[i] == Role::bearing) add_guard_with_centre(k_retreat, i, -1, "retreat", 0.0);
  }
  /// @param target  overlap where the guard is zero; at a boundary of the law the displacement
  void add_guard_with_centre(GuardKind kind, std::size_t i, int direction, std::string_view name, double target) {
    guards_.push_back({.kind = kind, .index = static_cast<int>(i), .direction = direction, .name = name});
    targets_.push_back(target);
  }

  // --- columns

  /// @param d        displacement of the contact, or of the leader that it follows
  /// @param carried  by how much a free centre has moved towards the wall
  [[nodiscard]] VisibleContact visible(std::size_t i, double xi, double d, double carried) {
    VisibleContact shown = is_follower(i) ? visible_follower(d) : visible_contact(i, xi, d);
    shown.displacement = is_follower(i) ? drive(i).value(xi) : shown.overlap - carried;
    shown.displacement *= length_;
    shown.overlap *= length_;
    shown.force *= force_unit_;
    shown.contact_radius *= length_;
    shown.pressure *= stress_unit();
    return shown;
  }
  /// In units of the law.
  [[nodiscard]] VisibleContact visible_contact(std::size_t i, double xi, double d) const {
    const Contact& c = contacts_[i];
    VisibleContact shown{.overlap = d, .regime = static_cast<double>(law_.regime(c.branch(), c.touches()))};
    if (!c.bears(law_, d)) return shown;
    if constexpr (k_has_contact_area) {
      const BearingContact bearing = law_.contact(c.branch(), d);
      shown.force = c.is_force_controlled() ? drive(i).value(xi) : bearing.force;
      shown.contact_radius = bearing.contact_radius;
      const double area = std::numbers::pi * bearing.contact_radius * bearing.contact_radius;
      shown.pressure = area > 0.0 ? shown.force / area : 0.0;
    } else {
      shown.force = c.is_force_controlled() ? drive(i).value(xi) : law_.force(c.branch(), d);
    }
    return shown;
  }
  [[nodiscard]] VisibleContact visible_follower(double d) {
    if constexpr (requires(Law & law, const Branch& b) { law.follower(b, true, 1.0); }) {
      const Contact& leader = contacts_[leader_];
      return law_.follower(leader.branch(), leader.touches(), d);
    } else {
      return {};
    }
  }

  /// The guards that may fire before the end of the step.
  void arm_guards(double xi) {
    guards_.clear();
    targets_.clear();
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      const Contact& c = contacts_[i];
      if (follows_centre(i)) {
        arm_guards_with_centre(i, xi);
        continue;
      }
      const int direction = drive(i).direction();
      if (is_follower(i) || direction == 0) continue;
      if (direction > 0 && c.touches()) {
        const auto ahead = c.next(law_);
        const double target = ahead ? c.prescribed_at(law_, *ahead) : 0.0;
        if (ahead && c.passes(target)) add_guard(k_boundary, i, direction, ahead->event, target);
      } else if (c.passes_opening(law_) && c.touches() == (direction < 0)) {
        const double opening = c.is_force_controlled() ? 0.0 : law_.opening(c.branch());
        add_guard(direction < 0 ? k_lost : k_made, i, direction, direction < 0 ? "contact-lost" : c.made_event(law_),
                  opening);
      }
    }
  }
  void add_guard(GuardKind kind, std::size_t i, int direction, std::string_view name, double target) {
    guards_.push_back({.kind = kind,
                       .index = static_cast<int>(i),
                       .direction = direction,
                       .name = name,
                       .is_exact = true,
                       .is_monotone = true});
    targets_.push_back(target);
  }

  Law law_;
  double length_;      ///< R0 [m]
  double force_unit_;  ///< [N]
  std::vector<ContactClass> classes_;
  std::vector<Contact> contacts_;
  std::vector<std::size_t> slots_;     ///< in y, of the coordinate of each class that takes a force
  std::vector<double> displacements_;  ///< of a row
  std::vector<bool> is_follower_;      ///< a contact that follows the leader's displacement, and does not act back
  std::size_t leader_ = 0;
  Columns columns_;
  Scales scales_;
  std::vector<Unknown> unknowns_;
  std::size_t work_slot_ = 0;
  std::optional<FreeCentre> centre_;
  std::size_t centre_slot_ = 0;   ///< in y, of the first coordinate of the centre
  Vector rest_ = Vector::Zero();  ///< of the centre, where the present mode began
  std::vector<Role> roles_;
  double ahead_ = k_least_ahead;
  std::vector<double> rates_;  ///< of what the program prescribes
  std::vector<double> trial_;  ///< work space
  bool has_begun_ = false;
  std::vector<Guard> guards_;
  std::vector<double> targets_;  ///< what the program prescribes where they are zero
};

}  // namespace monograin::contacts
