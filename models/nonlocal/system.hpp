/// The nonlocal elastic sphere between rigid walls as a hybrid system.
///
/// Unknowns: the signed square s of the contact radius of every class, the displacement of a free centre, and the work
/// of the walls. In s the equations are regular from the unloaded state on, and its sign says whether a contact is
/// open; in force or radius the rates would be infinite there. A class under force control has s^(3/2) as its unknown
/// instead: s follows from the force alone, and s^(3/2) begins linearly. Three forms: direct, Newton's method for all
/// unknowns at an instant; explicit, ds/dxi from the same matrix; implicit, the equations themselves.
///
/// Elastic: a contact has no memory, and the work of the walls is the stored energy. Lengths over R0, forces over E
/// R0^2. Particle has the equations, GuardSet the guards; System puts these behind the interface HybridSystem.
/// Source: Agarwal and Gonzalez (2018).
#pragma once

#include <optional>
#include <vector>

#include "nonlocal/guards.hpp"
#include "nonlocal/particle.hpp"
#include "nonlocal/setup.hpp"
#include "system/hybrid_system.hpp"

namespace monograin::nonlocal {

class System final : public HybridSystem {
 public:
  /// @throws std::invalid_argument as Contacts
  System(const Settings& settings, std::vector<ContactClass> classes);

  [[nodiscard]] std::span<const Unknown> unknowns() const noexcept override { return unknowns_; }
  [[nodiscard]] std::span<const ContactClass> classes() const noexcept override { return classes_; }
  void start(std::span<double> y) override;
  void begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) override;
  [[nodiscard]] std::function<void()> checkpoint() override {
    return [this, then = now_] { now_ = then; };
  }
  void complete(double xi, std::span<double> y) override { now_.particle.clear_centre(xi, y); }
  void rates(double xi, std::span<const double> y, std::span<double> dy) override { now_.particle.rates(xi, y, dy); }
  void residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) override {
    now_.particle.residual(xi, y, dy, res);
  }
  void solve(double xi, std::span<double> y) override { now_.particle.solve(xi, y); }
  double leave_singularity(double xi, std::span<double> y) override { return now_.particle.leave_singularity(xi, y); }
  void branch_reach(std::span<const double> y, std::span<double> reach) const override {
    now_.particle.branch_reach(y, reach);
  }
  [[nodiscard]] std::optional<double> closed_quadrature(double xi, std::span<const double> y) override;
  [[nodiscard]] std::span<const Guard> guards() const noexcept override { return now_.guards.list(); }
  void guard_values(double xi, std::span<const double> y, std::span<double> values) override {
    now_.guards.values(now_.particle, xi, y, values);
  }
  std::optional<DomainEnd> fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                std::vector<Event>& log) override;
  [[nodiscard]] std::span<const Observable> observables() const noexcept override { return observables_; }
  void observe(double xi, std::span<const double> y, std::span<double> values) override;
  [[nodiscard]] double quantity(Quantity quantity, int contact_class, double xi, std::span<const double> y) override;
  [[nodiscard]] double controlled(Control control, int contact_class, double xi, std::span<const double> y) override;
  [[nodiscard]] std::vector<SurfacePoint> surface(int contact_class, double xi, std::span<const double> y) override;
  [[nodiscard]] bool is_open(int contact_class) const noexcept override {
    return !now_.particle.mode.is_closed[static_cast<std::size_t>(contact_class)];
  }
  [[nodiscard]] std::vector<Diagnostic> warnings() const override;
  [[nodiscard]] std::optional<Difficulty> difficulty(double xi, std::span<const double> y) override {
    return now_.particle.difficulty(xi, y);
  }

 private:
  /// Everything that changes in a run.
  struct State {
    State(const Settings& settings, std::span<const ContactClass> classes)
        : particle(settings, classes), guards(particle.contacts()) {}

    Particle particle;
    GuardSet guards;
    bool has_begun = false;
    double least_margin = 1.0;
  };

  std::vector<ContactClass> classes_;
  State now_;
  std::vector<Unknown> unknowns_;
  std::vector<Observable> observables_;
};

}  // namespace monograin::nonlocal
