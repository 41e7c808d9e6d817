/// Tables in files, as CSV or as HDF5.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "history/table.hpp"
#include "scenario/text_file.hpp"

namespace monograin {

/// Ending of the names of HDF5 files.
inline constexpr std::string_view k_hdf5_extension = ".h5";

// Names of the results in the folder of a sweep.
inline constexpr std::string_view k_csv_results = "results.csv";
inline constexpr std::string_view k_hdf5_results = "results.h5";

/// Reads a table: one written by write_hdf5() if the name ends with `.h5`, otherwise CSV.
/// @throws std::runtime_error naming the file and what is wrong with it, as read_csv() and read_hdf5()
[[nodiscard]] Table read_table_file(const std::filesystem::path& file, FileKind kind = FileKind::any);

/// Checks that HDF5 can be used; call it before a long computation.
/// @throws std::runtime_error with a remedy if its library is not installed
void expect_hdf5();

/// Passes the lines of a table to a sink, without ends of lines: the row of headings, then the rows, as csv_text()
/// prints them. It may be called more than once.
using TableLines = std::function<void(const TextSink& sink)>;

/// Content of an HDF5 file beside the rows of its table.
struct Hdf5Frame {
  std::filesystem::path shown_as{};  ///< name of the file in messages; empty: its own
  std::size_t free_bytes = 0;  ///< at the beginning of the file, left to the caller; 0, or a power of 2 from 512 on
  std::vector<std::pair<std::string, std::string>> attributes{};  ///< of the file: names and texts
  std::function<std::string(const Column&)> group_of;  ///< group of a column's dataset; empty: the file itself
};

/// Writes a table as HDF5: a dataset for each column, in groups, with the attributes `name` and `unit`.
///
/// Datasets have one dimension, the rows, in compressed chunks. Numbers are doubles, bitwise those of the lines; words
/// are UTF-8 texts of fixed length, filled up with zeros. The name of a dataset is that of its column, with `:` for
/// `/`, which separates groups. A chunk of each column is in memory at a time, and equal lines give equal bytes.
/// @param file  is replaced
/// @throws std::runtime_error naming the file and why it cannot be written; a partly written file then stays
/// @throws std::invalid_argument for lines whose numbers of cells differ, and for a cell that is no number in a column
///         with a unit
void write_hdf5(const std::filesystem::path& file, const Hdf5Frame& frame, const TableLines& lines);

/// Reads a table from a file of write_hdf5(), with lines `# key: value` at its beginning as the header.
/// @param only  name of the one column to read; empty: the whole table
/// @throws std::runtime_error naming the file and why it cannot be read: among others, more than 1000 million cells
[[nodiscard]] Table read_hdf5(const std::filesystem::path& file, std::string_view only = {});

}  // namespace monograin
