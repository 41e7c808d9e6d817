/// Overrides of single keys, given beside a scenario file. Internal to this folder: it includes the TOML library.
#pragma once

#include <toml++/toml.h>

#include <string>

#include "scenario/faults.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

/// Puts the value of one `key=value` text into the tree; nodes made this way give the override as their file.
///
/// A path that leads nowhere and a value that is broken TOML are added to `faults`; the tree is then unchanged, but for
/// tables made on the way.
void apply_override(toml::table& root, const std::string& text, FaultList& faults);

/// Whether the place is in an override rather than in a file.
[[nodiscard]] bool is_override(const SourceLocation& where) noexcept;

}  // namespace monograin
