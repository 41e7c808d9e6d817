#include "monograin/history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "api/checked.hpp"
#include "api/untrapped.hpp"
#include "history/compare.hpp"
#include "history/table.hpp"
#include "monograin/comparison.hpp"
#include "scenario/words.hpp"

namespace monograin {
namespace {

/// @throws std::invalid_argument for a value that is neither the index of a label nor NaN
void require_labels_of_values(const History::Column& column) {
  if (column.labels.empty()) return;
  for (const double value : column.values) {
    const bool is_index =
        value >= 0.0 && value < static_cast<double>(column.labels.size()) && value == std::floor(value);
    if (is_index || std::isnan(value)) continue;
    throw std::invalid_argument(fmt::format("column '{}' has the value {}; expected indices of its {} labels, or NaN",
                                            column.name, value, column.labels.size()));
  }
}

/// Makes a table of columns.
/// @throws std::invalid_argument if columns differ in length or have the same name and unit, or labels lack a value
Table table_of(const std::vector<History::Column>& columns) {
  const Untrapped untrapped;
  std::vector<Column> headings;
  for (const History::Column& column : columns) {
    if (column.values.size() != columns.front().values.size()) {
      throw std::invalid_argument(fmt::format("column '{}' has {} rows and column '{}' {}; expected as many in each",
                                              columns.front().name, columns.front().values.size(), column.name,
                                              column.values.size()));
    }
    require_labels_of_values(column);
    headings.push_back({column.name, column.unit, column.labels});
    const auto is_same = [&](const Column& other) { return other.name == column.name && other.unit == column.unit; };
    if (std::ranges::count_if(headings, is_same) > 1) {
      throw std::invalid_argument(fmt::format("there are two columns '{}'; expected one", headings.back().heading()));
    }
  }
  Table table(std::move(headings));
  std::vector<double> row(columns.size());
  for (std::size_t i = 0; !columns.empty() && i < columns.front().values.size(); ++i) {
    for (std::size_t k = 0; k < row.size(); ++k) row[k] = columns[k].values[i];
    table.append(row);
  }
  return table;
}

}  // namespace

/// The recorded table, and contiguous copies of its columns, each made at its first use.
struct History::Content {
  explicit Content(std::shared_ptr<const Table> rows) : table(std::move(rows)), columns(table->columns().size()) {}

  [[nodiscard]] const Column& column(std::size_t k) {
    const std::lock_guard lock(mutex);
    if (!columns[k]) {
      const auto& [name, unit, labels] = table->columns()[k];
      std::vector<double> values(table->row_count());
      for (std::size_t row = 0; row < values.size(); ++row) values[row] = table->at(row, k);
      columns[k] = std::make_unique<const Column>(Column{name, unit, labels, std::move(values)});
    }
    return *columns[k];
  }

  std::shared_ptr<const Table> table;
  std::vector<std::unique_ptr<const Column>> columns;
  std::mutex mutex;
};

History::History() : History(std::vector<Column>{}) {}
History::History(std::vector<Column> columns) : History(std::make_shared<const Table>(table_of(columns))) {}
History::History(std::shared_ptr<const Table> table) : content_(std::make_shared<Content>(std::move(table))) {}

History history_of(Table table) { return History(std::make_shared<const Table>(std::move(table))); }

std::size_t History::row_count() const noexcept { return table().row_count(); }

std::vector<std::string_view> History::names() const& {
  std::vector<std::string_view> names;
  for (const auto& column : table().columns()) names.push_back(column.name);
  return names;
}

bool History::contains(std::string_view name) const noexcept { return table().find(name).has_value(); }

const History::Column& History::column(std::string_view name) const& {
  if (const auto found = table().find(name)) return content_->column(*found);
  const std::vector<std::string_view> candidates = names();
  const std::string meant = did_you_mean(name, candidates);
  throw std::out_of_range(fmt::format("there is no column '{}'{}", shown(name),
                                      meant.empty() ? "; expected one of: " + listed(candidates) : meant));
}

std::vector<std::string_view> History::words(std::string_view name) const& {
  const Column& found = column(name);
  if (found.labels.empty()) {
    throw std::out_of_range(
        fmt::format("column '{}' holds numbers; expected one of words, such as a regime", found.name));
  }
  std::vector<std::string_view> words;
  for (const double value : found.values) {
    words.push_back(std::isnan(value) ? std::string_view() : found.labels[static_cast<std::size_t>(value)]);
  }
  return words;
}

const Table& History::table() const noexcept { return *content_->table; }

Comparison compare(const History& reference, const History& other, const std::string& x, const std::string& y) {
  const Untrapped untrapped;
  return compare_tables(reference.table(), other.table(), x, y);
}

}  // namespace monograin
