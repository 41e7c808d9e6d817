#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "cel/system.hpp"
#include "elastic/hertz.hpp"
#include "stress_test/checks.hpp"
#include "stress_test/draw.hpp"
#include "system/continuum_material.hpp"
#include "system/model.hpp"
#include "system/resolution.hpp"

namespace monograin::cel {
namespace {

using std::string_view;

constexpr double k_least_wall_angle = 40.0 * std::numbers::pi / 180.0;

constexpr std::array k_material{
    QuantityKey{"youngs_modulus", "Young's modulus", Dimension::stress, k_positive},
    QuantityKey{"poisson_ratio", "Poisson's ratio", Dimension::none, {.lower = 0.0, .upper = 0.49}, {}},
    QuantityKey{"yield_stress", "uniaxial yield stress", Dimension::stress, k_positive},
};

constexpr std::array k_regimes{
    Term{"open", "the wall does not touch: no force"},
    Term{"elastic", "elastic contact on a fresh surface"},
    Term{"plastic", "the dent of the contact grows"},
    Term{"unloaded", "elastic contact on a dent, unloading or reloading"},
};

constexpr std::array k_events{
    Term{"contact-made", "a wall comes to touch the particle, or its dent"},
    Term{"contact-lost", "a wall leaves the particle, or its dent"},
    Term{"yield", "a contact begins to flow, for the first time or again"},
    Term{"load-reversal", "a contact stops flowing"},
    Term{"step-end", "end of a step of the program"},
    Term{"until-met", "a step ended early by its condition"},
    Term{"limit", "end of the equations' domain; the message says which"},
};

constexpr std::array k_references{&references::k_monograin, &references::k_agarwal2018};

constexpr std::array<string_view, 8> k_domain{
    "fitted to finite elements of E/Y 6.25 to 200; a warning outside",
    "fitted to two walls up to 0.5 R0, a closed die up to 0.47 R0 and six walls up to 0.19 R0; a warning beyond 0.5 R0",
    "axial forces within 1 to 7 % (rms) of finite elements, lateral forces of a die within 6 to 17 %; at worst: the "
    "end of a die beyond 0.44 R0 (+15 %), walls that come after others (15 %), unloading where pores have closed (25 "
    "%)",
    "walls at least 40 degrees apart: the influence of neighbours is that of a point force",
    "up to where the contacts cover 85 % of the surface (column coverage up to 1.7; stop)",
    "walls that balance each other, or a free centre: beside a fixed centre that walls push, contacts wider than half "
    "of R0 unload far too stiffly, and their stored energy is negative (a warning)",
    "up to where the stiffness becomes infinite (stop): for walls that balance each other at E/Y = 4 only, for others "
    "as soon as wide contacts unload",
    "no friction, no adhesion, no hardening",
};

std::unique_ptr<HybridSystem> bind(const ModelInput& input, std::vector<ContactClass> classes, const Reach& reach) {
  return std::make_unique<System>(input, std::move(classes), reach);
}

std::vector<DerivedParameter> parameters(const ModelInput& input, const FirstStep& /*step*/) {
  const double modulus = input.material("youngs_modulus");
  const Material material(input.material("yield_stress") / modulus, input.material("poisson_ratio"));
  const Dent fresh = dent_of(material, material.a_Y);
  const Contact at_yield = contact_at(material, fresh, 1.0, 1.0, material.a_Y * material.a_Y);
  auto list = material_parameters(input, {{"youngs_modulus", "Pa"}, {"poisson_ratio", "-"}, {"yield_stress", "Pa"}});
  list.push_back({"composite_modulus", material.Es * modulus, "Pa", "E*"});
  list.push_back({"modulus_over_yield", 1.0 / material.Y, "-"});
  list.push_back({"yield_contact_radius", material.a_Y * input.radius, "m", "a_Y"});
  list.push_back({"yield_force", at_yield.F * modulus * input.radius * input.radius, "N"});
  return list;
}

/// Upper estimate of displacement and force of a contact that first meets a condition: elastic, or at a mean pressure
/// of Y, which is below that of every contact that flows (1.29 Y).
Reach reach(const ModelInput& input, const Until& until) {
  const double radius = input.radius;
  const double modulus = composite_modulus(input.material("youngs_modulus"), input.material("poisson_ratio"));
  if (until.is_of(Quantity::force)) {
    const double elastic = radius * std::pow(0.75 * until.value / (modulus * radius * radius), 2.0 / 3.0);
    const double plastic = until.value / (2.0 * std::numbers::pi * radius * input.material("yield_stress"));
    return {.displacement = std::max(elastic, plastic), .force = until.value};
  }
  const double displacement = until.is_of(Quantity::displacement) ? until.value : k_infinity;
  const double force = displacement < radius ? hertz_force(modulus, radius, displacement) : k_infinity;
  return {.displacement = displacement, .force = force};
}

ProgramBounds draw(Dice& dice, DrawnMaterial& drawn) {
  const double modulus_over_yield = dice.log_uniform(6.25, 1e3);
  drawn.values = {{"youngs_modulus", 1.0},
                  {"poisson_ratio", draw_poisson_ratio(dice, 0.49)},
                  {"yield_stress", 1.0 / modulus_over_yield}};
  return {.deepest = 0.3, .force = 2.0 / modulus_over_yield};
}

/// Checks that the accumulated strain of the core never falls.
void check(const CheckedRun& run, std::vector<Violation>& found) {
  check_growth(run, "core_strain", run.tolerance, found);
}

}  // namespace

Model model() noexcept {
  return {.name = "cel",
          .summary = "elastic-plastic particle of coupled contacts on a core that yields, fitted to finite elements",
          .references = k_references,
          .source = "own law (docs/theory/cel.md)",
          .material = k_material,
          .configurations = k_wall_configurations,
          .has_free_centre = true,
          .regimes = k_regimes,
          .events = k_events,
          .domain = k_domain,
          .least_wall_angle = k_least_wall_angle,
          .moves_surface = true,
          .bind = bind,
          .parameters = parameters,
          .reach = reach,
          .draw = draw,
          .check = check,
          .continuum_material = continuum_material};
}

}  // namespace monograin::cel
