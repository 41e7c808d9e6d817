/// Remarks on settings of a scenario that have no effect or may be mistakes, as far as that is known without a run.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenario/scenario.hpp"

namespace monograin {

/// Remarks on numbers without a unit that are unlikely in SI units, on walls that never move inwards, on `points` that
/// are ignored because `times` are given, and those of the model.
[[nodiscard]] std::vector<std::string> remarks_on(const CheckedScenario& scenario);

/// Remark on output times beyond the latest end of the program, with their number. None if there are none, or if that
/// end is unknown.
[[nodiscard]] std::optional<std::string> remark_on_times(const CheckedScenario& scenario);

}  // namespace monograin
