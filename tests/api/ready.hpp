/// Ready scenarios, as others read them.
#pragma once

#include <filesystem>
#include <string>

#include "monograin/scenario.hpp"

namespace monograin {

inline Scenario ready_scenario(const std::string& name) {
  return read_scenario(std::filesystem::path(MONOGRAIN_SOURCE_DIR) / "scenarios" / name);
}

}  // namespace monograin
