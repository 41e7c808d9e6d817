/// The nonlocal elastic sphere between rigid walls as a hybrid system.
///
/// Unknowns: the signed square s of the contact radius of every class, the displacement of a free centre, and the work
/// of the walls. In s the equations are regular from the unloaded state on, and its sign says whether a contact is
/// open; in force or radius the rates would be infinite there. A class under force control has s^(3/2) as its unknown
/// instead: s follows from the force alone, and s^(3/2) begins linearly. Three forms: direct, Newton's method for all
/// unknowns at an instant; explicit, ds/dxi from the same matrix; implicit, the equations themselves.
///
/// Elastic: a contact has no memory, and the work of the walls is the stored energy. Lengths over R0, forces over E
/// R0^2. Source: Agarwal and Gonzalez (2018).
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "elastic/nonlocal_contacts.hpp"
#include "elastic/nonlocal_equilibrium.hpp"
#include "elastic/nonlocal_rates.hpp"
#include "elastic/nonlocal_support.hpp"
#include "system/hybrid_system.hpp"

namespace monograin::nonlocal {

struct Settings {
  Formulation model;
  RadiusRule radius_rule = RadiusRule::closed;
  double initial_radius = 0.0;  ///< R0 [m], > 0
  double youngs_modulus = 0.0;  ///< E [Pa], > 0
  Centre centre = Centre::fixed;
  /// Largest displacement [m] and force [N] that the program prescribes to a wall. They set the size of the unknowns,
  /// to which absolute tolerances are relative. 0: not known.
  double largest_displacement = 0.0;
  double largest_force = 0.0;
};

class System final : public HybridSystem {
 public:
  /// @throws std::invalid_argument as Contacts
  System(const Settings& settings, std::vector<ContactClass> classes);

