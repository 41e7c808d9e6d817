/// Scenarios made from a scenario, whose runs have to agree with its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "scenario/scenario.hpp"
#include "verify/stress/check/distance.hpp"

namespace monograin {

[[nodiscard]] Scenario with_integrator(Scenario scenario, std::string integrator);

/// What other runs are measured by: the direct form, exact but for rounding; where there is none, the integrator that
/// is held to be the surest, at a tolerance far below what is asked for.
[[nodiscard]] Scenario as_reference(Scenario scenario);

/// Every step takes so many times as long.
[[nodiscard]] Scenario slower(Scenario scenario, double factor);

/// The same scene of a larger particle, of a stiffer material.
[[nodiscard]] Scenario magnified(Scenario scenario, const Magnification& by);

/// The scene with its last step that can be cut done in two halves; nothing where there is none.
/// @param cut  index of the step
[[nodiscard]] std::optional<Scenario> halved(Scenario scenario, std::size_t& cut);

/// The first step of the scene forth and back; nothing where it does not say where it starts.
[[nodiscard]] std::optional<Scenario> forth_and_back(Scenario scenario);

/// The scene with every number of its data changed by up to that share.
[[nodiscard]] Scenario changed(Scenario scenario, double share, std::uint64_t sample);

}  // namespace monograin
