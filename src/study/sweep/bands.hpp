/// Percentile bands of a sweep's histories: the spread of curves due to uncertain inputs.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "figure/figure.hpp"
#include "history/table.hpp"
#include "study/sweep/sweep_file.hpp"

namespace monograin {

/// Table of the bands in the folder of a sweep.
inline constexpr const char* k_bands_file = "bands.csv";

/// Percentiles of one step of the program, over abscissae that all runs share.
struct StepBands {
  std::size_t step = 0;  ///< from 1
  std::vector<double> x;
  std::vector<std::size_t> runs{};  ///< that reach x in this step
  /// For each y and each percentile the values over x; nan where less than 95 % of the runs have a value.
  std::vector<std::vector<std::vector<double>>> percentiles{};
};

struct HistoryBands {
  Column x;
  std::vector<Column> y;
  std::vector<StepBands> steps;
};

/// Interpolates the histories of all runs at common abscissae, step by step, because a history that goes back and forth
/// has several y over one x. Abscissae go from the first to the last x that any run has in the step.
/// @param folder  of a sweep that has been run, with its histories
/// @throws std::runtime_error naming a column that a history does not have, and those that it has; and if no run has a
/// history
[[nodiscard]] HistoryBands bands_of(const Sweep& sweep, const std::filesystem::path& folder);

/// Writes bands.csv, with a row for each step and abscissa, and the figure `bands`: median and outermost percentiles, a
/// panel for each y.
/// @param format  of the figure, one of figure::k_formats
/// @return why there is no figure; empty: there is one
[[nodiscard]] std::string write_bands(const Sweep& sweep, const HistoryBands& bands,
                                      const std::filesystem::path& folder,
                                      std::string_view format = figure::k_usual_format);

}  // namespace monograin
