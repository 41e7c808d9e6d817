/// Runs sweeps: on all cores, over many processes, and on where they were stopped.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include "study/sweep/sweep_file.hpp"

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
};

/// How far a sweep has come.
struct SweepOutcome {
  std::size_t runs_before = 0;   ///< of the whole sweep, that were there already
  std::size_t runs_now = 0;      ///< done by this call
  std::size_t runs_missing = 0;  ///< left to other shards; 0: results.csv stands
};

/// Runs what is left of a sweep, or of its shard, and writes results.csv when all runs of the sweep are there.
///
/// Finished runs are kept in journals, one for each shard: NAME.journal in the folder. A run that any of them holds is
/// not done again; when together they hold all runs, they become results.csv, the same byte by byte whatever the number
/// of threads, shards and interruptions, and are removed. A run that is refused, stops or fails is a row with a reason.
/// @throws std::runtime_error where the folder holds something else, or cannot be written
[[nodiscard]] SweepOutcome run_sweep(const Sweep& sweep, const SweepOptions& options);

}  // namespace monograin
