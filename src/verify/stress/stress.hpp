/// The stress test: draws extreme and random scenes, checks the rules of all runs, and shrinks scenes that break them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "verify/stress/draw/generator.hpp"

namespace monograin {

struct StressOptions {
  std::uint64_t seed = 1;
  double seconds = 60.0;    ///< wall time for drawing, checking and shrinking
  std::size_t scenes = 0;   ///< largest number of scenes; 0: as many as there is time for
  std::uint64_t first = 0;  ///< index of the first scene
  DrawnModels models{};     ///< models whose scenes are drawn; empty: all
  int threads = 0;          ///< 0: one for each core
  std::filesystem::path folder;
  /// Called after every scene with the number of scenes done and the expected number of all; one call at a time.
  std::function<void(std::size_t done, std::size_t of)> progress;
};

/// A rule that a scene breaks.
struct StressFailure {
  std::uint64_t index = 0;  ///< index of the scene in the seed's sequence
  std::string model;
  std::string integrator;
  std::string check;
  std::string detail;
  std::string text{};  ///< the smallest scenario found that still breaks it
  std::string file{};  ///< name of its file in the folder
};

/// Outcome of a stress test. The outcome of each scene depends on the seed and the models only, not on the number of
/// threads.
struct StressReport {
  std::uint64_t seed = 1;
  DrawnModels drawn_from{};
  std::size_t scenes = 0;
  long runs = 0;
  std::size_t ill_conditioned = 0;
  std::size_t cut_short = 0;  ///< scenes so slow that not all comparisons were made
  std::map<std::pair<std::string, std::string>, std::size_t> by_model_and_integrator;  ///< number of scenes
  std::map<std::pair<std::string, std::string>, std::size_t> ends;  ///< number of scenes by model and stated_end()
  std::vector<StressFailure> failures;                              ///< in the order of the scenes
  std::uint64_t slowest = 0;                                        ///< index of the slowest scene
  double slowest_seconds = 0.0;

  /// Tables of the scenes and their ends, and a line for every failure.
  [[nodiscard]] std::string text() const;
};

/// Draws scenes and checks them until the time is up, and shrinks those that break a rule. Writes report.txt and a
/// scenario for every failure into the folder, all files at once.
/// @throws std::runtime_error if the folder holds files but no result of a stress test, or cannot be written
[[nodiscard]] StressReport run_stress(const StressOptions& options);

}  // namespace monograin
