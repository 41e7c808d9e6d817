/// Folders of results, in which a program replaces its own files and leaves those of the user alone.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace monograin {

/// The file that tells the folder of a run.
inline constexpr std::string_view k_run_marker = "run.json";

/// A result that is written out of sight and then takes its place.
///
/// Files go to path(), a hidden folder. In the target every written file replaces the one of its name; all other files
/// stay. Of an earlier result only those files are removed that this one does not have and that nobody has changed
/// since, which the hidden list `.monograin` in the folder tells. Whatever happens before publish(), the target stays
/// as it is.
///
/// publish() changes all files in one step, by an exchange of folders. Where the target has folders in it, belongs to
/// somebody else, is a file system of its own or has this process in it, the files are moved one by one, the marker
/// last. What a killed process has left is dealt with by the next one for the same target: such moves are completed,
/// all else is removed. A link is followed, and stays.
class StagedFolder {
 public:
  /// Makes the hidden folder, so that a target that cannot be written is reported before anything is computed.
  /// @param marker  a file that every result of the kind has
  /// @throws std::runtime_error if the target is a file, cannot be written, or holds files but no result of this
  /// program of that kind
  explicit StagedFolder(const std::filesystem::path& target, std::string_view marker = k_run_marker);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return staged_; }

  /// Puts the files in their place, once they are on the disk.
  /// @throws std::runtime_error if that cannot be done; the target is as it was then
  void publish();

 private:
  void make_parents();
  void make_staged();

  std::filesystem::path target_;
  std::string marker_;
  std::vector<std::filesystem::path> made_parents_;  ///< the outermost first
  std::filesystem::path staged_;
  int lock_ = -1;  ///< of the hidden folder, held as long as somebody works in it
};

/// Makes a folder for results whose files are written one by one.
/// @throws std::runtime_error if that cannot be done, or nothing can be written there
void prepare_folder(const std::filesystem::path& folder);

}  // namespace monograin
