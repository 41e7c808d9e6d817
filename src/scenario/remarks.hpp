/// Remarks on settings of a scenario that have no effect, as far as that is known without a run.
#pragma once

#include <optional>
#include <string>

#include "scenario/scenario.hpp"

namespace monograin {

/// Remark that `points` are ignored because `times` are given; none if only one of them is given.
[[nodiscard]] std::optional<std::string> remark_on_points(const CheckedScenario& scenario);

/// Remark on output times beyond the latest end of the program, with their number. None if there are none, or if that
/// end is unknown.
[[nodiscard]] std::optional<std::string> remark_on_times(const CheckedScenario& scenario);

}  // namespace monograin
