/// Tables in Markdown.
#pragma once

#include <string>
#include <vector>

namespace monograin {

using MarkdownRow = std::vector<std::string>;

/// Appends a table with aligned columns: words to the left, numbers to the right.
/// @param rows  the headings, then rows of as many cells
void append_markdown(std::string& text, const std::vector<MarkdownRow>& rows);

}  // namespace monograin
