/// Report on a file of measured data as it was read, before any fit.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "catalogue.hpp"
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

/// Path of x from one turning point to the next.
struct DataBranch {
  std::size_t begin = 0;   ///< rows
  std::size_t end = 0;     ///< the last row, in which the next branch begins
  bool is_loading = true;  ///< |x| grows
  double x_begin = 0.0;    ///< where x turns, in the file's unit: of noisy data beside the noise of the rows
  double x_end = 0.0;
  std::size_t held_begin = 0;  ///< rows in which x is held after the branch: the first one, and the one after the last
  std::size_t held_end = 0;
};

/// x or y as in the file.
struct DataAxis {
  std::size_t number = 0;  ///< of the column, from 1
  std::string name;        ///< heading, or "column 2"
  std::string unit;        ///< unit of the values
  std::vector<double> values;
};

struct DataReport {
  std::string file;
  TableLayout layout;
  std::vector<ColumnSummary> columns;
  DataAxis x;
  DataAxis y;
  std::vector<std::size_t> lines;    ///< line numbers of the rows with x and y
  std::size_t left_out = 0;          ///< rows without x or y
  std::vector<std::size_t> trailer;  ///< lines of text below the table
  std::vector<DataBranch> branches;
  std::vector<std::string> remarks;  ///< how a calibration interprets x and y, or why it would refuse them
};

/// The columns to use as x and y: a heading or a number. Empty: the first columns of the dimensions, else the first two
/// columns of numbers.
struct DataChoice {
  std::string x;
  std::string y;
  Dimension x_dimension = Dimension::length;
  Dimension y_dimension = Dimension::force;
  const char* x_named = "--x";  ///< names of x and y in messages
  const char* y_named = "--y";
};

/// "2 lines from line 15"; empty if there are none.
[[nodiscard]] std::string trailer_text(const std::vector<std::size_t>& lines);

/// Reads a table of measured data. @throws ScenarioError with its faults
[[nodiscard]] DataReport report_of_file(const std::filesystem::path& file, const DataChoice& choice = {});

/// Reads the data of a calibration from the folder of its results, without what the machine adds.
[[nodiscard]] DataReport report_of_calibration(const std::filesystem::path& folder, DataChoice choice = {});

/// Reports on the data of a calibration's curves, with the x and y that the calibration uses.
[[nodiscard]] std::vector<DataReport> reports_of(const Calibration& calibration);

/// The report as text: how the file is written, its columns, and the branches of loading and unloading.
[[nodiscard]] std::string data_text(const DataReport& report);

/// Chart of y over x, with separate loading and unloading, and the turning points.
[[nodiscard]] figure::Chart data_chart(const std::vector<DataReport>& reports);

/// Draws data_chart. @param output  svg, pdf or png; its script and data lie beside it
/// @throws FigureError
void draw_data(const std::vector<DataReport>& reports, const std::filesystem::path& output);

}  // namespace monograin
