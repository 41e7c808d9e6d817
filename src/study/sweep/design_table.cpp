#include "study/sweep/design_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "scenario/cells.hpp"

namespace monograin {
namespace {

/// The first separator of a row of headings among those of spreadsheets. A comma is also the separator of one column.
char separator_of(std::string_view headings) {
  const std::size_t at = headings.find_first_of(",;\t");
  return at == std::string_view::npos ? ',' : headings[at];
}

/// The text of a cell; a decimal comma of the number at its beginning becomes a point, unless commas separate cells.
std::string text_of(std::string_view cell, char separator) {
  std::string text(cell);
  const std::size_t number_end = std::min(text.find_first_not_of("+-.,0123456789eE"), text.size());
  const bool has_decimal_comma = separator != ',' && number_in(cell.substr(0, number_end), ',');
  if (has_decimal_comma) std::replace(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(number_end), ',', '.');
  return text;
}

}  // namespace

DesignTable parse_design_table(std::string_view text, const std::string& origin, FaultList& faults) {
  text = without_byte_order_mark(text);
  DesignTable table;
  const std::size_t faults_before = faults.size();
  char separator = ',';
  for (std::size_t number = 1; !text.empty() && faults.size() < faults_before + k_most_shown_faults; ++number) {
    const std::string_view line = take_line(text);
    if (is_comment(line)) continue;
    std::vector<DesignTable::Cell> cells;
    if (table.headings.empty()) separator = separator_of(line);
    for (const Cell& cell : cells_of(line, separator)) {
      cells.push_back({text_of(cell.text, separator), {origin, number, cell.column}});
    }
    if (table.headings.empty()) {
      table.headings = std::move(cells);
    } else if (cells.size() == table.headings.size()) {
      table.rows.push_back(std::move(cells));
    } else {
      faults.add({origin, number, 1},
                 fmt::format("the row has {} cells, but there are {} headings", cells.size(), table.headings.size()));
    }
  }
  if (table.rows.empty() && faults.size() == faults_before) {
    faults.add({origin},
               "the table has no rows; expected a row of keys such as material.yield_stress[MPa], and below "
               "it a row for each run");
  }
  return table;
}

DesignHeading parse_design_heading(std::string_view heading) {
  const std::size_t bracket = heading.rfind('[');
  if (bracket == std::string_view::npos || !heading.ends_with(']')) return {std::string(heading), {}};
  const std::string_view unit = heading.substr(bracket + 1, heading.size() - bracket - 2);
  const bool is_index = unit.find_first_not_of("0123456789") == std::string_view::npos;
  if (is_index) return {std::string(heading), {}};
  // The unit of a pure number is written as in histories.
  return {std::string(heading.substr(0, bracket)), unit == "-" ? std::string() : std::string(unit)};
}

}  // namespace monograin
