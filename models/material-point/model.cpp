#include "material-point/model.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>
#include <vector>

#include "material-point/presets.hpp"
#include "material-point/stress_test.hpp"
#include "material-point/system.hpp"
#include "material-point/yield_surface.hpp"
#include "system/number_text.hpp"

namespace monograin::material_point {
namespace {

using std::string_view;

constexpr std::array k_references{&references::k_edmans};

constexpr Range k_density{.lower = 0.0, .upper = 1.0, .lower_is_open = true, .upper_is_open = true};

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
    QuantityKey{"stiffness_ratio", "Young's modulus over the yield pressure", Dimension::none, k_positive},
    QuantityKey{"shear_ratio", "greatest shear strength over the yield pressure", Dimension::none, k_positive},
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
                "relative density at the start; not given: the reference density (vmdc, dpc)",
                Dimension::none,
                k_density,
                {},
                true},
    QuantityKey{"transition_width", "size of the arc between shear line and cap; 0: a corner (dpc)", Dimension::none,
                k_not_negative, 0.0},
};

constexpr Range k_strains{.lower = -10.0, .upper = 10.0};  // [-]; larger ones are probably percent

constexpr std::array k_drives{
    DriveKey{"strain", "axial logarithmic strain, tension positive; [axial, lateral] on a strain path", Control::strain,
             Dimension::none, k_strains, "-0.2", true, "strain_axial"},
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
    DriveKey{"lateral_strain", "lateral logarithmic strain (strain-path; not given: kept)", Control::strain,
             Dimension::none, k_strains, "0.05", false, "strain_lateral"},
    DriveKey{"lateral_stress",
             "lateral stress (triaxial; not given: kept)",
             Control::stress,
             Dimension::stress,
             {},
             "\"-5 MPa\"",
             false,
             "stress_lateral"},
};
constexpr std::array k_conditions{
    QuantityKey{"stress_axial", "axial stress, tension positive", Dimension::stress, {}, {}, true},
    QuantityKey{"stress_lateral", "lateral stress, tension positive", Dimension::stress, {}, {}, true},
    QuantityKey{"relative_density",
                "relative density without load (vmdc, dpc; vm has none and never meets it)",
                Dimension::none,
                k_density,
                {},
                true},
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

constexpr std::array<string_view, 10> k_domain{
    "tension is positive; strains are logarithmic, along fixed principal axes",
    "rate independent: the same curve whatever the durations",
    "vmdc, dpc: axis ratio eps, cap centre pi3 above zero, relative density below 1, Poisson's ratio below 1/2; events "
    "where a run reaches one of these, a fault where it starts beyond",
    "vm has no density: its column relative_density is nan",
    "moduli up to 1e10 yield pressures: a run ends where they grow beyond (xi, xi1), because stresses are then lost in "
    "the round-off of the strains",
    "dpc: an arc (transition_width) that ends above the axis of pressure",
    "plastic loading ends at corners of the program only",
    "warned: dpc flow that is not associated does negative plastic work at low pressure; a soft vmdc or dpc that "
    "stiffens, and a vm whose moduli grow under pressure, create energy",
    "integrator direct: vm, and hydrostatic loading; elsewhere the state depends on the path to it and is integrated",
    "stiff where the elastic strains are far smaller than those of the program (vmdc in tension, dpc in shear, "
    "stiffness_ratio above 1000): explicit integrators need thousands of steps there, cvode-bdf and ida do not",
};

// --- objections

std::string text_of(double value) { return number_text(value, 6); }

void check_needed(const ModelInput& input, std::vector<Objection>& found) {
  for (const char* key : {"tensile_ratio", "eps0", "reference_density"}) {
    if (input.optional_material(key)) continue;
    found.push_back({key, std::string("yield_model = \"") + input.word("yield_model") + "\" needs " + key +
                              " in [material]; expected a value, or a preset that has it"});
  }
}

void check_program(const ModelInput& input, std::vector<Objection>& found) {
  const string_view configuration = input.configuration;
  const bool is_path = configuration == "strain-path";
  const bool is_triaxial = configuration == "triaxial";
  for (std::size_t i = 0; i < input.program.size(); ++i) {
    const PlannedStep& step = input.program[i];
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

std::vector<Objection> objections(const ModelInput& input) {
  std::vector<Objection> found;
  const string_view yield_model = input.word("yield_model");
  const double width = input.material("transition_width");
  if (yield_model != "dpc" && width != 0.0) {
    found.push_back({"transition_width", "transition_width goes with yield_model = \"dpc\" only"});
  }
  check_program(input, found);
  if (yield_model != "vm" && input.configuration != "hydrostatic" && input.integrator == "direct") {
    found.push_back({"integrator",
                     "integrator = \"direct\" goes with yield_model = \"vm\" or configuration = "
                     "\"hydrostatic\" only; expected auto, or one that integrates"});
  }
  if (yield_model != "vm") check_needed(input, found);
  return found.empty() ? start_objections(parameters_of(input)) : found;
}

/// Greatest and least strain or stress that the program prescribes; both zero if there is none.
std::pair<double, double> prescribed_range(const std::vector<PlannedStep>& program) {
  std::pair<double, double> range;
  for (const PlannedStep& step : program) {
    for (const auto& part : {step.first, step.lateral}) {
      if (part) range = {std::max(range.first, part->target), std::min(range.second, part->target)};
    }
  }
  return range;
}

std::vector<std::string> reservations(const ModelInput& input) {
  std::vector<std::string> found;
  const bool is_vm = input.word("yield_model") == "vm";
  const auto grows = [&](const char* key) { return input.material(key) != 0.0; };
  if (is_vm && input.optional_material("reference_density") && (grows("eta") || grows("xi") || grows("xi1"))) {
    found.emplace_back(
        "von Mises plasticity has no density: the moduli and the strength begin as they are given, and eta, xi, xi1 "
        "are growth per plastic shear strain; those of a preset are growth per relative density");
  }
  const auto [greatest, least] = prescribed_range(input.program);
  if (!is_vm && greatest > 0.0 && least == 0.0) {
    found.emplace_back("the program only stretches the material: tension is positive, compression negative");
  }
  return found;
}

/// @throws std::invalid_argument where the material has no meaning at the start: a fit tries such numbers too
std::unique_ptr<HybridSystem> bind(const ModelInput& input, std::vector<ContactClass> /*classes*/,
                                   const Reach& /*reach*/) {
  const Parameters m = parameters_of(input);
  const std::vector<Objection> found = start_objections(m);
  if (!found.empty()) throw std::invalid_argument(found.front().message);
  return std::make_unique<System>(System::Settings{.parameters = m,
                                                   .yield_pressure = input.material("yield_pressure"),
                                                   .is_hydrostatic = input.configuration == "hydrostatic"});
}

std::vector<RestingChannel> channels(const ModelInput& input) {
  std::vector<RestingChannel> list{
      {.name = "axial", .at_rest = {0.0, 0.0, Control::strain}, .is_unloaded_at_rest = true}};
  if (input.configuration == "hydrostatic") return list;
  const bool is_free = input.configuration == "simple" || input.configuration == "triaxial";
  list.push_back({.name = "lateral",
                  .at_rest = {0.0, 0.0, is_free ? Control::stress : Control::strain},
                  .is_lateral = true,
                  .is_unloaded_at_rest = true});
  return list;
}

/// Constants of the material where it starts.
std::vector<DerivedParameter> parameters(const ModelInput& input, const FirstStep& /*step*/) {
  const Parameters m = parameters_of(input);
  const double unit = input.material("yield_pressure");
  const Properties at = properties_at(m, 0.0);
  std::vector<DerivedParameter> list{{"yield_pressure", unit, "Pa", "sigma_y0"},
                                     {"youngs_modulus", unit * at.youngs_modulus.value, "Pa", "E"},
                                     {"poisson_ratio", at.poisson_ratio.value, "-", "nu"},
                                     {"bulk_modulus", unit * at.bulk_modulus.value, "Pa", "K"},
                                     {"shear_modulus", unit * at.shear_modulus.value, "Pa", "G"},
                                     {"shear_strength", unit * at.shear_strength.value, "Pa", "Gamma"}};
  if (!is_compressible(m.model)) return list;
  list.push_back({"relative_density", at.relative_density, "-", "rho"});
  list.push_back({"hydrostatic_strength", unit * at.yield_pressure.value, "Pa", "sigma_y"});
  list.push_back({"tensile_strength", unit * at.tensile_strength.value, "Pa", "Lambda"});
  list.push_back({"axis_ratio", at.axis_ratio.value, "-", "eps"});
  list.push_back({"cap_centre", unit * at.cap_centre.value, "Pa", "pi3"});
  if (m.model != YieldModel::dpc) return list;
  const CapConstants cap = cap_constants(m, at);
  list.push_back({"friction_slope", cap.friction_slope.value, "-", "tan pi6"});
  list.push_back({"cohesion", unit * cap.cohesion.value, "Pa", "pi5"});
  list.push_back({"arc_radius", unit * cap.arc_radius.value, "Pa", "pi8 C"});
  list.push_back({"arc_centre", unit * cap.arc_centre.value, "Pa", "(1 - A) C"});
  list.push_back({"flow_stretch", cap.flow_stretch.value, "-", "B"});
  list.push_back({"transition_start", unit * cap.transition_start.value, "Pa", "p_i"});
  return list;
}

}  // namespace

std::vector<Objection> start_objections(const Parameters& m) {
  std::vector<Objection> found;
  const Properties at = properties_at(m, 0.0);
  const std::string where = is_compressible(m.model) ? " at relative_density = " + text_of(m.relative_density) : "";
  if (const double nu = at.poisson_ratio.value; !k_poisson_below_half.contains(nu)) {
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

Parameters parameters_of(const ModelInput& input) {
  const auto value = [&](const char* key, double absent) { return input.optional_material(key).value_or(absent); };
  const string_view yield_model = input.word("yield_model");
  Parameters m;
  m.model = yield_model == "vm" ? YieldModel::vm : yield_model == "dpc" ? YieldModel::dpc : YieldModel::vmdc;
  m.stiffness_ratio = input.material("stiffness_ratio");
  m.nu0 = input.material("nu0");
  m.shear_ratio = input.material("shear_ratio");
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

Model model() noexcept {
  return {.name = "material-point",
          .summary = "compressible plastic material under prescribed strains and stresses",
          .references = k_references,
          .source = "sections 2 and 3; Table 3 corrected",
          .material = k_material,
          .configurations = k_configurations,
          .regimes = k_regimes,
          .events = k_events,
          .domain = k_domain,
          .material_options = k_material_options,
          .presets = presets(),
          .sign = "tension positive",
          .drives = k_drives,
          .lateral_drives = k_lateral_drives,
          .conditions = k_conditions,
          .objections = objections,
          .reservations = reservations,
          .bind = bind,
          .channels = channels,
          .parameters = parameters,
          .draw = draw,
          .draw_program = draw_program,
          .check = check,
          .may_be_undefined = [](const CheckedRun& run, std::size_t /*row*/, string_view column) {
            return column == "relative_density" && run.input.word("yield_model") == "vm";
          }};
}

}  // namespace monograin::material_point
