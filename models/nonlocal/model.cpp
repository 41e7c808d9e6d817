#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "elastic/hertz.hpp"
#include "nonlocal/limit.hpp"
#include "nonlocal/system.hpp"
#include "stress_test/checks.hpp"
#include "stress_test/draw.hpp"
#include "system/continuum_material.hpp"
#include "system/model.hpp"
#include "system/resolution.hpp"

namespace monograin::nonlocal {
namespace {

using std::string_view;

constexpr std::array k_material{
    QuantityKey{"youngs_modulus", "Young's modulus", Dimension::stress, k_positive},
    QuantityKey{"poisson_ratio", "Poisson's ratio", Dimension::none, {.lower = 0.0, .upper = 0.5}, {}},
};

constexpr std::array<string_view, 5> k_terms{"4", "1", "2", "3", "inf"};
constexpr std::array<string_view, 4> k_radius_rules{"closed", "integral", "projected", "none"};
constexpr std::array<string_view, 2> k_influences{"half-space", "sphere"};

constexpr std::array k_options{
    OptionKey{"terms",
              "terms of the particle's profile in the local law; 1: Hertz, inf: the sphere itself (the "
              "workbench's own)",
              OptionKey::Kind::choice, k_terms},
    OptionKey{
        "contact_radius_rule",
        "contact radius in the deformed configuration: the source's closed form or its integral, the same with the "
        "displacement projected on the true radial direction (the workbench's own), or none",
        OptionKey::Kind::choice, k_radius_rules},
    OptionKey{
        "influence",
        "what a force does elsewhere on the surface: the source's half-space, or the sphere's exact solution without "
        "its logarithm (the workbench's own; for nearly incompressible material)",
        OptionKey::Kind::choice, k_influences},
};

constexpr std::array k_regimes{
    Term{"open", "the wall does not touch: no force"},
    Term{"elastic", "elastic contact"},
};

constexpr std::array k_events{
    Term{"contact-made", "a contact closes, also one that the surface is pushed against"},
    Term{"contact-lost", "a contact opens, also under growing load where close neighbours push the surface away"},
    Term{"impingement", "the circles of two contacts meet on the surface: circular contacts are no longer right"},
    Term{"stiffening", "the margin to the limit of applicability falls below 0.25 (warning)"},
    Term{"step-end", "end of a step of the program"},
    Term{"until-met", "a step ended early by its condition"},
    Term{"limit", "limit of applicability: the stiffness becomes infinite; or a wall at the centre of the particle"},
    Term{"radius-limit", "a contact is as wide as the particle"},
};

constexpr std::array k_references{&references::k_agarwal2018};

constexpr std::array<string_view, 8> k_domain{
    "up to the limit of applicability, where the margin is 0 (column margin; stop), well before it the source's "
    "formulation stiffens too much",
    "up to contacts as wide as the particle, with all terms but for 1e-6 (stop; not with contact_radius_rule none "
    "and 1 to 4 terms)",
    "walls at least 0.05 rad apart: the influence is that of a point force",
    "works best for nearly incompressible material, where errors of the half-space cancel: under hydrostatic "
    "compression the compliance is off by 1 % at nu = 0.48 and by -26 % at nu = 0.3",
    "more terms are no better everywhere: between two walls, against finite elements of rubber, four are better than "
    "one up to 0.36 R0 and worse beyond (force -15 against -3 % at 0.45 R0)",
    "the closed contact radius is off from its integral by a quarter of the correction at a = R0/2 and 90 degrees",
    "a force-controlled wall, also at zero force, follows the surface and closes a gap at once",
    "a free centre that only idle contacts keep from moving has no determined position, and their contacts no "
    "determined regime",
};

Formulation formulation_of(const ModelInput& input) {
  return {.poisson_ratio = input.material("poisson_ratio"),
          .terms = input.choice<Terms>(
              "terms",
              {{"4", Terms::four}, {"1", Terms::one}, {"2", Terms::two}, {"3", Terms::three}, {"inf", Terms::all}}),
          .influence = input.choice<Influence>("influence",
                                               {{"half-space", Influence::half_space}, {"sphere", Influence::sphere}})};
}

Centre centre_of(const ModelInput& input) { return input.centre_is_free ? Centre::free : Centre::fixed; }

std::unique_ptr<HybridSystem> bind(const ModelInput& input, std::vector<ContactClass> classes, const Reach& reach) {
  const auto radius_rule = input.choice<RadiusRule>("contact_radius_rule", {{"closed", RadiusRule::closed},
                                                                            {"integral", RadiusRule::integral},
                                                                            {"projected", RadiusRule::projected},
                                                                            {"none", RadiusRule::none}});
  const Settings settings{.model = formulation_of(input),
                          .radius_rule = radius_rule,
                          .initial_radius = input.radius,
                          .youngs_modulus = input.material("youngs_modulus"),
                          .centre = centre_of(input),
                          .reach = reach};
  return std::make_unique<System>(settings, std::move(classes));
}

/// Displacement over R0 of the first driven wall at the limit of applicability, if all walls go on as in their first
/// step. None if a wall is under force control, if none moves, or if the limit lies beyond the centre of the particle.
std::optional<double> limit_displacement(const ModelInput& input, const FirstStep& step) {
  double fastest = 0.0;  // [m] in the first step
  for (const Ramp& ramp : step.ramps) fastest = std::max(fastest, std::abs(ramp.rate()));
  std::vector<Ramp> ramps;
  std::optional<Ramp> driven;
  double end = k_infinity;  // where a wall reaches the centre
  for (const Ramp& ramp : step.ramps) {
    if (ramp.control == Control::force) return std::nullopt;
    // The fastest wall goes as far as R0 per step: the path is as long whatever the first step is.
    const double start = ramp.start / input.radius;
    const double speed = fastest > 0.0 ? ramp.rate() / fastest : 0.0;
    ramps.push_back({start, start + speed, Control::displacement});
    if (speed > 0.0) end = std::min(end, (1.0 - start) / speed);
    if (!driven && speed != 0.0) driven = ramps.back();
  }
  if (!driven || !std::isfinite(end)) return std::nullopt;
  Contacts contacts(formulation_of(input), step.classes, centre_of(input));
  std::vector<double> y(contacts.unknown_count(), 0.0);
  for (std::size_t c = 0; c < ramps.size(); ++c) y[c] = ramps[c].start;
  try {
    const auto xi = limit_of_step(contacts, ramps, end, y);
    return xi ? std::optional(driven->value(*xi)) : std::nullopt;
  } catch (const std::domain_error&) {
    return std::nullopt;  // a contact becomes as wide as the particle, or nothing holds the centre
  }
}

std::vector<DerivedParameter> parameters(const ModelInput& input, const FirstStep& step) {
  const double youngs_modulus = input.material("youngs_modulus");
  const double poisson_ratio = input.material("poisson_ratio");
  const double unit = 1.0 / (youngs_modulus * input.radius);
  return {
      {"youngs_modulus", youngs_modulus, "Pa"},
      {"poisson_ratio", poisson_ratio, "-"},
      {"composite_modulus", composite_modulus(youngs_modulus, poisson_ratio), "Pa", "E*"},
      {"compliance_opposite", half_space_influence(poisson_ratio, std::numbers::pi) * unit, "m/N", "1/n_NL(180)"},
      {"compliance_right_angle", half_space_influence(poisson_ratio, std::numbers::pi / 2) * unit, "m/N", "1/n_NL(90)"},
      {"limit_displacement", limit_displacement(input, step).value_or(k_nan) * input.radius, "m"}};
}

/// Displacement and force of a wall at which its contact, considered alone, meets a condition. Infinite if the contact
/// does not while it is narrower than the particle, or if the condition is an event.
Reach reach(const ModelInput& input, const Until& until) {
  const LocalLaw law(formulation_of(input).terms);
  const double radius = input.radius;
  const double modulus = composite_modulus(input.material("youngs_modulus"), input.material("poisson_ratio"));
  const double force_unit = modulus * radius * radius;
  double square = k_infinity;  // of the contact radius
  if (until.is_of(Quantity::force)) {
    if (until.value < force_unit * law.greatest_force()) square = law.signed_square_under(until.value / force_unit);
  } else if (until.is_of(Quantity::displacement)) {
    if (until.value < radius) square = law.signed_square(until.value / radius);
  } else if (until.is_of(Quantity::contact_radius)) {
    square = std::pow(until.value / radius, 2);
  } else if (until.is_of(Quantity::pressure)) {
    square = std::pow(0.75 * std::numbers::pi * until.value / modulus, 2);  // with one term; others raise it
  }
  if (!(square < 1.0)) return {.displacement = k_infinity, .force = k_infinity};
  const LocalContact contact = law.at(square);
  return {.displacement = contact.approach * radius, .force = contact.force * force_unit};
}

ProgramBounds draw(Dice& dice, DrawnMaterial& drawn) {
  drawn.values = {{"youngs_modulus", 1.0}, {"poisson_ratio", draw_poisson_ratio(dice, 0.5)}};
  draw_choices(dice, k_options, drawn);
  return {.deepest = 0.3, .force = 0.2};
}

/// The formulas of the deformed contact radius are undefined from where a contact is as wide as the particle.
bool may_be_undefined(const CheckedRun& run, std::size_t row, string_view column) {
  constexpr string_view k_deformed = "_deformed";
  if (!column.ends_with(k_deformed)) return false;
  const std::size_t radius = run.rows.column(column.substr(0, column.size() - k_deformed.size()));
  return run.rows.at(row, radius) >= run.input.radius * (1.0 - run.round_off);
}

}  // namespace

Model model() noexcept {
  return {.name = "nonlocal",
          .summary = "linear elastic sphere, of which every contact moves the surface under all others",
          .references = k_references,
          .source = "sections 2 to 4, appendix B",
          .material = k_material,
          .options = k_options,
          .configurations = k_wall_configurations,
          .has_free_centre = true,
          .has_profile = true,
          .regimes = k_regimes,
          .events = k_events,
          .domain = k_domain,
          .least_wall_angle = k_least_wall_angle,
          .moves_surface = true,
          .stops_when_pulled = true,
          .bind = bind,
          .parameters = parameters,
          .reach = reach,
          .is_elastic = [](const ModelInput&) { return true; },
          .draw = draw,
          .may_be_undefined = may_be_undefined,
          .continuum_material = continuum_material};
}

}  // namespace monograin::nonlocal
