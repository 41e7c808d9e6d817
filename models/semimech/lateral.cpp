#include "semimech/lateral.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "system/resolution.hpp"

namespace monograin::semimech {

double lateral_onset(double modulus_over_yield) noexcept {
  struct Entry {
    double modulus_over_yield, onset;
  };
  constexpr std::array<Entry, 5> table{
      {{163.08, 0.4159}, {386.40, 0.4115}, {1045.79, 0.4102}, {2841.34, 0.41}, {4954.40, 0.4098}}};
  constexpr double same_material = 1e-3;  // the printed moduli are rounded
  for (const Entry& entry : table) {
    if (std::abs(modulus_over_yield / entry.modulus_over_yield - 1.0) < same_material) return entry.onset;
  }
  const double lambda =
      std::clamp(modulus_over_yield, k_least_lateral_modulus_over_yield, k_greatest_lateral_modulus_over_yield);
  return 0.409833 + 4.03e-4 * std::pow(1e-3 * lambda, -1.4956);
}

LateralLaw make_lateral(const Law& law) {
  if (law.configuration != Configuration::die)
    throw std::invalid_argument("lateral contacts exist in the die only, not under " +
                                std::string(name(law.configuration)) + " compression");
  const double lambda = law.material.modulus_over_yield;
  const double exponent = 5.7775 * std::tanh(0.0159 * std::pow(lambda, 0.6146));                  // eq. 2.51
  const double log_tau = -std::log(1480.8863 * std::tanh(5.0261e-5 * std::pow(lambda, 1.2889)));  // eq. 2.50, mm
  LateralLaw lateral{.log_coefficient = log_tau + (exponent - 1.0) * std::log(20.0), .exponent = exponent};
  lateral.yield_approach = std::exp((std::log(law.yield_approach) - lateral.log_coefficient) / exponent);
  lateral.onset = lateral_onset(lambda);
  return lateral;
}

ValueAndSlope lateral_approach(const LateralLaw& lateral, double x) noexcept {
  const double value = std::exp(lateral.log_coefficient + lateral.exponent * std::log(x));
  return {.value = value, .slope = lateral.exponent * value / x};
}

Boundaries boundaries(const Law& law, const LateralLaw& lateral) {
  Boundaries list;
  if (lateral.yield_approach < LateralLaw::small_range_end)
    list.push_back({"yield", lateral.yield_approach, Regime::elastic_plastic});
  list.push_back({"", LateralLaw::small_range_end, Regime::undefined});
  list.push_back({"secondary-onset", lateral.onset, regime_at(law, lateral.onset)});
  if (lateral.onset < law.stiffening.zero_porosity)
    list.push_back({"", law.stiffening.zero_porosity, Regime::elastic_volumetric});
  return list;
}

ContactState lateral_state_in(const Law& law, const LateralLaw& lateral, Regime regime, double x) {
  if (regime == Regime::open) return {};
  if (regime == Regime::elastic || regime == Regime::elastic_plastic) {
    const auto [own, slope] = lateral_approach(lateral, x);
    ContactState state = state_in(law, regime, own);
    state.contact_radius_by_approach *= slope;
    state.pressure_by_approach *= slope;
    state.force_by_approach *= slope;
    return state;
  }
  ContactState state{.regime = regime,
                     .contact_radius = k_nan,
                     .pressure = k_nan,
                     .force = k_nan,
                     .contact_radius_by_approach = k_nan,
                     .pressure_by_approach = k_nan,
                     .force_by_approach = k_nan};
  if (regime != Regime::undefined) {
    const ContactState primary = state_in(law, regime, x);
    state.pressure = primary.pressure;
    state.pressure_by_approach = primary.pressure_by_approach;
  }
  return state;
}

}  // namespace monograin::semimech
