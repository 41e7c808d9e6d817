/// Reads `[loading]`: the walls and their programs. Internal: includes the TOML library.
#pragma once

#include "scenario/language.hpp"
#include "scenario/scenario.hpp"
#include "scenario/section.hpp"

namespace monograin {

[[nodiscard]] Loading read_loading(Reading& reading, Section::Origin table, const Language& language);

}  // namespace monograin
