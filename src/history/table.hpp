/// A table with a self-describing header, and its CSV form: what histories, events and stored curves are kept in.
#pragma once

#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenario/text_file.hpp"

namespace monograin {

/// One column. A column with labels holds words: its values are indices into them.
struct Column {
  std::string name;  ///< without the unit, e.g. "axial.force"
  std::string unit;  ///< e.g. "N", "-"; empty for columns without one (step, row, regime)
  std::vector<std::string> labels;

  /// "axial.force[N]", or just the name where there is no unit.
  [[nodiscard]] std::string heading() const;
  [[nodiscard]] bool holds_words() const noexcept { return !labels.empty(); }

  bool operator==(const Column&) const = default;
};

/// Rows of numbers under named columns, with `key: value` lines above. Rows are stored one after another in one array.
class Table {
 public:
  std::vector<std::pair<std::string, std::string>> header;

  Table() = default;
  explicit Table(std::vector<Column> columns) : columns_(std::move(columns)) {}

  [[nodiscard]] const std::vector<Column>& columns() const noexcept { return columns_; }
  [[nodiscard]] std::size_t row_count() const noexcept {
    return columns_.empty() ? 0 : values_.size() / columns_.size();
  }
  [[nodiscard]] std::span<const double> row(std::size_t index) const;
  [[nodiscard]] double at(std::size_t row, std::size_t column) const { return values_[row * columns_.size() + column]; }

  /// Appends a row. @throws std::logic_error when its length is not the number of columns
  void append(std::span<const double> row);
  /// Space for that many further rows, so that appending them does not allocate.
  void reserve_rows(std::size_t count);

  /// Index of the column with that name or heading ("axial.force" or "axial.force[N]"), if there is one.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const noexcept;
  /// All values of one column. @throws std::out_of_range naming the column and those there are
  [[nodiscard]] std::vector<double> column(std::string_view name) const;
  /// The word in a cell of a column that holds words.
  [[nodiscard]] std::string_view word(std::size_t row, std::size_t column) const;
  /// Value of a header line, or an empty view.
  [[nodiscard]] std::string_view header_value(std::string_view key) const noexcept;
  /// The same where it is a number.
  [[nodiscard]] std::optional<double> header_number(std::string_view key) const noexcept;

 private:
  std::vector<Column> columns_;
  std::vector<double> values_;
};

/// Digits after which a double read back is the double that was written.
inline constexpr int k_all_digits = std::numeric_limits<double>::max_digits10;

/// A number as write_csv writes it.
[[nodiscard]] std::string csv_number(double value);
/// Appends it to a text. @param digits  significant ones; integers have all of theirs
void append_csv_number(std::string& text, double value, int digits = k_all_digits);

/// Writes `# key: value` lines, one row of headings, and the rows with 17 significant digits (`nan` for undefined
/// values), whatever the locale. Reading the text back gives the same doubles, bit by bit.
/// Nothing is quoted: a line break in a header line becomes a space.
/// @throws std::invalid_argument when a heading or a word contains a comma, a quote or a line break
void write_csv(const Table& table, std::ostream& out);
/// The text that write_csv writes.
/// @param digits  significant ones: fewer for what has been measured, which is not read back bit by bit then
[[nodiscard]] std::string csv_text(const Table& table, int digits = k_all_digits);

/// Reads what write_csv writes, and any CSV with one row of headings and optional `#` lines.
/// Blank lines, blanks around cells, a byte order mark and CRLF line ends do no harm; quotes have no meaning. A column
/// in which any cell is not a number becomes a column of words (an empty cell is the empty word).
/// @throws std::runtime_error `file:line:column: what is wrong` for a missing or empty file, ragged rows, no header
/// row, two columns with the same heading, a file of more than 1 GiB or 100 million cells, a line of more than 1 MiB
[[nodiscard]] Table read_csv(const std::filesystem::path& file, FileKind kind = FileKind::any);

}  // namespace monograin
