/// The law of a scenario of model `similarity`, `semimech` or `hardening`.
#pragma once

#include "plastic/law.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

[[nodiscard]] plastic::Law plastic_law_of(const Scenario& scenario);

}  // namespace monograin
