#include "mdr/adhesion_validity.hpp"

#include <cmath>
#include <numbers>

namespace monograin::mdr {
namespace {

using std::numbers::pi;

// Constants of F.1, all digits as printed.
constexpr double k_peak_onset = 0.135;
constexpr double k_peak_factor = 1.75;

/// Contact diameters that a plastic zone has to fit into, for small-scale yielding (F.4).
constexpr double k_zones_per_diameter = 15.0;

}  // namespace

double peak_radius_over_initial_radius(double displacement_over_radius, double yield_overlap_ratio) noexcept {
  const double x = displacement_over_radius - yield_overlap_ratio - k_peak_onset;
  return x <= 0.0 ? 0.0 : k_peak_factor * std::pow(x, 0.75);
}

double plastic_zone_size(double composite_modulus, double surface_energy, double yield_stress,
                         double mean_pressure) noexcept {
  const double stress = yield_stress + mean_pressure;
  return composite_modulus * surface_energy / (pi * stress * stress);
}

AdhesionValidity adhesion_validity(double critical_radius, double peak_radius, double plastic_zone_size) noexcept {
  if (peak_radius > 0.0 && critical_radius <= peak_radius) return AdhesionValidity::peak_failure;
  if (2.0 * critical_radius < k_zones_per_diameter * plastic_zone_size) return AdhesionValidity::yielding_failure;
  return AdhesionValidity::valid;
}

}  // namespace monograin::mdr
