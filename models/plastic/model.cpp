#include "plastic/model.hpp"

#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <variant>

#include "elastic/hertz.hpp"
#include "plastic/ludwik.hpp"
#include "plastic/parameters.hpp"
#include "plastic/semimech.hpp"
#include "plastic/system.hpp"
#include "stress/checks.hpp"
#include "stress/draw.hpp"
#include "system/resolution.hpp"

namespace monograin::plastic {
namespace {

using std::string_view;

constexpr std::array k_thesis{&references::k_shahin2021};
constexpr std::array k_similarity_references{&references::k_shahin2021, &references::k_storakers1997,
                                             &references::k_biwa1995};

constexpr Range k_share{.lower = 0.0, .upper = 1.0};

constexpr std::array<string_view, 3> k_source_configurations{"simple", "die", "hydrostatic"};

constexpr std::array<string_view, 2> k_unloading_rules{"none", "mdr"};
constexpr std::array<string_view, 2> k_minimum_conditions{"current", "ideal"};

constexpr OptionKey k_unloading{
    "unloading",
    "unloading of the contacts: none (the source has no law; a program that unloads is refused) or mdr, "
    "the workbench's own extension, the elastic indenter that model mdr leaves under the "
    "same mean pressure and contact radius",
    OptionKey::Kind::choice, k_unloading_rules};

// --- keys

constexpr std::array k_elastic_plastic_material{
    QuantityKey{"youngs_modulus", "Young's modulus", Dimension::stress, k_positive},
    QuantityKey{"poisson_ratio", "Poisson's ratio", Dimension::none, k_poisson_to_half},
    QuantityKey{"yield_stress", "uniaxial yield stress", Dimension::stress, k_positive},
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
    QuantityKey{"youngs_modulus",
                "Young's modulus, for unloading and ludwik (which takes infinity without it)",
                Dimension::stress,
                k_positive,
                {},
                true},
    QuantityKey{"poisson_ratio", "Poisson's ratio, for unloading only", Dimension::none, k_poisson_to_half, {}, true},
};

constexpr std::array k_similarity_options{
    OptionKey{"curvature_correction", "contact radius with the next term of the spheres' curvature",
              OptionKey::Kind::toggle},
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
constexpr Term k_closing_pores{"low-compressibility",
                               "the pores close: the mean pressure rises, without bound towards zero porosity (die, "
                               "hydrostatic)"};
constexpr Term k_undefined{"undefined", "lateral contact of a die where the source has no law; its columns are nan"};
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

constexpr std::array k_hardening_regimes{k_open,      k_fully_plastic, k_closing_pores,
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
constexpr Term k_limit{
    "limit", "the walls meet at displacement/R0 = 1, or another end of the equations; the message says which"};

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
    Term{"low-compressibility",
         "the pores begin to close: the slope of H/x^(mu/2) is zero, with H the mean pressure over kappa and x = "
         "displacement/R0 (die, hydrostatic)"},
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
    "that has not yielded unloads along its loading curve";

constexpr string_view k_energy =
    "warned: dissipation that falls by more than 1e-6 of the energy, possible with unloading = \"mdr\" where the "
    "elastic indenter holds more energy than the law's own pressure has put in: soft materials, contacts that have "
    "just yielded, and beyond zero porosity";
constexpr string_view k_similarity_energy =
    "warned: dissipation that falls by more than 1e-6 of the energy, possible with unloading = \"mdr\" where the "
    "elastic indenter stores faster than the walls work: small contacts of any material with 1/m below 1, the deeper "
    "the softer it is";
constexpr string_view k_hardening_energy =
    "warned: dissipation that falls by more than 1e-6 of the energy, possible with unloading = \"mdr\" where the "
    "elastic indenter stores faster than the walls work: small contacts of any material with 1/m below 1, the deeper "
    "the softer it is, and contacts just before zero porosity";

constexpr std::array<string_view, 7> k_similarity_domain{
    "small strains: the source sees the law leave its calculations at displacement/R0 of about 0.03; a warning beyond",
    "against finite elements (1/m = 0.327, two walls) the force is too high by 15, 32 and 68 % at displacement/R0 = "
    "0.01, 0.03 and 0.1",
    "every contact is independent of the others",
    "displacement/R0 below 1",
    k_loading_only,
    k_extension,
    k_similarity_energy,
};

constexpr std::array<string_view, 12> k_semimech_domain{
    "E/((1-nu^2) Y) from 22.0931 on; a warning outside 117.24 to 5933.40",
    "die and hydrostatic: nu below 0.5; a warning outside E/Y = 100 to 5000, nu = 0.2 to 0.48, "
    "E/(3 (1-2 nu) Y) = 64 to 28000",
    "displacement/R0 below 1; a warning beyond 0.5 (simple) and 0.01 beyond zero porosity (die, hydrostatic)",
    "elastic regime: the pressure is Hertz's but the contact radius is not, so the force is D1^2 times that of Hertz: "
    "1.35 to 3.07 (simple), 1.42 to 3.22 (die), 1.58 to 3.59 (hydrostatic)",
    "too stiff below displacement/R0 = 0.03 against finite elements, at 0.005, 0.01, 0.02 by 58, 35, 19 % (simple), "
    "50, 33, 18 % (die), 66, 37, 15 % (hydrostatic); a warning where a whole run lies there",
    "lateral contacts of a die: forces 2.1 to 3.5 times those of finite elements for axial displacement/R0 from 0.03 "
    "to 0.1; a warning",
    "the law's second derivative jumps at its regime boundaries and is infinite just after the greatest pressure",
    "lateral contacts of a die: force and area for axial displacement/R0 up to 0.1, pressure from the onset (about "
    "0.41) on, nothing between; E/((1-nu^2) Y) from 163.08 to 4954.40, a warning outside",
    "lateral contacts do not act back on the axial ones",
    k_loading_only,
    k_extension,
    k_energy,
};

constexpr std::array<string_view, 6> k_hardening_domain{
    "rigid-plastic: no elastic strain; the run ends where the particle fills its cell (die: displacement/R0 = 0.4764, "
    "hydrostatic: 0.1940)",
    "simple: a warning beyond displacement/R0 = 0.5",
    "lateral contacts of a die: the source has no law for them",
    k_loading_only,
    k_extension,
    k_hardening_energy,
};

// --- from a scenario to the law

// Range of the search for the displacement that meets a condition: from this share of the limit, where pressures may be
// infinite, down to the resolution.
constexpr double k_deepest = 0.9;
// Bisections that refine the displacement: next to the limit, work may grow by orders over a tenth of the path.
constexpr int k_bisections = 20;

/// Configuration of a scenario. Other sets of walls count as simple: the law that allows them treats each wall by
/// itself.
Configuration configuration_of(const ModelInput& input) {
  if (input.configuration == "die") return Configuration::die;
  return input.configuration == "hydrostatic" ? Configuration::hydrostatic : Configuration::simple;
}

SemimechMaterial semimech_material(const ModelInput& input) {
  return make_semimech_material(input.material("youngs_modulus"), input.material("poisson_ratio"),
                                input.material("yield_stress"));
}

bool can_unload(const ModelInput& input) { return input.word("unloading") != "none"; }

// --- objections

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

std::vector<Objection> semimech_objections(const ModelInput& input) {
  try {
    static_cast<void>(semimech_law(input));
  } catch (const std::invalid_argument& error) {
    // The material is too soft against its strength, too compressible, or incompressible.
    const bool is_soft = semimech_material(input).modulus_over_yield < k_least_modulus_over_yield;
    return {{is_soft ? "yield_stress" : "poisson_ratio", error.what()}};
  }
  return {};
}

// --- functions of all three laws

double strength(const ModelInput& input) { return input.material("strength"); }
double yield_stress(const ModelInput& input) { return input.material("yield_stress"); }

/// Functions of a law of this folder, with the unit of its pressures.
template <Law (*make_law)(const ModelInput&), double (*stress_unit)(const ModelInput&)>
struct Functions {
  static std::unique_ptr<HybridSystem> bind(const ModelInput& input, std::vector<ContactClass> classes,
                                            const Reach& reach) {
    Settings settings{.law = make_law(input),
                      .strength = stress_unit(input),
                      .unloading = can_unload(input) ? Unloading::mdr : Unloading::none,
                      .reach = reach};
    if (settings.unloading == Unloading::mdr) {
      settings.poisson_ratio = input.material("poisson_ratio");
      settings.composite_modulus = composite_modulus(input.material("youngs_modulus"), settings.poisson_ratio);
    }
    if (const auto* semimech = std::get_if<SemimechLaw>(&settings.law)) {
      settings.out_of_range = outside_calibration(input.material("youngs_modulus"), input.material("poisson_ratio"),
                                                  settings.strength, semimech->configuration);
    }
    return std::make_unique<System>(WallLaw(std::move(settings)),
                                    contacts::Settings{input.radius, reach, input.centre_is_free}, std::move(classes));
  }

  static std::vector<DerivedParameter> parameters(const ModelInput& input, const FirstStep& /*step*/) {
    std::vector<DerivedParameter> list = material_parameters(input, {{"youngs_modulus", "Pa"},
                                                                     {"poisson_ratio", "-"},
                                                                     {"yield_stress", "Pa"},
                                                                     {"strength", "Pa"},
                                                                     {"hardening_exponent", "-"}});
    add_law_parameters(make_law(input), list);
    return list;
  }

  static Reach reach(const ModelInput& input, const Until& until) {
    const Law law = make_law(input);
    const double radius = input.radius;
    const double strength = stress_unit(input);
    const double force_unit = strength * radius * radius;
    const auto state_at_approach = [&](double x) {
      return std::visit([x](const auto& any) { return state_at(any, x); }, law);
    };
    const auto reach_at = [&](double x) { return Reach{x * radius, state_at_approach(x).force * force_unit}; };
    if (until.is_event()) {
      for (const Boundary& boundary : boundaries(law)) {
        if (boundary.event == until.event && boundary.beyond != Regime::undefined) return reach_at(boundary.approach);
      }
      return {k_infinity, k_infinity};
    }
    const auto is_met = [&](double x) {
      if (until.quantity == Quantity::displacement) return x * radius >= until.value;
      const ContactState contact = state_at_approach(x);
      if (until.quantity == Quantity::force) return contact.force * force_unit >= until.value;
      if (until.quantity == Quantity::pressure) return contact.pressure * strength >= until.value;
      if (until.quantity == Quantity::contact_radius) return contact.contact_radius * radius >= until.value;
      return until.value <= 0.0;
    };
    double first = 0.0;
    // Pressures fall again at greater depth: the search goes on to the least displacement that meets the condition.
    for (double x = k_deepest * limit(law); x > 0.5 * k_resolution; x *= 0.5) {
      if (is_met(x)) first = x;
    }
    if (first == 0.0) return {k_infinity, k_infinity};
    double before = 0.5 * first;
    for (int k = 0; k < k_bisections; ++k) {
      const double middle = std::midpoint(before, first);
      (is_met(middle) ? first : before) = middle;
    }
    return reach_at(first);
  }

  /// Adds to a model the functions that all three laws share.
  static Model of(Model model) {
    model.bind = bind;
    model.parameters = parameters;
    model.reach = reach;
    model.can_unload = can_unload;
    return model;
  }
};

/// Power law nearest to Ludwik's law. The fit over the total strain depends on Young's modulus; infinite:
/// rigid-plastic.
PowerLaw power_law_of(const LudwikInput& ludwik) {
  const HollomonMaterial fitted =
      fit_hollomon({.youngs_modulus = ludwik.youngs_modulus,
                    .yield_stress = ludwik.yield_stress,
                    .hardening = ludwik.strength,
                    .exponent_inverse = 1.0 / ludwik.exponent},
                   ludwik.largest_strain, ludwik.fits_both ? HollomonFit::both : HollomonFit::exponent);
  return {fitted.strength, fitted.exponent};
}

// --- the stress test

/// Draws strength and exponent of a power law, and the elastic constants that unloading needs.
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

ProgramBounds draw_similarity(Dice& dice, DrawnMaterial& drawn) {
  return draw_power_law(dice, drawn, k_similarity_options);
}

ProgramBounds draw_hardening(Dice& dice, DrawnMaterial& drawn) {
  return draw_power_law(dice, drawn, k_hardening_options);
}

ProgramBounds draw_semimech(Dice& dice, DrawnMaterial& drawn) {
  const bool is_enclosed = drawn.configuration != "simple";
  const double poisson_ratio = draw_poisson_ratio(dice, is_enclosed ? 0.4999 : 0.5);
  // The softest material that the law admits has E/((1 - nu^2) Y) = 22.0931; some scenes lie just above it.
  const double lambda = dice.happens(0.1) ? 22.0931 : dice.log_uniform(22.0931, 1e6);
  drawn.values = {{"youngs_modulus", lambda * (1.0 - poisson_ratio * poisson_ratio)},
                  {"poisson_ratio", poisson_ratio},
                  {"yield_stress", 1.0}};
  draw_choices(dice, k_semimech_options, drawn);
  return {.force = 2.0, .only_loads = !drawn.options.contains("unloading")};
}

/// Where a source has no law for a lateral contact, its columns are nan.
bool lateral_may_be_undefined(const CheckedRun& /*run*/, std::size_t /*row*/, string_view column) {
  return column.starts_with("lateral.");
}

}  // namespace

Law similarity_law(const ModelInput& input) {
  return make_similarity(input.material("hardening_exponent"), input.toggle("curvature_correction")
                                                                   ? SimilarityRadius::corrected
                                                                   : SimilarityRadius::parabolic);
}

Law hardening_law(const ModelInput& input) {
  return make_hardening(
      input.material("hardening_exponent"), configuration_of(input),
      input.word("minimum_condition") == "ideal" ? MinimumCondition::ideal : MinimumCondition::current);
}

Law semimech_law(const ModelInput& input) { return make_semimech(semimech_material(input), configuration_of(input)); }

Model similarity_model() noexcept {
  return Functions<similarity_law, strength>::of(
      {.name = "similarity",
       .summary = "rigid-plastic power-law contact by the similarity solution, contacts independent of each other",
       .references = k_similarity_references,
       .source = "Shahin (2021), section 2.2 and appendix B",
       .material = k_power_law_material,
       .options = k_similarity_options,
       .configurations = k_wall_configurations,
       .has_free_centre = true,
       .regimes = k_similarity_regimes,
       .events = k_similarity_events,
       .domain = k_similarity_domain,
       .objections = power_law_objections,
       .power_law_of = power_law_of,
       .draw = draw_similarity});
}

Model semimech_model() noexcept {
  return Functions<semimech_law, yield_stress>::of(
      {.name = "semimech",
       .summary = "elastic-ideally plastic particle by the semi-mechanistic law, from first touch to no pores left",
       .references = k_thesis,
       .source = "chapter 2; misprints corrected",
       .material = k_elastic_plastic_material,
       .options = k_semimech_options,
       .configurations = k_source_configurations,
       .regimes = k_semimech_regimes,
       .events = k_semimech_events,
       .domain = k_semimech_domain,
       .objections = semimech_objections,
       .draw = draw_semimech,
       .may_be_undefined = lateral_may_be_undefined});
}

Model hardening_model() noexcept {
  return Functions<hardening_law, strength>::of(
      {.name = "hardening",
       .summary = "rigid-plastic particle that hardens by a power law, by the semi-mechanistic law",
       .references = k_thesis,
       .source = "chapter 3; misprints corrected",
       .material = k_power_law_material,
       .options = k_hardening_options,
       .configurations = k_source_configurations,
       .regimes = k_hardening_regimes,
       .events = k_hardening_events,
       .domain = k_hardening_domain,
       .objections = power_law_objections,
       .power_law_of = power_law_of,
       .draw = draw_hardening,
       .may_be_undefined = lateral_may_be_undefined});
}

}  // namespace monograin::plastic
