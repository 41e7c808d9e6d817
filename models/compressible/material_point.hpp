/// A material point of a compressible plastic material under prescribed strains and stresses, as a hybrid system.
///
/// Two channels, axial and lateral, each with its logarithmic strain or its stress prescribed; a single channel drives
/// both alike. Tension is positive. Stresses are in units of the yield pressure at the reference density.
///
/// Unknowns: the state variable phi, the deviatoric plastic strain g^p, and the length l of their common path, which is
/// the accumulated plastic multiplier times the length of the flow. The elastic law is linear for given moduli, so that
/// strains and stresses follow from phi and g^p in closed form, and a prescribed lateral stress needs no unknown of its
/// own. In an elastic phase the unknowns are constant. In a plastic phase, with the flow of the segment's potential:
///   implicit  phi' = l' a/n, g^p' = l' g_s/n, f = 0, with a = -g_p (vm: |g_s|), n = |(a, g_s)|; of index 1 in l
///   explicit  l' = n N/D from the derivative of f = 0; complete() takes the state back to f = 0
///   direct    only where the flow keeps its direction, so that f = 0 along it is one equation: all of vm, and
///             hydrostatic loading
///
/// Modes. Between the corners of the program the elastic rates of stress are constant, so that the end of an elastic
/// phase is known in closed form. Plastic loading ends at corners only: the elastic domain is convex, so that N would
/// grow where the plastic flow came to rest (N = 0), and the other changes of N are proportional to N itself. At an end
/// of a segment where the flow is isochoric, phi is stationary and the pressure moves as the program prescribes. The
/// state passes such an end in one direction only, and only if the program moves the pressure in that direction.
/// Otherwise it tends to the end (critical state) without reaching it.
///
/// Source: Edmans and Sinka (n.d.), sections 2 and 3; Table 3 as corrected.
#pragma once

#include <array>
#include <vector>

#include "compressible/yield_surface.hpp"
#include "system/hybrid_system.hpp"

namespace monograin::compressible {

class MaterialPoint final : public HybridSystem {
 public:
  struct Settings {
    Parameters parameters;
    double yield_pressure = 0.0;  ///< [Pa], > 0, at the reference density
    bool is_hydrostatic = false;  ///< both channels always alike
  };

  explicit MaterialPoint(const Settings& settings);

  [[nodiscard]] std::span<const Unknown> unknowns() const noexcept override;
  [[nodiscard]] double error_gain() const noexcept override;
  [[nodiscard]] bool is_solvable() const noexcept override;
  [[nodiscard]] bool is_semi_explicit() const noexcept override { return false; }
  void start(std::span<double> y) override;
  void begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) override;
  [[nodiscard]] std::function<void()> checkpoint() override {
    return [this, then = *this] { *this = then; };
  }
  void complete(double xi, std::span<double> y) override;
  [[nodiscard]] bool has_corrections() const noexcept override { return true; }
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
  [[nodiscard]] double quantity(Quantity quantity, int channel, double xi, std::span<const double> y) override;
  [[nodiscard]] double controlled(Control control, int channel, double xi, std::span<const double> y) override;
  [[nodiscard]] std::vector<Diagnostic> warnings() const override;
  [[nodiscard]] std::optional<Difficulty> difficulty(double xi, std::span<const double> y) override;

 private:
  // Indices of the unknowns.
  static constexpr std::size_t k_phi = 0;
  static constexpr std::size_t k_deviatoric = 1;
  static constexpr std::size_t k_path = 2;
  // Channels.
  static constexpr std::size_t k_axial = 0;
  static constexpr std::size_t k_lateral = 1;

  enum GuardKind { yielding, end_of_segment, apex, domain_end_guard };

  /// Stress and strain at an instant, for given plastic strains.
  struct Response {
    Properties at;
    double p = 0.0;
    double s = 0.0;
    double axial_strain = 0.0;
    double lateral_strain = 0.0;
  };

  /// Change of p and s.
  struct Increment {
    double p = 0.0;
    double s = 0.0;
  };

  /// Direction of the flow, and what determines the plastic multiplier.
  struct Flow {
    Yield yield;
    double phi = 0.0;              ///< d(phi)/dl
    double deviatoric = 0.0;       ///< d(g^p)/dl
    double f_by_phi = 0.0;         ///< df/dphi, including the change of stress
    double f_by_deviatoric = 0.0;  ///< df/d(g^p), by the change of stress
    double loading = 0.0;          ///< N
    double stiffness = 0.0;        ///< D
    double p_by_flow = 0.0;        ///< dp/dl by the flow alone
    Increment elastic;             ///< rate per xi, without flow
  };

  [[nodiscard]] double prescribed(std::size_t channel, double xi) const noexcept;
  [[nodiscard]] double prescribed_rate(std::size_t channel) const noexcept;
  [[nodiscard]] bool is_stress(std::size_t channel) const noexcept;
  [[nodiscard]] static double flow_work(const Properties& at, const Yield& yield, double p, double s) noexcept;
  [[nodiscard]] double stress(std::size_t channel, double xi, const Response& now) const noexcept;
  [[nodiscard]] Response response(double xi, std::span<const double> y) const;
  [[nodiscard]] Increment stress_change(const Properties& at, Increment stiff, double axial, double lateral) const;
  [[nodiscard]] static double stiffness_over_strength(const Properties& at) noexcept;
  [[nodiscard]] Increment elastic_rate(const Properties& at) const;
  [[nodiscard]] Flow flow(const Response& now) const;
  [[nodiscard]] Flow flow(const Response& now, const Yield& yield) const;
  [[nodiscard]] static double cosine(const Flow& flow) noexcept;
  static void require_unique(const Flow& flow);
  [[nodiscard]] static double length(const Flow& flow) noexcept;
  [[nodiscard]] Flow flow_to_surface(const Response& now) const;
  [[nodiscard]] std::optional<Yield> yield_across_cap(const Response& now) const;
  enum class ReturnPath { flow, shortest };
  class ReturnMapping;
  [[nodiscard]] bool is_brought_back(double xi, std::span<double> y, ReturnPath path) const;
  [[nodiscard]] bool leads_out(bool towards_compression, const Response& now) const;
  [[nodiscard]] bool passes_apex(const Response& now) const;
  [[nodiscard]] double pressure_rate_at_end(const Response& now, bool towards_compression) const;
  [[nodiscard]] bool is_isochoric_end(Segment segment, bool towards_compression) const noexcept;

  [[nodiscard]] bool goes_on_yielding(const Response& now) const;
  void turn_plastic(Branch branch, const Response& now);
  void hold(std::span<const double> y) noexcept;
  void choose_side(const Response& now);
  void go_on_plastic(const Response& now, std::vector<Event>& log);
  void pass_ends(const Response& now, std::vector<Event>& log);
  void enter_neighbour(const Response& now, bool towards_compression);
  void watch_elastic(double xi, const Response& now);
  void watch_plastic(const Response& now);
  [[nodiscard]] double margin(Limit limit, const Response& now) const;
  [[nodiscard]] DomainEnd domain_end(Limit limit, const Response& now) const;

  Settings settings_;
  std::vector<Observable> observables_;
  std::array<Ramp, 2> ramps_{};  ///< stresses in units of the yield pressure
  double held_phi_ = 0.0;
  double held_deviatoric_ = 0.0;
  bool is_plastic_ = false;
  Branch branch_;      ///< while plastic
  double exit_ = 0.0;  ///< xi at which the present elastic phase ends
  Branch exit_branch_;
  std::vector<Guard> guards_;
  double least_work_ = 0.0;  ///< least work rate of the flow in observed states
};

}  // namespace monograin::compressible
