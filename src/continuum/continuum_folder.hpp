/// The folder in which CalculiX computes, and the files that stay.
#pragma once

#include <filesystem>
#include <optional>

#include "history/run.hpp"
#include "history/staged_folder.hpp"

namespace monograin {

/// Path of the program of CalculiX. @throws std::runtime_error that says how to get it if it is not on the PATH
[[nodiscard]] std::filesystem::path find_calculix();

/// The folder in which CalculiX computes a run: the hidden folder of the result, or without a target a temporary one.
/// It is removed with this object.
class ContinuumFolder {
 public:
  /// Makes the folder. A target that cannot take the result is thus reported before anything is computed.
  /// @param target       folder of the result; empty: no file stays
  /// @param keeps_files  true: input, results and messages of CalculiX stay as well
  /// @throws std::runtime_error as StagedFolder does
  ContinuumFolder(const std::filesystem::path& target, bool keeps_files);
  ~ContinuumFolder();
  ContinuumFolder(const ContinuumFolder&) = delete;
  ContinuumFolder& operator=(const ContinuumFolder&) = delete;

  /// Absolute path.
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

  /// Puts the files of the run, and those of CalculiX that stay, into the target. Does nothing without a target.
  /// @throws std::runtime_error as StagedFolder::publish() does
  void publish(Run& run);

 private:
  std::optional<StagedFolder> staged_;
  std::filesystem::path path_;
  bool keeps_files_;
};

}  // namespace monograin
