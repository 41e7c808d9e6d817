/// The pressure curve that a scenario brings along.
#pragma once

#include <memory>

#include "mdr/pressure_curve.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

/// Of the samples that `pressure_table` names; null where it names none: the source's exponential.
[[nodiscard]] std::shared_ptr<const mdr::PressureCurve> pressure_curve_of(const Scenario& scenario);

}  // namespace monograin
