/// Columns of numbers from a table that somebody measured.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/faults.hpp"

namespace monograin {

/// A column that is asked for, and where and how: `x = "force[N]"`.
struct ColumnRequest {
  std::string name;  ///< a heading, or a heading without its unit
  SourceLocation where;
  std::string naming;
};

struct MeasuredColumn {
  std::string heading;  ///< as in the file; empty where there is no such column
  std::vector<double> values;
  std::vector<std::size_t> at;  ///< place of each value in its line, from 1
};

struct MeasuredData {
  std::vector<MeasuredColumn> columns;  ///< in the order in which they were asked for
  std::vector<std::size_t> lines;       ///< of each row in the file, from 1
  std::string text;                     ///< the file as it was read
};

/// Reads CSV with commas and one row of headings. Lines that begin with '#' and blank lines do not count, nor do
/// columns that were not asked for. Every cell has to be a finite number.
///
/// What comes back is only meaningful if nothing was added to `faults`: the first twenty of the table, each with line
/// and column.
[[nodiscard]] MeasuredData parse_measured(std::string_view text, const std::string& origin,
                                          const std::vector<ColumnRequest>& wanted, FaultList& faults);

/// The heading's unit: "N" of "force[N]"; empty where it has none.
[[nodiscard]] std::string_view unit_in(std::string_view heading) noexcept;
/// The heading without its unit.
[[nodiscard]] std::string_view name_in(std::string_view heading) noexcept;

}  // namespace monograin
