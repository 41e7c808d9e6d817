/// Curves of a run: columns of numbers under their names.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace monograin {

class Table;

/// A table of columns, each an array of its own. Copies share their values, which never change; spans into them hold as
/// long as one of the copies lives. May be read from many threads.
class History {
 public:
  struct Column {
    std::string name;                 ///< without the unit, e.g. "axial.force"
    std::string unit;                 ///< SI, "-" of a pure number; empty: it counts, or holds words
    std::vector<std::string> labels;  ///< of a column of words: its values are indices into them
    std::vector<double> values;       ///< NaN where a quantity is undefined
  };

  /// No columns.
  History();
  /// Curves of one's own, such as measured ones.
  /// @throws std::invalid_argument where the columns differ in length
  explicit History(std::vector<Column> columns);
  /// The columns of a table that was recorded.
  explicit History(std::shared_ptr<const Table> table);

  [[nodiscard]] std::size_t row_count() const noexcept;
  /// Names of the columns, without units, in the order of the files.
  [[nodiscard]] std::vector<std::string_view> names() const;
  [[nodiscard]] bool contains(std::string_view name) const noexcept;

  /// @param name  of a column, with or without its unit: "axial.force" or "axial.force[N]"
  /// @throws std::out_of_range that names the nearest column
  [[nodiscard]] const Column& column(std::string_view name) const;
  /// Values of a column, one for each row.
  [[nodiscard]] std::span<const double> operator[](std::string_view name) const { return column(name).values; }
  /// Words of a column, one for each row. @throws std::out_of_range where it holds numbers, too
  [[nodiscard]] std::vector<std::string_view> words(std::string_view name) const;

  /// The rows that the columns are made of.
  [[nodiscard]] const Table& table() const noexcept;

 private:
  struct Content;
  std::shared_ptr<Content> content_;
};

}  // namespace monograin
