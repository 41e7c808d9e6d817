/// What a scenario asks for to no effect, as far as it shows without a run.
#pragma once

#include <optional>
#include <string>

#include "scenario/scenario.hpp"

namespace monograin {

/// Says that `points` are ignored where `times` are given, if both are.
[[nodiscard]] std::optional<std::string> remark_on_points(const CheckedScenario& scenario);

/// Says how many output times lie beyond the latest end that the program may have, if any do and that end is known.
[[nodiscard]] std::optional<std::string> remark_on_times(const CheckedScenario& scenario);

}  // namespace monograin
