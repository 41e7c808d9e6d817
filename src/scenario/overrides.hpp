/// Overrides of single keys, given beside a scenario file. Internal to this folder: it includes the TOML library.
#pragma once

#include <toml++/toml.h>

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scenario/faults.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

/// A part of a key's path: a key, or an index into an array.
using PathPart = std::variant<std::string, std::size_t>;

/// The parts of `loading.steps[0].rate`, the first one a key; nothing where the text is no such path.
[[nodiscard]] std::optional<std::vector<PathPart>> parse_key_path(std::string_view text);

/// The text as a TOML string, in quotes.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// Puts the value of one `key=value` text into the tree; nodes made this way give the override as their file.
///
/// An index one past the end of an array appends to it.
///
/// A path that leads nowhere and a value that is broken TOML are added to `faults`; the tree is then unchanged, but for
/// tables made on the way.
void apply_override(toml::table& root, const std::string& text, FaultList& faults);

/// Puts a number into the tree, which its text would put there, without reading the text.
/// @param text  `key=number`
void apply_number(toml::table& root, const std::string& text, double number, FaultList& faults);

/// Whether the place is in an override rather than in a file.
[[nodiscard]] bool is_override(const SourceLocation& where) noexcept;

}  // namespace monograin
