/// Variants of a scenario whose runs have to agree with its own run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "scenario/scenario.hpp"
#include "verify/stress/check/distance.hpp"

namespace monograin {

/// The scene with another integrator.
[[nodiscard]] CheckedScenario with_integrator(CheckedScenario scenario, std::string integrator);

/// The scene with the integrator against which other runs are measured: the direct form, exact but for round-off; if
/// the model has none, the most reliable integrator, at a tolerance far below the scene's own.
[[nodiscard]] CheckedScenario as_reference(CheckedScenario scenario);

/// The scene with all steps longer by a factor.
[[nodiscard]] CheckedScenario slower(CheckedScenario scenario, double factor);

/// The scene with lengths and stresses larger by given factors.
[[nodiscard]] CheckedScenario magnified(CheckedScenario scenario, const Magnification& by);

/// The scene with the last step that can be cut made in two halves; nothing if no step can be cut.
/// @param cut  receives the index of that step
[[nodiscard]] std::optional<CheckedScenario> halved(CheckedScenario scenario, std::size_t& cut);

/// The first step of the scene forth and back; nothing if the scene does not say where that step starts.
[[nodiscard]] std::optional<CheckedScenario> forth_and_back(CheckedScenario scenario);

/// The scene with every number of its data changed by up to a share.
/// @param sample  number of the set of changes; 2n and 2n + 1 change material and program in opposite directions
[[nodiscard]] CheckedScenario changed(CheckedScenario scenario, double share, std::uint64_t sample);

}  // namespace monograin
