/// The parsed TOML tree and the positions of its parts. For readers of TOML files: includes the TOML library.
#pragma once

#include <toml++/toml.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/scenario.hpp"
#include "scenario/text_file.hpp"

namespace monograin {

/// Largest number of parts of a dotted key.
inline constexpr std::size_t k_most_key_parts = 32;

/// Parses a text; its nodes give `origin` as their file.
/// @throws ScenarioError with one fault if the text is not TOML, is too large or nests too deeply
[[nodiscard]] toml::table parse_document(std::string_view text, const std::string& origin);

/// A kind of file that a command takes.
struct DocumentKind {
  std::string_view noun;               ///< "a scenario"
  std::string_view command;            ///< that takes it
  std::vector<std::string_view> keys;  ///< by which files of this kind are known
};

/// Kinds of files, in the order in which their keys decide.
enum class DocumentType { scenario, sweep, experiment_plan, calibration, figure };
[[nodiscard]] const DocumentKind& kind_of(DocumentType type);

/// Type of a file by its keys; none if no key shows it.
[[nodiscard]] std::optional<DocumentType> type_of(const toml::table& root);

/// Refuses a file of another type, which would cause a fault for each of its keys.
/// @throws ScenarioError with one fault if the keys show another type
void expect_type(const toml::table& root, const std::string& origin, DocumentType own);

/// Position of a node or key; `fallback` if the tree does not have it.
[[nodiscard]] SourceLocation place_of(const toml::source_region& region, const SourceLocation& fallback);

/// Text by which a user recognizes a node in a message: its value, or "a table".
[[nodiscard]] std::string shown(const toml::node& node);

}  // namespace monograin
