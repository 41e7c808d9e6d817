#include <array>
#include <numbers>
#include <optional>
#include <string>

#include "compressible/curve_fit.hpp"
#include "compressible/regressions.hpp"
#include "compressible/system.hpp"
#include "material-point/presets.hpp"
#include "stress_test/draw.hpp"
#include "system/curve_procedure.hpp"
#include "system/model.hpp"

namespace monograin::compressible {
namespace {

using std::string_view;

constexpr Range k_from_one{.lower = 1.0};
constexpr Range k_depth{.lower = 0.0, .upper = k_largest_displacement, .lower_is_open = true};

constexpr std::array k_material{
    QuantityKey{"stiffness_ratio", "Young's modulus over yield pressure, E0/sigma_y0", Dimension::none, k_positive},
    QuantityKey{"shear_ratio",
                "shear strength over yield pressure, Gamma0/sigma_y0; for the regressions and unloading_table only",
                Dimension::none,
                k_positive,
                {},
                true},
    QuantityKey{"tensile_ratio",
                "hydrostatic tensile strength over yield pressure, Lambda0/sigma_y0; the law does not depend on it",
                Dimension::none,
                k_positive,
                {},
                true},
    QuantityKey{"nu0", "Poisson's ratio at the reference density", Dimension::none, k_poisson_to_half},
    QuantityKey{"yield_pressure", "hydrostatic yield pressure sigma_y0 at the reference density", Dimension::stress,
                k_positive},
};

constexpr std::array k_columns{
    QuantityKey{"stiffness_over_shear", "E0/Gamma0", Dimension::none, k_positive},
    QuantityKey{"delta_max_over_R0", "largest displacement", Dimension::none, k_depth},
    QuantityKey{"alpha", "exponent of unloading", Dimension::none, k_from_one},
    QuantityKey{"beta", "secant stiffness over that of Hertz", Dimension::none, k_positive},
};

std::string example_unloading_table() {
  std::vector<std::vector<double>> rows;
  for (const double stiffness : {1.0, 50.0, 2000.0}) {
    for (const double depth : {0.01, 0.25, 0.5}) {
      rows.push_back({stiffness, depth, 1.5 + 0.001 * stiffness * depth, 1.0 + depth});
    }
  }
  return csv_text("stiffness_over_shear,delta_max_over_R0,alpha,beta", rows);
}

constexpr OptionKey number(string_view name, string_view meaning, Range range) {
  return {name, meaning, OptionKey::Kind::quantity, {}, false, Dimension::none, range};
}

constexpr std::array k_options{
    number("k", "slope of the linear part; from the regression unless given", k_positive),
    number("delta_t", "displacement over R0 at which the exponential part begins; from the regression unless given",
           k_positive),
    number("a", "exponent of the exponential part; from the regression unless given", k_positive),
    number("alpha", "exponent of unloading; 1.5 (Hertz) unless it or unloading_table is given", k_from_one),
    number("beta", "secant stiffness of unloading over that of Hertz; 1 unless it or unloading_table is given",
           k_positive),
    OptionKey{.name = "unloading_table",
              .meaning = "alpha and beta over E0/Gamma0 and the largest displacement: columns stiffness_over_shear, "
                         "delta_max_over_R0, alpha, beta",
              .kind = OptionKey::Kind::file,
              .columns = k_columns,
              .example = example_unloading_table},
};

constexpr std::array k_regimes{
    Term{"open", "the wall does not touch: no force"},
    Term{"linear", "first loading up to delta_t"},
    Term{"exponential", "first loading beyond delta_t"},
    Term{"unloading", "below the largest displacement so far, back or forth"},
};

constexpr std::array k_events{
    Term{"contact-made", "a wall comes to touch the particle, or the place at which it has left it"},
    Term{"contact-lost", "a wall leaves the particle at the displacement d0 of its unloading"},
    Term{"transition", "the linear part ends; the slope jumps"},
    Term{"load-reversal", "a contact at its largest displacement starts to unload"},
    Term{"reload", "a contact passes its old largest displacement, and the loading law goes on"},
    Term{"step-end", "end of a step of the program"},
    Term{"until-met", "a step ended early by its condition"},
    Term{"limit", "the law ends, at a displacement of 0.5 R0"},
};

constexpr std::array k_references{&references::k_edmans};

constexpr std::array<string_view, 8> k_domain{
    "displacement up to 0.5 R0, where the source's data end",
    "k, delta_t, a from the material: stiffness_ratio from 3 to 500, shear_ratio from 0.25 to 1; a warning below 4.5, "
    "where the source left delta_t and a unfitted; two printed coefficients are misprints and corrected",
    "every contact is independent of the others; a warning where more than two walls are loaded",
    "no contact radius, no pressure, no shape of the particle",
    "unloading: the source has no law for alpha and beta; a warning where Hertz's 1.5 and 1 stand in for them",
    "unloading ends at first touch or before: where beta would have it beyond, alpha stays and a warning counts it",
    "reloading: not in the source; elastic along the unloading curve",
    "warned: dissipation that falls by more than 1e-6 of the energy, where alpha, beta or a soft material make the "
    "unloading softer than the loading",
};

GivenLaw given_law(const ModelInput& input) { return {input.number("k"), input.number("delta_t"), input.number("a")}; }

std::vector<Objection> objections(const ModelInput& input) {
  const auto shear_ratio = input.optional_material("shear_ratio");
  std::vector<Objection> found =
      regression_objections(given_law(input), input.material("stiffness_ratio"), shear_ratio);
  if (input.word("unloading_table").empty()) return found;
  for (const char* key : {"alpha", "beta"}) {
    if (!input.number(key)) continue;
    found.push_back({key, std::string("key '") + key +
                              "' does not go with 'unloading_table', which stands for it; expected one of them"});
  }
  if (!shear_ratio) {
    found.push_back({"unloading_table",
                     "unloading_table is over E0/Gamma0; expected shear_ratio in [material], or alpha and beta"});
  }
  return found;
}

UnloadingRule tabulated_rule(const SampledCurve& table, double stiffness_over_shear) {
  std::vector<UnloadingRow> rows;
  for (std::size_t k = 0; k < table.x.size(); ++k) {
    rows.push_back({table.x[k], {table.y[k], {table.values[0][k], table.values[1][k]}}});
  }
  return interpolated_rule(rows, stiffness_over_shear);
}

/// @throws std::invalid_argument for a material that the source has no law for
Settings settings_of(const ModelInput& input) {
  const double stiffness_ratio = input.material("stiffness_ratio");
  const auto shear_ratio = input.optional_material("shear_ratio");
  const GivenLaw given = given_law(input);
  Settings settings{.law = loading_law_of(given, stiffness_ratio, shear_ratio),
                    .hertz_stiffness = hertz_stiffness(stiffness_ratio, input.material("nu0")),
                    .yield_pressure = input.material("yield_pressure")};
  if (is_extrapolated(given, stiffness_ratio)) {
    settings.reservations.push_back({"softer than the materials that delta_t and a were fitted to, from 4.5 on",
                                     "stiffness_ratio", stiffness_ratio});
  }
  if (const SampledCurve* table = input.curve("unloading_table")) {
    settings.unloading = tabulated_rule(*table, stiffness_ratio / *shear_ratio);
    return settings;
  }
  const UnloadingShape hertz;
  const auto alpha = input.number("alpha");
  const auto beta = input.number("beta");
  settings.unloading =
      UnloadingRule(UnloadingShape{alpha.value_or(hertz.exponent), beta.value_or(hertz.stiffness_ratio)});
  if (!alpha) {
    settings.reservations.push_back(
        {"the source has no law for alpha, and it is not given; Hertz's stands in", "alpha", hertz.exponent});
  }
  if (!beta) {
    settings.reservations.push_back(
        {"the source has no law for beta, and it is not given; Hertz's stands in", "beta", hertz.stiffness_ratio});
  }
  return settings;
}

std::unique_ptr<HybridSystem> bind(const ModelInput& input, std::vector<ContactClass> classes, const Reach& reach) {
  return std::make_unique<System>(WallLaw(settings_of(input)),
                                  contacts::Settings{input.radius, reach, input.centre_is_free}, std::move(classes));
}

/// pi R0^2 sigma_y0 [N].
double force_unit(const ModelInput& input) {
  return std::numbers::pi * input.radius * input.radius * input.material("yield_pressure");
}

std::vector<DerivedParameter> parameters(const ModelInput& input, const FirstStep& /*step*/) {
  std::vector<DerivedParameter> list = material_parameters(
      input,
      {{"stiffness_ratio", "-"}, {"shear_ratio", "-"}, {"tensile_ratio", "-"}, {"nu0", "-"}, {"yield_pressure", "Pa"}});
  const auto [law, hertz_stiffness, unloading, yield_pressure, reservations] = settings_of(input);
  const double transition_force = law.stiffness * law.transition;
  list.push_back({"k", law.stiffness, "-", "k"});
  list.push_back({"delta_t", law.transition, "-", "delta_t"});
  list.push_back({"a", law.exponent, "-", "a"});
  list.push_back({"transition_force", transition_force, "-", "k delta_t"});
  list.push_back({"slope_after_transition", law.exponent * transition_force, "-", "a k delta_t"});
  list.push_back({"largest_force", loading_force(law, k_largest_displacement), "-", "f(0.5)"});
  list.push_back({"hertz_stiffness", hertz_stiffness, "-", "k_H"});
  list.push_back({"force_unit", force_unit(input), "N", "pi R0^2 sigma_y0"});
  // Unloading from the end of the law. From smaller displacements, alpha and beta may follow from a table.
  const UnloadingCurve curve = unloading_from(law, hertz_stiffness, unloading, k_largest_displacement);
  const UnloadingShape shape = unloading.at(k_largest_displacement);
  list.push_back({"unloading_exponent", shape.exponent, "-", "alpha at 0.5"});
  list.push_back({"unloading_stiffness_ratio", shape.stiffness_ratio, "-", "beta at 0.5"});
  list.push_back({"separation", curve.separation(), "-", "d0 from 0.5"});
  return list;
}

ProgramBounds draw(Dice& dice, DrawnMaterial& drawn) {
  drawn.values = {{"stiffness_ratio", dice.log_uniform(3.0, 500.0)},
                  {"shear_ratio", dice.uniform(0.25, 1.0)},
                  {"nu0", draw_poisson_ratio(dice, 0.5)},
                  {"yield_pressure", 1.0}};
  if (dice.happens(0.3)) {
    drawn.options["k"] = dice.log_uniform(1e-2, 1e2);
    drawn.options["delta_t"] = dice.log_uniform(1e-6, 1.0);
    drawn.options["a"] = dice.log_uniform(1e-3, 1e1);
    drawn.values["stiffness_ratio"] = dice.log_uniform(1e-1, 1e6);
  }
  if (dice.happens(0.2)) {
    drawn.options["unloading_table"] = example_file_name("unloading_table");
  } else if (dice.happens(0.5)) {
    drawn.options["alpha"] = dice.happens(0.2) ? 1.0 : dice.uniform(1.0, 5.0);
    drawn.options["beta"] = dice.log_uniform(1e-2, 1e2);
  }
  return {.force = 2.0};
}

// --- the source's procedure of fitting k, delta_t and a to the first loading

constexpr std::array<string_view, 3> k_fitted_keys{"compressible.k", "compressible.delta_t", "compressible.a"};
constexpr std::array<string_view, 1> k_fixed_keys{"material.yield_pressure"};

ProcedureFit reported(std::string procedure, const LoadingFit& fit) {
  return {std::move(procedure),
          {fit.law.stiffness, fit.law.transition, fit.law.exponent},
          fit.errors.area,
          fit.errors.peak};
}

std::vector<ProcedureFit> fit(const ForceCurve& loading) {
  const auto nested = fit_nested(loading.displacement, loading.force);
  if (!nested) return {};
  return {reported("nested", *nested), reported("joint", fit_jointly(loading.displacement, loading.force, *nested))};
}

ProcedureFit measure(const ForceCurve& loading, std::span<const double> parameters) {
  const LoadingLaw law{parameters[0], parameters[1], parameters[2]};
  return reported("this fit", {law, fit_errors(law, loading.displacement, loading.force)});
}

std::map<std::string, double> unloading_starts(const ModelInput& input, const ForceCurve& unloading) {
  const double stiffness = hertz_stiffness(input.material("stiffness_ratio"), input.material("nu0"));
  const auto fit = fit_unloading(unloading.displacement, unloading.force, stiffness);
  if (!fit) return {};
  return {{"compressible.alpha", fit->shape.exponent}, {"compressible.beta", fit->shape.stiffness_ratio}};
}

constexpr CurveProcedure k_procedure{.keys = k_fitted_keys,
                                     .fixed_keys = k_fixed_keys,
                                     .force_unit = force_unit,
                                     .fit = fit,
                                     .measure = measure,
                                     .unloading_starts = unloading_starts};

}  // namespace

Model model() noexcept {
  return {.name = "compressible",
          .summary = "compressible plastic particle: force linear, then exponential; power-law unloading",
          .references = k_references,
          .source = "section 6 and appendix A; a1 of eq. A.1 and a6 of eq. A.2 corrected",
          .material = k_material,
          .options = k_options,
          .configurations = k_wall_configurations,
          .has_free_centre = true,
          .has_contact_area = false,
          .regimes = k_regimes,
          .events = k_events,
          .domain = k_domain,
          .presets = material_point::presets(),
          .has_pores = true,
          .objections = objections,
          .bind = bind,
          .parameters = parameters,
          .draw = draw,
          .curve_procedure = &k_procedure};
}

}  // namespace monograin::compressible
