/// The parsed TOML tree and the positions of its parts. For readers of TOML files: includes the TOML library.
#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>

#include "scenario/scenario.hpp"
#include "scenario/text_file.hpp"

namespace monograin {

/// Parses a text; its nodes give `origin` as their file.
/// @throws ScenarioError with one fault if the text is not TOML, is too large or nests too deeply
[[nodiscard]] toml::table parse_document(std::string_view text, const std::string& origin);

/// Refuses a file of another kind, which would cause a fault for each of its keys.
/// @param own  key by which files of the expected kind are known: "model", "vary", "data", "program"
/// @throws ScenarioError with one fault if the tree lacks that key and has that of another kind
void expect_kind(const toml::table& root, const std::string& origin, std::string_view own);

/// Position of a node or key; `fallback` if the tree does not have it.
[[nodiscard]] SourceLocation place_of(const toml::source_region& region, const SourceLocation& fallback);

/// Text by which a user recognizes a node in a message: its value, or "a table".
[[nodiscard]] std::string shown(const toml::node& node);

}  // namespace monograin
