#include "plastic/info.hpp"

#include <array>
#include <stdexcept>

#include "plastic/semimech.hpp"

namespace monograin::plastic {
namespace {

using std::string_view;

constexpr Range k_positive{.lower = 0.0, .lower_is_open = true};
constexpr Range k_poisson{.lower = -1.0, .upper = 0.5, .lower_is_open = true};
constexpr Range k_share{.lower = 0.0, .upper = 1.0};

constexpr std::array<string_view, 5> k_all_configurations{"simple", "die", "hydrostatic", "oblique-die", "walls"};
constexpr std::array<string_view, 3> k_source_configurations{"simple", "die", "hydrostatic"};

constexpr std::array<string_view, 2> k_unloading_rules{"none", "mdr"};
constexpr std::array<string_view, 2> k_minimum_conditions{"current", "ideal"};

constexpr OptionKey k_unloading{
    "unloading",
    "what walls do that go back: the source has no law (none refuses such programs); mdr is "
    "the workbench's own extension, the elastic indenter that model mdr leaves under the "
    "same mean pressure and contact radius",
    OptionKey::Kind::choice, k_unloading_rules};

// --- keys

constexpr std::array k_elastic_plastic_material{
    QuantityKey{"youngs_modulus", "Young's modulus", Dimension::stress, k_positive, {}},
    QuantityKey{"poisson_ratio", "Poisson's ratio", Dimension::none, k_poisson, {}},
    QuantityKey{"yield_stress", "uniaxial yield stress", Dimension::stress, k_positive, {}},
};

constexpr std::array k_power_law_material{
    QuantityKey{"strength",
                "strength kappa of the power law sigma = kappa epsilon^(1/m)",
                Dimension::stress,
                k_positive,
                {},
                true},
    QuantityKey{
        "hardening_exponent", "exponent 1/m of the power law; 0: ideally plastic", Dimension::none, k_share, {}, true},
    QuantityKey{
        "youngs_modulus", "Young's modulus, for unloading and ludwik only", Dimension::stress, k_positive, {}, true},
    QuantityKey{"poisson_ratio", "Poisson's ratio, for unloading only", Dimension::none, k_poisson, {}, true},
};

constexpr std::array k_similarity_options{
    OptionKey{"curvature_correction",
              "contact radius with the next term of the spheres' curvature",
              OptionKey::Kind::toggle,
              {}},
    k_unloading,
};

constexpr std::array k_semimech_options{k_unloading};

constexpr std::array k_hardening_options{
    OptionKey{"minimum_condition",
              "contact radius in the condition for the least pressure: the actual one, or that without hardening",
              OptionKey::Kind::choice, k_minimum_conditions},
    k_unloading,
};

// --- regimes

constexpr Term k_open{"open", "the wall does not touch: no force"};
constexpr Term k_fully_plastic{"fully-plastic", "the plastic zone has reached the surface all over the contact"};
constexpr Term k_low_compressibility{"low-compressibility",
                                     "the pores close and the mean pressure rises again (die, hydrostatic)"};
constexpr Term k_undefined{"undefined", "lateral contact of a die where the source has no law; its columns are empty"};
constexpr Term k_unloaded{"unloading", "yielded contact below its largest displacement (unloading = \"mdr\")"};
constexpr Term k_separated{"separated", "yielded contact that has opened over its dent: no force"};

constexpr std::array k_similarity_regimes{
    k_open,
    Term{"fully-plastic", "similarity solution of a rigid-plastic power-law contact"},
    k_unloaded,
    k_separated,
};

constexpr std::array k_semimech_regimes{
    k_open,
    Term{"elastic", "mean pressure of Hertz, contact radius of the law: the force is D1^2 times that of Hertz"},
    Term{"elastic-plastic", "yielded below the surface; the mean pressure rises to its maximum"},
    Term{"fully-plastic", "the mean pressure falls from its maximum to its minimum"},
    k_low_compressibility,
    Term{"elastic-volumetric", "no pores are left: elastic compression of the volume (die, hydrostatic)"},
    k_undefined,
    k_unloaded,
    k_separated,
};

constexpr std::array k_hardening_regimes{k_open,      k_fully_plastic, k_low_compressibility,
                                         k_undefined, k_unloaded,      k_separated};

// --- events

constexpr Term k_made{"contact-made", "a wall comes to touch the particle"};
constexpr Term k_lost{"contact-lost", "a wall leaves the particle, or its dent"};
constexpr Term k_touched{"dent-touched", "a wall touches the bottom of its dent again"};
constexpr Term k_reversal{"load-reversal", "a contact at its largest displacement starts to unload"};
constexpr Term k_reload{"reload", "a contact passes its old maximum displacement, and the law goes on"};
constexpr Term k_low{"low-compressibility", "least mean pressure: the pores begin to close (die, hydrostatic)"};
constexpr Term k_impingement{"impingement", "the circles of neighbouring contacts meet; the law does not change there"};
constexpr Term k_step_end{"step-end", "end of a step of the program"};
constexpr Term k_until_met{"until-met", "a step ended early by its condition"};
constexpr Term k_limit{"limit",
                       "the walls meet at gamma/2R = 1, or another end of the equations; the message says which"};

constexpr std::array k_similarity_events{k_made,   k_lost,     k_touched,   k_reversal,
                                         k_reload, k_step_end, k_until_met, k_limit};

constexpr std::array k_semimech_events{
    k_made,
    k_lost,
    k_touched,
    Term{"yield", "mean pressure of 1.1 Y: the elastic regime ends"},
    Term{"fully-plastic", "greatest mean pressure"},
    k_low,
    Term{"zero-porosity", "no pores are left (die, hydrostatic)"},
    Term{"secondary-onset", "lateral contacts begin to bear the pressure of the axial ones (die)"},
    k_impingement,
    k_reversal,
    k_reload,
    k_step_end,
    k_until_met,
    k_limit,
};

constexpr std::array k_hardening_events{
    k_made,
    k_lost,
    k_touched,
    k_low,
    Term{"zero-porosity", "the particle fills its cell; the pressure is infinite there, and the run ends just before"},
    k_impingement,
    k_reversal,
    k_reload,
    k_step_end,
    k_until_met,
    k_limit,
};

// --- validity

constexpr string_view k_loading_only = "walls only come nearer, unless unloading = \"mdr\"";
constexpr string_view k_extension =
    "unloading = \"mdr\" is not of the source: A = 4 p a/E*, b = a, and the unloading branch of model mdr; a contact "
    "that "
    "has not yielded goes back the way it came";

constexpr string_view k_energy =
    "warned: dissipation that falls by more than 1e-6 of the energy, possible with unloading = \"mdr\" where the "
    "elastic "
    "indenter holds more energy than the law's own pressure has put in: soft materials, contacts that have just "
    "yielded, and beyond zero porosity";

constexpr std::array<string_view, 6> k_similarity_domain{
    "small strains: the source sees the law leave its calculations at gamma/2R of about 0.03; a warning beyond",
    "every contact is independent of the others",
    "gamma/2R below 1",
    k_loading_only,
    k_extension,
    k_energy,
};

constexpr std::array<string_view, 12> k_semimech_domain{
    "E/((1-nu^2) Y) from 22.0931 on; a warning outside 117.24 to 5933.40",
    "die and hydrostatic: nu below 0.5; a warning outside E/Y = 100 to 5000, nu = 0.2 to 0.48, "
    "E/(3 (1-2 nu) Y) = 64 to 28000",
    "gamma/2R below 1; a warning beyond 0.5 (simple) and 0.01 beyond zero porosity (die, hydrostatic)",
    "elastic regime: the pressure is Hertz's but the contact radius is not, so the force is D1^2 (1.35 to 3.07) times "
    "that of Hertz",
    "too stiff below gamma/2R = 0.03 against finite elements, at 0.005, 0.01, 0.02 by 58, 35, 19 % (simple), 50, 33, "
    "18 % (die), 66, 37, 15 % (hydrostatic); a warning where a whole run lies there",
    "lateral contacts of a die: forces 2.1 to 3.5 times those of finite elements for gamma/2R from 0.03 to 0.1; a "
    "warning",
    "the law's second derivative jumps at its regime boundaries and is infinite just after the greatest pressure",
    "lateral contacts of a die: force and area for gamma/2R up to 0.1, pressure from the onset (about 0.41) on, "
    "nothing "
    "between; E/((1-nu^2) Y) from 163.08 to 4954.40, a warning outside",
    "lateral contacts do not act back on the axial ones",
    k_loading_only,
    k_extension,
    k_energy,
};

constexpr std::array<string_view, 6> k_hardening_domain{
    "rigid-plastic: no elastic strain; the run ends where the particle fills its cell (die: gamma/2R = 0.4764, "
    "hydrostatic: 0.1940)",
    "simple: a warning beyond gamma/2R = 0.5",
    "lateral contacts of a die: the source has no law for them",
    k_loading_only,
    k_extension,
    k_energy,
};

// --- objections

void require_elastic_constants(const ModelInput& given, std::vector<Objection>& found) {
  if (given.choices.at("unloading") != "mdr") return;
  for (const char* key : {"youngs_modulus", "poisson_ratio"}) {
    if (given.material.contains(key)) continue;
    found.push_back({"unloading", std::string("unloading = \"mdr\" needs the elastic constants; expected ") + key +
                                      " in [material]"});
  }
}

std::vector<Objection> power_law_objections(const ModelInput& given) {
  std::vector<Objection> found;
  require_elastic_constants(given, found);
  return found;
}

std::vector<Objection> semimech_objections(const ModelInput& given) {
  const auto& constants = given.material;
  const Configuration configuration = configuration_named(given.configuration);
  try {
    static_cast<void>(make_semimech(make_semimech_material(constants.at("youngs_modulus"),
                                                           constants.at("poisson_ratio"), constants.at("yield_stress")),
                                    configuration));
  } catch (const std::invalid_argument& error) {
    // Too soft against its strength, or compressed to nothing, or not at all.
    const double lambda = make_semimech_material(constants.at("youngs_modulus"), constants.at("poisson_ratio"),
                                                 constants.at("yield_stress"))
                              .modulus_over_yield;
    return {{lambda < k_least_modulus_over_yield ? "yield_stress" : "poisson_ratio", error.what()}};
  }
  return {};
}

}  // namespace

ModelInfo similarity_info() noexcept {
  return {.name = "similarity",
          .summary = "rigid-plastic power-law contact by the similarity solution, every contact for itself",
          .source = "000_34f0f4b3689a4570.txt (Biwa-Storakers law), section 2.2 and appendix B",
          .material = k_power_law_material,
          .options = k_similarity_options,
          .configurations = k_all_configurations,
          .has_free_centre = false,
          .regimes = k_similarity_regimes,
          .events = k_similarity_events,
          .domain = k_similarity_domain,
          .takes_ludwik = true,
          .objections = power_law_objections};
}

ModelInfo semimech_info() noexcept {
  return {.name = "semimech",
          .summary = "elastic-ideally plastic particle by the semi-mechanistic law, from first touch to no pores left",
          .source = "000_34f0f4b3689a4570.txt, chapter 2",
          .material = k_elastic_plastic_material,
          .options = k_semimech_options,
          .configurations = k_source_configurations,
          .has_free_centre = false,
          .regimes = k_semimech_regimes,
          .events = k_semimech_events,
          .domain = k_semimech_domain,
          .takes_ludwik = false,
          .objections = semimech_objections};
}

ModelInfo hardening_info() noexcept {
  return {.name = "hardening",
          .summary = "rigid-plastic particle that hardens by a power law, by the semi-mechanistic law",
          .source = "000_34f0f4b3689a4570.txt, chapter 3",
          .material = k_power_law_material,
          .options = k_hardening_options,
          .configurations = k_source_configurations,
          .has_free_centre = false,
          .regimes = k_hardening_regimes,
          .events = k_hardening_events,
          .domain = k_hardening_domain,
          .takes_ludwik = true,
          .objections = power_law_objections};
}

}  // namespace monograin::plastic
