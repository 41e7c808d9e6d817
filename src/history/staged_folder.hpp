/// Folders of results: the program replaces its own files and keeps those of the user.
#pragma once

#include <chrono>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/hidden_path.hpp"

namespace monograin {

/// File that marks the folder of a run.
inline constexpr std::string_view k_run_marker = "run.json";

/// Hidden list of the written files, in the folder of every result that is published.
inline constexpr std::string_view k_written_files = ".monograin";

/// A result that is written to a hidden folder and then published to its target folder.
///
/// Files are written to path(), the hidden folder. publish() replaces files of the same name in the target and keeps
/// all others, except files of an earlier result that the new result lacks and that nobody has changed; the hidden list
/// `.monograin` in the target has their names and digests. Until publish(), the target does not change.
///
/// publish() changes all files in one step, by an exchange of folders. If the target contains folders, has another
/// owner, is a file system of its own, lies in a folder that cannot be written or contains the working directory,
/// publish() moves the files one by one, the marker last. A signal that ends the process waits for publish(). After a
/// process that was killed the next one for the same target clears up: it completes moves that had begun, and removes
/// other hidden folders. If the target is a link, the link stays and its destination is the target.
class StagedFolder {
 public:
  /// Makes the hidden folder. A target to which the result cannot be written is thus reported before anything is
  /// computed.
  /// @param marker  name of a file that every result of the kind has
  /// @param names   other files that every result of the kind has
  /// @throws std::runtime_error if the target is a file, cannot be written, or holds a result of another kind, or a
  /// file or a folder of the user with one of these names
  explicit StagedFolder(const std::filesystem::path& target, std::string_view marker = k_run_marker,
                        std::span<const std::string_view> names = {});
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  /// Hidden folder to which the files are written.
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return staged_.path(); }

  /// Time [s] since this object was made.
  [[nodiscard]] double age() const;

  /// Puts the files into the target. A result that took more than a second is flushed to the disk before, so that it
  /// survives a loss of power; flushing a short run would take longer than the run.
  /// @param effort  time [s] that the result took
  /// @throws std::runtime_error if a file cannot be put there, because a folder or a file of the user has its name. The
  /// target is then unchanged, unless publish() was moving files one by one.
  void publish(double effort);

 private:
  void make_parents();
  void make_staged();
  void check_name(const std::string& name) const;

  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::filesystem::path target_;
  std::filesystem::path shown_target_;  ///< as it was named
  std::string marker_;
  bool replaces_own_ = false;                        ///< the target holds an earlier result
  std::vector<std::filesystem::path> made_parents_;  ///< folders made for the target, the outermost first
  HiddenPath staged_;
  int lock_ = -1;  ///< descriptor that locks the hidden folder until it is published or removed
};

/// Follows links and returns the absolute path to which they lead, also if nothing exists there.
[[nodiscard]] std::filesystem::path destination_of(std::filesystem::path path);

/// Makes a folder, if it does not exist, for results whose files are written one by one.
/// @throws std::runtime_error if the folder cannot be made or written
void prepare_folder(const std::filesystem::path& folder);

}  // namespace monograin
