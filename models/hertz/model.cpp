#include <array>
#include <cmath>
#include <numbers>

#include "contacts/model_of.hpp"
#include "elastic/hertz.hpp"
#include "hertz/law.hpp"
#include "stress_test/checks.hpp"
#include "stress_test/draw.hpp"
#include "system/continuum_material.hpp"
#include "system/lammps_law.hpp"
#include "system/model.hpp"
#include "system/number_text.hpp"
#include "system/resolution.hpp"

namespace monograin::hertz {
namespace {

using std::string_view;

constexpr std::array k_references{&references::k_hertz1882, &references::k_zunker2024};

constexpr std::array k_material{
    QuantityKey{"youngs_modulus", "Young's modulus", Dimension::stress, k_positive},
    QuantityKey{"poisson_ratio", "Poisson's ratio", Dimension::none, k_poisson_to_half},
};

constexpr std::array k_regimes{
    Term{"open", "the wall does not touch: no force"},
    Term{"elastic", "Hertz contact"},
};

constexpr std::array<string_view, 3> k_domain{
    "small contacts: contact radius well below the particle radius (no check)",
    "a wall stays at least 1e-3 R0 from the centre (stop)",
    "no friction, no adhesion, no yield",
};

double composite_modulus(const ModelInput& input) {
  return monograin::composite_modulus(input.material("youngs_modulus"), input.material("poisson_ratio"));
}

WallLaw law_of(const ModelInput& input) { return {composite_modulus(input)}; }

std::vector<DerivedParameter> parameters(const ModelInput& input, const FirstStep& /*step*/) {
  const double youngs_modulus = input.material("youngs_modulus");
  const double poisson_ratio = input.material("poisson_ratio");
  return {{"youngs_modulus", youngs_modulus, "Pa"},
          {"poisson_ratio", poisson_ratio, "-"},
          {"composite_modulus", composite_modulus(input), "Pa"},
          {"shear_modulus", youngs_modulus / (2.0 * (1.0 + poisson_ratio)), "Pa"},
          {"linear_compressibility", (1.0 - 2.0 * poisson_ratio) / youngs_modulus, "1/Pa", "1/(3 K)"}};
}

/// Displacement and force at which a contact meets a condition for the first time.
Reach reach(const ModelInput& input, const Until& until) {
  const double radius = input.radius;
  const WallLaw law = law_of(input);
  const double force_unit = law.unit_force(radius);
  double displacement = k_infinity;
  if (until.is_of(Quantity::force)) displacement = radius * law.displacement({}, until.value / force_unit);
  if (until.is_of(Quantity::displacement)) displacement = until.value;
  if (until.is_of(Quantity::contact_radius)) displacement = until.value * until.value / radius;
  if (until.is_of(Quantity::pressure))
    displacement = radius * std::pow(0.75 * std::numbers::pi * until.value / law.composite_modulus, 2);
  if (until.is_of(Quantity::force)) return {.displacement = displacement, .force = until.value};
  const double overlap = displacement / radius;  // beyond 1 there is no force: the wall has reached the centre before
  return {.displacement = displacement, .force = overlap < 1.0 ? force_unit * law.force({}, overlap) : k_infinity};
}

ProgramBounds draw(Dice& dice, DrawnMaterial& drawn) {
  drawn.values = {{"youngs_modulus", 1.0}, {"poisson_ratio", draw_poisson_ratio(dice, 0.5)}};
  if (dice.happens(0.05)) drawn.values["poisson_ratio"] = dice.one_of({-0.2, -0.99});
  return {.force = 0.3};
}

/// LAMMPS takes the material for both bodies, also against a wall. The force constant 4/3 E/(1 - nu^2) makes the wall
/// rigid.
LammpsLaw lammps_law(const ModelInput& input) {
  const std::string rest = " tangential linear_nohistory 0 0 damping velocity";
  const std::string youngs_modulus = number_text(input.material("youngs_modulus"));
  const std::string poisson_ratio = number_text(input.material("poisson_ratio"));
  return {.pair = "hertz/material " + youngs_modulus + " 0 " + poisson_ratio + rest,
          .wall = "hertz " + number_text(4.0 / 3.0 * composite_modulus(input)) + " 0" + rest};
}

/// Reports missed contacts: between elastic sphere and wall an overlap always has a force.
void check(const CheckedRun& run, std::vector<Violation>& found) {
  for (const ContactClass& c : run.classes) {
    const std::size_t overlap = run.rows.column(c.name + ".overlap");
    const std::size_t force = run.rows.column(c.name + ".force");
    check_rows(run, "missed-contact", c.name + ".overlap is past the surface, without a force", found,
               [&](std::size_t row) {
                 if (run.rows.at(row, force) != 0.0) return 0.0;
                 return run.rows.at(row, overlap) / run.input.radius - run.tolerance;
               });
  }
}

}  // namespace

Model model() noexcept {
  return contacts::model_of<law_of>({.name = "hertz",
                                     .summary = "elastic sphere between rigid walls, Hertz contacts at fixed radius",
                                     .references = k_references,
                                     .source = "Zunker and Kamrin (2024), eq. 25",
                                     .material = k_material,
                                     .options = {},
                                     .has_profile = true,
                                     .regimes = k_regimes,
                                     .domain = k_domain,
                                     .parameters = parameters,
                                     .reach = reach,
                                     .is_elastic = [](const ModelInput&) { return true; },
                                     .draw = draw,
                                     .check = check,
                                     .lammps_law = lammps_law,
                                     .continuum_material = continuum_material});
}

}  // namespace monograin::hertz
