/// Files of a sweep: its results, a row for each run, as CSV or as HDF5; and its design.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "history/table_file.hpp"
#include "study/sweep/sweep_file.hpp"

namespace monograin {

enum class ResultsFormat : std::size_t { csv, hdf5 };
/// Names that users give the formats, in their order.
inline constexpr std::array<std::string_view, 2> k_results_formats{"csv", "hdf5"};

/// Format of a name; none if the name is empty. @throws std::invalid_argument for another name
[[nodiscard]] std::optional<ResultsFormat> results_format(std::string_view name);

/// Name of the file that repeats a sweep: its text, and all files that it and its scenario name.
inline constexpr const char* k_sweep_record = "sweep.json";

[[nodiscard]] std::filesystem::path results_file(const std::filesystem::path& folder, ResultsFormat format);

/// Format of the results, of whatever sweep, that the program has written in a folder; CSV if there are none.
[[nodiscard]] ResultsFormat format_in(const std::filesystem::path& folder);

/// Finds the results of a sweep in a folder, and converts them with write_results() if they are in another format than
/// the wanted one. Those in HDF5 are then all in memory.
/// @param wanted  none: any format
/// @return their file; none if the folder has no results of this sweep
/// @throws std::runtime_error if the folder has results, of this or another sweep, that were changed after they were
///         written, or if the converted ones cannot be written
[[nodiscard]] std::optional<std::filesystem::path> found_results(const Sweep& sweep,
                                                                 const std::filesystem::path& folder,
                                                                 std::optional<ResultsFormat> wanted);

/// Writes the results of a sweep into a folder, completely or not at all, and removes what killed processes have
/// written there in part; no other process may write there. The lines of the file before its rows name
/// program, sweep and design, and have digests of the sweep and of all that follows them.
/// @return the file
/// @throws std::runtime_error naming the file and why it cannot be written
[[nodiscard]] std::filesystem::path write_results(const Sweep& sweep, const std::filesystem::path& folder,
                                                  ResultsFormat format, const TableLines& lines);

/// Number of runs in a file of results that were refused, stopped or failed.
[[nodiscard]] std::size_t count_ended_early(const std::filesystem::path& results);

/// Writes the file that repeats the sweep. @throws std::runtime_error naming the file and why it cannot be written
void write_sweep_record(const Sweep& sweep, const std::filesystem::path& folder);

/// Removes results of other sweeps in any format, but no file that the program has not written.
void remove_other_results(const Sweep& sweep, const std::filesystem::path& folder);

/// Runs as a CSV table, which `design = "table"` reads back bit by bit.
[[nodiscard]] std::string design_text(const Sweep& sweep);

}  // namespace monograin
