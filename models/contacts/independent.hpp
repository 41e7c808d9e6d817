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
///   stored(b, d)                energy that unloading gives back
///   contact_radius(b, d)        over R0
///   next(b), pass(b)            boundary ahead on the primary loading branch; what changes there
///   turn(b, d), reload(b)       begins to unload at d; is back there. Without them a contact goes back as it came
///   k_opens_beyond              true: a wall that ends a step at opening() is as it was, touching or not
///   made_event(b)               name of the event of touching, if it is not "contact-made"
///   surface(b, d)               points of the surface; pressures over unit_force/R0^2
///   start(), warnings(walls)    forgets, and tells, what the law has noted on the way; walls: how many have touched
///
/// Unknowns: a coordinate of every wall whose force is prescribed at some time, and the work of the walls. The
/// coordinate is in proportion to the force while that is prescribed: linear in the step coordinate, it is exact in
/// every form of the equations, and nothing is singular at first touch or where a contact opens with an infinite
/// compliance. Otherwise it is the displacement. Guards are functions of the program alone.
#pragma once

#include <concepts>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "contacts/columns.hpp"
#include "contacts/wall_contact.hpp"

namespace monograin::contacts {

struct Settings {
  double initial_radius = 1.0;  ///< R0 [m], > 0
  /// Largest displacement [m] and force [N] the program asks of a wall: how large the unknowns become, which absolute
  /// tolerances are relative to. 0: not said.
  double largest_displacement = 0.0;
  double largest_force = 0.0;
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
        columns_(k_has_stored_energy, k_has_contact_area, Law::k_regimes, classes_) {
    const double work = set_scales(settings.largest_displacement / length_, settings.largest_force / force_unit_);
    for (std::size_t i = 0; i < classes_.size(); ++i) {
      if (!classes_[i].takes_force) continue;
      slots_[i] = unknowns_.size();
      unknowns_.push_back({classes_[i].name, Unknown::Kind::differential, reach_, true});
    }
    work_slot_ = unknowns_.size();
    unknowns_.push_back({"work", Unknown::Kind::quadrature, work, false});
  }
  /// Makes the law, and the Settings, of a model's own settings.
  template <class OfModel>
  requires std::constructible_from<Law, OfModel> IndependentContacts(const OfModel& settings,
                                                                     std::vector<ContactClass> classes)
      : IndependentContacts(Law(settings),
                            {settings.initial_radius, settings.largest_displacement, settings.largest_force},
                            std::move(classes)) {}

  [[nodiscard]] std::span<const Unknown> unknowns() const noexcept override { return unknowns_; }
  [[nodiscard]] std::span<const ContactClass> classes() const noexcept override { return classes_; }
  [[nodiscard]] std::span<const Guard> guards() const noexcept override { return guards_; }
  [[nodiscard]] std::span<const Observable> observables() const noexcept override { return columns_.observables(); }
  [[nodiscard]] bool is_open(int contact_class) const noexcept override { return !contact(contact_class).touches(); }
  [[nodiscard]] std::function<void()> checkpoint() override {
    return [this, then = *this] { *this = then; };
  }

  void start(std::span<double> y) override {
    std::ranges::fill(y, 0.0);
    has_begun_ = false;
    if constexpr (requires(Law & law) { law.start(); }) law_.start();
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      contacts_[i] = {static_cast<int>(i), -classes_[i].gap / length_};
    }
    complete(0.0, y);
  }

