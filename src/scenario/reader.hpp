/// From a parsed tree to a checked scenario. Internal: includes the TOML library.
#pragma once

#include <toml++/toml.h>

#include <string>

#include "scenario/faults.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

/// Fills all of a scenario but its name, text and overrides. What comes back is only meaningful if nothing was added
/// to `faults`.
/// @param files  texts of all files that the tree may name; nullptr: they are read from disk, beside `origin`
[[nodiscard]] CheckedScenario read_tree(const toml::table& root, const std::string& origin, const FileTexts* files,
                                        FaultList& faults);

}  // namespace monograin
