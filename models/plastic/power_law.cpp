#include "plastic/power_law.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "plastic/ludwik.hpp"
#include "system/continuum_material.hpp"

namespace monograin::plastic {

std::vector<Objection> power_law_objections(const ModelInput& input) {
  std::vector<Objection> found;
  if (!can_unload(input)) return found;
  for (const char* key : {"youngs_modulus", "poisson_ratio"}) {
    if (input.optional_material(key)) continue;
    found.push_back({"unloading", std::string("unloading = \"mdr\" needs the elastic constants; expected ") + key +
                                      " in [material]"});
  }
  return found;
}

ContinuumMaterial power_law_continuum(const ModelInput& input) {
  constexpr double k_least_strain = 1e-6;
  constexpr double k_largest_strain = 5.0;
  constexpr int k_points = 110;
  for (const char* key : {"youngs_modulus", "poisson_ratio"}) {
    if (input.optional_material(key)) continue;
    throw std::invalid_argument(std::string("finite elements need the elastic constants; expected ") + key +
                                " in [material]");
  }
  const double exponent = input.material("hardening_exponent");
  if (exponent == 1.0) {
    throw std::invalid_argument("a power law with hardening_exponent = 1 does not yield; expected an exponent below 1");
  }
  ContinuumMaterial material = continuum_material(input);
  const double modulus = material.youngs_modulus;
  const double strength = input.material("strength");
  // The elastic line ends where E e = kappa e^mu.
  const double yield_strain = std::fmax(std::pow(strength / modulus, 1.0 / (1.0 - exponent)), k_least_strain);
  if (yield_strain > k_largest_strain) return material;
  material.flow = {{0.0, strength * std::pow(yield_strain, exponent)}};
  for (int i = 0; i < k_points; ++i) {
    const double strain =
        yield_strain + k_least_strain * std::pow(k_largest_strain / k_least_strain, i / (k_points - 1.0));
    const double stress = strength * std::pow(strain, exponent);
    material.flow.push_back({strain - stress / modulus, stress});
  }
  return material;
}

std::vector<DerivedParameter> power_law_parameters(const ModelInput& input) {
  return material_parameters(
      input, {{"youngs_modulus", "Pa"}, {"poisson_ratio", "-"}, {"strength", "Pa"}, {"hardening_exponent", "-"}});
}

PowerLaw power_law_of(const LudwikInput& ludwik) {
  const HollomonMaterial fitted =
      fit_hollomon({.youngs_modulus = ludwik.youngs_modulus,
                    .yield_stress = ludwik.yield_stress,
                    .hardening = ludwik.strength,
                    .exponent_inverse = 1.0 / ludwik.exponent},
                   ludwik.largest_strain, ludwik.fits_both ? HollomonFit::both : HollomonFit::exponent);
  return {fitted.strength, fitted.exponent};
}

ProgramBounds draw_power_law(Dice& dice, DrawnMaterial& drawn, std::span<const OptionKey> options) {
  const double exponent = dice.uniform(0.0, 1.0);
  drawn.values = {{"strength", 1.0}, {"hardening_exponent", dice.happens(0.7) ? exponent : std::round(exponent)}};
  draw_choices(dice, options, drawn);
  const bool unloads = drawn.options.contains("unloading");
  if (unloads) {
    drawn.values["youngs_modulus"] = dice.log_uniform(2.0, 1e6);
    drawn.values["poisson_ratio"] = draw_poisson_ratio(dice, 0.5);
  }
  return {.force = 2.0, .only_loads = !unloads};
}

}  // namespace monograin::plastic