  void begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) override {
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      Contact& c = contacts_[i];
      const bool is_by_force = ramps[i].control == Control::force;
      const WallDrive drive(ramps[i], is_by_force ? force_unit_ : length_);
      const double d = is_by_force ? displacement_at(c, y[slots_[i]]) : drive.start();
      c.take_up(drive);
      // A driven wall that touches the fresh particle is in contact from the start, without an event.
      if (const auto end = c.begin_step(law_, d, has_begun_ || classes_[i].gap > 0.0, log)) throw CannotBegin(*end);
    }
    has_begun_ = true;
    complete(0.0, y);
    arm_guards();
  }

  void complete(double xi, std::span<double> y) override {
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      if (classes_[i].takes_force) y[slots_[i]] = coordinate(contacts_[i], xi);
    }
  }
  void solve(double xi, std::span<double> y) override { complete(xi, y); }

  void rates(double xi, std::span<const double> /*y*/, std::span<double> dy) override {
    dy[work_slot_] = power(xi);
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      if (classes_[i].takes_force)
        dy[slots_[i]] = contacts_[i].drive().rate() / prescribed_per_coordinate(contacts_[i]);
    }
  }
  void all_rates(double xi, std::span<const double> y, std::span<double> dy) override { rates(xi, y, dy); }

  void residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) override {
    res[work_slot_] = dy[work_slot_] - power(xi);
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      if (classes_[i].takes_force) res[slots_[i]] = y[slots_[i]] - coordinate(contacts_[i], xi);
    }
  }

  [[nodiscard]] std::optional<double> closed_quadrature(double xi, std::span<const double> /*y*/) override {
    if constexpr (k_has_work) {
      return sum([&](const Contact& c) { return c.touches() ? law_.work(c.branch(), c.displacement(law_, xi)) : 0.0; });
    } else {
      return std::nullopt;
    }
  }

  void guard_values(double xi, std::span<const double> /*y*/, std::span<double> values) override {
    for (std::size_t g = 0; g < guards_.size(); ++g) {
      // Ramps are as short as contacts are shallow.
      const WallDrive& drive = contact(guards_[g].index).drive();
      values[g] = (drive.value(xi) - targets_[g]) / drive.size();
    }
  }

  std::optional<DomainEnd> fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                std::vector<Event>& log) override {
    for (const std::size_t g : fired) {
      Contact& c = contacts_[static_cast<std::size_t>(guards_[g].index)];
      std::optional<DomainEnd> end;
      if (guards_[g].kind == k_made)
        c.make(law_, true, log);
      else if (guards_[g].kind == k_lost)
        c.lose(law_, log);
      else
        end = c.pass(law_, *c.next(law_), log);
      // A dent may be shallower than the round-off of a ramp, and so may be what lies beyond a boundary.
      if (!end && guards_[g].kind != k_lost) end = c.pass_reached(law_, xi, log);
      if (end) return end;
    }
    complete(xi, y);
    arm_guards();
    return std::nullopt;
  }

  void observe(double xi, std::span<const double> y, std::span<double> values) override {
    const double energy_unit = force_unit_ * length_;
    Energies energies{.work = y[work_slot_] * energy_unit};
    if constexpr (k_has_stored_energy) {
      energies.stored = energy_unit * sum([&](const Contact& c) {
                          const double d = c.displacement(law_, xi);
                          return c.bears(law_, d) ? law_.stored(c.branch(), d) : 0.0;
                        });
      energies.dissipation = energies.work - energies.stored;
    }
    columns_.write(
        energies, contacts_.size(), [&](std::size_t i) { return visible(contacts_[i], xi); }, values);
  }

  /// @throws std::logic_error for what the law does not have
  [[nodiscard]] double quantity(Quantity quantity, int contact_class, double xi,
                                std::span<const double> /*y*/) override {
    const bool is_of_area = quantity == Quantity::pressure || quantity == Quantity::contact_radius;
    if (is_of_area && !k_has_contact_area) throw std::logic_error("no such quantity at a wall of this model");
    const VisibleContact shown = visible(contact(contact_class), xi);
    return quantity_of({.force = shown.force,
                        .displacement = shown.displacement,
                        .pressure = shown.pressure,
                        .contact_radius = shown.contact_radius,
                        .apparent_radius = length_},
                       quantity);
  }
  [[nodiscard]] double controlled(Control control, int contact_class, double xi, std::span<const double> y) override {
    return quantity(control == Control::force ? Quantity::force : Quantity::displacement, contact_class, xi, y);
  }

  [[nodiscard]] std::vector<SurfacePoint> surface(int contact_class, double xi,
                                                  std::span<const double> /*y*/) override {
    std::vector<SurfacePoint> points;
    if constexpr (requires(Law & law, const Branch& b) { law.surface(b, 1.0); }) {
      const Contact& c = contact(contact_class);
      const double d = c.displacement(law_, xi);
      if (c.bears(law_, d)) points = law_.surface(c.branch(), d);
      for (SurfacePoint& point : points) {
        point.radius *= length_;
        point.pressure *= force_unit_ / (length_ * length_);
        point.displacement *= length_;
        point.relaxed_height *= length_;
      }
    }
    return points;
  }

  /// Of the whole program: every contact is as shallow when it is made.
  [[nodiscard]] std::optional<Difficulty> difficulty(double /*xi*/, std::span<const double> /*y*/) override {
    constexpr double k_least_depth = 1e-12;
    return reach_ <= k_least_depth ? std::optional(Difficulty::below_resolution) : std::nullopt;
  }

  [[nodiscard]] std::vector<Diagnostic> warnings() const override {
    if constexpr (requires(const Law& law) { law.warnings(0.0); })
      return law_.warnings(sum([](const Contact& c) { return c.has_touched() ? 1.0 : 0.0; }));
    else
      return {};
  }

 private:
  using Branch = typename Law::Branch;
  using Contact = WallContact<Law>;
  static constexpr bool k_has_work = requires(Law & law, const Branch& b) { law.work(b, 1.0); };
  static constexpr bool k_has_stored_energy = requires(Law & law, const Branch& b) { law.stored(b, 1.0); };
  static constexpr bool k_has_contact_area = requires(Law & law, const Branch& b) { law.contact_radius(b, 1.0); };

  enum GuardKind : int { k_made, k_boundary, k_lost };

  [[nodiscard]] const Contact& contact(int contact_class) const noexcept {
    return contacts_[static_cast<std::size_t>(contact_class)];
  }

  /// Sum over all walls.
  template <class OfContact>
  [[nodiscard]] double sum(OfContact&& of_contact) const {
    double total = 0.0;
    for (std::size_t i = 0; i < contacts_.size(); ++i) total += classes_[i].multiplicity() * of_contact(contacts_[i]);
    return total;
  }
  [[nodiscard]] double power(double xi) const {
    return sum([&](const Contact& c) { return c.power(law_, xi); });
  }

  /// Takes how far the program goes for the magnitude of displacements, or where that is not said the end of the law.
  /// @return the work of one wall up to there
  double set_scales(double displacement, double force) {
    constexpr double k_infinity = std::numeric_limits<double>::infinity();
    const bool is_said = displacement > 0.0 || force > 0.0;
    const Contact last = Contact::pressed_to(law_, is_said ? displacement : k_infinity, force);
    const auto ahead = last.next(law_);
    const double end = ahead && ahead->limit ? ahead->position : k_infinity;
    reach_ = is_said ? displacement : std::isfinite(end) ? end : 1.0;
    if (force > 0.0) reach_ = std::max(reach_, last.displacement_under(law_, force));
    reach_ = std::min(reach_, end);
    const double at_reach = law_.force(last.branch(), reach_);
    force_per_coordinate_ = at_reach / reach_;
    if constexpr (k_has_work) return law_.work(last.branch(), reach_);
    return at_reach * reach_;
  }

  /// What is prescribed over the coordinate.
  [[nodiscard]] double prescribed_per_coordinate(const Contact& c) const {
    return c.is_force_controlled() ? force_per_coordinate_ : 1.0;
  }
  /// Coordinate of a wall whose force is prescribed at some time.
  [[nodiscard]] double coordinate(const Contact& c, double xi) const {
    return c.drive().value(xi) / prescribed_per_coordinate(c);
  }
  /// Displacement that a coordinate stands for.
  [[nodiscard]] double displacement_at(const Contact& c, double u) const {
    return c.is_force_controlled() ? c.displacement_under(law_, u * force_per_coordinate_) : u;
  }

  [[nodiscard]] VisibleContact visible(const Contact& c, double xi) const {
    const double d = c.displacement(law_, xi);
    VisibleContact shown{.displacement = d * length_,
                         .overlap = d * length_,
                         .force = c.visible_force(law_, xi) * force_unit_,
                         .regime = static_cast<double>(law_.regime(c.branch(), c.touches()))};
    if constexpr (k_has_contact_area) {
      if (!c.bears(law_, d)) return shown;
      shown.contact_radius = law_.contact_radius(c.branch(), d) * length_;
      shown.pressure = shown.force / (std::numbers::pi * shown.contact_radius * shown.contact_radius);
    }
    return shown;
  }

  /// The guards that may fire before the end of the step. A wall that ends where it meets or leaves the particle has
  /// met or left it, but a force that ends at nothing has not; any other boundary at which a step ends is passed by the
  /// next one, if that goes on.
  void arm_guards() {
    guards_.clear();
    targets_.clear();
    for (const Contact& c : contacts_) {
      const WallDrive& drive = c.drive();
      const bool is_by_force = c.is_force_controlled();
      const double opening = is_by_force ? 0.0 : law_.opening(c.branch());
      if (drive.direction() < 0 && c.touches()) {
        if (drive.end() < opening || (!is_by_force && opens_at(drive.end(), opening)))
          add_guard(k_lost, c, -1, "contact-lost", opening);
      } else if (drive.direction() > 0 && c.touches()) {
        const auto ahead = c.next(law_);
        const double target = ahead ? c.prescribed_at(law_, *ahead) : 0.0;
        if (ahead && drive.goes_beyond(target)) add_guard(k_boundary, c, 1, ahead->event, target);
      } else if (drive.direction() > 0 && !is_by_force) {
        if (drive.end() > opening || opens_at(drive.end(), opening))
          add_guard(k_made, c, 1, c.made_event(law_), opening);
      }
    }
  }
  [[nodiscard]] static bool opens_at(double end, double opening) noexcept {
    if constexpr (requires { Law::k_opens_beyond; }) return !Law::k_opens_beyond && end == opening;
    return end == opening;
  }
  void add_guard(GuardKind kind, const Contact& c, int direction, std::string_view name, double target) {
    guards_.push_back({.kind = kind,
                       .index = static_cast<int>(&c - contacts_.data()),
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
  std::vector<std::size_t> slots_;  ///< in y, of the coordinate of each class that takes a force
  Columns columns_;
  double reach_ = 1.0;                 ///< largest displacement that is expected
  double force_per_coordinate_ = 1.0;  ///< where the force is prescribed
  std::vector<Unknown> unknowns_;
  std::size_t work_slot_ = 0;
  bool has_begun_ = false;
  std::vector<Guard> guards_;
  std::vector<double> targets_;  ///< what the program prescribes where they are zero
};

}  // namespace monograin::contacts