  [[nodiscard]] std::span<const Unknown> unknowns() const noexcept override { return unknowns_; }
  [[nodiscard]] std::span<const ContactClass> classes() const noexcept override { return classes_; }
  void start(std::span<double> y) override;
  void begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) override;
  [[nodiscard]] std::function<void()> checkpoint() override {
    return [this, then = *this] { *this = then; };
  }
  void complete(double xi, std::span<double> y) override;
  void rates(double xi, std::span<const double> y, std::span<double> dy) override;
  void all_rates(double xi, std::span<const double> y, std::span<double> dy) override { rates(xi, y, dy); }
  void residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) override;
  void solve(double xi, std::span<double> y) override;
  double leave_singularity(double xi, std::span<double> y) override;
  void branch_reach(std::span<const double> y, std::span<double> reach) const override;
  [[nodiscard]] std::optional<double> closed_quadrature(double xi, std::span<const double> y) override;
  [[nodiscard]] std::span<const Guard> guards() const noexcept override { return guards_; }
  void guard_values(double xi, std::span<const double> y, std::span<double> values) override;
  std::optional<DomainEnd> fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                std::vector<Event>& log) override;
  [[nodiscard]] std::span<const Observable> observables() const noexcept override { return observables_; }
  void observe(double xi, std::span<const double> y, std::span<double> values) override;
  [[nodiscard]] double quantity(Quantity quantity, int contact_class, double xi, std::span<const double> y) override;
  [[nodiscard]] double controlled(Control control, int contact_class, double xi, std::span<const double> y) override;
  [[nodiscard]] std::vector<SurfacePoint> surface(int contact_class, double xi, std::span<const double> y) override;
  [[nodiscard]] bool is_open(int contact_class) const noexcept override;
  [[nodiscard]] std::vector<Diagnostic> warnings() const override;
  [[nodiscard]] std::optional<Difficulty> difficulty(double xi, std::span<const double> y) override;

 private:
  enum class Regime { open, elastic };

  /// Two walls, given by their classes, that may meet on the surface of the particle; one pair for each angle.
  struct Pair {
    std::size_t first = 0, second = 0;
    double angle = 0.0;
    bool has_impinged = false;
  };

  [[nodiscard]] static std::vector<Pair> pairs_of(std::span<const ContactClass> classes);
  [[nodiscard]] double greatest_depth() const;
  double set_scales();
  void list_unknowns(double depth);
  void list_observables();
  void reserve_work_space();
  /// Signed square of a force-controlled class from its unknown.
  [[nodiscard]] static double square_of(double power);
  [[nodiscard]] bool is_loaded(std::size_t i) const noexcept { return ramps_[i].control == Control::force; }
  [[nodiscard]] double prescribed(std::size_t i, double xi) const noexcept;
  [[noreturn]] void throw_pull(std::size_t i) const;
  void or_pull_that_follows(double xi, auto&& ask) const;
  [[nodiscard]] double end_of_force(std::size_t i) const noexcept;
  [[nodiscard]] double square_under_force(std::size_t i, double xi) const;
  std::span<double> evaluate(double xi, std::span<const double> y);
  [[nodiscard]] bool only_stands(std::size_t i, double xi, std::span<const double> y);
  void resolve_others(double xi, std::span<const std::size_t> fired, std::vector<Event>& log);
  void evaluate_closely(double xi, std::span<const double> y);
  void mark_closed();
  void note(std::span<double> y) const;
  [[nodiscard]] double depth(std::size_t i, double xi);
  [[nodiscard]] double shift(std::size_t i, std::span<const double> y) const noexcept;
  [[nodiscard]] std::optional<DomainEnd> limit_at_start(std::span<const double> y);
  [[nodiscard]] double limit_value(const Guard& guard, double xi);
  [[nodiscard]] DomainEnd end_at(const Guard& guard, double xi, std::span<const double> y);
  [[nodiscard]] double angle_between_edges(const Pair& pair, double xi);
  [[nodiscard]] std::optional<double> square_ahead(std::size_t i, double xi);
  void resolve_mode(double xi, std::vector<Event>& log);
  void mark_touching();
  void arm_guards();
  void arm_contacts();
  void arm_carriers();
  void arm_impingement();
  void arm_ends_of_forces();
  void arm_limits();
  void add_guard(int kind, std::size_t index, int direction, std::string_view name);

  /// Margin below which the source's formulation counts as stiffened.
  static constexpr double k_stiff_margin = 0.25;
  /// The power of s that is the unknown of a force-controlled class.
  static constexpr double k_force_power = 1.5;

  Settings settings_;
  std::vector<ContactClass> classes_;
  Contacts contacts_;
  EquilibriumSearch search_;
  Rates motion_;
  CentreSupport support_;
  std::vector<Unknown> unknowns_;
  std::vector<Observable> observables_;
  std::size_t work_place_;
  std::vector<Pair> pairs_;
  std::vector<Eigen::VectorXd> arms_;  ///< mean normal of each class along the free directions

  std::vector<Ramp> ramps_;  ///< displacements over R0, forces over E R0^2
  std::vector<Regime> regimes_;
  double touch_ = 0.0;                       ///< touch tolerance: |s| below this is round-off
  double guard_unit_ = 1.0;                  ///< unit of |s| in guards of contacts
  double idle_ = 0.0;                        ///< least s of a contact that supports a free centre
  double widest_ = 1.0;                      ///< largest contact radius over R0 for which states exist
  std::optional<double> greatest_approach_;  ///< approach at widest_, if the radius there has too few digits
  bool is_shallow_ = false;                  ///< no contact of the program is deeper than round-off
  bool has_begun_ = false;
  bool has_stiffened_ = false;
  double least_margin_ = 1.0;
  std::vector<Guard> guards_;
  // Work space, so that nothing is allocated while integrating.
  std::vector<double> state_, rates_;  ///< unknowns of contacts_, and their rates
  std::vector<double> all_rates_;
  std::vector<ContactState> now_;
  std::vector<double> edge_angles_;  ///< edge angles that the guards have computed in this state; nan: none
  std::vector<Ramp> drawn_ramps_;
  std::vector<char> is_closed_;
  std::vector<char> touches_;  ///< wall may move a free centre; if open, until its gap exceeds idle_
};

}  // namespace monograin::nonlocal
