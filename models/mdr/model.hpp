/// Model `mdr`: its keys and words, how it becomes a system, what it derives and how it is drawn.
#pragma once

#include "mdr/system.hpp"
#include "system/model.hpp"

namespace monograin::mdr {

/// The model `mdr`, as the workbench knows it.
[[nodiscard]] Model model() noexcept;

/// Settings that every MDR particle has, whether or not it yields: radius, elastic constants, free centre, largest
/// displacement and force.
[[nodiscard]] Settings common_settings(const ModelInput& input, const Reach& reach);

/// The material of a scenario; its yield stress is infinite where the scenario has none.
[[nodiscard]] Material material_of(const ModelInput& input);

/// Parameters derived from the material of a scenario, and its state at first yield.
[[nodiscard]] std::vector<DerivedParameter> parameters(const ModelInput& input, const FirstStep& step);

/// Largest displacement and force of a contact that meets a condition for the first time, as estimated from the softer
/// of the elastic and the plastic law, which goes farther in and bears less. For a pressure or a contact radius the
/// displacement is that of the elastic law. Infinite where nothing is known.
[[nodiscard]] Reach reach(const ModelInput& input, const Until& until);

}  // namespace monograin::mdr
