/// Rules between values that are valid one by one. For the reader of scenarios: includes the TOML library.
#pragma once

#include <toml++/toml.h>

#include <string>

#include "scenario/section.hpp"

namespace monograin {

/// Reports the objections of the scenario's model, and walls that go back although the model has no unloading.
/// @param tree  from which the scenario was read without a fault; gives positions
void check_rules(Reading& reading, const toml::table& tree, const std::string& origin, const Language& language,
                 const CheckedScenario& scenario);

}  // namespace monograin
