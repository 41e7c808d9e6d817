#include "scene/parameters.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

#include "compressible/material_point_info.hpp"
#include "compressible/yield_surface.hpp"
#include "elastic/hertz.hpp"
#include "elastic/nonlocal_coupling.hpp"
#include "mdr/contact.hpp"
#include "scene/compressible_law.hpp"
#include "scene/mdr_law.hpp"
#include "scene/nonlocal_model.hpp"
#include "scene/packing_law.hpp"
#include "scene/plastic_law.hpp"

namespace monograin {
namespace {

using List = std::vector<DerivedParameter>;

void add_mdr(const Scenario& scenario, List& list) {
  const double youngs_modulus = scenario.material.at("youngs_modulus");
  const double poisson_ratio = scenario.material.at("poisson_ratio");
  const mdr::Material material = mdr_material_of(scenario);
  const double yield_stress = material.yield_stress;
  list.push_back({"youngs_modulus", youngs_modulus, "Pa"});
  list.push_back({"poisson_ratio", poisson_ratio, "-"});
  list.push_back({"composite_modulus", material.composite_modulus, "Pa"});
  list.push_back({"shear_modulus", youngs_modulus / (2.0 * (1.0 + poisson_ratio)), "Pa"});
  list.push_back({"bulk_compliance", material.bulk_compliance, "1/Pa"});
  if (!std::isfinite(yield_stress)) return;
  list.push_back({"yield_stress", yield_stress, "Pa"});
  list.push_back({"modulus_over_yield", youngs_modulus / yield_stress, "-"});
  if (material.pressure_curve) list.push_back({"pressure_table_end", material.pressure_curve->end(), "-"});
  const double d_yield = material.yield_overlap_ratio;
  list.push_back({"yield_overlap_over_radius", d_yield, "-"});
  if (!std::isfinite(d_yield)) return;
  const double overlap = d_yield * scenario.radius;
  const mdr::Contact contact =
      mdr::plastic_contact(material, scenario.radius, overlap, mdr::yield_area_constant(d_yield, scenario.radius));
  list.push_back({"yield_overlap", overlap, "m"});
  list.push_back({"yield_pressure", mdr::plastic_pressure(material, d_yield).pressure, "Pa"});
  list.push_back({"yield_contact_radius", contact.contact_radius, "m"});
  list.push_back({"yield_force", contact.force, "N"});
}

void add_nonlocal(const Scenario& scenario, List& list) {
  const double youngs_modulus = scenario.material.at("youngs_modulus");
  const double poisson_ratio = scenario.material.at("poisson_ratio");
  list.push_back({"youngs_modulus", youngs_modulus, "Pa"});
  list.push_back({"poisson_ratio", poisson_ratio, "-"});
  list.push_back({"composite_modulus", composite_modulus(youngs_modulus, poisson_ratio), "Pa", "E*"});
  const double unit = 1.0 / (youngs_modulus * scenario.radius);
  list.push_back({"compliance_opposite", nonlocal::half_space_influence(poisson_ratio, std::numbers::pi) * unit, "m/N",
                  "1/n_NL(180)"});
  list.push_back({"compliance_right_angle", nonlocal::half_space_influence(poisson_ratio, std::numbers::pi / 2) * unit,
                  "m/N", "1/n_NL(90)"});
  const double none = std::numeric_limits<double>::quiet_NaN();
  list.push_back({"limit_displacement", nonlocal_limit_of(scenario).value_or(none) * scenario.radius, "m"});
}

void add_material(const Scenario& scenario, std::initializer_list<std::pair<const char*, const char*>> keys,
                  List& list) {
  for (const auto& [key, unit] : keys) {
    if (const auto found = scenario.material.find(key); found != scenario.material.end()) {
      list.push_back({key, found->second, unit});
    }
  }
}

void add_radius_series(const plastic::RadiusSeries& series, List& list) {
  list.push_back({"radius_first", series.first, "-", "D1"});
  list.push_back({"radius_third", series.third, "-", "D3"});
  list.push_back({"radius_fifth", series.fifth, "-", "D5"});
}

void add_fall(const plastic::PressureFall& fall, bool is_enclosed, List& list) {
  list.push_back({"greatest_pressure", fall.greatest, "-", "H_max"});
  list.push_back({"greatest_pressure_approach", fall.start, "-", "x_Hmax"});
  list.push_back({"fall_rate", fall.rate, "-", "q"});
  list.push_back({"fall_exponent", 1.0 + fall.exponent_excess, "-", "r"});
  list.push_back({"simple_shift", fall.simple_shift, "-", "s_SC"});
  list.push_back({"simple_amplitude", fall.simple_amplitude, "-", "p_SC"});
  list.push_back({"simple_inflexion", fall.simple_inflexion, "-", "z_SC"});
  if (!is_enclosed) return;
  list.push_back({"least_pressure_approach", fall.end, "-", "x_Hmin"});
  list.push_back({"shift", fall.shift, "-", "s"});
  list.push_back({"inflexion", fall.inflexion, "-", "z_LC"});
  list.push_back({"least_pressure_of_simple", fall.simple_least, "-", "H_min1"});
  list.push_back({"steep_amplitude", fall.steep_amplitude, "-", "p_o"});
  list.push_back({"least_pressure_of_slope", fall.steep_least, "-", "H_min2"});
  list.push_back({"least_pressure", fall.least, "-", "H_min"});
  list.push_back({"amplitude", fall.amplitude, "-", "p"});
}

void add_law(const plastic::SemimechLaw& law, List& list) {
  const bool is_enclosed = law.configuration != plastic::Configuration::simple;
  list.push_back({"modulus_over_yield", law.material.modulus_over_yield, "-", "lambda"});
  list.push_back({"bulk_over_yield", law.material.bulk_over_yield, "-", "zeta"});
  add_radius_series(law.radius, list);
  list.push_back({"yield_approach", law.yield_approach, "-", "x_y"});
  list.push_back({"logarithm_amplitude", law.logarithm_amplitude, "-", "c1"});
  list.push_back({"logarithm_exponent", law.logarithm_exponent, "-", "c2"});
  add_fall(law.fall, is_enclosed, list);
  if (!is_enclosed) return;
  const plastic::Stiffening& stiffening = law.stiffening;
  list.push_back({"cell_at_least_pressure", stiffening.cell_at_least, "-", "chi_m"});
  list.push_back({"softness", stiffening.softness, "-", "l"});
  list.push_back({"pressure_scale", stiffening.pressure_scale, "-", "u"});
  list.push_back({"elastic_volume", stiffening.elastic_volume, "-", "V_el/V"});
  list.push_back({"cell_at_zero_porosity", stiffening.cell_at_zero_porosity, "-", "chi_zp"});
  list.push_back({"zero_porosity_approach", stiffening.zero_porosity, "-", "x_zp"});
  list.push_back({"impingement_approach", *plastic::impingement(law), "-"});
  if (law.configuration != plastic::Configuration::die) return;
  const plastic::LateralLaw lateral = plastic::make_lateral(law);
  list.push_back({"lateral_coefficient", std::exp(lateral.log_coefficient), "-", "tau 20^(omega-1)"});
  list.push_back({"lateral_exponent", lateral.exponent, "-", "omega"});
  list.push_back({"lateral_yield_approach", lateral.yield_approach, "-"});
  list.push_back({"lateral_onset_approach", lateral.onset, "-", "x_on"});
}

void add_law(const plastic::HardeningLaw& law, List& list) {
  const bool is_enclosed = law.configuration != plastic::Configuration::simple;
  add_radius_series(law.radius, list);
  add_fall(law.fall, is_enclosed, list);
  if (!is_enclosed) return;
  list.push_back({"cell_at_least_pressure", law.cell_at_least, "-", "chi_m"});
  list.push_back({"pressure_scale", law.pressure_scale, "-", "u"});
  list.push_back({"zero_porosity_approach", law.zero_porosity, "-", "x_zp"});
  list.push_back({"impingement_approach", *plastic::impingement(law), "-"});
}

void add_law(const plastic::SimilarityLaw& law, List& list) {
  list.push_back({"area_constant", law.area_constant, "-", "c^2"});
  list.push_back({"pressure_constant", law.pressure_constant, "-", "k"});
}

void add_compressible(const Scenario& scenario, List& list) {
  using namespace compressible;
  add_material(
      scenario,
      {{"stiffness_ratio", "-"}, {"shear_ratio", "-"}, {"tensile_ratio", "-"}, {"nu0", "-"}, {"yield_pressure", "Pa"}},
      list);
  const auto [law, hertz_stiffness, unloading, reservations] = compressible_law_of(scenario);
  const double transition_force = law.stiffness * law.transition;
  list.push_back({"k", law.stiffness, "-", "k"});
  list.push_back({"delta_t", law.transition, "-", "delta_t"});
  list.push_back({"a", law.exponent, "-", "a"});
  list.push_back({"transition_force", transition_force, "-", "k delta_t"});
  list.push_back({"slope_after_transition", law.exponent * transition_force, "-", "a k delta_t"});
  list.push_back({"largest_force", loading_force(law, k_largest_displacement), "-", "f(0.5)"});
  list.push_back({"hertz_stiffness", hertz_stiffness, "-", "k_H"});
  list.push_back({"force_unit",
                  std::numbers::pi * scenario.radius * scenario.radius * scenario.material.at("yield_pressure"), "N",
                  "pi R0^2 sigma_y0"});
  // Where the largest displacement is the end of the law; between, alpha and beta may follow from a table.
  const UnloadingCurve curve = unloading_from(law, hertz_stiffness, unloading, k_largest_displacement);
  const UnloadingShape shape = unloading.at(k_largest_displacement);
  list.push_back({"unloading_exponent", shape.exponent, "-", "alpha at 0.5"});
  list.push_back({"unloading_stiffness_ratio", shape.stiffness_ratio, "-", "beta at 0.5"});
  list.push_back({"separation", curve.separation(), "-", "d0 from 0.5"});
}

void add_packing(const Scenario& scenario, List& list) {
  const packing::Law law = packing_law_of(scenario);
  add_material(scenario, {{"youngs_modulus", "Pa"}, {"poisson_ratio", "-"}}, list);
  if (law.given.plasticity) add_material(scenario, {{"yield_stress", "Pa"}, {"hardening_modulus", "Pa"}}, list);
  list.push_back({"shear_modulus", law.shear_modulus, "Pa", "G"});
  list.push_back({"bulk_modulus", law.bulk_modulus, "Pa", "K"});
  list.push_back({"modulus_at_one", law.modulus_at_one, "Pa", "M"});
  list.push_back({"critical_porosity", law.given.critical_porosity, "-", "p_c"});
  list.push_back({"c2", law.given.strain_offset, "-"});
  list.push_back({"jamming", law.jamming, "-", "Phi_J"});
  list.push_back({"initial_packing_fraction", initial_packing_fraction_of(scenario, law), "-"});
  const packing::State state = packing::state(law, law.jamming);
  list.push_back({"jamming_strain", state.strain, "-", "e(Phi_J)"});
  list.push_back({"jamming_stress", state.stress, "Pa", "sigma(Phi_J)"});
  const packing::Branch strain = packing::growing_branch(law, packing::Measure::strain);
  list.push_back({"greatest_strain", strain.greatest, "-"});
  list.push_back({"greatest_strain_fraction", strain.end, "-"});
  const packing::Branch stress = packing::growing_branch(law, packing::Measure::stress);
  list.push_back({"greatest_stress", stress.greatest, "Pa"});
  list.push_back({"greatest_stress_fraction", stress.end, "-"});
  if (!law.given.plasticity) return;
  list.push_back({"softening_fraction", packing::softening(law), "-"});
  list.push_back({"fully_plastic_fraction", packing::full_plasticity(law), "-"});
}

/// The material where it starts.
void add_material_point(const Scenario& scenario, List& list) {
  using namespace compressible;
  const Parameters m = parameters_from(scenario.material, std::get<std::string>(scenario.options.at("yield_model")));
  const double unit = scenario.material.at("yield_pressure");
  const Properties at = properties_at(m, 0.0);
  list.push_back({"yield_pressure", unit, "Pa", "sigma_y0"});
  list.push_back({"youngs_modulus", unit * at.youngs_modulus.value, "Pa", "E"});
  list.push_back({"poisson_ratio", at.poisson_ratio.value, "-", "nu"});
  list.push_back({"bulk_modulus", unit * at.bulk_modulus.value, "Pa", "K"});
  list.push_back({"shear_modulus", unit * at.shear_modulus.value, "Pa", "G"});
  list.push_back({"shear_strength", unit * at.shear_strength.value, "Pa", "Gamma"});
  if (!is_compressible(m.model)) return;
  list.push_back({"relative_density", at.relative_density, "-", "rho"});
  list.push_back({"hydrostatic_strength", unit * at.yield_pressure.value, "Pa", "sigma_y"});
  list.push_back({"tensile_strength", unit * at.tensile_strength.value, "Pa", "Lambda"});
  list.push_back({"axis_ratio", at.axis_ratio.value, "-", "eps"});
  list.push_back({"cap_centre", unit * at.cap_centre.value, "Pa", "pi3"});
  if (m.model != YieldModel::dpc) return;
  const CapConstants cap = cap_constants(m, at);
  list.push_back({"friction_slope", cap.friction_slope.value, "-", "tan pi6"});
  list.push_back({"cohesion", unit * cap.cohesion.value, "Pa", "pi5"});
  list.push_back({"arc_radius", unit * cap.arc_radius.value, "Pa", "pi8 C"});
  list.push_back({"arc_centre", unit * cap.arc_centre.value, "Pa", "(1 - A) C"});
  list.push_back({"flow_stretch", cap.flow_stretch.value, "-", "B"});
  list.push_back({"transition_start", unit * cap.transition_start.value, "Pa", "p_i"});
}

void add_plastic(const Scenario& scenario, List& list) {
  add_material(scenario,
               {{"youngs_modulus", "Pa"},
                {"poisson_ratio", "-"},
                {"yield_stress", "Pa"},
                {"strength", "Pa"},
                {"hardening_exponent", "-"}},
               list);
  std::visit([&](const auto& law) { add_law(law, list); }, plastic_law_of(scenario));
}

struct ModelParameters {
  std::string_view model;
  void (*add)(const Scenario& scenario, List& list);
};

constexpr std::array k_parameters{
    ModelParameters{"hertz", add_mdr},
    ModelParameters{"mdr", add_mdr},
    ModelParameters{"similarity", add_plastic},
    ModelParameters{"semimech", add_plastic},
    ModelParameters{"hardening", add_plastic},
    ModelParameters{"nonlocal", add_nonlocal},
    ModelParameters{"compressible", add_compressible},
    ModelParameters{"packing", add_packing},
    ModelParameters{"material-point", add_material_point},
};

}  // namespace

std::vector<DerivedParameter> derived_parameters(const Scenario& scenario) {
  List list;
  if (scenario.radius > 0.0) list.push_back({"radius", scenario.radius, "m"});
  for (const auto& [model, add] : k_parameters) {
    if (model == scenario.model) add(scenario, list);
  }
  return list;
}

}  // namespace monograin
