/// The files a run leaves: history.csv, events.csv, run.json, and a figure if asked for.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "history/run.hpp"

namespace monograin {

/// The file whose presence tells that a folder holds a run.
inline constexpr std::string_view k_run_marker = "run.json";

/// A folder that is filled out of sight and then takes its place in one stroke, replacing what was there.
/// Whatever happens before publish(), the old content of the target stays untouched.
class StagedFolder {
 public:
  /// @param marker  the file that tells an earlier result, which is replaced
  /// @throws std::runtime_error if the target exists and is neither empty nor an earlier result
  explicit StagedFolder(std::filesystem::path target, std::string_view marker = k_run_marker);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return staged_; }
  void publish();

 private:
  std::filesystem::path target_;
  std::filesystem::path staged_;
};

/// Throws what StagedFolder would, without creating anything: to be asked before a run is started.
void check_run_folder(const std::filesystem::path& target, std::string_view marker = k_run_marker);

/// The scenario of a run, from its folder: with the overrides and the tables it had then, wherever those are now.
/// @throws std::runtime_error where there is no run.json, or none that holds a scenario
[[nodiscard]] Scenario scenario_of_run(const std::filesystem::path& folder);

/// Writes a run into a folder, whole or not at all.
/// @param draw  called with the folder before it is published, for figures; may be empty
/// @throws std::runtime_error naming the file that could not be written
void write_run(Run& run, const std::filesystem::path& folder,
               const std::function<void(const std::filesystem::path&)>& draw = {});

}  // namespace monograin
