/// The parsed TOML tree and the places of its parts. For readers of TOML files: it includes the TOML
/// library.
#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>

#include "scenario/scenario.hpp"

namespace monograin {

inline constexpr std::size_t k_largest_text = 16U * 1024U * 1024U;

/// Parses a text; `origin` is what its nodes give as their file.
/// @throws ScenarioError with one fault where the text is not TOML, is too large or nests too deeply
[[nodiscard]] toml::table parse_document(std::string_view text, const std::string& origin);

/// Where a node or key was written; `fallback` where the tree does not know.
[[nodiscard]] SourceLocation place_of(const toml::source_region& region, const SourceLocation& fallback);

/// A node as a user would recognise it in a message: its value, or "a table".
[[nodiscard]] std::string shown(const toml::node& node);

}  // namespace monograin
