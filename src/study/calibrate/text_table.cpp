#include "study/calibrate/text_table.hpp"

#include <algorithm>
#include <cstddef>

namespace monograin {
namespace {

std::size_t width_of(const std::string& cell) {
  const auto begins_character = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; };
  return static_cast<std::size_t>(std::ranges::count_if(cell, begins_character));
}

}  // namespace

std::string aligned(const std::vector<TextRow>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const TextRow& row : rows) {
    for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], width_of(row[k]));
  }
  std::string text;
  for (const TextRow& row : rows) {
    for (std::size_t k = 0; k < row.size(); ++k) {
      const std::string blanks(widths[k] - width_of(row[k]), ' ');
      text += k == 0 ? row[k] + blanks : "  " + blanks + row[k];
    }
    text += '\n';
  }
  return text;
}

}  // namespace monograin
