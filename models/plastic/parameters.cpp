#include "plastic/parameters.hpp"

#include <cmath>
#include <variant>

namespace monograin::plastic {
namespace {

void add_radius_series(const RadiusSeries& series, std::vector<DerivedParameter>& list) {
  list.push_back({"radius_first", series.first, "-", "D1"});
  list.push_back({"radius_third", series.third, "-", "D3"});
  list.push_back({"radius_fifth", series.fifth, "-", "D5"});
}

void add_fall(const PressureFall& fall, bool is_enclosed, std::vector<DerivedParameter>& list) {
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

void add_law(const SemimechLaw& law, std::vector<DerivedParameter>& list) {
  const bool is_enclosed = law.configuration != Configuration::simple;
  list.push_back({"modulus_over_yield", law.material.modulus_over_yield, "-", "lambda"});
  list.push_back({"bulk_over_yield", law.material.bulk_over_yield, "-", "zeta"});
  add_radius_series(law.radius, list);
  list.push_back({"yield_approach", law.yield_approach, "-", "x_y"});
  list.push_back({"logarithm_amplitude", law.logarithm_amplitude, "-", "c1"});
  list.push_back({"logarithm_exponent", law.logarithm_exponent, "-", "c2"});
  add_fall(law.fall, is_enclosed, list);
  if (!is_enclosed) return;
  const Stiffening& stiffening = law.stiffening;
  list.push_back({"cell_at_least_pressure", stiffening.cell_at_least, "-", "chi_m"});
  list.push_back({"softness", stiffening.softness, "-", "l"});
  list.push_back({"pressure_scale", stiffening.pressure_scale, "-", "u"});
  list.push_back({"elastic_volume", stiffening.elastic_volume, "-", "V_el/V"});
  list.push_back({"cell_at_zero_porosity", stiffening.cell_at_zero_porosity, "-", "chi_zp"});
  list.push_back({"zero_porosity_approach", stiffening.zero_porosity, "-", "x_zp"});
  list.push_back({"impingement_approach", *impingement(law), "-"});
  if (law.configuration != Configuration::die) return;
  const LateralLaw lateral = make_lateral(law);
  list.push_back({"lateral_coefficient", std::exp(lateral.log_coefficient), "-", "tau 20^(omega-1)"});
  list.push_back({"lateral_exponent", lateral.exponent, "-", "omega"});
  list.push_back({"lateral_yield_approach", lateral.yield_approach, "-"});
  list.push_back({"lateral_onset_approach", lateral.onset, "-", "x_on"});
}

void add_law(const HardeningLaw& law, std::vector<DerivedParameter>& list) {
  const bool is_enclosed = law.configuration != Configuration::simple;
  add_radius_series(law.radius, list);
  add_fall(law.fall, is_enclosed, list);
  if (!is_enclosed) return;
  list.push_back({"cell_at_least_pressure", law.cell_at_least, "-", "chi_m"});
  list.push_back({"pressure_scale", law.pressure_scale, "-", "u"});
  list.push_back({"zero_porosity_approach", law.zero_porosity, "-", "x_zp"});
  list.push_back({"impingement_approach", *impingement(law), "-"});
}

void add_law(const SimilarityLaw& law, std::vector<DerivedParameter>& list) {
  list.push_back({"area_constant", law.area_constant, "-", "c^2"});
  list.push_back({"pressure_constant", law.pressure_constant, "-", "k"});
}

}  // namespace

void add_law_parameters(const Law& law, std::vector<DerivedParameter>& list) {
  std::visit([&](const auto& any) { add_law(any, list); }, law);
}

}  // namespace monograin::plastic
