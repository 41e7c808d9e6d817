#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "elastic/hertz.hpp"
#include "mdr/adhesion_map.hpp"
#include "mdr/system.hpp"
#include "stress_test/checks.hpp"
#include "stress_test/draw.hpp"
#include "system/continuum_material.hpp"
#include "system/lammps_law.hpp"
#include "system/model.hpp"
#include "system/number_text.hpp"
#include "system/resolution.hpp"

namespace monograin::mdr {
namespace {

using std::string_view;

constexpr std::array k_material{
    QuantityKey{"youngs_modulus", "Young's modulus", Dimension::stress, k_positive},
    QuantityKey{"poisson_ratio", "Poisson's ratio", Dimension::none, k_poisson_to_half},
    QuantityKey{"yield_stress", "uniaxial yield stress", Dimension::stress, k_positive},
    QuantityKey{"surface_energy", "work of adhesion of particle and wall", Dimension::surface_energy, k_not_negative,
                0.0},
};

/// Table of the model's own pressure curve, raised as by hardening.
std::string example_pressure_table() {
  std::vector<std::vector<double>> rows;
  for (int i = 0; i <= 60; ++i) {
    const double x = i / 60.0;
    rows.push_back({x, (1.0 + 1.75 * std::exp(-4.4 * x)) * (1.0 + 0.3 * x)});
  }
  return csv_text("delta_max_over_R,pressure_over_yield", rows);
}

constexpr std::array<string_view, 3> k_radius_rules{"yielded", "gated", "seed"};
constexpr std::array<string_view, 2> k_elastic_profiles{"ellipse", "parabola"};
constexpr std::array<string_view, 2> k_delta_max_rules{"running-maximum", "shifted"};

constexpr std::array k_options{
    OptionKey{"radius_rule", "which contacts make the apparent radius grow, and when", OptionKey::Kind::choice,
              k_radius_rules},
    OptionKey{"elastic_profile", "indenter of an elastic contact: the unified ellipse or Hertz's parabola",
              OptionKey::Kind::choice, k_elastic_profiles},
    OptionKey{"delta_max_rule", "whether the largest overlap of an unloaded contact moves with the apparent radius",
              OptionKey::Kind::choice, k_delta_max_rules},
    OptionKey{"strict", "stop where the contact caps intersect instead of warning", OptionKey::Kind::toggle},
    OptionKey{.name = "pressure_table",
              .meaning = "own curve of p_Y/Y over delta_max/R instead of 1 + 1.75 exp(-4.4 x): CSV, from 0 on",
              .kind = OptionKey::Kind::file,
              .example = example_pressure_table},
};

constexpr std::array k_regimes{
    Term{"open", "the wall does not touch an undented surface: no force"},
    Term{"elastic", "elastic contact, loading, unloading or reloading"},
    Term{"fully-plastic", "yielded contact at its largest overlap"},
    Term{"unloading", "yielded contact below its largest overlap, unloading or reloading elastically"},
    Term{"separated", "yielded contact that has opened over its dent: no force"},
    Term{"adhering", "adhesive contact below its largest load: its edge sticks, the contact radius stays"},
    Term{"peeling", "adhesive contact whose edge recedes in equilibrium between elastic and surface energy"},
};

constexpr std::array k_events{
    Term{"contact-made", "a wall comes to touch the particle"},
    Term{"contact-lost", "a wall leaves the particle, or its dent"},
    Term{"dent-touched", "a wall touches the bottom of its dent again"},
    Term{"yield", "an elastic contact becomes fully plastic"},
    Term{"load-reversal",
         "a contact at its largest overlap starts to unload at a corner of the program or of the growth"},
    Term{"retreat", "a contact at its largest overlap starts to unload in the middle of a step"},
    Term{"reload", "a contact passes its old maximum overlap"},
    Term{"stick", "the edge of an adhesive contact comes to rest as the load is reversed"},
    Term{"peel", "the springs at the edge of an adhesive contact tear, and the edge begins to recede"},
    Term{"follow", "no spring at the edge is stretched any more, and the edge advances with the load again"},
    Term{"pull-off", "the edge of an adhesive contact turns unstable and the contact opens at once"},
    Term{"force-extremum", "the force of an adhesive contact that pulls is greatest or least: nothing changes there"},
    Term{"growth-on", "the apparent radius starts to grow"},
    Term{"growth-off", "the apparent radius stops growing"},
    Term{"caps-intersect", "the caps of two contacts meet: the source's limit of validity (warning; stop if strict)"},
    Term{"step-end", "end of a step of the program"},
    Term{"until-met", "a step ended early by its condition"},
    Term{"singular-growth", "the free surface is used up: the apparent radius would grow without bound"},
    Term{"volume-limit", "elastic compression to half the volume"},
    Term{"limit", "another end of the equations' domain; the message says which"},
};

constexpr std::array k_references{&references::k_zunker2024, &references::k_zunker2024b};

constexpr std::array<string_view, 9> k_domain{
    "E/Y above about 10 (small elastic strains); a warning below",
    "a contact yields only where E/(1 - nu^2)/Y exceeds 2.407; a warning below",
    "contact caps do not intersect (event caps-intersect)",
    "with pressure_table: contacts at their largest overlap within the table; the run stops where it ends",
    "warned: adhesive contacts whose pull-off the convex indenter, without yielding in tension, does not predict well",
    "at yield under a prescribed force (ellipse) the wall gives way at once and takes the apparent radius along: at "
    "E/Y = 10 by 1.5e-4 R0 between two walls and 4.1e-4 R0 between six, less for stiffer particles",
    "under a prescribed force a plastic contact that has softened to 1 % of its first stiffness, at overlaps of nine "
    "tenths of the apparent radius, ends the run: at a given radius it bears no more than a largest force",
    "a mode in which every contact's branch agrees with its motion need not exist (several loaded walls while the "
    "radius grows): the run stops there",
    "warned: dissipation that falls by more than 1e-6 of the energy. radius_rule yielded, where plastic contacts alone "
    "make the radius grow, is the default because it creates none without adhesion for E/Y above 10 before the free "
    "surface nearly vanishes; gated and seed, which the source's curves are drawn with, create energy where elastic "
    "contacts grow (E/Y below 41 at nu = 0.3): at E/Y = 6.25 and up to 0.25 R0 0.14 of the largest energy between two "
    "walls, 0.42 between six",
};

std::shared_ptr<const PressureCurve> pressure_curve_of(const ModelInput& input) {
  const SampledCurve* samples = input.curve("pressure_table");
  return samples == nullptr ? nullptr : std::make_shared<const PressureCurve>(samples->x, samples->y);
}

Material material_of(const ModelInput& input) {
  return make_material(input.material("youngs_modulus"), input.material("poisson_ratio"),
                       input.material("yield_stress"), pressure_curve_of(input));
}

std::unique_ptr<HybridSystem> bind(const ModelInput& input, std::vector<ContactClass> classes, const Reach& reach) {
  Settings settings;
  settings.initial_radius = input.radius;
  settings.youngs_modulus = input.material("youngs_modulus");
  settings.poisson_ratio = input.material("poisson_ratio");
  settings.yield_stress = input.material("yield_stress");
  settings.surface_energy = input.material("surface_energy");
  settings.radius_rule = input.choice<RadiusRule>(
      "radius_rule", {{"gated", RadiusRule::gated}, {"yielded", RadiusRule::yielded}, {"seed", RadiusRule::seed}});
  settings.elastic_profile = input.choice<ElasticProfile>(
      "elastic_profile", {{"ellipse", ElasticProfile::ellipse}, {"parabola", ElasticProfile::parabola}});
  settings.delta_max_rule = input.choice<DeltaMaxRule>(
      "delta_max_rule", {{"running-maximum", DeltaMaxRule::running_maximum}, {"shifted", DeltaMaxRule::shifted}});
  settings.stops_at_cap_intersection = input.toggle("strict");
  settings.pressure_curve = pressure_curve_of(input);
  settings.centre_is_free = input.centre_is_free;
  settings.reach = reach;
  return std::make_unique<System>(settings, std::move(classes));
}

/// @throws std::invalid_argument with a pressure_table
ContinuumMaterial continuum_material(const ModelInput& input) {
  if (input.curve("pressure_table") != nullptr) {
    throw std::invalid_argument("pressure_table has no flow curve for finite elements; remove it");
  }
  ContinuumMaterial material = monograin::continuum_material(input);
  if (input.material("surface_energy") > 0.0) material.differences = {"finite elements leave out the adhesion"};
  return material;
}

/// The law of LAMMPS without its bulk response and damping.
/// @throws std::invalid_argument for options of which LAMMPS has only the default
LammpsLaw lammps_law(const ModelInput& input) {
  if (input.curve("pressure_table") != nullptr) {
    throw std::invalid_argument("LAMMPS has no pressure_table: its mdr hardens as p_Y/Y = 1 + 1.75 exp(-4.4 x)");
  }
  for (const auto& [option, only] :
       {std::pair{"radius_rule", "yielded"}, {"elastic_profile", "ellipse"}, {"delta_max_rule", "running-maximum"}}) {
    if (input.word(option) != only) {
      throw std::invalid_argument(std::string("LAMMPS computes mdr with ") + option + " = '" + only + "' only");
    }
  }
  if (input.material("poisson_ratio") < 0.0) {
    throw std::invalid_argument("LAMMPS takes no negative Poisson's ratio for mdr");
  }
  std::string law = "mdr";
  for (const char* key : {"youngs_modulus", "poisson_ratio", "yield_stress", "surface_energy"}) {
    law += " " + number_text(input.material(key));
  }
  law += " 0 0 tangential linear_nohistory 0 0 damping mdr 1";
  return {
      .pair = law,
      .wall = law,
      .differences = {
          "The sixth number, psi_b = 0, leaves out the bulk response of LAMMPS, as monograin does. Confined beds of "
          "particles need it: set psi_b there.",
          "LAMMPS multiplies the force of a wall by 1 + exp(10.7 d/R0 - 10), d = displacement relative to the "
          "centre: by 1.00005 at first touch, 1.003 at 0.4 R0, 1.01 at 0.5 R0.",
          "LAMMPS counts all contacts in the growth of the apparent radius, averages it over ten steps, lets it "
          "grow while other walls unload, fades it where little free surface is left, and bounds it by 1.5 R0.",
          "LAMMPS drops a contact and its dent once the wall no longer overlaps the apparent sphere.",
          "With adhesion, LAMMPS keeps the adhesive radius below 0.99 of the contact radius, and iterates to an "
          "absolute 1e-10 in its unit of length: for particles of micrometres units micro are better."}};
}

ProgramBounds draw(Dice& dice, DrawnMaterial& drawn) {
  const double modulus_over_yield = dice.log_uniform(2.0, 1e6);
  drawn.values = {{"youngs_modulus", 1.0},
                  {"poisson_ratio", draw_poisson_ratio(dice, 0.5)},
                  {"yield_stress", 1.0 / modulus_over_yield}};
  double surface_energy = 0.0;
  // The range reaches from negligible adhesion to far beyond the validity of the pull-off.
  if (dice.happens(0.5)) surface_energy = dice.log_uniform(1e-12, 1e-1);
  if (surface_energy > 0.0) drawn.values["surface_energy"] = surface_energy;
  draw_choices(dice, k_options, drawn);
  if (dice.happens(0.1)) drawn.options["pressure_table"] = example_file_name("pressure_table");
  return {.force = 3.0 / modulus_over_yield, .tension = 5.0 * surface_energy};
}

/// Upper bound of the fall of the apparent radius at yield, over R0. A contact of the ellipse bears more as soon as it
/// yields, so that n walls under a prescribed force give way by some dx, and their caps of overlap d become smaller by
/// pi d (2 - d) dx. A step of Newton's method on the volume balance, of slope 4 pi (1 - n d/2), gives the fall of the
/// radius; the walls give way by less as the radius falls.
double most_fall_at_yield(const CheckedRun& run) {
  if (run.input.word("elastic_profile") == "parabola") return 0.0;
  const Material law = material_of(run.input);
  const double d = law.yield_overlap_ratio;
  double count = 0.0;
  for (const ContactClass& c : run.classes) count += c.takes_force ? c.multiplicity() : 0;
  if (count == 0.0 || !std::isfinite(d)) return 0.0;
  const Contact before = elastic_contact(ElasticProfile::ellipse, law.composite_modulus, 1.0, d);
  const Contact after = plastic_contact(law, 1.0, d, yield_area_constant(d, 1.0));
  const double slope = 1.0 - 0.5 * count * d;
  if (!(after.by_overlap > 0.0 && slope > 0.0)) return k_infinity;
  return 0.25 * count * d * (2.0 - d) * (after.force - before.force) / (after.by_overlap * slope);
}

void check(const CheckedRun& run, std::vector<Violation>& found) {
  check_growth(run, "apparent_radius", (most_fall_at_yield(run) + run.tolerance) * run.input.radius, found);
}

std::vector<DerivedParameter> parameters(const ModelInput& input, const FirstStep& /*step*/) {
  const double youngs_modulus = input.material("youngs_modulus");
  const double poisson_ratio = input.material("poisson_ratio");
  const Material material = material_of(input);
  const double yield_stress = material.yield_stress;
  std::vector<DerivedParameter> list{{"youngs_modulus", youngs_modulus, "Pa"},
                                     {"poisson_ratio", poisson_ratio, "-"},
                                     {"composite_modulus", material.composite_modulus, "Pa"},
                                     {"shear_modulus", youngs_modulus / (2.0 * (1.0 + poisson_ratio)), "Pa"},
                                     {"linear_compressibility", material.linear_compressibility, "1/Pa", "1/(3 K)"}};
  list.push_back({"yield_stress", yield_stress, "Pa"});
  list.push_back({"modulus_over_yield", youngs_modulus / yield_stress, "-"});
  if (material.pressure_curve) list.push_back({"pressure_table_end", material.pressure_curve->end(), "-"});
  const double d_yield = material.yield_overlap_ratio;
  list.push_back({"yield_overlap_over_radius", d_yield, "-"});
  if (!std::isfinite(d_yield)) return list;
  const double overlap = d_yield * input.radius;
  const Contact contact = plastic_contact(material, input.radius, overlap, yield_area_constant(d_yield, input.radius));
  list.push_back({"yield_overlap", overlap, "m"});
  list.push_back({"yield_pressure", plastic_pressure(material, d_yield).pressure, "Pa"});
  list.push_back({"yield_contact_radius", contact.contact_radius, "m"});
  list.push_back({"yield_force", contact.force, "N"});
  return list;
}

/// Largest displacement and force of a contact that meets a condition for the first time, as estimated from the softer
/// of the elastic and the plastic law, which goes farther in and bears less. For a pressure or a contact radius the
/// displacement is that of the elastic law. Infinite where nothing is known.
Reach reach(const ModelInput& input, const Until& until) {
  const double radius = input.radius;
  const Material law = material_of(input);
  const double modulus = law.composite_modulus;
  const double circumference = 2.0 * std::numbers::pi * radius;
  const auto up_to_radius = [&](double contact_radius) { return contact_radius * contact_radius / radius; };
  Reach reach{.displacement = k_infinity, .force = k_infinity};
  if (until.is_of(Quantity::force)) {
    const double plastic = until.value / (circumference * law.yield_stress);
    const double elastic = elastic_overlap(ElasticProfile::parabola, modulus, radius, until.value);
    return {.displacement = std::max(elastic, plastic), .force = until.value};
  }
  if (until.is_of(Quantity::displacement)) reach.displacement = until.value;
  if (until.is_of(Quantity::contact_radius)) reach.displacement = up_to_radius(until.value);
  if (until.is_of(Quantity::pressure)) {
    const double elastic = up_to_radius(0.75 * std::numbers::pi * radius * until.value / modulus);
    if (elastic < law.yield_overlap_ratio * radius) reach.displacement = elastic;
  }
  if (until.event == "yield") reach.displacement = law.yield_overlap_ratio * radius;
  if (reach.displacement < radius) {
    const double plastic = plastic_pressure(law, 0.0).pressure * circumference * reach.displacement;
    reach.force = std::min(hertz_force(modulus, radius, reach.displacement), plastic);
  }
  return reach;
}

}  // namespace

Model model() noexcept {
  return {.name = "mdr",
          .summary = "elastic-perfectly plastic particle by dimensionality reduction, with growing apparent radius",
          .references = k_references,
          .source = "Part I; the bulk response of Part II is left out",
          .material = k_material,
          .options = k_options,
          .configurations = k_wall_configurations,
          .has_free_centre = true,
          .has_profile = true,
          .regimes = k_regimes,
          .events = k_events,
          .domain = k_domain,
          .bind = bind,
          .parameters = parameters,
          .reach = reach,
          .draw = draw,
          .check = check,
          .adhesion_map = &k_adhesion_map,
          .lammps_law = lammps_law,
          .continuum_material = continuum_material};
}

}  // namespace monograin::mdr
