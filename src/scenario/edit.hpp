/// Edits of single values in the text of a scenario. The rest of the text stays as its author wrote it.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace monograin {

/// A new value of a key.
struct TextEdit {
  std::string path;   ///< "table.key", "table.list[1].key", "table.list[1-4].key"
  std::string value;  ///< as TOML
};

/// The text with edited values. A key that is absent is inserted below the header of its table.
/// @param text  of a valid scenario
/// @throws std::runtime_error if a key is absent and its table has no header
[[nodiscard]] std::string with_values(std::string text, const std::vector<TextEdit>& edits);

/// The text with a `key=value` text, as of `--set`, written into it.
/// @throws std::runtime_error if the text has no place for it
[[nodiscard]] std::string with_override(const std::string& text, const std::string& key_and_value);

/// The text with `key=value` texts, as of `--set`, in it. Its comments are lost if there are any such texts.
/// @throws ScenarioError for a path that the text cannot follow, and for a value that is not TOML
[[nodiscard]] std::string text_with_overrides(const std::string& text, std::span<const std::string> overrides);

/// A table of a larger document as a document of its own; comments are lost.
/// @throws ScenarioError if there is no such table
[[nodiscard]] std::string text_of_table(std::string_view document, std::string_view key, const std::string& origin);

}  // namespace monograin
