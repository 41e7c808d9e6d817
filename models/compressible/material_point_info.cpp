#include "compressible/material_point_info.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>
#include <vector>

#include "compressible/presets.hpp"
#include "compressible/yield_surface.hpp"

namespace monograin::compressible {
namespace {

using std::string_view;

constexpr Range k_positive{.lower = 0.0, .lower_is_open = true};
constexpr Range k_not_negative{.lower = 0.0};
constexpr Range k_density{.lower = 0.0, .upper = 1.0, .lower_is_open = true, .upper_is_open = true};
constexpr Range k_poisson{.lower = -1.0, .upper = 0.5, .lower_is_open = true, .upper_is_open = true};

constexpr std::array<string_view, 5> k_configurations{"simple", "die", "hydrostatic", "triaxial", "strain-path"};
constexpr std::array<string_view, 3> k_yield_models{"vmdc", "dpc", "vm"};

constexpr std::array k_material_options{
    OptionKey{
        "yield_model",
        "von Mises double cap, Drucker-Prager cap, or von Mises (whose strength grows with the accumulated plastic "
        "strain)",
        OptionKey::Kind::choice, k_yield_models},
};

constexpr QuantityKey number(string_view name, string_view meaning, std::optional<double> default_value = 0.0) {
  return {name, meaning, Dimension::none, {}, default_value};
}

constexpr std::array k_material{
    QuantityKey{
        "yield_pressure", "hydrostatic yield pressure at the reference density", Dimension::stress, k_positive, {}},
    QuantityKey{"stiffness_ratio", "Young's modulus over the yield pressure", Dimension::none, k_positive, {}},
    QuantityKey{"shear_ratio", "greatest shear strength over the yield pressure", Dimension::none, k_positive, {}},
    QuantityKey{"tensile_ratio",
                "hydrostatic tensile strength over the yield pressure (vmdc, dpc)",
                Dimension::none,
                k_positive,
                {},
                true},
    QuantityKey{"nu0", "Poisson's ratio at the reference density", Dimension::none, {}, {}},
    QuantityKey{"eps0",
                "half-axis of the cap along p over that along q, at the reference density (vmdc, dpc)",
                Dimension::none,
                {},
                {},
                true},
    number("eta", "growth exponent of the yield pressure (vm: of the shear strength)"),
    number("xi", "growth exponent of Young's modulus"),
    number("zeta", "growth exponent of the shear strength (vmdc, dpc)"),
    number("omega", "growth exponent of the tensile strength (vmdc, dpc)"),
    number("xi1", "growth of Poisson's ratio, linear"),
    number("xi2", "growth of the cap's axis ratio, linear (vmdc, dpc)"),
    QuantityKey{"reference_density",
                "relative density at which the values above hold (vmdc, dpc)",
                Dimension::none,
                k_density,
                {},
                true},
    QuantityKey{"relative_density",
                "relative density at the start; not given: the reference density",
                Dimension::none,
                k_density,
                {},
                true},
    QuantityKey{"transition_width", "size of the arc between shear line and cap; 0: a corner (dpc)", Dimension::none,
                k_not_negative, 0.0},
};

constexpr std::array k_drives{
    DriveKey{"strain",
             "axial logarithmic strain, tension positive; [axial, lateral] on a strain path",
             Control::strain,
             Dimension::none,
             {},
             "-0.2",
             true,
             "strain_axial"},
    DriveKey{"stress",
             "axial stress, tension positive",
             Control::stress,
             Dimension::stress,
             {},
             "\"-10 MPa\"",
             false,
             "stress_axial"},
};
constexpr std::array k_lateral_drives{
    DriveKey{"lateral_strain",
             "lateral logarithmic strain (strain-path; not given: kept)",
             Control::strain,
             Dimension::none,
             {},
             "0.05"},
    DriveKey{"lateral_stress",
             "lateral stress (triaxial; not given: kept)",
             Control::stress,
             Dimension::stress,
             {},
             "\"-5 MPa\""},
};
constexpr std::array k_conditions{
    QuantityKey{"stress_axial", "axial stress, tension positive", Dimension::stress, {}, {}, true},
    QuantityKey{"stress_lateral", "lateral stress, tension positive", Dimension::stress, {}, {}, true},
    QuantityKey{"relative_density", "relative density without load", Dimension::none, k_density, {}, true},
};

constexpr std::array k_regimes{
    Term{"elastic", "inside the yield surface: no plastic strain"},
    Term{"plastic-tension", "yielding on the tensile cap: dilates (vmdc)"},
    Term{"plastic-shear", "yielding in shear: at constant volume (vm, vmdc), or dilating (dpc)"},
    Term{"plastic-transition", "yielding on the arc between shear line and cap: dilates (dpc)"},
    Term{"plastic-cap", "yielding on the compression cap: densifies (vmdc, dpc)"},
};

constexpr std::array k_events{
    Term{"yield", "the stress reaches the yield surface"},
    Term{"plastic-off", "a step of the program starts by unloading"},
    Term{"segment-change", "the stress passes from one segment of the yield surface to the next"},
    Term{"step-end", "end of a step of the program"},
    Term{"until-met", "a step ended early by its condition"},
    Term{"density-limit", "full density: no pores are left"},
    Term{"loss-of-uniqueness", "the program no longer determines the plastic strain (softening, or no more hardening)"},
    Term{"cap-centre-tensile", "the centre of the cap reaches zero pressure (pi3 = 0)"},
    Term{"cap-axis-nonpositive", "the linear law of the cap's axis ratio reaches zero"},
    Term{"poisson-half", "the linear law of Poisson's ratio reaches 1/2"},
    Term{"limit", "another end of the equations; the message says which"},
};

constexpr std::array<string_view, 9> k_domain{
    "tension is positive; strains are logarithmic, along fixed principal axes",
    "rate independent: the same curve whatever the durations",
    "vmdc, dpc: axis ratio eps, cap centre pi3 above zero, relative density below 1, Poisson's ratio below 1/2; events "
    "where a run reaches one of these, a fault where it starts beyond",
    "moduli up to 1e10 yield pressures: a run ends where they grow beyond (xi, xi1), because stresses are then what "
    "rounding leaves of the strains",
    "dpc: an arc (transition_width) that ends above the axis of pressure",
    "plastic loading ends at corners of the program only",
    "warned: dpc flow that is not associated does negative plastic work at low pressure",
    "integrator direct: vm, and hydrostatic loading; elsewhere the state depends on the way to it and is integrated",
    "stiff where the elastic strains are far smaller than those of the program (vmdc in tension, dpc in shear, "
    "stiffness_ratio above 1000): explicit integrators need thousands of steps there, cvode-bdf and ida do not",
};

// --- objections

std::string text_of(double value) {
  char buffer[32];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 6);
  return {buffer, end};
}

void check_needed(const ModelInput& given, std::vector<Objection>& found) {
  for (const char* key : {"tensile_ratio", "eps0", "reference_density"}) {
    if (given.material.contains(key)) continue;
    found.push_back({key, std::string("yield_model = \"") + given.choices.at("yield_model") + "\" needs " + key +
                              " in [material]; expected a value, or a preset that has it"});
  }
}

void check_program(const ModelInput& given, std::vector<Objection>& found) {
  const string_view configuration = given.configuration;
  const bool is_path = configuration == "strain-path";
  const bool is_triaxial = configuration == "triaxial";
  for (std::size_t i = 0; i < given.program.size(); ++i) {
    const PlannedStep& step = given.program[i];
    const auto object = [&](const std::string& message) {
      found.push_back({"steps", message + " configuration = \"" + std::string(configuration) + "\"", i});
    };
    if (is_path && step.first && step.first->control == Control::stress) {
      object("stress does not go with");
    }
    if (!step.lateral) continue;
    if (!is_path && !is_triaxial) {
      object("the lateral direction is not open to steps with");
    } else if (is_path && step.lateral->control == Control::stress) {
      object("lateral_stress does not go with");
    } else if (is_triaxial && step.lateral->control == Control::strain) {
      object("a lateral strain does not go with");
    }
  }
}

std::vector<Objection> objections(const ModelInput& given) {
  std::vector<Objection> found;
  const string_view yield_model = given.choices.at("yield_model");
  const double width = given.material.at("transition_width");
  if (yield_model != "dpc" && width != 0.0) {
    found.push_back({"transition_width", "transition_width goes with yield_model = \"dpc\" only"});
  }
  check_program(given, found);
  if (yield_model != "vm" && given.configuration != "hydrostatic" && given.integrator == "direct") {
    found.push_back({"integrator",
                     "integrator = \"direct\" goes with yield_model = \"vm\" or configuration = "
                     "\"hydrostatic\" only; expected auto, or one that integrates"});
  }
  if (yield_model != "vm") check_needed(given, found);
  return found.empty() ? start_objections(parameters_from(given.material, yield_model)) : found;
}

}  // namespace

