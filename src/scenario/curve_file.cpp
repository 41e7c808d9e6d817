#include "scenario/curve_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "scenario/cells.hpp"
#include "scenario/language.hpp"
#include "scenario/measured_data.hpp"
#include "scenario/words.hpp"

namespace monograin {
namespace {

constexpr std::string_view k_example_headings = "delta_max_over_R,p_over_Y";

class CurveParser {
 public:
  CurveParser(const std::string& origin, FaultList& faults) : origin_(origin), faults_(faults) {}

  SampledCurve parse(std::string_view text) {
    std::string_view rest = without_byte_order_mark(text);
    while (!rest.empty() && found_ < k_most_shown_faults) {
      ++line_;
      add_line(take_line(rest));
    }
    if (found_ < k_most_shown_faults) {
      check_length();
    } else if (!rest.empty()) {
      ++line_;
      fault(1, "too many faults above; the rest of the table is not checked");
    }
    curve_.text = text;
    return std::move(curve_);
  }

 private:
  void add_line(std::string_view line) {
    if (is_comment(line)) return;
    const std::vector<Cell> cells = cells_of(line);
    if (cells.size() != headings_.size()) {
      fault(line.find_first_not_of(" \t") + 1,
            fmt::format("{} cell{} where 2 are expected, for example {}", cells.size(), cells.size() == 1 ? "" : "s",
                        has_headings_ ? "0.1,2.1" : k_example_headings));
      has_headings_ = true;  // the next row is not a row of headings
      ++rows_;
    } else if (has_headings_) {
      take_row(cells);
    } else {
      take_headings(cells);
    }
  }

  void take_headings(const std::vector<Cell>& cells) {
    has_headings_ = true;
    if (std::ranges::any_of(cells, [](const Cell& cell) { return number_in(cell.text).has_value(); })) {
      fault(cells.front().column,
            fmt::format("numbers where a row of headings is expected, for example {}", k_example_headings));
      return take_row(cells);
    }
    for (std::size_t k = 0; k < headings_.size(); ++k) {
      if (!cells[k].text.empty()) headings_[k] = shown(cells[k].text);
    }
  }

  void take_row(const std::vector<Cell>& cells) {
    ++rows_;
    const auto x = number(cells, 0, 0.0);
    const auto y = number(cells, 1, k_least_sample);
    if (x) {
      check_order(cells[0], *x);
      curve_.x.push_back(*x);
    }
    if (y) curve_.y.push_back(*y);
  }

  std::optional<double> number(const std::vector<Cell>& cells, std::size_t k, double least) {
    const std::optional<double> value = number_in(cells[k].text);
    if (value && *value >= least && *value <= k_greatest_sample) return value;
    fault(cells[k].column,
          fmt::format("{} = {}: expected a number from {:g} to {:g}", headings_[k],
                      cells[k].text.empty() ? "(nothing)" : shown(cells[k].text), least, k_greatest_sample));
    return std::nullopt;
  }

  void check_order(const Cell& cell, double x) {
    if (rows_ == 1 && x != 0.0) {
      fault(cell.column, fmt::format("{} = {}: expected 0 in the first row", headings_[0], shown(cell.text)));
    } else if (!curve_.x.empty() && !(x - curve_.x.back() >= k_least_sample)) {
      fault(cell.column, fmt::format("{} = {}: not above the one before, {}; expected ascending values at least {:g} "
                                     "apart",
                                     headings_[0], shown(cell.text), curve_.x.back(), k_least_sample));
    }
  }

  void check_length() {
    line_ = std::max<std::size_t>(line_, 1);
    if (!has_headings_) {
      fault(1, fmt::format("the table is empty; expected a row of headings, for example {}, and at least {} rows of "
                           "numbers",
                           k_example_headings, k_least_samples));
    } else if (rows_ < k_least_samples) {
      fault(1, fmt::format("the table ends after {} row{}; expected at least {}", rows_, rows_ == 1 ? "" : "s",
                           k_least_samples));
    }
  }

  void fault(std::size_t column, std::string message) {
    ++found_;
    faults_.add({origin_, line_, column}, std::move(message));
  }

  const std::string& origin_;
  FaultList& faults_;
  SampledCurve curve_;
  std::array<std::string, 2> headings_{"x", "y"};
  bool has_headings_ = false;
  std::size_t line_ = 0;
  std::size_t rows_ = 0;
  std::size_t found_ = 0;
};

}  // namespace

SampledCurve parse_curve(std::string_view text, const std::string& origin, FaultList& faults) {
  return CurveParser(origin, faults).parse(text);
}

SampledCurve parse_columns(std::string_view text, const std::string& origin, std::span<const QuantityKey> columns,
                           const SourceLocation& named_at, std::string_view naming, FaultList& faults) {
  std::vector<ColumnRequest> wanted;
  for (const QuantityKey& column : columns) {
    wanted.push_back({std::string(column.name), named_at, fmt::format("{}: column '{}'", naming, column.name)});
  }
  const std::size_t before = faults.size();
  MeasuredData data = parse_measured(text, origin, wanted, faults, {.may_have_trailer = false});
  SampledCurve table{.text = std::move(data.text)};
  if (faults.size() > before) return table;
  std::map<std::pair<double, double>, std::size_t> lines;  // lines of earlier rows, by their first two columns
  for (std::size_t row = 0; row < data.lines.size() && faults.size() < before + k_most_shown_faults; ++row) {
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const double value = data.columns[k].values[row];
      const KeySpec spec = quantity_key(columns[k]);
      if (finite_range(spec).contains(value)) continue;
      faults.add({origin, data.lines[row], data.columns[k].at[row]},
                 fmt::format("{} = {}: expected {}", columns[k].name, value, expectation(spec)));
    }
    const std::pair place(data.columns[0].values[row], data.columns[1].values[row]);
    const auto [entry, is_new] = lines.try_emplace(place, data.lines[row]);
    if (is_new) continue;
    faults.add({origin, data.lines[row], data.columns[0].at[row]},
               fmt::format("{} = {} with {} = {} stands in line {} already; expected one row for each pair",
                           columns[0].name, place.first, columns[1].name, place.second, entry->second));
  }
  table.x = std::move(data.columns[0].values);
  table.y = std::move(data.columns[1].values);
  for (std::size_t k = 2; k < columns.size(); ++k) table.values.push_back(std::move(data.columns[k].values));
  return table;
}

SampledCurve take_curve(const FileText& file, const std::string& name, std::span<const QuantityKey> columns,
                        const SourceLocation& named_at, std::string_view naming, FaultList& faults) {
  const auto& [text, problem] = file;
  if (!problem.empty()) {
    std::string headings(k_example_headings);
    for (const QuantityKey& column : columns) {
      if (&column == columns.data()) headings.clear();
      if (!headings.empty()) headings += ',';
      headings += column.name;
    }
    faults.add(named_at,
               fmt::format("{}: {} ({}); expected a table of {} such as {}, its path relative to the "
                           "scenario's folder",
                           naming, problem, on_one_line(name), columns.empty() ? "two columns" : "columns", headings));
    return {};
  }
  if (text.size() > k_largest_table) {
    faults.add({name}, fmt::format("the table is too large; expected at most {} MiB", k_largest_table >> 20U));
    return {};
  }
  if (!columns.empty()) return parse_columns(text, name, columns, named_at, naming, faults);
  return parse_curve(text, name, faults);
}

}  // namespace monograin
