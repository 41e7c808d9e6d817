#include "packing/equations.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "system/resolution.hpp"

namespace monograin::packing {
namespace {

constexpr double k_noise = 1e-11;  // smaller steps of Newton's method may be round-off

}  // namespace

double IntegratedEquations::strain(const IntegratedState& y) const noexcept {
  return total_strain(law_, y.packing_fraction) - law_.sign * y.particle_strain;
}

double IntegratedEquations::excess(const IntegratedState& y) const {
  const double phi = y.packing_fraction;
  if (branch_.control() == Control::packing_fraction) return phi - value_;
  if (branch_.control() == Control::strain) return strain(y) - value_;
  const double stress = total_stress(law_, phi, strain(y) * effective_modulus(law_, phi), piece_);
  return (stress - std::min(value_, branch_.range().greatest)) / law_.given.youngs_modulus;
}

std::array<double, 2> IntegratedEquations::excess_slopes(const IntegratedState& y) const {
  const double phi = y.packing_fraction;
  const double scale = law_.sign * particle_scale_;
  if (branch_.control() == Control::packing_fraction) return {0.0, 1.0};
  if (branch_.control() == Control::strain) return {-scale, 1.0 / phi};
  const double by_strain = total_stress_slope(law_, phi, piece_) * effective_modulus(law_, phi);
  const double by_fraction = slopes(law_, phi, strain(y), piece_).at_given_particles;
  return {-scale * by_strain / law_.given.youngs_modulus, by_fraction / law_.given.youngs_modulus};
}

IntegratedState IntegratedEquations::within_branch(const IntegratedState& y) const noexcept {
  const double least = std::midpoint(branch_.range().begin, branch_.end_of_start());
  return {y.particle_strain, std::max(y.packing_fraction, least)};
}

IntegratedState IntegratedEquations::rates(const IntegratedState& y, double rate) const {
  const double phi = y.packing_fraction;
  const Slopes s = slopes(law_, phi, strain(y), piece_);
  const double growth = branch_.growth(s);
  if (!(growth > 0.0)) throw DomainError(branch_.limit());
  const double fraction_rate = rate / growth;
  return {s.particle_strain * fraction_rate, fraction_rate};
}

IntegratedState IntegratedEquations::completed(const IntegratedState& guess) const {
  branch_.require_state(value_);
  if (branch_.control() == Control::packing_fraction) return {guess.particle_strain, value_};
  const double least = branch_.least_integrated();
  const double end = branch_.range().end;
  if (branch_.control() == Control::strain) {
    // The first guess of an implicit stage keeps the particles' strain, which would take the packing below jamming or
    // beyond a pole.
    const double with_particles = law_.zero_stress * std::exp(value_ + law_.sign * guess.particle_strain);
    return {guess.particle_strain, std::max(std::min(with_particles, end), least)};
  }
  // Takes the shortest path in both unknowns. With the consistent coupling, the stress at a given strain of the
  // particles has a maximum before the packing's own.
  return nearest(guess);
}

/// Newton's method along the gradient of excess(). @throws std::domain_error if it does not converge
IntegratedState IntegratedEquations::nearest(IntegratedState y) const {
  double last = 1.0;
  for (int k = 0; k < k_most_newton_steps; ++k) {
    // Next to jamming, and to a full packing of nearly incompressible particles, a tolerated state may lie outside.
    const double inside = std::max(std::min(y.packing_fraction, branch_.range().end), branch_.least_integrated());
    const bool is_inside = y.packing_fraction == inside;
    y.packing_fraction = inside;
    auto [by_particles, by_fraction] = excess_slopes(y);
    if (!is_inside) by_fraction = 0.0;
    const double steepness = std::hypot(by_particles, by_fraction);
    const double share = -excess(y) / (steepness * steepness);
    y.packing_fraction += share * by_fraction;
    y.particle_strain += share * by_particles * particle_scale_;
    const double step = std::abs(share) * steepness;
    // Corrections that no longer shrink are round-off.
    const bool is_round_off = step < k_noise && step > 0.5 * last;
    last = step;
    if (step <= k_zero_guard || is_round_off) return y;
  }
  throw std::domain_error("no packing fraction bears the stress");
}

}  // namespace monograin::packing
