#include "study/stress_materials.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace monograin {
namespace {

double draw_poisson_ratio(Dice& dice, double upper) {
  const double ordinary = dice.uniform(0.0, 0.49);
  const double odd = dice.one_of({0.0, 0.2, 0.3, 0.49, 0.4999, upper});
  return std::min(dice.happens(0.5) ? ordinary : odd, upper);
}

/// A word of an option, where it is not the default.
void draw_choices(Dice& dice, StressScene& scene) {
  for (const OptionKey& option : scene.model->options) {
    if (option.kind == OptionKey::Kind::choice) {
      const std::size_t which = dice.below(option.choices.size());
      if (which > 0) scene.options[std::string(option.name)] = std::string(option.choices[which]);
    } else if (option.kind == OptionKey::Kind::toggle && dice.happens(0.25)) {
      scene.options[std::string(option.name)] = !option.default_toggle;
    }
  }
}

StressBounds draw_hertz(Dice& dice, StressScene& scene) {
  scene.material = {{"youngs_modulus", 1.0}, {"poisson_ratio", draw_poisson_ratio(dice, 0.5)}};
  if (dice.happens(0.05)) scene.material["poisson_ratio"] = dice.one_of({-0.2, -0.99});
  return {.force = 0.3};
}

StressBounds draw_mdr(Dice& dice, StressScene& scene) {
  const double modulus_over_yield = dice.log_uniform(2.0, 1e6);
  scene.material = {{"youngs_modulus", 1.0},
                    {"poisson_ratio", draw_poisson_ratio(dice, 0.5)},
                    {"yield_stress", 1.0 / modulus_over_yield}};
  double surface_energy = 0.0;
  // From next to nothing to far beyond where the pull-off is predicted well.
  if (dice.happens(0.5)) surface_energy = dice.log_uniform(1e-12, 1e-1);
  if (surface_energy > 0.0) scene.material["surface_energy"] = surface_energy;
  draw_choices(dice, scene);
  if (dice.happens(0.1)) scene.options["pressure_table"] = std::string(k_stress_pressure_table);
  return {.force = 3.0 / modulus_over_yield, .tension = 5.0 * surface_energy};
}

/// Strength and exponent of a power law, and the elastic constants that unloading needs.
StressBounds draw_power_law(Dice& dice, StressScene& scene) {
  const double exponent = dice.uniform(0.0, 1.0);
  scene.material = {{"strength", 1.0}, {"hardening_exponent", dice.happens(0.7) ? exponent : std::round(exponent)}};
  draw_choices(dice, scene);
  const bool unloads = scene.options.contains("unloading");
  if (unloads) {
    scene.material["youngs_modulus"] = dice.log_uniform(2.0, 1e6);
    scene.material["poisson_ratio"] = draw_poisson_ratio(dice, 0.5);
  }
  return {.force = 2.0, .only_loads = !unloads};
}

StressBounds draw_semimech(Dice& dice, StressScene& scene) {
  const bool is_enclosed = scene.configuration != "simple";
  const double poisson_ratio = draw_poisson_ratio(dice, is_enclosed ? 0.4999 : 0.5);
  // From the softest that the law has, E/((1 - nu^2) Y) = 22.0931, just above it in some scenes.
  const double lambda = dice.happens(0.1) ? 22.0931 : dice.log_uniform(22.0931, 1e6);
  scene.material = {{"youngs_modulus", lambda * (1.0 - poisson_ratio * poisson_ratio)},
                    {"poisson_ratio", poisson_ratio},
                    {"yield_stress", 1.0}};
  draw_choices(dice, scene);
  return {.force = 2.0, .only_loads = !scene.options.contains("unloading")};
}

StressBounds draw_nonlocal(Dice& dice, StressScene& scene) {
  scene.material = {{"youngs_modulus", 1.0}, {"poisson_ratio", draw_poisson_ratio(dice, 0.5)}};
  draw_choices(dice, scene);
  return {.deepest = 0.3, .force = 0.2};
}

StressBounds draw_compressible(Dice& dice, StressScene& scene) {
  scene.material = {{"stiffness_ratio", dice.log_uniform(3.0, 500.0)},
                    {"shear_ratio", dice.uniform(0.25, 1.0)},
                    {"nu0", draw_poisson_ratio(dice, 0.5)},
                    {"yield_pressure", 1.0}};
  if (dice.happens(0.3)) {
    scene.options["k"] = dice.log_uniform(1e-2, 1e2);
    scene.options["delta_t"] = dice.log_uniform(1e-6, 1.0);
    scene.options["a"] = dice.log_uniform(1e-3, 1e1);
    scene.material["stiffness_ratio"] = dice.log_uniform(1e-1, 1e6);
  }
  if (dice.happens(0.2)) {
    scene.options["unloading_table"] = std::string(k_stress_unloading_table);
  } else if (dice.happens(0.5)) {
    scene.options["alpha"] = dice.happens(0.2) ? 1.0 : dice.uniform(1.0, 5.0);
    scene.options["beta"] = dice.log_uniform(1e-2, 1e2);
  }
  return {.force = 2.0};
}

/// From the published set outwards. Not every set is admissible: the generator draws again.
StressBounds draw_packing(Dice& dice, StressScene& scene) {
  const bool is_plastic = dice.happens(0.5);
  scene.material = {{"youngs_modulus", 1.0}, {"poisson_ratio", draw_poisson_ratio(dice, 0.4999)}};
  if (is_plastic) {
    scene.material["yield_stress"] = 1.0 / dice.log_uniform(2.0, 1e6);
    scene.material["hardening_modulus"] = dice.happens(0.2) ? 0.0 : dice.log_uniform(1e-6, 10.0);
  }
  draw_choices(dice, scene);
  const auto maybe = [&](const char* key, double value) {
    if (dice.happens(0.5)) scene.options[key] = value;
  };
  const double stretch = dice.log_uniform(0.05, 5.0);
  if (dice.happens(0.5)) {
    scene.options["f_E"] = stretch;
    scene.options["f_G"] = dice.happens(0.2) ? stretch : dice.uniform(0.01, 1.0) * stretch;
  }
  const double jamming = dice.happens(0.5) ? 0.8 : dice.uniform(0.3, 0.99);
  scene.options["jamming_fraction"] = jamming;
  if (!scene.options.contains("continuous_jamming")) {
    maybe("critical_porosity", (1.0 - jamming) * dice.uniform(0.8, 1.5));
    maybe("c2", -std::log(jamming) * dice.uniform(0.8, 1.5));
  }
  maybe("c1", dice.log_uniform(1e-2, 1e3));
  maybe("alpha", dice.log_uniform(1e-2, 1e2));
  maybe("Z_1", dice.uniform(4.0, 12.0));
  const double initial = jamming * dice.one_of({0.5, 0.9, 0.999999, 1.0, 1.000001, 1.01});
  maybe("initial_packing_fraction", std::min(initial, 0.999));
  const auto given = scene.options.find("initial_packing_fraction");
  return {.deepest = 1.0,
          .force = 0.5,
          .only_loads = is_plastic,
          .start = given == scene.options.end() ? jamming : std::get<double>(given->second)};
}

/// Around the sets of the source's tables (Tables 4 to 6).
StressBounds draw_material_point(Dice& dice, StressScene& scene) {
  const std::string model(dice.one_of<std::string_view>({"vmdc", "vmdc", "dpc", "vm"}));
  const bool is_compressible = model != "vm";
  const double stiffness = dice.happens(0.8) ? dice.log_uniform(30.0, 2000.0) : dice.log_uniform(2.0, 1e6);
  scene.material = {{"yield_pressure", 1.0},
                    {"stiffness_ratio", stiffness},
                    {"shear_ratio", dice.uniform(0.3, 3.0)},
                    {"nu0", draw_poisson_ratio(dice, 0.4999)}};
  scene.options["yield_model"] = model;
  const auto maybe = [&](const char* key, double value) {
    if (dice.happens(0.6)) scene.material[key] = value;
  };
  maybe("eta", dice.uniform(0.0, 17.0));
  maybe("xi", dice.uniform(0.0, 10.0));
  maybe("xi1", dice.uniform(0.0, 0.9));
  if (is_compressible) {
    const double density = dice.uniform(0.2, 0.9);
    scene.material["reference_density"] = density;
    scene.material["tensile_ratio"] = dice.log_uniform(1e-3, 0.5);
    scene.material["eps0"] = dice.uniform(0.1, 1.2);
    maybe("zeta", dice.uniform(0.0, 19.0));
    maybe("omega", dice.uniform(0.0, 20.0));
    maybe("xi2", dice.uniform(0.0, 3.0));
    if (dice.happens(0.3)) scene.material["relative_density"] = dice.uniform(density, 0.99);
    if (model == "dpc" && dice.happens(0.5)) scene.material["transition_width"] = dice.log_uniform(1e-6, 0.1);
  }
  return {.deepest = 0.4, .force = 3.0, .tension = 0.5};
}

struct StressedModel {
  std::string_view name;
  StressBounds (*draw)(Dice&, StressScene&);
};

constexpr std::array<StressedModel, 9> k_models{{{"hertz", draw_hertz},
                                                 {"mdr", draw_mdr},
                                                 {"similarity", draw_power_law},
                                                 {"semimech", draw_semimech},
                                                 {"hardening", draw_power_law},
                                                 {"nonlocal", draw_nonlocal},
                                                 {"compressible", draw_compressible},
                                                 {"material-point", draw_material_point},
                                                 {"packing", draw_packing}}};

}  // namespace

StressBounds draw_material(Dice& dice, StressScene& scene) {
  const StressedModel& model = k_models[dice.below(k_models.size())];
  scene.model = find_model(model.name);
  const auto configurations = scene.model->configurations;
  scene.configuration = configurations.empty() ? "" : configurations[dice.below(configurations.size())];
  return model.draw(dice, scene);
}

}  // namespace monograin
