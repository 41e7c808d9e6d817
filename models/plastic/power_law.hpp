/// Material of a power law sigma = kappa epsilon^(1/m), as scenarios give it: keys, the fit to Ludwik's law, and random
/// materials for the stress test.
#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "plastic/model_of.hpp"
#include "stress_test/draw.hpp"
#include "system/model.hpp"

namespace monograin::plastic {

inline constexpr std::array k_power_law_material{
    QuantityKey{"strength",
                "strength kappa of the power law sigma = kappa epsilon^(1/m)",
                Dimension::stress,
                k_positive,
                {},
                true},
    QuantityKey{"hardening_exponent",
                "exponent 1/m of the power law; 0: ideally plastic",
                Dimension::none,
                Range{.lower = 0.0, .upper = 1.0},
                {},
                true},
    QuantityKey{"youngs_modulus",
                "Young's modulus, for unloading, finite elements and ludwik (which takes infinity without it)",
                Dimension::stress,
                k_positive,
                {},
                true},
    QuantityKey{"poisson_ratio",
                "Poisson's ratio, for unloading and finite elements only",
                Dimension::none,
                k_poisson_to_half,
                {},
                true},
};

/// Values of k_power_law_material that a scenario gives.
[[nodiscard]] std::vector<DerivedParameter> power_law_parameters(const ModelInput& input);

/// Objections to a scenario that unloads without elastic constants.
[[nodiscard]] std::vector<Objection> power_law_objections(const ModelInput& input);

/// Elastic material that flows by the power law of its total strain where that is below the elastic line.
/// @throws std::invalid_argument without elastic constants
[[nodiscard]] ContinuumMaterial power_law_continuum(const ModelInput& input);

/// Power law nearest to Ludwik's law. The fit over the total strain depends on Young's modulus; infinite:
/// rigid-plastic.
/// @throws std::invalid_argument, std::domain_error as fit_hollomon
[[nodiscard]] PowerLaw power_law_of(const LudwikInput& ludwik);

/// Draws strength and exponent of a power law, and the elastic constants that unloading needs.
[[nodiscard]] ProgramBounds draw_power_law(Dice& dice, DrawnMaterial& drawn, std::span<const OptionKey> options);

/// Completes a model with what follows from the law, its options and its material.
/// @tparam law_of   function from a scenario to its law
/// @tparam options  options of the model
template <auto law_of, const auto& options>
[[nodiscard]] Model power_law_model_of(Model model) {
  model.options = options;
  model.draw = [](Dice& dice, DrawnMaterial& drawn) { return draw_power_law(dice, drawn, options); };
  model.material = k_power_law_material;
  model.objections = power_law_objections;
  model.power_law_of = power_law_of;
  model.continuum_material = power_law_continuum;
  return model_of<[](const ModelInput& input, const Reach& reach) {
    return WallLaw(law_of(input), settings_of(input, "strength", reach));
  }>(std::move(model));
}

}  // namespace monograin::plastic
