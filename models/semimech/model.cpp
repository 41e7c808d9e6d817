#include <array>
#include <cmath>
#include <stdexcept>

#include "plastic/model_of.hpp"
#include "semimech/wall_law.hpp"
#include "stress_test/draw.hpp"
#include "system/continuum_material.hpp"

namespace monograin::semimech {
namespace {

using std::string_view;

constexpr std::array k_references{&references::k_shahin2021};

constexpr std::array k_material{
    QuantityKey{"youngs_modulus", "Young's modulus", Dimension::stress, k_positive},
    QuantityKey{"poisson_ratio", "Poisson's ratio", Dimension::none, k_poisson_to_half},
    QuantityKey{"yield_stress", "uniaxial yield stress", Dimension::stress, k_positive},
};

constexpr std::array k_options{plastic::k_unloading};

constexpr auto k_regimes = plastic::joined(
    plastic::k_regime_before_contact,
    std::array{
        Term{"elastic", "mean pressure of Hertz, contact radius of the law: the force is D1^2 times that of Hertz"},
        Term{"elastic-plastic", "yielded below the surface; the mean pressure rises to its maximum"},
        Term{"fully-plastic", "the mean pressure falls from its maximum to its minimum"},
        Term{"low-compressibility", "the pores close and the mean pressure rises again (die, hydrostatic)"},
        Term{"elastic-volumetric", "no pores are left: elastic compression of the volume (die, hydrostatic)"}},
    plastic::k_regime_without_law, plastic::k_regimes_of_unloading);

constexpr auto k_events = plastic::joined(
    plastic::k_events_of_touching,
    std::array{Term{"yield", "mean pressure of 1.1 Y: the elastic regime ends"},
               Term{"fully-plastic", "greatest mean pressure"},
               Term{"low-compressibility", "least mean pressure: the pores begin to close (die, hydrostatic)"},
               Term{"zero-porosity", "no pores are left (die, hydrostatic)"},
               Term{"secondary-onset", "lateral contacts begin to bear the pressure of the axial ones (die)"}},
    plastic::k_event_of_neighbours, plastic::k_events_of_programs);

constexpr std::array<string_view, 12> k_domain{
    "E/((1-nu^2) Y) from 22.0931 on; a warning outside 117.24 to 5933.40",
    "die and hydrostatic: nu below 0.5; a warning outside E/Y = 100 to 5000, nu = 0.2 to 0.48, "
    "E/(3 (1-2 nu) Y) = 64 to 28000",
    "displacement/R0 below 1; a warning beyond 0.5 (simple) and 0.01 beyond zero porosity (die, hydrostatic)",
    "elastic regime: the pressure is Hertz's but the contact radius is not, so the force is D1^2 times that of Hertz: "
    "1.35 to 3.07 (simple), 1.42 to 3.22 (die), 1.58 to 3.59 (hydrostatic)",
    "too stiff below displacement/R0 = 0.03 against finite elements, at 0.005, 0.01, 0.02 by 55, 35, 19 % (simple), "
    "66, 37, 27 % (die), 78, 59, 35 % (hydrostatic); a warning where a whole run lies there",
    "lateral contacts of a die: forces 1 to 3 times those of finite elements of E/Y = 200 for axial displacement/R0 "
    "from 0.03 to 0.1; a warning",
    "the law's second derivative jumps at its regime boundaries and is infinite just after the greatest pressure",
    "lateral contacts of a die: force and area for axial displacement/R0 up to 0.1, pressure from the onset (about "
    "0.41) on, nothing between; E/((1-nu^2) Y) from 163.08 to 4954.40, a warning outside",
    "lateral contacts do not act back on the axial ones",
    plastic::k_loading_only,
    plastic::k_extension,
    "warned: dissipation that falls by more than 1e-6 of the energy, possible with unloading = \"mdr\" where the "
    "elastic indenter holds more energy than the law's own pressure has put in: soft materials, contacts that have "
    "just yielded, and beyond zero porosity",
};

Material material_of(const ModelInput& input) {
  return make_material(input.material("youngs_modulus"), input.material("poisson_ratio"),
                       input.material("yield_stress"));
}

Law law_of(const ModelInput& input) { return make_law(material_of(input), plastic::configuration_of(input)); }

WallLaw wall_law_of(const ModelInput& input, const Reach& reach) {
  const Law law = law_of(input);
  return {law, plastic::settings_of(input, "yield_stress", reach),
          outside_calibration(input.material("youngs_modulus"), input.material("poisson_ratio"),
                              input.material("yield_stress"), law.configuration)};
}

std::vector<Objection> objections(const ModelInput& input) {
  try {
    static_cast<void>(law_of(input));
  } catch (const std::invalid_argument& error) {
    // The material is too soft against its strength, too compressible, or incompressible.
    const bool is_soft = material_of(input).modulus_over_yield < k_least_modulus_over_yield;
    return {{is_soft ? "yield_stress" : "poisson_ratio", error.what()}};
  }
  return {};
}

std::vector<DerivedParameter> parameters(const ModelInput& input, const FirstStep& /*step*/) {
  const Law law = law_of(input);
  std::vector<DerivedParameter> list =
      material_parameters(input, {{"youngs_modulus", "Pa"}, {"poisson_ratio", "-"}, {"yield_stress", "Pa"}});
  list.push_back({"plane_strain_modulus_over_yield", law.material.modulus_over_yield, "-", "lambda"});
  list.push_back({"bulk_over_yield", law.material.bulk_over_yield, "-", "zeta"});
  add_parameters(law.radius, list);
  list.push_back({"yield_approach", law.yield_approach, "-", "x_y"});
  list.push_back({"logarithm_amplitude", law.logarithm_amplitude, "-", "c1"});
  list.push_back({"logarithm_exponent", law.logarithm_exponent, "-", "c2"});
  add_parameters(law.fall, law.configuration, list);
  if (!is_enclosed(law.configuration)) return list;
  const Stiffening& stiffening = law.stiffening;
  list.push_back({"cell_at_least_pressure", stiffening.cell_at_least, "-", "chi_m"});
  list.push_back({"softness", stiffening.softness, "-", "l"});
  list.push_back({"pressure_scale", stiffening.pressure_scale, "-", "u"});
  list.push_back({"elastic_volume", stiffening.elastic_volume, "-", "V_el/V"});
  list.push_back({"cell_at_zero_porosity", stiffening.cell_at_zero_porosity, "-", "chi_zp"});
  list.push_back({"zero_porosity_approach", stiffening.zero_porosity, "-", "x_zp"});
  list.push_back({"impingement_approach", impingement_approach(law.configuration, law.radius), "-"});
  if (law.configuration != Configuration::die) return list;
  const LateralLaw lateral = make_lateral(law);
  list.push_back({"lateral_coefficient", std::exp(lateral.log_coefficient), "-", "tau 20^(omega-1)"});
  list.push_back({"lateral_exponent", lateral.exponent, "-", "omega"});
  list.push_back({"lateral_yield_approach", lateral.yield_approach, "-"});
  list.push_back({"lateral_onset_approach", lateral.onset, "-", "x_on"});
  return list;
}

ProgramBounds draw(Dice& dice, DrawnMaterial& drawn) {
  const bool is_enclosed = drawn.configuration != "simple";
  const double poisson_ratio = draw_poisson_ratio(dice, is_enclosed ? 0.4999 : 0.5);
  // The softest material that the law admits has E/((1 - nu^2) Y) = 22.0931; some scenes lie just above it.
  const double lambda = dice.happens(0.1) ? 22.0931 : dice.log_uniform(22.0931, 1e6);
  drawn.values = {{"youngs_modulus", lambda * (1.0 - poisson_ratio * poisson_ratio)},
                  {"poisson_ratio", poisson_ratio},
                  {"yield_stress", 1.0}};
  draw_choices(dice, k_options, drawn);
  return {.force = 2.0, .only_loads = !drawn.options.contains("unloading")};
}

}  // namespace

Model model() noexcept {
  return plastic::model_of<wall_law_of>(
      {.name = "semimech",
       .summary = "elastic-ideally plastic particle by the semi-mechanistic law, from first touch to no pores left",
       .references = k_references,
       .source = "chapter 2, with A. Agarwal and M. Gonzalez; misprints corrected",
       .material = k_material,
       .options = k_options,
       .configurations = plastic::k_source_configurations,
       .regimes = k_regimes,
       .events = k_events,
       .domain = k_domain,
       .objections = objections,
       .parameters = parameters,
       .draw = draw,
       .continuum_material = continuum_material});
}

}  // namespace monograin::semimech
