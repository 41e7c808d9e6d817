#include <array>

#include "hardening/law.hpp"
#include "plastic/power_law.hpp"

namespace monograin::hardening {
namespace {

using std::string_view;

constexpr std::array k_references{&references::k_shahin2021};

constexpr std::array<string_view, 2> k_minimum_conditions{"current", "ideal"};

constexpr std::array k_options{
    OptionKey{"minimum_condition",
              "contact radius in the condition for the least pressure: the actual one, or that without hardening",
              OptionKey::Kind::choice, k_minimum_conditions},
    plastic::k_unloading,
};

constexpr auto k_regimes = plastic::joined(
    plastic::k_regime_before_contact,
    std::array{
        Term{"fully-plastic", "the plastic zone has reached the surface all over the contact"},
        Term{"low-compressibility",
             "the pores close: the mean pressure rises, without bound towards zero porosity (die, hydrostatic)"}},
    plastic::k_regime_without_law, plastic::k_regimes_of_unloading);

constexpr auto k_events = plastic::joined(
    plastic::k_events_of_touching,
    std::array{
        Term{"low-compressibility",
             "the pores begin to close: the slope of H/x^(mu/2) is zero, with H the mean pressure over kappa and x = "
             "displacement/R0 (die, hydrostatic)"},
        Term{"zero-porosity",
             "the particle fills its cell; the pressure is infinite there, and the run ends just before"}},
    plastic::k_event_of_neighbours, plastic::k_events_of_programs);

constexpr std::array<string_view, 6> k_domain{
    "rigid-plastic: no elastic strain; the run ends where the particle fills its cell (die: displacement/R0 = 0.4764, "
    "hydrostatic: 0.1940)",
    "simple: a warning beyond displacement/R0 = 0.5",
    "lateral contacts of a die: the source has no law for them",
    plastic::k_loading_only,
    plastic::k_extension,
    "warned: dissipation that falls by more than 1e-6 of the energy, possible with unloading = \"mdr\" where the "
    "elastic indenter stores faster than the walls work: small contacts of any material with 1/m below 1, the deeper "
    "the softer it is, and contacts just before zero porosity",
};

Law law_of(const ModelInput& input) {
  return make_law(input.material("hardening_exponent"), plastic::configuration_of(input),
                  input.word("minimum_condition") == "ideal" ? MinimumCondition::ideal : MinimumCondition::current);
}

std::vector<DerivedParameter> parameters(const ModelInput& input, const FirstStep& /*step*/) {
  const Law law = law_of(input);
  std::vector<DerivedParameter> list = plastic::power_law_parameters(input);
  add_parameters(law.radius, list);
  add_parameters(law.fall, law.configuration, list);
  if (!is_enclosed(law.configuration)) return list;
  list.push_back({"cell_at_least_pressure", law.cell_at_least, "-", "chi_m"});
  list.push_back({"pressure_scale", law.pressure_scale, "-", "u"});
  list.push_back({"zero_porosity_approach", law.zero_porosity, "-", "x_zp"});
  list.push_back({"impingement_approach", impingement_approach(law.configuration, law.radius), "-"});
  return list;
}

}  // namespace

Model model() noexcept {
  return plastic::power_law_model_of<law_of, k_options>(
      {.name = "hardening",
       .summary = "rigid-plastic particle that hardens by a power law, by the semi-mechanistic law",
       .references = k_references,
       .source = "chapter 3, with A. Agarwal and M. Gonzalez; misprints corrected",
       .configurations = plastic::k_source_configurations,
       .regimes = k_regimes,
       .events = k_events,
       .domain = k_domain,
       .parameters = parameters});
}

}  // namespace monograin::hardening
