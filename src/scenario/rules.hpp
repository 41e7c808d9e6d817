/// Rules between values that are right one by one. For the reader of scenarios: it includes the TOML library.
#pragma once

#include <toml++/toml.h>

#include <string>

#include "scenario/section.hpp"

namespace monograin {

/// Reports what the scenario's model objects to, and walls that go back where it has no unloading.
/// @param tree  what the scenario was read from without a fault, for the places
void check_rules(Reading& reading, const toml::table& tree, const std::string& origin, const Language& language,
                 const CheckedScenario& scenario);

}  // namespace monograin
