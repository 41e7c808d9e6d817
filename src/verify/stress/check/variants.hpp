/// Scenarios made from a scenario, whose runs have to agree with its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "scenario/scenario.hpp"
#include "verify/stress/check/distance.hpp"

namespace monograin {

[[nodiscard]] CheckedScenario with_integrator(CheckedScenario scenario, std::string integrator);

/// What other runs are measured by: the direct form, exact but for rounding; where there is none, the integrator that
/// is held to be the surest, at a tolerance far below what is asked for.
[[nodiscard]] CheckedScenario as_reference(CheckedScenario scenario);

/// Every step takes so many times as long.
[[nodiscard]] CheckedScenario slower(CheckedScenario scenario, double factor);

/// The same scene of a larger particle, of a stiffer material.
[[nodiscard]] CheckedScenario magnified(CheckedScenario scenario, const Magnification& by);

/// The scene with its last step that can be cut done in two halves; nothing where there is none.
/// @param cut  index of the step
[[nodiscard]] std::optional<CheckedScenario> halved(CheckedScenario scenario, std::size_t& cut);

/// The first step of the scene forth and back; nothing where it does not say where it starts.
[[nodiscard]] std::optional<CheckedScenario> forth_and_back(CheckedScenario scenario);

/// The scene with every number of its data changed by up to that share.
[[nodiscard]] CheckedScenario changed(CheckedScenario scenario, double share, std::uint64_t sample);

}  // namespace monograin
