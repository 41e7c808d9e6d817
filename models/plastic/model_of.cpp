#include "plastic/model_of.hpp"

#include "elastic/hertz.hpp"

namespace monograin::plastic {

void add_parameters(const RadiusSeries& series, std::vector<DerivedParameter>& list) {
  list.push_back({"radius_first", series.first, "-", "D1"});
  list.push_back({"radius_third", series.third, "-", "D3"});
  list.push_back({"radius_fifth", series.fifth, "-", "D5"});
}

void add_parameters(const PressureFall& fall, Configuration configuration, std::vector<DerivedParameter>& list) {
  list.push_back({"greatest_pressure", fall.greatest, "-", "H_max"});
  list.push_back({"greatest_pressure_approach", fall.start, "-", "x_Hmax"});
  list.push_back({"fall_rate", fall.rate, "-", "q"});
  list.push_back({"fall_exponent", 1.0 + fall.exponent_excess, "-", "r"});
  list.push_back({"simple_shift", fall.simple_shift, "-", "s_SC"});
  list.push_back({"simple_amplitude", fall.simple_amplitude, "-", "p_SC"});
  list.push_back({"simple_inflexion", fall.simple_inflexion, "-", "z_SC"});
  if (!is_enclosed(configuration)) return;
  list.push_back({"least_pressure_approach", fall.end, "-", "x_Hmin"});
  list.push_back({"shift", fall.shift, "-", "s"});
  list.push_back({"inflexion", fall.inflexion, "-", "z_LC"});
  list.push_back({"least_pressure_of_simple", fall.simple_least, "-", "H_min1"});
  list.push_back({"steep_amplitude", fall.steep_amplitude, "-", "p_o"});
  list.push_back({"least_pressure_of_slope", fall.steep_least, "-", "H_min2"});
  list.push_back({"least_pressure", fall.least, "-", "H_min"});
  list.push_back({"amplitude", fall.amplitude, "-", "p"});
}

Configuration configuration_of(const ModelInput& input) {
  if (input.configuration == "die") return Configuration::die;
  return input.configuration == "hydrostatic" ? Configuration::hydrostatic : Configuration::simple;
}

bool can_unload(const ModelInput& input) { return input.word("unloading") != "none"; }

bool may_be_undefined(const CheckedRun& /*run*/, std::size_t /*row*/, std::string_view column) {
  return column.starts_with("lateral.");
}

Settings settings_of(const ModelInput& input, const char* strength, const Reach& reach) {
  Settings settings{.strength = input.material(strength), .can_unload = can_unload(input), .reach = reach};
  if (settings.can_unload) {
    settings.poisson_ratio = input.material("poisson_ratio");
    settings.composite_modulus = composite_modulus(input.material("youngs_modulus"), settings.poisson_ratio);
  }
  return settings;
}

}  // namespace monograin::plastic
