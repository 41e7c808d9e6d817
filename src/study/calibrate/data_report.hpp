/// Report of a file of measured data as it was read, to be seen before anything is fitted.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "figure/chart.hpp"
#include "scenario/table_layout.hpp"
#include "study/calibrate/calibration.hpp"

namespace monograin {

/// One column of the file.
struct ColumnSummary {
  std::string heading;
  std::string unit;
  bool is_numeric = true;
  std::size_t values = 0;
  std::size_t missing = 0;
  double lowest = 0.0;  ///< in the file's unit
  double highest = 0.0;
};

/// A way of x from one turning point to the next.
struct DataBranch {
  std::size_t begin = 0;   ///< rows
  std::size_t end = 0;     ///< the last one, in which the next way begins
  bool is_loading = true;  ///< |x| grows
};

/// x over y as they stand in the file.
struct DataAxis {
  std::size_t number = 0;  ///< of the column, from 1
  std::string name;        ///< heading, or "column 2"
  std::string unit;        ///< in which the values are
  std::vector<double> values;
};

struct DataReport {
  std::string file;
  TableLayout layout;
  std::vector<ColumnSummary> columns;
  DataAxis x;
  DataAxis y;
  std::vector<std::size_t> lines;  ///< of the rows with x and y
  std::size_t left_out = 0;        ///< rows without x or y
  std::vector<DataBranch> branches;
  std::vector<std::string> remarks;  ///< what a calibration makes of x and y
};

/// Which columns are x and y: a heading or a number; empty: the first length and the first force, else the first two
/// columns of numbers.
struct DataChoice {
  std::string x;
  std::string y;
};

/// Reads a table of measured data. @throws ScenarioError with its faults
[[nodiscard]] DataReport report_of_file(const std::filesystem::path& file, const DataChoice& choice = {});

/// Those of a calibration's curves, with the x and y that it takes.
[[nodiscard]] std::vector<DataReport> reports_of(const Calibration& calibration);

/// The report for a reader: how the file is written, its columns, and the ways of loading and unloading.
[[nodiscard]] std::string data_text(const DataReport& report);

/// y over x, loading and unloading apart, with the turning points.
[[nodiscard]] figure::Chart data_chart(const std::vector<DataReport>& reports);

/// Draws data_chart. @param output  svg, pdf or png; its script and data lie beside it
/// @throws FigureError
void draw_data(const std::vector<DataReport>& reports, const std::filesystem::path& output);

}  // namespace monograin
