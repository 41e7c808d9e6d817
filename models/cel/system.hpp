/// The coupled elastic-plastic particle between rigid walls as a hybrid system.
///
/// Unknowns: the own coordinate of every class (elastic displacement, or force where that is prescribed), its dent, a
/// free centre, the core, and the work of the walls. While a contact flows and the core can yield, the state depends on
/// its path: the explicit form has rates from the derivatives of all equations, the implicit form the equations
/// themselves and the flow rule of the core. Otherwise the equations determine the state at any instant. Integrators
/// then advance the work only, in any form: the other unknowns rest, and complete() solves for them.
///
/// Particle has the equations, Newton solves them, Motion has the rates, decide_mode() chooses the mode, GuardSet
/// has its guards; System puts these behind the interface HybridSystem. Own law of this project (docs/theory/cel.md).
#pragma once

#include <vector>

#include "cel/modes.hpp"
#include "cel/newton.hpp"
#include "contacts/columns.hpp"
#include "system/hybrid_system.hpp"
#include "system/model_input.hpp"

namespace monograin::cel {

class System final : public HybridSystem {
 public:
  /// @param reach  largest displacement and force of the program, which give the scales of the unknowns
  System(const ModelInput& input, std::vector<ContactClass> classes, const Reach& reach);

  [[nodiscard]] std::span<const Unknown> unknowns() const noexcept override { return unknowns_; }
  [[nodiscard]] std::span<const ContactClass> classes() const noexcept override { return classes_; }
  void start(std::span<double> y) override;
  void begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) override;
  [[nodiscard]] std::function<void()> checkpoint() override {
    return [this, then = *this] { *this = then; };
  }
  void complete(double xi, std::span<double> y) override;
  void rates(double xi, std::span<const double> y, std::span<double> dy) override;
  void residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) override;
  [[nodiscard]] bool is_semi_explicit() const noexcept override { return false; }
  [[nodiscard]] bool is_solvable() const noexcept override { return !particle_.layout().has_core(); }
  [[nodiscard]] bool is_solvable_here() const noexcept override { return is_solvable() || !particle_.any_flows(); }
  void solve(double xi, std::span<double> y) override;
  [[nodiscard]] std::optional<double> closed_quadrature(double xi, std::span<const double> y) override;
  [[nodiscard]] std::span<const Guard> guards() const noexcept override { return guards_.list(); }
  void guard_values(double xi, std::span<const double> y, std::span<double> values) override;
  std::optional<DomainEnd> fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                std::vector<Event>& log) override;
  [[nodiscard]] std::span<const Observable> observables() const noexcept override { return columns_.observables(); }
  void observe(double xi, std::span<const double> y, std::span<double> values) override;
  [[nodiscard]] double quantity(Quantity quantity, int contact_class, double xi, std::span<const double> y) override;
  [[nodiscard]] double controlled(Control control, int contact_class, double xi, std::span<const double> y) override;
  [[nodiscard]] bool is_open(int contact_class) const noexcept override {
    return !particle_.classes[static_cast<std::size_t>(contact_class)].touches;
  }
  [[nodiscard]] std::vector<Diagnostic> warnings() const override;
  [[nodiscard]] std::optional<Difficulty> difficulty(double xi, std::span<const double> y) override;

 private:
  void set_ramp(std::size_t i, const Ramp& ramp, std::span<double> y);
  void leave_idle_walls(double xi, std::span<double> y, std::size_t first, std::vector<Event>& log);
  [[nodiscard]] std::optional<DomainEnd> arm_guards(double xi, std::span<const double> y);
  [[nodiscard]] contacts::VisibleContact visible(std::size_t i, double xi) const;

  double length_, modulus_, force_unit_;  ///< R0 [m], E [Pa], E R0^2 [N]
  double modulus_over_yield_;
  bool centre_is_free_;
  std::vector<ContactClass> classes_;
  Particle particle_;
  Newton newton_;
  Motion motion_;
  GuardSet guards_;
  std::vector<Unknown> unknowns_;
  contacts::Columns columns_;
  std::size_t work_slot_;

  bool has_begun_ = false;
  double deepest_ = 0.0;               ///< largest overlap in a row so far, over R0
  double least_stored_ = 0.0;          ///< least stored energy in a row so far, over the work; 0 if none is negative
  std::vector<double> last_;           ///< last state found by solve()
  std::vector<double> trial_, state_;  ///< work space
};

}  // namespace monograin::cel
