#include "figure/markdown.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace monograin {

std::string number_or_dash(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : "-";
}

void append_markdown(std::string& text, const std::vector<MarkdownRow>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 3);
  for (const MarkdownRow& row : rows) {
    for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], row[k].size());
  }
  const auto cell = [](const MarkdownRow& row, std::size_t k) { return k < row.size() ? row[k] : std::string(); };
  const auto is_word = [](const std::string& text_of_cell) {
    return !text_of_cell.empty() && std::isalpha(static_cast<unsigned char>(text_of_cell.front())) != 0;
  };
  const auto holds_words = [&](std::size_t k) {
    return k == 0 ||
           std::any_of(rows.begin() + 1, rows.end(), [&](const MarkdownRow& row) { return is_word(cell(row, k)); });
  };
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t k = 0; k < widths.size(); ++k) {
      text += holds_words(k) ? fmt::format("| {:<{}} ", cell(rows[r], k), widths[k])
                             : fmt::format("| {:>{}} ", cell(rows[r], k), widths[k]);
    }
    text += "|\n";
    if (r > 0) continue;
    for (std::size_t k = 0; k < widths.size(); ++k) {
      text += fmt::format("| {}{} ", std::string(widths[k] - 1, '-'), holds_words(k) ? '-' : ':');
    }
    text += "|\n";
  }
}

}  // namespace monograin
