/// Columns of numbers from a table that was measured.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/faults.hpp"
#include "scenario/table_layout.hpp"

namespace monograin {

/// A requested column, with the position and the text of the request: `x = "force[N]"`, `x = 2`.
struct ColumnRequest {
  std::string name{};  ///< a heading, with or without its unit; empty: `number` selects the column
  SourceLocation where;
  std::string naming{};
  std::size_t number = 0;  ///< from 1; 0: `name` selects the column
};

struct MeasuredColumn {
  std::size_t number = 0;  ///< number of the column, from 1; 0 if there is no such column
  std::string heading;     ///< as in the file; empty if it has none
  std::string unit;        ///< see TableLayout
  std::vector<double> values;
  std::vector<std::size_t> at;  ///< position of each value in its line, from 1
};

struct MeasuredData {
  std::vector<MeasuredColumn> columns;  ///< in the order of the requests
  std::vector<std::size_t> lines;       ///< of each row in the file, from 1
  std::vector<std::size_t> left_out;    ///< lines of the rows without a number in one of the columns
  std::vector<std::size_t> trailer;     ///< lines of text below the table
  TableLayout layout;
  std::string text;  ///< the file as it was read, in UTF-8
};

/// Reads a table of numbers. Lines that begin with '#', blank lines, lines of separators, and columns that were not
/// requested do not count. Every cell has to be a finite number. A cell that is empty or marks a missing number (nan,
/// n/a, a dash, an error of a spreadsheet) leaves its row out, as long as `format` admits so many. Lines of text
/// below the last row, in which no cell begins as a number does, are left out if `format` admits them.
///
/// The result is only meaningful if nothing was added to `faults`. Reports the first twenty faults of the table, with
/// line and column.
/// @param bytes  the file, in any encoding that decode_text knows
[[nodiscard]] MeasuredData parse_measured(std::string_view bytes, const std::string& origin,
                                          const std::vector<ColumnRequest>& wanted, FaultList& faults,
                                          const TableFormat& format = {});

}  // namespace monograin
