/// A plastic particle between rigid walls as a hybrid system, by one of the laws of this folder.
///
/// Every contact depends on the displacement of its own wall alone, but for the lateral contacts of a die, which depend
/// on that of the axial walls and do not act back. Lengths in R0, stresses in the strength S.
///
/// Unknowns: for every wall whose force is prescribed at some time a coordinate u of its displacement in which the
/// force begins linearly, so that nothing is singular at first touch: x^n with P ~ x^n for small x, or, on an unloading
/// branch, the power 3/2 of the distance from its opening, and the displacement itself while that is what is
/// prescribed; and the work of the walls. Under a prescribed force F the
/// explicit form is u' = F'/(dP/du), the implicit one P(u) = F, and the direct one inverts the law.
///
/// Unloading: the source has no law. `mdr` gives every yielded contact the elastic indenter that model mdr would leave
/// under the same mean pressure and contact radius; a contact that has not yielded goes back the way it came.
#pragma once

#include <vector>

#include "mdr/contact.hpp"
#include "plastic/law.hpp"
#include "system/hybrid_system.hpp"

namespace monograin::plastic {

enum class Unloading { none, mdr };

struct Settings {
  Law law;
  double initial_radius = 0.0;  ///< R0 [m], > 0
  double strength = 0.0;        ///< S [Pa], > 0
  Unloading unloading = Unloading::none;
  double composite_modulus = 0.0;          ///< E* [Pa], > 0; for unloading only
  double poisson_ratio = 0.0;              ///< for unloading only
  std::vector<OutOfRange> out_of_range{};  ///< what of the material the law was not fitted to
  /// Largest displacement [m] and force [N] the program asks of a wall: how large the unknowns become, which absolute
  /// tolerances are relative to. 0: not said.
  double largest_displacement = 0.0;
  double largest_force = 0.0;
};

class System final : public HybridSystem {
 public:
  System(Settings settings, std::vector<ContactClass> classes);

