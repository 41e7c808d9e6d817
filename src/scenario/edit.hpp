/// Changes of single values in the text of a scenario, which leave all else in it as its author wrote it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace monograin {

/// A value that is to stand at a key.
struct TextEdit {
  std::string path;   ///< "table.key", "table.list[1].key"
  std::string value;  ///< as TOML
};

/// The text with these values. A key that is not there is put below the header of its table.
/// @param text  a scenario's, valid
/// @throws std::runtime_error where a key is absent and its table has no header
[[nodiscard]] std::string with_values(std::string text, const std::vector<TextEdit>& edits);

/// A table of a larger document as a document of its own; comments are lost.
/// @throws ScenarioError where there is no such table
[[nodiscard]] std::string text_of_table(std::string_view document, std::string_view key, const std::string& origin);

}  // namespace monograin
