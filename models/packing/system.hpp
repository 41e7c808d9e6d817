/// A packing of soft discs under a prescribed packing fraction, strain or stress as a hybrid system.
///
/// A loose packing rearranges without stress. Its strain is that at jamming plus ln(Phi/Phi_J): the strain is
/// continuous through jamming, where the published parameters let the stress jump. For a jammed packing, the direct
/// form is the closed form, or its inverse where strain or stress is prescribed. The other forms integrate eq. 21 as
/// the appendix assembles it, with the strain of the particles v = m e (eqs. 19, 20) beside that of the packing:
///
///   v' = s (1/Phi - d e/d Phi) Phi'     with e = ln Phi + c2 - s v; singular where the packing jams
///   0  = Phi, e or sigma minus its prescribed value    gives Phi
///
/// The integration begins a millionth of Phi_J above the singular point, where eq. 22 starts it. Below that, the
/// integrated unknowns rest, and the closed form is observed. Under a prescribed stress, the packing stays at jamming
/// until the stress reaches the value with which its branch begins.
///
/// If a prescribed strain or stress exceeds what the packing can reach, or a packing fraction leaves the domain of the
/// equations, the run ends a little before, where the rates are still finite.
///
/// All events lie at known packing fractions, and therefore at known values of the controlled quantity.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "packing/law.hpp"
#include "system/hybrid_system.hpp"

namespace monograin::packing {

enum class Regime { unjammed, elastic, elastic_plastic, fully_plastic };

class System final : public HybridSystem {
 public:
  /// @param initial_packing_fraction  in (0, 1)
  System(const Law& law, double initial_packing_fraction);

  [[nodiscard]] std::span<const Unknown> unknowns() const noexcept override { return unknowns_; }
  void start(std::span<double> y) override;
  /// @throws std::domain_error where a plastic packing would be unloaded, or a full one compacted
  void begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) override;
  [[nodiscard]] std::function<void()> checkpoint() override {
    return [this, then = *this] { *this = then; };
  }
  void complete(double xi, std::span<double> y) override;
  void rates(double xi, std::span<const double> y, std::span<double> dy) override;
  void all_rates(double xi, std::span<const double> y, std::span<double> dy) override { rates(xi, y, dy); }
  void residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) override;
  void solve(double xi, std::span<double> y) override;
  [[nodiscard]] std::optional<double> closed_quadrature(double /*xi*/, std::span<const double> /*y*/) override {
    return std::nullopt;
  }
  [[nodiscard]] std::span<const Guard> guards() const noexcept override { return guards_; }
  void guard_values(double xi, std::span<const double> y, std::span<double> values) override;
  std::optional<DomainEnd> fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                std::vector<Event>& log) override;
  [[nodiscard]] std::span<const Observable> observables() const noexcept override { return observables_; }
  void observe(double xi, std::span<const double> y, std::span<double> values) override;
  /// @throws std::logic_error always: the language offers no condition but events
  [[nodiscard]] double quantity(Quantity quantity, int channel, double xi, std::span<const double> y) override;
  [[nodiscard]] double controlled(Control control, int channel, double xi, std::span<const double> y) override;
  [[nodiscard]] std::vector<Diagnostic> warnings() const override { return {}; }

 private:
  enum class Mode {
    unjammed,
    held,      ///< at jamming, under less stress than its branch begins with
    starting,  ///< next to the singular point: closed form
    jammed     ///< integrated where there is an integrator
  };

  /// Observed state at an instant.
  struct Seen {
    double packing_fraction = 0.0;
    double stress_elastic = 0.0;  ///< [Pa]
    double strain = 0.0;
    double stress = 0.0;  ///< [Pa]
  };

  [[nodiscard]] double prescribed(double xi) const noexcept;
  [[nodiscard]] int direction() const noexcept;
  [[nodiscard]] Seen by_law(double xi) const;
  [[nodiscard]] Seen seen(double xi, std::span<const double> y) const;
  [[nodiscard]] double prescribed_at(double packing_fraction) const;
  [[nodiscard]] double prescribed_at_jamming() const noexcept;
  [[nodiscard]] double strain_of(std::span<const double> y) const noexcept;
  [[nodiscard]] double excess(double xi, std::span<const double> y) const;
  [[nodiscard]] std::array<double, 2> excess_slopes(std::span<const double> y) const;
  [[nodiscard]] double least_fraction() const noexcept;
  [[nodiscard]] std::array<double, 2> within_branch(std::span<const double> y) const noexcept;
  [[nodiscard]] bool is_brought_back(double xi, std::span<double> y) const;
  [[nodiscard]] Regime regime() const noexcept;

  void take_piece(double xi);
  void take_branch();
  [[nodiscard]] double last_place() const noexcept;
  [[nodiscard]] double growth_of(const Slopes& slopes) const noexcept;
  [[nodiscard]] double growth_by_law(double packing_fraction) const;
  [[nodiscard]] bool has_passed_end(double packing_fraction, double growth) const;
  [[nodiscard]] bool is_at_limit(double xi) const noexcept;
  [[nodiscard]] DomainEnd limit() const;
  void require_state(double xi) const;
  void resolve_mode(double xi, std::vector<Event>& log);
  [[nodiscard]] Mode mode_of_jammed(double value) const;
  void set_mode(Mode mode, double xi, std::span<double> y);
  void arm_place(int kind, std::string_view name, double place);
  void arm_guards(double xi);
  void arm_jamming();
  void arm_loosening();
  void arm_compaction(double xi);
  void pass_places(double xi, std::vector<Event>& log);
  void end_branch_at_jamming() noexcept;

  Law law_;
  double initial_ = 0.0;
  State at_jamming_;
  double softening_ = 0.0;  ///< Phi above which the plastic packing is softer than the elastic one; infinite: never
  std::array<Unknown, 2> unknowns_;
  std::vector<Observable> observables_;

  Ramp ramp_;
  Branch branch_;               ///< growing branch of the controlled quantity
  double growth_at_end_ = 0.0;  ///< derivative of the controlled quantity by Phi at the end of a branch that ends at a
                                ///< fold; else 0
  double start_end_ = 0.0;      ///< Phi up to which the closed form is used at the start
  Mode mode_ = Mode::unjammed;
  double resting_ = 0.0;  ///< value of the unknown Phi in modes that do not integrate it
  double at_rest_ = 0.0;  ///< Phi of an unjammed packing under no stress
  bool is_jammed_ = false;
  bool is_softer_ = false;
  bool is_fully_plastic_ = false;
  Piece piece_ = Piece::growing;  ///< piece of eq. 11 that an integrated state follows
  std::vector<Guard> guards_;
  std::vector<double> places_;  ///< positions of the guards, as values of the controlled quantity
};

}  // namespace monograin::packing