std::vector<Objection> start_objections(const Parameters& m) {
  std::vector<Objection> found;
  const Properties at = properties_at(m, 0.0);
  const std::string where = is_compressible(m.model) ? " at relative_density = " + text_of(m.relative_density) : "";
  if (const double nu = at.poisson_ratio.value; !k_poisson.contains(nu)) {
    found.push_back({"nu0", "Poisson's ratio is " + text_of(nu) + where + "; expected above -1 and below 0.5"});
  }
  if (!is_compressible(m.model)) return found;
  if (const double eps = at.axis_ratio.value; !(eps > 0.0)) {
    std::string message = "the cap's axis ratio eps0 + xi2 (relative_density - reference_density) is " + text_of(eps) +
                          where + ", where its linear law does not hold; expected above 0";
    if (m.xi2 > 0.0) {
      message += ", that is a relative_density above " + text_of(m.reference_density - m.eps0 / m.xi2);
    }
    found.push_back({"relative_density", message});
    return found;
  }
  if (const double centre = at.cap_centre.value; !(centre > 0.0)) {
    found.push_back({"relative_density", "the cap's centre pi3 = sigma_y - eps Gamma is " + text_of(centre) +
                                             " yield pressures" + where +
                                             ", where the segments of the yield surface overlap; expected above 0"});
    return found;
  }
  if (m.model != YieldModel::dpc) return found;
  try {
    static_cast<void>(cap_constants(m, at));
  } catch (const std::domain_error& error) {
    found.push_back({"transition_width", std::string(error.what()) + where + "; expected a smaller one"});
  }
  return found;
}

