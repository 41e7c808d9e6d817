/// Events with which a step or a run ends anyway.
#pragma once

#include <string_view>

namespace monograin {

/// True for an event with which a step or a run ends anyway: no step can wait for it.
[[nodiscard]] constexpr bool is_end(std::string_view event) noexcept {
  return event == "step-end" || event == "until-met" || event == "limit";
}

}  // namespace monograin
