#include "plastic/power_law.hpp"

#include <cmath>
#include <string>

#include "plastic/ludwik.hpp"

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
