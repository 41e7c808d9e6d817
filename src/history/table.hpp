/// A table with a self-describing header, and its CSV form. Histories, events and stored curves are such tables.
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenario/text_file.hpp"

namespace monograin {

/// Description of one column. A column with labels holds words: its values are indices into the labels.
struct Column {
  std::string name;    ///< without the unit, e.g. "axial.force"
  std::string unit{};  ///< e.g. "N", "-"; empty for columns without a unit (step, row, regime)
  std::vector<std::string> labels{};

  /// Name and unit as in a file, e.g. "axial.force[N]"; only the name if there is no unit.
  [[nodiscard]] std::string heading() const;
  [[nodiscard]] bool holds_words() const noexcept { return !labels.empty(); }

  bool operator==(const Column&) const = default;
};

/// True for the columns step and row of a history, which number its rows and are not results.
[[nodiscard]] bool is_counter(const Column& column) noexcept;

/// Rows of numbers under named columns, with header lines `key: value`. One array holds all values, row by row.
class Table {
 public:
  std::vector<std::pair<std::string, std::string>> header;  ///< keys and values of the header lines

  Table() = default;
  explicit Table(std::vector<Column> columns) : columns_(std::move(columns)) {}

  [[nodiscard]] const std::vector<Column>& columns() const noexcept { return columns_; }
  [[nodiscard]] std::size_t row_count() const noexcept {
    return columns_.empty() ? 0 : values_.size() / columns_.size();
  }
  /// Values of one row; words are indices into the labels of their column.
  [[nodiscard]] std::span<const double> row(std::size_t index) const;
  [[nodiscard]] double at(std::size_t row, std::size_t column) const { return values_[row * columns_.size() + column]; }

  /// Appends a row. @throws std::logic_error if its length is not the number of columns
  void append(std::span<const double> row);
  /// Reserves space for `count` further rows, so that appending them does not allocate.
  void reserve_rows(std::size_t count);
  /// Appends columns.
  /// @param value  (row, index among the new columns) -> value
  template <class Value>
  void append_columns(const std::vector<Column>& columns, Value&& value) {
    std::vector<double> wide;
    wide.reserve(row_count() * (columns_.size() + columns.size()));
    for (std::size_t r = 0; r < row_count(); ++r) {
      wide.insert(wide.end(), row(r).begin(), row(r).end());
      for (std::size_t c = 0; c < columns.size(); ++c) wide.push_back(value(r, c));
    }
    columns_.insert(columns_.end(), columns.begin(), columns.end());
    values_ = std::move(wide);
  }

  /// Index of the column with that name or heading ("axial.force" or "axial.force[N]"), if there is one.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const noexcept;
  /// Copies the values of the column with that name or heading.
  /// @throws std::out_of_range that lists the columns of the table, if there is no such column
  [[nodiscard]] std::vector<double> column(std::string_view name) const;
  /// Word in a cell of a column of words. @throws std::out_of_range if the cell holds no word
  [[nodiscard]] std::string_view word(std::size_t row, std::size_t column) const;
  /// Value of the header line with that key; empty if there is no such line.
  [[nodiscard]] std::string_view header_value(std::string_view key) const noexcept;
  /// Value of the header line with that key as a number; none if there is no such line, or it holds no number.
  [[nodiscard]] std::optional<double> header_number(std::string_view key) const noexcept;

 private:
  std::vector<Column> columns_;
  std::vector<double> values_;
};

/// Significant digits with which a double that is written and read back is bitwise equal.
inline constexpr int k_all_digits = std::numeric_limits<double>::max_digits10;

/// Text of a number as csv_text() writes it.
[[nodiscard]] std::string csv_number(double value);
/// Appends a number to a text as csv_text() writes it.
/// @param digits  significant digits; with k_all_digits as few of them as restore the value. Integers below 1e15 are
///                written with all their digits.
void append_csv_number(std::string& text, double value, int digits = k_all_digits);

/// Number in a cell of a CSV file; none if any part of the cell is not a number. Independent of the locale.
[[nodiscard]] std::optional<double> parsed_number(std::string_view cell) noexcept;
/// Column without labels of a heading: name and unit.
[[nodiscard]] Column parsed_heading(std::string_view heading);
/// Key and value of a line `# key: value`, which has to begin with `#`.
[[nodiscard]] std::pair<std::string, std::string> parsed_header_line(std::string_view line);

/// Text of a table as CSV: `# key: value` lines, one row of headings, and the rows (`nan` for undefined values),
/// independent of the locale. Numbers have as few digits, at most 17, as read_csv() needs to restore bitwise equal
/// doubles. Nothing is quoted; a line break in a header line becomes a space.
/// @param digits  significant digits; fewer than k_all_digits suit measured values, which are then not restored bitwise
/// @throws std::invalid_argument if a heading or a word contains a comma, a quote or a line break
[[nodiscard]] std::string csv_text(const Table& table, int digits = k_all_digits);

/// Passes the text of csv_text() to a sink: the header with the headings, then each row.
/// @throws std::invalid_argument as csv_text()
void for_each_csv_part(const Table& table, const TextSink& sink, int digits = k_all_digits);

/// Writes the text of a table to a file, completely or not at all, without ever holding the whole text.
/// @throws std::runtime_error naming the file and why it cannot be written
/// @throws std::invalid_argument as csv_text()
void write_csv(const std::filesystem::path& file, const Table& table);

/// Reads a file with csv_text(), or any CSV with one row of headings and optional `#` lines. Without a comma among the
/// headings, semicolons or tabs separate the cells, and commas mark decimals; UTF-16 is read by its byte order mark.
/// Blank lines, blanks around cells, a byte order mark and CRLF line ends are accepted; quotes have no meaning. A
/// column with a cell that is neither a number nor empty is one of words, as is one without numbers. An empty cell is
/// undefined among numbers (NaN) and the empty word among words.
/// @throws std::runtime_error `file:line:column: message` for a missing or empty file, ragged rows, no row of headings,
/// two columns with the same heading, a file of more than 1 GiB or 100 million cells, a line of more than 1 MiB
[[nodiscard]] Table read_csv(const std::filesystem::path& file, FileKind kind = FileKind::any);

}  // namespace monograin
