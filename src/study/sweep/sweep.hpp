/// Runs sweeps: on all cores, in several processes, and from where an interrupted sweep stopped.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "figure/figure.hpp"
#include "study/sweep/sweep_file.hpp"
#include "study/sweep/sweep_results.hpp"

namespace monograin {

/// One of several processes that share the runs of a sweep: runs index, index + count, ...
struct SweepShard {
  std::size_t index = 1;  ///< from 1
  std::size_t count = 1;
};

struct SweepOptions {
  std::filesystem::path folder;
  int threads = 0;  ///< 0: one for each core
  SweepShard shard;
  /// Called after every run with how many of this process's runs are done, and how many there are; one call at a time.
  std::function<void(std::size_t done, std::size_t of)> progress;
  /// Format of the results; none: that of the results of any sweep in the folder, CSV if there are none. Results of
  /// this sweep in another format are converted, and stay.
  std::optional<ResultsFormat> format{};
  /// Format of the figure that is to be drawn from the results, one of figure::k_formats.
  std::string_view figure_format = figure::k_usual_format;
};

/// Progress of a sweep.
struct SweepOutcome {
  std::size_t runs_before = 0;       ///< runs of the whole sweep that were finished before
  std::size_t runs_now = 0;          ///< done by this call
  std::size_t runs_ended_early = 0;  ///< of all that are finished, by any call: refused, stopped or failed
  std::size_t runs_missing = 0;      ///< left to other shards; 0: the results are complete
  /// How many of those done by this call warn, and of what the first one does: a sentence, or none.
  std::vector<std::string> warnings{};
  std::filesystem::path results{};  ///< their file; empty while runs are missing
};

/// "3 of 15 runs refused, stopped or failed (columns status and reason)", of all that are finished; empty: none were.
[[nodiscard]] std::string early_ends_text(const Sweep& sweep, const SweepOutcome& outcome);

/// Folder of the results: the one chosen, or else runs/NAME.
[[nodiscard]] std::filesystem::path folder_of(const Sweep& sweep, const std::filesystem::path& chosen);

/// Runs the missing runs of a sweep, or of its shard, and writes the results once all runs of the sweep are finished.
///
/// Finished runs are kept in journals, one for each shard: NAME.journal in the folder. A run that any journal holds is
/// not repeated. When the journals together hold all runs, they become the results and are removed. The file does not
/// depend on the number of threads, shards and interruptions. A run that is refused, stops or fails is a row with a
/// reason.
/// @throws std::runtime_error if the folder holds something else, or results that were changed after they were
///         written, or cannot be written; before any run, if HDF5 is wanted and cannot be written
[[nodiscard]] SweepOutcome run_sweep(const Sweep& sweep, const SweepOptions& options);

}  // namespace monograin
