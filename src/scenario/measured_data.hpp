/// Columns of numbers from a table that somebody, or a machine, has measured.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/faults.hpp"
#include "scenario/table_layout.hpp"

namespace monograin {

/// A column that is asked for, and where and how: `x = "force[N]"`, `x = 2`.
struct ColumnRequest {
  std::string name;  ///< a heading, or a heading without its unit; empty: the number counts
  SourceLocation where;
  std::string naming;
  std::size_t number = 0;  ///< from 1; 0: the name counts
};

struct MeasuredColumn {
  std::size_t number = 0;  ///< place of the column, from 1; 0 where there is no such column
  std::string heading;     ///< as in the file; empty where it has none
  std::string unit;        ///< see TableLayout
  std::vector<double> values;
  std::vector<std::size_t> at;  ///< place of each value in its line, from 1
};

struct MeasuredData {
  std::vector<MeasuredColumn> columns;  ///< in the order in which they were asked for
  std::vector<std::size_t> lines;       ///< of each row in the file, from 1
  std::vector<std::size_t> left_out;    ///< lines of the rows without a number in one of the columns
  TableLayout layout;
  std::string text;  ///< the file as it was read, in UTF-8
};

/// Reads a table of numbers. Lines that begin with '#', blank lines and lines of separators do not count, nor do
/// columns that were not asked for. Every cell has to be a finite number. A cell that is empty or says that there is
/// none (nan, n/a, a dash) leaves its row out, as long as no more rows are left out than `format` admits.
///
/// What comes back is only meaningful if nothing was added to `faults`: the first twenty of the table, each with line
/// and column.
/// @param bytes  the file, in any encoding that decode_text knows
[[nodiscard]] MeasuredData parse_measured(std::string_view bytes, const std::string& origin,
                                          const std::vector<ColumnRequest>& wanted, FaultList& faults,
                                          const TableFormat& format = {});

}  // namespace monograin
