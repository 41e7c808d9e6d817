/// A material point of a compressible plastic material under prescribed strains and stresses, as a hybrid system.
///
/// Two channels, axial and lateral, each with its logarithmic strain or its stress prescribed; a single channel drives
/// both alike. Tension is positive. Stresses are in units of the yield pressure at the reference density.
///
/// Unknowns: the state variable phi, the deviatoric plastic strain g^p, and the length l of their common path, which is
/// the accumulated plastic multiplier times the length of the flow. The elastic law is linear for given moduli, so that
/// strains and stresses follow from phi and g^p in closed form, and a prescribed lateral stress needs no unknown of its
/// own. In an elastic phase the unknowns are constant. In a plastic phase, with the flow of the segment's potential:
/// - implicit: phi' = l' a/n, g^p' = l' Psi_s/n, f = 0; of index 1 in l. a = -Psi_p (vm: |Psi_s|), n = |(a, Psi_s)|.
/// - explicit: l' = n N/D from the derivative of f = 0; complete() takes the state back to f = 0.
/// - direct: only where the flow keeps its direction, so that f = 0 along it is one equation; that is all of vm, and
///   hydrostatic loading.
///
/// Modes. Between the corners of the program the elastic rates of stress are constant, so that the end of an elastic
/// phase is known in closed form. Plastic loading ends at corners only: the elastic domain is convex, so that N would
/// grow where the plastic flow came to rest (N = 0), and the other changes of N are proportional to N itself.
///
/// Source: Edmans and Sinka (n.d.), sections 2 and 3; Table 3 as corrected.
#pragma once

#include <vector>

#include "material-point/plastic_flow.hpp"
#include "system/hybrid_system.hpp"

namespace monograin::material_point {

class System final : public HybridSystem {
 public:
  struct Settings {
    Parameters parameters;
    double yield_pressure = 0.0;  ///< [Pa], > 0, at the reference density
    bool is_hydrostatic = false;  ///< both channels always alike
  };

  explicit System(const Settings& settings);

  [[nodiscard]] std::span<const Unknown> unknowns() const noexcept override;
  [[nodiscard]] double error_gain() const noexcept override;
  [[nodiscard]] bool is_solvable() const noexcept override { return phase_.has_straight_flow; }
  [[nodiscard]] bool is_semi_explicit() const noexcept override { return false; }
  void start(std::span<double> y) override;
  void begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) override;
  [[nodiscard]] std::function<void()> checkpoint() override {
    return [this, then = *this] { *this = then; };
  }
  void complete(double xi, std::span<double> y) override;
  [[nodiscard]] bool has_corrections() const noexcept override { return true; }
  void rates(double xi, std::span<const double> y, std::span<double> dy) override;
  void residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) override;
  void solve(double xi, std::span<double> y) override;
  [[nodiscard]] std::span<const Guard> guards() const noexcept override { return guards_; }
  void guard_values(double xi, std::span<const double> y, std::span<double> values) override;
  std::optional<DomainEnd> fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                std::vector<Event>& log) override;
  [[nodiscard]] std::span<const Observable> observables() const noexcept override { return observables_; }
  void observe(double xi, std::span<const double> y, std::span<double> values) override;
  [[nodiscard]] double quantity(Quantity quantity, int channel, double xi, std::span<const double> y) override;
  [[nodiscard]] double controlled(Control control, int channel, double xi, std::span<const double> y) override;
  [[nodiscard]] std::vector<Diagnostic> warnings() const override;
  [[nodiscard]] std::optional<Difficulty> difficulty(double xi, std::span<const double> y) override;

 private:
  /// End of the present elastic phase.
  struct ElasticEnd {
    double xi = 0.0;
    Branch branch;  ///< on which the material yields
  };

  [[nodiscard]] Response response(double xi, std::span<const double> y) const;
  [[nodiscard]] PlasticFlow flow(double xi, std::span<const double> y) const;
  void turn_plastic(const Response& now);
  void go_on_plastic(const Response& now, std::vector<Event>& log);
  void pass_ends(const Response& now, std::vector<Event>& log);
  void arm_elastic(double xi, const Response& now);
  void arm_plastic(const Response& now);

  double yield_pressure_;  ///< [Pa]
  std::vector<Observable> observables_;
  Phase phase_;
  PlasticStrains at_start_;  ///< plastic strains with which the phase began; solve() starts from them
  ElasticEnd elastic_end_;
  std::vector<Guard> guards_;
  FlowEnergy least_;  ///< least rates of the flow in observed states
};

}  // namespace monograin::material_point
