#include <array>

#include "plastic/power_law.hpp"
#include "similarity/law.hpp"

namespace monograin::similarity {
namespace {

using std::string_view;

constexpr std::array k_references{&references::k_shahin2021, &references::k_storakers1997, &references::k_biwa1995};

constexpr std::array k_options{
    OptionKey{"curvature_correction", "contact radius with the next term of the spheres' curvature",
              OptionKey::Kind::toggle},
    plastic::k_unloading,
};

constexpr auto k_regimes =
    plastic::joined(plastic::k_regime_before_contact,
                    std::array{Term{"fully-plastic", "similarity solution of a rigid-plastic power-law contact"}},
                    plastic::k_regimes_of_unloading);

constexpr auto k_events = plastic::joined(plastic::k_events_of_touching, plastic::k_events_of_programs);

constexpr std::array<string_view, 7> k_domain{
    "small strains: the source sees the law leave its calculations at displacement/R0 of about 0.03; a warning beyond",
    "against finite elements (1/m = 0.327, two walls) the force is too high by 15, 32 and 68 % at displacement/R0 = "
    "0.01, 0.03 and 0.1",
    "every contact is independent of the others",
    "displacement/R0 below 1",
    plastic::k_loading_only,
    plastic::k_extension,
    "warned: dissipation that falls by more than 1e-6 of the energy, possible with unloading = \"mdr\" where the "
    "elastic indenter stores faster than the walls work: small contacts of any material with 1/m below 1, the deeper "
    "the softer it is",
};

Law law_of(const ModelInput& input) {
  return make_law(input.material("hardening_exponent"),
                  input.toggle("curvature_correction") ? RadiusRule::corrected : RadiusRule::parabolic);
}

std::vector<DerivedParameter> parameters(const ModelInput& input, const FirstStep& /*step*/) {
  const Law law = law_of(input);
  std::vector<DerivedParameter> list = plastic::power_law_parameters(input);
  list.push_back({"area_constant", law.area_constant, "-", "c^2"});
  list.push_back({"pressure_constant", law.pressure_constant, "-", "k"});
  return list;
}

}  // namespace

Model model() noexcept {
  return plastic::power_law_model_of<law_of, k_options>(
      {.name = "similarity",
       .summary = "rigid-plastic power-law contact by the similarity solution, contacts independent of each other",
       .references = k_references,
       .source = "Shahin (2021), section 2.2 and appendix B",
       .configurations = k_wall_configurations,
       .has_free_centre = true,
       .regimes = k_regimes,
       .events = k_events,
       .domain = k_domain,
       .parameters = parameters});
}

}  // namespace monograin::similarity