Parameters parameters_from(const std::map<std::string, double>& material, std::string_view yield_model) {
  const auto value = [&](const char* key, double absent) {
    const auto found = material.find(key);
    return found == material.end() ? absent : found->second;
  };
  Parameters m;
  m.model = yield_model == "vm" ? YieldModel::vm : yield_model == "dpc" ? YieldModel::dpc : YieldModel::vmdc;
  m.stiffness_ratio = material.at("stiffness_ratio");
  m.nu0 = material.at("nu0");
  m.shear_ratio = material.at("shear_ratio");
  m.tensile_ratio = value("tensile_ratio", m.tensile_ratio);
  m.eps0 = value("eps0", m.eps0);
  m.eta = value("eta", 0.0);
  m.xi = value("xi", 0.0);
  m.zeta = value("zeta", 0.0);
  m.omega = value("omega", 0.0);
  m.xi1 = value("xi1", 0.0);
  m.xi2 = value("xi2", 0.0);
  m.reference_density = value("reference_density", value("relative_density", m.reference_density));
  m.relative_density = value("relative_density", m.reference_density);
  m.transition_width = value("transition_width", 0.0);
  return m;
}

ModelInfo material_point_info() noexcept {
  ModelInfo info{.name = "material-point",
                 .summary = "compressible plastic material under prescribed strains and stresses",
                 .source = "001_3cd85d3b0dc520cf.txt, sections 2 and 3 (Edmans and Sinka); Table 3 as corrected",
                 .material = k_material,
                 .options = {},
                 .configurations = k_configurations,
                 .regimes = k_regimes,
                 .events = k_events,
                 .domain = k_domain};
  info.material_options = k_material_options;
  info.presets = presets();
  info.objections = objections;
  info.drives = k_drives;
  info.lateral_drives = k_lateral_drives;
  info.conditions = k_conditions;
  info.sign = "tension positive";
  return info;
}

}  // namespace monograin::compressible