  [[nodiscard]] std::span<const Unknown> unknowns() const noexcept override { return unknowns_; }
  [[nodiscard]] std::span<const ContactClass> classes() const noexcept override { return classes_; }
  void start(std::span<double> y) override;
  /// @throws std::domain_error where a wall would go back and there is no unloading
  void begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) override;
  [[nodiscard]] std::function<void()> checkpoint() override {
    return [this, then = *this] { *this = then; };
  }
  void complete(double xi, std::span<double> y) override;
  void rates(double xi, std::span<const double> y, std::span<double> dy) override;
  void all_rates(double xi, std::span<const double> y, std::span<double> dy) override { rates(xi, y, dy); }
  void residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) override;
  void solve(double xi, std::span<double> y) override;
  [[nodiscard]] std::optional<double> closed_quadrature(double xi, std::span<const double> y) override;
  [[nodiscard]] std::span<const Guard> guards() const noexcept override { return guards_; }
  void guard_values(double xi, std::span<const double> y, std::span<double> values) override;
  std::optional<DomainEnd> fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                std::vector<Event>& log) override;
  [[nodiscard]] std::span<const Observable> observables() const noexcept override { return observables_; }
  void observe(double xi, std::span<const double> y, std::span<double> values) override;
  [[nodiscard]] double quantity(Quantity quantity, int contact_class, double xi, std::span<const double> y) override;
  [[nodiscard]] double controlled(Control control, int contact_class, double xi, std::span<const double> y) override;
  [[nodiscard]] bool is_open(int contact_class) const noexcept override;
  [[nodiscard]] std::optional<Difficulty> difficulty(double xi, std::span<const double> y) override;
  [[nodiscard]] std::vector<Diagnostic> warnings() const override;

 private:
  /// What a contact class remembers: changed by transitions only.
  struct Memory {
    Regime regime = Regime::open;
    bool is_on_primary_branch = true;  ///< at its largest displacement
    double largest = 0.0;              ///< largest displacement, off the primary branch
    double largest_force = 0.0;        ///< there
    double resting = 0.0;              ///< displacement at which an open wall without load was left
    std::size_t next = 0;              ///< boundary ahead on the primary branch
    bool has_impinged = false;         ///< has met its neighbours
    mdr::UnloadingShape indenter{};    ///< of a contact that has been unloaded since it yielded
  };

  /// What the history shows of a contact.
  struct Contact {
    double force = 0.0;
    double stiffness = 0.0;  ///< dP/dx
    double contact_radius = 0.0;
    double pressure = 0.0;
  };

  /// u = unit ((x - origin)/length)^power of the present branch.
  struct Chart {
    double origin = 0.0;
    double length = 1.0;
    double unit = 1.0;
    double power = 1.0;
  };

  /// Force over the coordinate u and over the displacement.
  struct Slope {
    double force = 0.0;
    double by_coordinate = 0.0;
    double by_displacement = 0.0;
  };

  /// Whether a class is that of the fixed walls of a die, whose contacts follow from the axial ones.
  [[nodiscard]] bool is_lateral(std::size_t i) const noexcept { return is_lateral_[i]; }
  [[nodiscard]] bool is_loaded(std::size_t i) const noexcept { return ramps_[i].control == Control::force; }
  [[nodiscard]] static bool touches(Regime regime) noexcept {
    return regime != Regime::open && regime != Regime::separated;
  }
  [[nodiscard]] bool presses(std::size_t i) const noexcept { return is_loaded(i) && touches(memory_[i].regime); }
  /// Direction of the present ramp: 1 loading, -1 unloading, 0 holding.
  [[nodiscard]] int direction(std::size_t i) const noexcept { return directions_[i]; }
  [[nodiscard]] int direction_of_ramp(std::size_t i, double x) const;
  [[nodiscard]] bool is_reloaded(std::size_t i, double x) const;
  [[nodiscard]] double prescribed(std::size_t i, double xi) const noexcept;
  [[nodiscard]] bool is_on_indenter(std::size_t i) const noexcept;
  [[nodiscard]] double origin(std::size_t i) const noexcept;
  [[nodiscard]] Chart chart(std::size_t i) const noexcept;
  [[nodiscard]] double stretch(std::size_t i, double distance) const noexcept;
  [[nodiscard]] double coordinate(std::size_t i, double x) const noexcept;
  [[nodiscard]] double displacement_at(std::size_t i, double u) const noexcept;
  [[nodiscard]] double displacement(std::size_t i, double xi, std::span<const double> y) const noexcept;
  [[nodiscard]] bool is_known(std::size_t i) const noexcept;
  [[nodiscard]] double known_coordinate(std::size_t i, double xi, std::span<const double> y) const;
  [[nodiscard]] double displacement_under_force(std::size_t i, double force, double near = 0.0) const;
  [[nodiscard]] Contact seen(std::size_t i, double xi, std::span<const double> y) const;
  [[nodiscard]] Contact contact(std::size_t i, double x) const;
  [[nodiscard]] Contact lateral_contact(std::size_t i, double x) const;
  [[nodiscard]] static Contact seen_on_indenter(const mdr::Contact& c) noexcept;
  [[nodiscard]] Contact contact_at_distance(std::size_t i, double distance) const;
  [[nodiscard]] std::optional<DomainEnd> end_passed(std::size_t i, double x, std::vector<Event>& log) const;
  [[nodiscard]] Slope slope(std::size_t i, double u) const;
  [[nodiscard]] double power(std::size_t i, double xi, const Slope& now) const;
  [[nodiscard]] double stored_energy(std::size_t i, double x) const;
  [[nodiscard]] mdr::UnloadingShape indenter_at(std::size_t i, double x) const;

  void meet_walls(std::size_t i, double x, std::vector<Event>& log);
  void turn_back(std::size_t i, double x, std::vector<Event>& log);
  void lose_contact(std::size_t i);
  void resume_loading(std::size_t i, double x, std::vector<Event>& log);
  void resolve_lateral();
  void arm_guards(double xi, std::span<const double> y);
  void watch_primary(std::size_t i, double x, double target);
  void add_guard(int kind, std::size_t i, int direction, std::string_view name, double place);

  Settings settings_;
  double modulus_ = 0.0;     ///< E* over S
  bool is_shallow_ = false;  ///< no contact of the program is deeper than rounding
  std::vector<ContactClass> classes_;
  std::vector<bool> is_lateral_;
  std::size_t first_primary_ = 0;
  std::optional<LateralLaw> lateral_law_;
  Boundaries boundaries_;
  Boundaries lateral_boundaries_;
  std::optional<double> impingement_;
  std::vector<Unknown> unknowns_;
  std::vector<Observable> observables_;
  std::vector<std::size_t> places_;  ///< in y, of the coordinate of each class that takes a force; else 0
  std::size_t work_place_ = 0;

  std::vector<Ramp> ramps_;  ///< displacements over R0, forces over S R0^2
  std::vector<int> directions_;
  bool has_begun_ = false;
  std::vector<Memory> memory_;
  std::vector<Guard> guards_;
  std::vector<double> guard_places_;  ///< x at which they are zero

  std::vector<std::string> range_messages_;
  double farthest_ = 0.0;               ///< largest x looked at
  bool has_lateral_gap_ = false;        ///< a lateral contact was undefined
  std::optional<double> overshooting_;  ///< recovery over displacement of a contact that opens beyond first touch
};

}  // namespace monograin::plastic
