/// Cells of a table in a text file, and where they stand.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace monograin {

struct Cell {
  std::string_view text;   ///< without the blanks around it
  std::size_t column = 1;  ///< of its first character in the line
};

/// Takes the next line off the text, without blanks at its end.
[[nodiscard]] std::string_view take_line(std::string_view& text);

/// Whether a line says nothing: it is blank, or begins with '#'.
[[nodiscard]] bool is_comment(std::string_view line) noexcept;

/// The cells of a line, which commas separate.
[[nodiscard]] std::vector<Cell> cells_of(std::string_view line);

/// The finite number that all of the text is, whatever the locale.
[[nodiscard]] std::optional<double> number_in(std::string_view text) noexcept;

/// The text without a byte order mark at its beginning.
[[nodiscard]] std::string_view without_byte_order_mark(std::string_view text) noexcept;

}  // namespace monograin
