/// Tables in Markdown.
#pragma once

#include <string>
#include <vector>

namespace monograin {

/// A number to some significant digits; a dash if it is undefined.
[[nodiscard]] std::string number_or_dash(double value, int digits);

using MarkdownRow = std::vector<std::string>;

/// Appends a table with aligned columns: words to the left, numbers to the right.
/// @param rows  the headings, then rows of no more cells
void append_markdown(std::string& text, const std::vector<MarkdownRow>& rows);

}  // namespace monograin
