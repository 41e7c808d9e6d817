/// The law of a scenario of model `mdr` or `hertz`.
#pragma once

#include <memory>

#include "mdr/contact.hpp"
#include "scenario/scenario.hpp"
#include "scene/scene.hpp"

namespace monograin {

/// The pressure curve of the samples that `pressure_table` names; null where it names none: the source's exponential.
[[nodiscard]] std::shared_ptr<const mdr::PressureCurve> pressure_curve_of(const Scenario& scenario);

/// Its yield stress is infinite where the scenario has none.
[[nodiscard]] mdr::Material mdr_material_of(const Scenario& scenario);

/// How far a contact is pressed that reaches a condition's value for the first time, at most: the softer law goes
/// farther in and bears less; up to a pressure or a contact radius that is the elastic one. Infinity where the model
/// has to be run to say so.
[[nodiscard]] Reach mdr_reach(const Scenario& scenario, const Until& until);

}  // namespace monograin
