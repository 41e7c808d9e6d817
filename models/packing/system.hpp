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
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "packing/equations.hpp"
#include "packing/events.hpp"
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
  void residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) override;
  void solve(double xi, std::span<double> y) override;
  [[nodiscard]] std::span<const Guard> guards() const noexcept override { return guards_.list(); }
  void guard_values(double xi, std::span<const double> /*y*/, std::span<double> values) override {
    guards_.distances(ramp_, xi, values);
  }
  std::optional<DomainEnd> fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                std::vector<Event>& log) override;
  [[nodiscard]] std::span<const Observable> observables() const noexcept override { return observables_; }
  void observe(double xi, std::span<const double> y, std::span<double> values) override;
  /// @throws std::logic_error always: the language offers no condition but events
  [[nodiscard]] double quantity(Quantity quantity, int channel, double xi, std::span<const double> y) override;
  [[nodiscard]] double controlled(Control control, int channel, double xi, std::span<const double> y) override;

 private:
  [[nodiscard]] bool is_jammed() const noexcept { return mode_ != Mode::unjammed; }
  [[nodiscard]] PackingState by_law(double xi) const;
  [[nodiscard]] PackingState seen(double xi, std::span<const double> y) const;
  [[nodiscard]] IntegratedEquations equations(double xi) const;
  [[nodiscard]] bool is_at_limit(double xi) const noexcept;
  [[nodiscard]] Regime regime() const noexcept;
  void require_pores(std::span<const double> y) const;
  void resolve_mode(std::vector<Event>& log);
  void set_mode(Mode mode, double xi, std::span<double> y);
  /// Piece of eq. 11 that an integrated state follows.
  [[nodiscard]] Piece piece() const noexcept { return yielding_.is_full ? Piece::full : Piece::growing; }

  double initial_ = 0.0;
  std::array<Unknown, 2> unknowns_;
  std::vector<Observable> observables_;

  Ramp ramp_;
  ControlledBranch branch_;
  Mode mode_ = Mode::unjammed;
  double resting_ = 0.0;  ///< value of the unknown Phi in modes that do not integrate it
  double at_rest_ = 0.0;  ///< Phi of an unjammed packing under no stress
  Yielding yielding_;
  Guards guards_;
};

}  // namespace monograin::packing
