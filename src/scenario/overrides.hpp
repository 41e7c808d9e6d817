/// Overrides of single keys of a scenario file. Internal to this folder: includes the TOML library.
#pragma once

#include <toml++/toml.h>

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scenario/edit.hpp"
#include "scenario/faults.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

/// A part of a key's path: a key, or an index into an array.
using PathPart = std::variant<std::string, std::size_t>;

/// Parts of a path such as `loading.steps[0].rate`, the first one a key; none if the text is no such path.
[[nodiscard]] std::optional<std::vector<PathPart>> parse_key_path(std::string_view text);

/// The text as a TOML string, in quotes.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// Sets the value of one `key=value` text in the tree. New nodes give the override as their file.
///
/// An index one past the end of an array appends to it. A path with a range, `loading.wall[2-5].gap`, sets the key of
/// each entry.
///
/// Adds a fault for a path that the tree cannot follow, and for a value that is not TOML. The tree is then
/// unchanged, except for tables made for the first parts of the path.
void apply_override(toml::table& root, const std::string& text, FaultList& faults);

/// Sets a number in the tree, as apply_override() would from its text, without parsing the text.
/// @param text  `key=number`
void apply_number(toml::table& root, const std::string& text, double number, FaultList& faults);

/// The edit of a scenario's text that has the effect of one `key=value` text; none, and a fault, if its value is not
/// TOML.
[[nodiscard]] std::optional<TextEdit> edit_of(const std::string& text, FaultList& faults);

/// True if a position is in an override rather than in a file.
[[nodiscard]] bool is_override(const SourceLocation& where) noexcept;

}  // namespace monograin
