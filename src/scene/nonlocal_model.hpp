/// The nonlocal formulation of a scenario, and how far its loading can go.
#pragma once

#include <optional>

#include "elastic/nonlocal_contacts.hpp"
#include "scenario/scenario.hpp"
#include "scene/scene.hpp"

namespace monograin {

[[nodiscard]] nonlocal::Model nonlocal_model_of(const Scenario& scenario);

/// Displacement over R0 of the first driven wall at the limit of applicability, if all walls go on as in their first
/// step. None where a wall follows a force then, none moves, or the limit lies beyond the centre of the particle.
[[nodiscard]] std::optional<double> nonlocal_limit_of(const Scenario& scenario);

/// Displacement and force of a wall whose contact, by itself, meets a condition; infinite where none does as long as it
/// is narrower than the particle, or where an event says.
[[nodiscard]] Reach nonlocal_reach(const Scenario& scenario, const Until& until);

}  // namespace monograin
