/// Motion of a particle: the rates of its unknowns with the step coordinate.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "cel/tangent.hpp"
#include "system/resolution.hpp"

namespace monograin::cel {

class Motion {
 public:
  /// Evaluates a particle and its motion at a state, unless the cached motion is for that.
  /// @return the margin to a fold: the speed of walls over the sum of that and the speed of their contacts; negative
  /// beyond the fold, where the determinant of the equations has changed its sign
  double evaluate(Particle& p, double xi, std::span<const double> y);
  /// Declares from which step coordinate on the contacts that flow do so.
  void begin_flow(double xi) noexcept {
    flow_begin_ = xi;
    xi_ = k_nan;
  }

  [[nodiscard]] double margin() const noexcept { return margin_; }
  /// Rates of all unknowns up to the core, then Lam.
  [[nodiscard]] std::span<const double> rates() const noexcept { return rates_; }
  /// Rates of all unknowns that also draw the state back to the equations: the errors of an integrator would otherwise
  /// add up.
  [[nodiscard]] std::span<const double> drawn_rates() const noexcept { return drawn_rates_; }
  /// Rate of the work of all walls.
  [[nodiscard]] double power() const noexcept { return power_; }
  [[nodiscard]] double yield_rate(const Particle& p, std::size_t i) { return tangent_.yield_rate(p, i, rates_); }

 private:
  Tangent tangent_;
  Eigen::MatrixX2d right_, solutions_;  ///< first columns: rates; second columns: drawing back
  std::vector<double> rates_, drawn_rates_;
  double margin_ = 1.0;
  double power_ = 0.0;
  double flow_begin_ = 0.0;
  // Key of the cache.
  double xi_ = k_nan;
  std::uint64_t revision_ = 0;
};

}  // namespace monograin::cel
