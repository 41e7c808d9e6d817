/// Makes a checked scenario from a parsed tree. Internal: includes the TOML library.
#pragma once

#include <toml++/toml.h>

#include <string>

#include "scenario/faults.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

/// Fills a scenario except name, text and overrides. The result is only meaningful if nothing was added to `faults`.
/// @param files  texts of all files that the tree may name; nullptr: files are read from disk, beside `origin`
[[nodiscard]] CheckedScenario read_tree(const toml::table& root, const std::string& origin, const FileTexts* files,
                                        FaultList& faults);

}  // namespace monograin
