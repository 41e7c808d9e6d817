/// Systems that pass every call on to another one, and measure, disturb or end its run.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "system/hybrid_system.hpp"

namespace monograin {

/// Passes every call on to another system.
class WrappedSystem : public HybridSystem {
 protected:
  using State = std::span<double>;
  using View = std::span<const double>;

 public:
  explicit WrappedSystem(std::unique_ptr<HybridSystem> system) : system_(std::move(system)) {}

  void leave_out_energies() noexcept override {
    Equations::leave_out_energies();
    system_->leave_out_energies();
  }
  [[nodiscard]] std::span<const Unknown> unknowns() const noexcept override { return system_->unknowns(); }
  [[nodiscard]] std::span<const ContactClass> classes() const noexcept override { return system_->classes(); }
  void start(State y) override { system_->start(y); }
  void begin_step(std::span<const Ramp> ramps, State y, std::vector<Event>& log) override {
    system_->begin_step(ramps, y, log);
  }
  [[nodiscard]] std::function<void()> checkpoint() override { return system_->checkpoint(); }
  void complete(double xi, State y) override { system_->complete(xi, y); }
  void rates(double xi, View y, State dy) override { system_->rates(xi, y, dy); }
  void all_rates(double xi, View y, State dy) override { system_->all_rates(xi, y, dy); }
  void residual(double xi, View y, View dy, State res) override { system_->residual(xi, y, dy, res); }
  [[nodiscard]] bool is_semi_explicit() const noexcept override { return system_->is_semi_explicit(); }
  [[nodiscard]] bool has_corrections() const noexcept override { return system_->has_corrections(); }
  [[nodiscard]] double error_gain() const noexcept override { return system_->error_gain(); }
  [[nodiscard]] bool is_solvable() const noexcept override { return system_->is_solvable(); }
  [[nodiscard]] bool is_solvable_here() const noexcept override { return system_->is_solvable_here(); }
  void solve(double xi, State y) override { system_->solve(xi, y); }
  double leave_singularity(double xi, State y) override { return system_->leave_singularity(xi, y); }
  [[nodiscard]] double next_kink(double after, double xi, View y) override { return system_->next_kink(after, xi, y); }
  [[nodiscard]] std::optional<double> closed_quadrature(double xi, View y) override {
    return system_->closed_quadrature(xi, y);
  }
  [[nodiscard]] bool is_quadrature_costly() const noexcept override { return system_->is_quadrature_costly(); }
  [[nodiscard]] std::span<const Guard> guards() const noexcept override { return system_->guards(); }
  void guard_values(double xi, View y, State values) override { system_->guard_values(xi, y, values); }
  std::optional<DomainEnd> fire(std::span<const std::size_t> fired, double xi, State y,
                                std::vector<Event>& log) override {
    return system_->fire(fired, xi, y, log);
  }
  [[nodiscard]] std::span<const Observable> observables() const noexcept override { return system_->observables(); }
  void observe(double xi, View y, State values) override { system_->observe(xi, y, values); }
  [[nodiscard]] double quantity(Quantity quantity, int channel, double xi, View y) override {
    return system_->quantity(quantity, channel, xi, y);
  }
  [[nodiscard]] double controlled(Control control, int channel, double xi, View y) override {
    return system_->controlled(control, channel, xi, y);
  }
  [[nodiscard]] std::vector<SurfacePoint> surface(int contact_class, double xi, View y) override {
    return system_->surface(contact_class, xi, y);
  }
  [[nodiscard]] bool is_open(int contact_class) const noexcept override { return system_->is_open(contact_class); }
  [[nodiscard]] bool contacts_adhere() const noexcept override { return system_->contacts_adhere(); }
  [[nodiscard]] std::optional<Difficulty> difficulty(double xi, View y) override { return system_->difficulty(xi, y); }
  [[nodiscard]] std::vector<Diagnostic> warnings() const override { return system_->warnings(); }
  void branch_reach(View y, State reach) const override { system_->branch_reach(y, reach); }

 private:
  std::unique_ptr<HybridSystem> system_;
};

/// Calls a function before the evaluations that every integrator repeats; the function may throw to end the run.
class WatchedSystem final : public WrappedSystem {
 public:
  WatchedSystem(std::unique_ptr<HybridSystem> system, std::function<void()> before)
      : WrappedSystem(std::move(system)), before_(std::move(before)) {}

  void rates(double xi, View y, State dy) override {
    before_();
    WrappedSystem::rates(xi, y, dy);
  }
  void residual(double xi, View y, View dy, State res) override {
    before_();
    WrappedSystem::residual(xi, y, dy, res);
  }
  void solve(double xi, State y) override {
    before_();
    WrappedSystem::solve(xi, y);
  }
  void guard_values(double xi, View y, State values) override {
    before_();
    WrappedSystem::guard_values(xi, y, values);
  }
  void observe(double xi, View y, State values) override {
    before_();
    WrappedSystem::observe(xi, y, values);
  }

 private:
  std::function<void()> before_;
};

}  // namespace monograin
