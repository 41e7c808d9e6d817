/// Cells of a table in a text file, with their positions.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace monograin {

/// The minus sign of printed texts, U+2212.
inline constexpr std::string_view k_minus_sign = "\xE2\x88\x92";

struct Cell {
  std::string_view text;   ///< without the blanks and quotes around it
  std::size_t column = 1;  ///< of its first character in the line, counted in characters of UTF-8
};

/// Removes the first line from the text and returns it without its line end.
[[nodiscard]] std::string_view take_line(std::string_view& text);

/// True if a line is blank or begins with '#'.
[[nodiscard]] bool is_comment(std::string_view line) noexcept;

/// The cells of a line. A cell may stand in double quotes, which are not part of its text; the separator counts as text
/// between them.
/// @param separator  a character, or ' ' for any number of blanks and tabs
[[nodiscard]] std::vector<Cell> cells_of(std::string_view line, char separator = ',');

/// Parses a text that is a finite number as a whole, whatever the locale; none otherwise.
/// @param decimal  '.' or ','. The other one may mark thousands: "1.100,5", "1.250.000"; "1.100" may mean 1.1 and is
///                 refused.
[[nodiscard]] std::optional<double> number_in(std::string_view text, char decimal = '.');

/// The text without a byte order mark at its beginning.
[[nodiscard]] std::string_view without_byte_order_mark(std::string_view text) noexcept;

}  // namespace monograin
