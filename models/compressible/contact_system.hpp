/// A compressible plastic particle between rigid walls as a hybrid system: every contact follows the law of its own
/// wall, and knows nothing of the others. Lengths in R0, forces in pi R0^2 sigma_y0.
///
/// Unknowns: for every wall whose force is prescribed at some time a coordinate u of its displacement, and the work of
/// the walls. u is the displacement itself, but on the exponential part and on an unloading curve under a prescribed
/// force it is proportional to the force: nothing is then singular where the contact opens with an infinite compliance,
/// and a part with a small exponent, along which the force hardly says where the wall is, asks for no more digits than
/// a force has. Under a prescribed force F the explicit form is u' = F'/(df/du), the implicit one f(u) = F, and the
/// direct one inverts the law.
#pragma once

#include <vector>

#include "compressible/contact_law.hpp"
#include "system/hybrid_system.hpp"

namespace monograin::compressible {

struct ContactSettings {
  LoadingLaw law;
  double hertz_stiffness = 1.0;  ///< k_H > 0
  UnloadingRule unloading;
  double initial_radius = 1.0;           ///< R0 [m]
  double yield_pressure = 1.0;           ///< sigma_y0 [Pa]
  std::vector<Diagnostic> reservations;  ///< what the user should know of these numbers
  /// Largest displacement [m] and force [N] the program asks of a wall: how large the unknowns become, which absolute
  /// tolerances are relative to. 0: not said.
  double largest_displacement = 0.0;
  double largest_force = 0.0;
};

class ContactSystem final : public HybridSystem {
 public:
  ContactSystem(ContactSettings settings, std::vector<ContactClass> classes);

  [[nodiscard]] std::span<const Unknown> unknowns() const noexcept override { return unknowns_; }
  [[nodiscard]] std::span<const ContactClass> classes() const noexcept override { return classes_; }
  void start(std::span<double> y) override;
  /// @throws std::domain_error where a wall at the end of the law would go on
  void begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) override;
  [[nodiscard]] std::function<void()> checkpoint() override {
    return [this, then = *this] { *this = then; };
  }
  void complete(double xi, std::span<double> y) override;
  void rates(double xi, std::span<const double> y, std::span<double> dy) override;
  void all_rates(double xi, std::span<const double> y, std::span<double> dy) override { rates(xi, y, dy); }
  void residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) override;
  void solve(double xi, std::span<double> y) override { complete(xi, y); }
  [[nodiscard]] std::optional<double> closed_quadrature(double xi, std::span<const double> y) override;
  [[nodiscard]] std::span<const Guard> guards() const noexcept override { return guards_; }
  void guard_values(double xi, std::span<const double> y, std::span<double> values) override;
  std::optional<DomainEnd> fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                std::vector<Event>& log) override;
  [[nodiscard]] std::span<const Observable> observables() const noexcept override { return observables_; }
  void observe(double xi, std::span<const double> y, std::span<double> values) override;
  /// NaN for what the law does not have: pressure, contact radius, apparent radius other than R0.
  [[nodiscard]] double quantity(Quantity quantity, int contact_class, double xi, std::span<const double> y) override;
  [[nodiscard]] double controlled(Control control, int contact_class, double xi, std::span<const double> y) override;
  [[nodiscard]] bool is_open(int contact_class) const noexcept override;
  [[nodiscard]] std::vector<Diagnostic> warnings() const override;

 private:
  enum class Regime { open, linear, exponential, unloading };

  /// What a contact class remembers: changed by transitions only.
  struct Memory {
    Regime regime = Regime::open;
    bool has_unloaded = false;  ///< `curve` is that from the largest displacement so far
    UnloadingCurve curve;
    double resting = 0.0;  ///< displacement at which an open wall without load was left
    bool has_been_loaded = false;
  };

  /// What holds at a place of the present branch.
  struct State {
    double force = 0.0;
    double by_coordinate = 0.0;  ///< df/du
    double compliance = 0.0;     ///< f/(df/dd): where f vanishes the limit
  };

  [[nodiscard]] bool touches(std::size_t i) const noexcept { return memory_[i].regime != Regime::open; }
  [[nodiscard]] bool is_loaded(std::size_t i) const noexcept { return ramps_[i].control == Control::force; }
  [[nodiscard]] int direction(std::size_t i) const noexcept;
  [[nodiscard]] double prescribed(std::size_t i, double xi) const noexcept;
  [[nodiscard]] double opening(std::size_t i) const noexcept;
  [[nodiscard]] double unit_force(std::size_t i) const noexcept;
  [[nodiscard]] bool counts_force(std::size_t i) const noexcept;
  [[nodiscard]] double coordinate(std::size_t i, double d) const noexcept;
  [[nodiscard]] double coordinate_under(std::size_t i, double force) const noexcept;
  [[nodiscard]] double displacement_at(std::size_t i, double u) const noexcept;
  [[nodiscard]] double displacement(std::size_t i, double xi, std::span<const double> y) const noexcept;
  [[nodiscard]] double displacement_under_force(std::size_t i, double force) const noexcept;
  [[nodiscard]] double force_at(std::size_t i, double d) const noexcept;
  [[nodiscard]] double force_of(std::size_t i, double xi, std::span<const double> y) const noexcept;
  [[nodiscard]] State state(std::size_t i, double u) const noexcept;
  [[nodiscard]] double power(std::size_t i, double xi, std::span<const double> y) const noexcept;
  [[nodiscard]] UnloadingCurve way_back(std::size_t i, double d) const noexcept;
  [[nodiscard]] bool goes_beyond(std::size_t i, double end) const noexcept;

  void make_contact(std::size_t i);
  void go_on_loading(std::size_t i, double d);
  void pass_boundaries(std::size_t i, double d, std::vector<Event>& log);
  void turn_back(std::size_t i, double d, std::vector<Event>& log);
  void resolve_mode(std::size_t i, double d, std::vector<Event>& log);
  void arm_guards();
  void add_guard(int kind, std::size_t i, int direction, std::string_view name, double place);

  ContactSettings settings_;
  std::vector<ContactClass> classes_;
  std::vector<Unknown> unknowns_;
  std::vector<Observable> observables_;
  std::vector<std::size_t> places_;  ///< in y, of the coordinate of each class that takes a force; else 0
  std::size_t work_place_ = 0;

  std::vector<Ramp> ramps_;  ///< displacements over R0, forces over pi R0^2 sigma_y0
  bool has_begun_ = false;
  std::vector<Memory> memory_;
  std::vector<Guard> guards_;
  std::vector<double> guard_places_;  ///< displacement at which they are zero

  int clipped_ = 0;           ///< unloadings that would have opened before first touch
  double least_ratio_ = 1.0;  ///< of the slopes where a contact that was looked at has turned back, or would
};

}  // namespace monograin::compressible
