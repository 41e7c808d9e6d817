/// Curves of a run as named columns of numbers.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace monograin {

class Table;

/// An immutable table of named columns, each a contiguous array with one value per row.
///
/// Copies share their values: a span or reference into them is valid as long as one copy lives. Any number of threads
/// may read one history.
class History {
 public:
  struct Column {
    std::string name;                 ///< without the unit, e.g. "axial.force"
    std::string unit;                 ///< SI, "-" for a pure number; empty for a counter or a column of words
    std::vector<std::string> labels;  ///< if not empty, the column holds words: values are indices into `labels`
    std::vector<double> values;       ///< NaN where a quantity is undefined
  };

  /// A history without columns.
  History();
  /// A history of your own curves, such as measured ones.
  /// @throws std::invalid_argument if columns differ in length, two have the same name and unit, or a value of a column
  ///         of words is neither the index of a label nor NaN
  explicit History(std::vector<Column> columns);
  /// A history over a recorded table, which it shares.
  explicit History(std::shared_ptr<const Table> table);
  /// A history that was moved from stays as it was.
  History(const History&) = default;
  History& operator=(const History&) = default;
  ~History() = default;

  [[nodiscard]] std::size_t row_count() const noexcept;  ///< number of rows
  /// Names of the columns, without units, in the order in which history.csv has them.
  [[nodiscard]] std::vector<std::string_view> names() const&;
  [[nodiscard]] std::vector<std::string> names() const&& { return copied(names()); }  ///< copies
  /// True if there is a column of that name, given with or without its unit.
  [[nodiscard]] bool contains(std::string_view name) const noexcept;

  /// The column of that name: name, unit, labels and values.
  /// @param name  name of a column, with or without its unit: "axial.force" or "axial.force[N]"
  /// @throws std::out_of_range for an unknown name; the message suggests the nearest one
  [[nodiscard]] const Column& column(std::string_view name) const&;
  [[nodiscard]] Column column(std::string_view name) const&& { return column(name); }  ///< a copy
  /// Values of a column in its unit, one for each row; NaN where the quantity is undefined.
  /// @throws std::out_of_range for an unknown name
  [[nodiscard]] std::span<const double> operator[](std::string_view name) const& { return column(name).values; }
  /// Copy of the values, which would otherwise end with a history that is a temporary, such as that of a call of run().
  [[nodiscard]] std::vector<double> operator[](std::string_view name) const&& { return column(name).values; }
  /// Words of a column, one for each row, such as the regimes of a contact; empty where the value is NaN.
  /// @throws std::out_of_range for an unknown name, or a column of numbers
  [[nodiscard]] std::vector<std::string_view> words(std::string_view name) const&;
  [[nodiscard]] std::vector<std::string> words(std::string_view name) const&& {
    return copied(words(name));
  }  ///< copies

  /// The recorded table, row by row, that this history reads.
  [[nodiscard]] const Table& table() const noexcept;

 private:
  static std::vector<std::string> copied(const std::vector<std::string_view>& texts) {
    return {texts.begin(), texts.end()};
  }

  struct Content;
  std::shared_ptr<Content> content_;
};

}  // namespace monograin
