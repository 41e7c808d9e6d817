/// The MDR particle between rigid walls as a hybrid system.
///
/// Setup says which unknowns there are, Particle evaluates them, GuardSet and ModeSearch decide the modes; System puts
/// these behind the interface HybridSystem. While the radius grows, the explicit form is the rate that keeps the
/// volume balance (apparent_radius.hpp), and the implicit and direct forms are the balance itself, with its constant
/// frozen at every transition.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "contacts/columns.hpp"
#include "mdr/guards.hpp"
#include "mdr/mode_search.hpp"
#include "mdr/particle.hpp"
#include "system/hybrid_system.hpp"

namespace monograin::mdr {

class System final : public HybridSystem {
 public:
  System(const Settings& settings, std::vector<ContactClass> classes)
      : System(std::make_shared<const Setup>(settings, std::move(classes))) {}

  [[nodiscard]] std::span<const Unknown> unknowns() const noexcept override { return unknowns_; }
  [[nodiscard]] std::span<const ContactClass> classes() const noexcept override { return setup_->classes; }
  void start(std::span<double> y) override;
  void begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) override;
  [[nodiscard]] std::function<void()> checkpoint() override {
    return [this, then = now_] { now_ = then; };
  }
  void complete(double xi, std::span<double> y) override;
  void rates(double xi, std::span<const double> y, std::span<double> dy) override;
  void all_rates(double xi, std::span<const double> y, std::span<double> dy) override;
  void residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) override;
  void solve(double xi, std::span<double> y) override;
  [[nodiscard]] double next_kink(double after, double xi, std::span<const double> y) override;
  [[nodiscard]] std::optional<double> closed_quadrature(double xi, std::span<const double> y) override;
  [[nodiscard]] std::span<const Guard> guards() const noexcept override { return now_.guards.list(); }
  void guard_values(double xi, std::span<const double> y, std::span<double> values) override {
    now_.guards.values(now_.particle, now_.caps, xi, y, values);
  }
  std::optional<DomainEnd> fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                std::vector<Event>& log) override;
  [[nodiscard]] std::span<const Observable> observables() const noexcept override { return observables_; }
  void observe(double xi, std::span<const double> y, std::span<double> values) override;
  [[nodiscard]] double quantity(Quantity quantity, int contact_class, double xi, std::span<const double> y) override;
  [[nodiscard]] double controlled(Control control, int contact_class, double xi, std::span<const double> y) override;
  [[nodiscard]] std::vector<SurfacePoint> surface(int contact_class, double xi, std::span<const double> y) override;
  [[nodiscard]] bool is_open(int contact_class) const noexcept override {
    return !now_.particle.branch(static_cast<std::size_t>(contact_class)).touches();
  }
  [[nodiscard]] bool contacts_adhere() const noexcept override { return setup_->law.adheres(); }
  [[nodiscard]] std::optional<Difficulty> difficulty(double xi, std::span<const double> y) override;
  [[nodiscard]] std::vector<Diagnostic> warnings() const override;

 private:
  /// Everything that changes in a run.
  struct State {
    Particle particle;
    GuardSet guards{};
    ContactCaps caps;
    std::optional<Diagnostic> validity{};  ///< for the first adhesive contact that unloads outside the model's validity
    bool has_begun = false;
  };

  explicit System(std::shared_ptr<const Setup> setup);
  template <class Search>
  void decide_mode(std::span<double> y, Search&& search);
  void stick_under_force(std::span<const double> y, std::vector<Event>& log);
  [[nodiscard]] contacts::VisibleContact visible(std::size_t i) const;
  [[nodiscard]] std::optional<DomainEnd> reach_centre_at_once(double xi, std::span<const double> y);

  std::shared_ptr<const Setup> setup_;
  std::vector<Unknown> unknowns_;
  contacts::Columns columns_;
  std::vector<Observable> observables_;
  State now_;
  // Work space, kept so that integrating allocates no memory.
  ModeSearch search_;
  std::vector<Guard> fired_;
  std::vector<double> trial_;
  std::vector<double> before_search_;
};

}  // namespace monograin::mdr
