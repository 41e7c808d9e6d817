#include "scenario/cells.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <system_error>

namespace monograin {
namespace {

std::string_view without_end_blanks(std::string_view text) {
  const std::size_t last = text.find_last_not_of(" \t\r");
  return text.substr(0, last == std::string_view::npos ? 0 : last + 1);
}

std::size_t characters_in(std::string_view text) {
  const auto begins = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; };
  return static_cast<std::size_t>(std::ranges::count_if(text, begins));
}

/// Blanks that may stand around a cell.
std::string_view blanks_beside(char separator) { return separator == '\t' ? " " : " \t"; }

/// Position where a cell ends: at the next separator, or at the end of the line.
std::size_t end_of_cell(std::string_view line, std::size_t begin, char separator) {
  const std::string_view separators = separator == ' ' ? std::string_view(" \t") : std::string_view(&separator, 1);
  return std::min(line.find_first_of(separators, begin), line.size());
}

/// Position of the closing quote of a cell that begins with a quote; npos if there is none, or if text follows it.
std::size_t closing_quote(std::string_view line, std::size_t begin, char separator) {
  std::size_t at = line.find('"', begin + 1);
  while (at != std::string_view::npos && line.substr(at + 1).starts_with('"')) at = line.find('"', at + 2);
  if (at == std::string_view::npos) return at;
  const std::size_t next = std::min(line.find_first_not_of(blanks_beside(separator), at + 1), line.size());
  const bool is_closed = next == line.size() || line[next] == separator || (separator == ' ' && next > at + 1);
  return is_closed ? at : std::string_view::npos;
}

/// True if the other sign than the decimal one marks thousands in a number without its sign: "1.100,5", "1.250.000".
/// "1.100" alone may as well have a decimal point, and is no such number.
bool has_thousands(std::string_view digits, char decimal) {
  const std::size_t end = std::min(digits.find(decimal), digits.size());
  const std::string_view whole = digits.substr(0, end);
  const char mark = decimal == '.' ? ',' : '.';
  const std::size_t first = whole.find(mark);
  if (first == std::string_view::npos || first == 0 || first > 3 || whole[0] == '0' || whole.size() % 4 != first % 4) {
    return false;
  }
  for (std::size_t k = 0; k < whole.size(); ++k) {
    const bool is_mark = k >= first && (k - first) % 4 == 0;
    if (is_mark ? whole[k] != mark : whole[k] < '0' || whole[k] > '9') return false;
  }
  return end < digits.size() || whole.size() > first + 4;
}

}  // namespace

std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  std::string_view line = text.substr(0, end);
  if (line.ends_with('\r')) line.remove_suffix(1);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

bool is_comment(std::string_view line) noexcept {
  const std::size_t begin = line.find_first_not_of(" \t\r");
  return begin == std::string_view::npos || line[begin] == '#';
}

std::vector<Cell> cells_of(std::string_view line, char separator) {
  std::vector<Cell> cells;
  std::size_t counted = 0;  // bytes of the line in which the characters have been counted
  std::size_t column = 1;
  const auto add = [&](std::size_t begin, std::size_t end) {
    column += characters_in(line.substr(counted, begin - counted));
    counted = begin;
    cells.push_back({without_end_blanks(line.substr(begin, end - begin)), column});
  };
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t begin = std::min(line.find_first_not_of(blanks_beside(separator), at), line.size());
    if (separator == ' ' && begin == line.size()) break;
    const bool is_quoted = begin < line.size() && line[begin] == '"';
    const std::size_t quote = is_quoted ? closing_quote(line, begin, separator) : std::string_view::npos;
    const std::size_t end = end_of_cell(line, quote == std::string_view::npos ? begin : quote, separator);
    if (quote == std::string_view::npos) {
      add(begin, end);
    } else {
      add(begin + 1, quote);
    }
    at = end + 1;
  }
  return cells;
}

std::optional<double> number_in(std::string_view text, char decimal) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const bool is_negative = text.starts_with('-') || text.starts_with(k_minus_sign);
  if (is_negative) text.remove_prefix(text.starts_with('-') ? 1 : k_minus_sign.size());
  if (text.starts_with('-')) return std::nullopt;
  std::string digits;
  const char mark = decimal == '.' ? ',' : '.';
  if (decimal != '.' || text.find(mark) != std::string_view::npos) {
    const bool is_grouped = has_thousands(text, decimal);
    if (!is_grouped && text.find(mark) != std::string_view::npos) return std::nullopt;
    digits = text;
    std::erase(digits, mark);
    std::ranges::replace(digits, decimal, '.');
    text = digits;
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return is_negative ? -value : value;
}

std::string_view without_byte_order_mark(std::string_view text) noexcept {
  constexpr std::string_view k_mark = "\xEF\xBB\xBF";
  if (text.starts_with(k_mark)) text.remove_prefix(k_mark.size());
  return text;
}

}  // namespace monograin
