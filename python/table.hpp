/// Tables whose columns numpy sees without a copy.
#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "history/table.hpp"

namespace monograin::python {

/// A table that nobody changes any more, with its columns one after another.
class TableView {
 public:
  explicit TableView(std::shared_ptr<const Table> table) : table_(std::move(table)) {}

  [[nodiscard]] const Table& table() const noexcept { return *table_; }
  /// Values of a column, which live as long as this object. The first call transposes the table.
  [[nodiscard]] std::span<const double> column(std::size_t index);

 private:
  std::shared_ptr<const Table> table_;
  std::once_flag is_transposed_;
  std::vector<double> values_;  ///< column by column
};

[[nodiscard]] std::shared_ptr<TableView> view_of(Table table);

}  // namespace monograin::python
