/// The nonlocal formulation of a scenario, and how far its loading can go.
#pragma once

#include <optional>

#include "elastic/nonlocal_contacts.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

[[nodiscard]] nonlocal::Model nonlocal_model_of(const Scenario& scenario);

/// Displacement over R0 of the first driven wall at the limit of applicability, if all walls go on as in their first
/// step. None where a wall follows a force then, none moves, or the limit lies beyond the centre of the particle.
[[nodiscard]] std::optional<double> nonlocal_limit_of(const Scenario& scenario);

}  // namespace monograin
