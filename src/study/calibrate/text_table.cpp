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

std::string markdown(const std::vector<TextRow>& rows, bool has_headings) {
  const std::size_t columns = rows.front().size();
  std::string text;
  const auto add = [&](const TextRow& row) {
    text += '|';
    for (std::size_t k = 0; k < columns; ++k) {
      text += ' ';
      for (const char c : k < row.size() ? row[k] : std::string()) {
        if (c == '|') text += '\\';
        text += c;
      }
      text += " |";
    }
    text += '\n';
  };
  add(has_headings ? rows.front() : TextRow{});
  text += '|';
  for (std::size_t k = 0; k < columns; ++k) text += k == 0 ? " --- |" : " ---: |";
  text += '\n';
  for (std::size_t row = has_headings ? 1 : 0; row < rows.size(); ++row) add(rows[row]);
  return text;
}

}  // namespace monograin
