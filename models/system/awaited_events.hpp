/// Events for which a step of a program may wait.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "system/keys.hpp"

namespace monograin {

/// Names of events without those that end a step or a run anyway.
[[nodiscard]] inline std::vector<std::string_view> events_to_wait_for(std::span<const Term> events) {
  std::vector<std::string_view> names;
  for (const Term& event : events) {
    if (event.name != "step-end" && event.name != "until-met" && event.name != "limit") names.push_back(event.name);
  }
  return names;
}

}  // namespace monograin
