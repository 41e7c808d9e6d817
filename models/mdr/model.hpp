/// Model `mdr`: its keys and words, how it becomes a system, what it derives and how it is drawn.
#pragma once

#include "mdr/system.hpp"
#include "system/model.hpp"

namespace monograin::mdr {

[[nodiscard]] Model model() noexcept;

/// Settings that do not depend on what the particle does beyond its elastic limit.
[[nodiscard]] Settings common_settings(const ModelInput& input, const Reach& reach);

/// The material of a scenario; its yield stress is infinite where the scenario has none.
[[nodiscard]] Material material_of(const ModelInput& input);

[[nodiscard]] std::vector<DerivedParameter> parameters(const ModelInput& input, const FirstStep& step);

/// How far a contact is pressed that meets a condition for the first time, at most: the softer law goes farther in and
/// bears less; up to a pressure or a contact radius that is the elastic one.
[[nodiscard]] Reach reach(const ModelInput& input, const Until& until);

}  // namespace monograin::mdr
