/// Hidden files and folders in which results are written before they get their names.
#pragma once

#include <filesystem>
#include <mutex>

namespace monograin {

/// Owns a hidden file or folder: it is removed with all its content when the object, or the process by a signal, ends.
class HiddenPath {
 public:
  HiddenPath() = default;
  /// @param shown  path whose content it is to become; messages show this one
  HiddenPath(std::filesystem::path path, std::filesystem::path shown);
  HiddenPath(HiddenPath&& other) noexcept;
  HiddenPath& operator=(HiddenPath&& other) noexcept;
  ~HiddenPath();

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

  /// Keeps what is there now, under this or another name.
  void release() noexcept;

 private:
  void remove() noexcept;

  std::filesystem::path path_;
};

/// Path of a file for messages and results: in place of a hidden folder it has the path that this stands for.
[[nodiscard]] std::filesystem::path shown_path(const std::filesystem::path& path);

/// Lets SIGINT, SIGTERM and SIGHUP end the process only after all hidden paths are removed. Call it once, before other
/// threads start. Without it these signals end the process at once, unless they are ignored.
void remove_hidden_paths_at_signals() noexcept;

/// Keeps these signals from ending the process as long as the lock is held: for moves that have to be completed, and
/// while a hidden path is made. A thread may hold it more than once.
[[nodiscard]] std::unique_lock<std::recursive_mutex> hold_signals();

/// Gives a new process, after fork(), the signals that the program itself began with. Calls only what is safe there.
void restore_signals() noexcept;

}  // namespace monograin
