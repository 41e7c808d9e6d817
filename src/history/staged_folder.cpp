#include "history/staged_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "history/run.hpp"
#include "scenario/hidden_path.hpp"
#include "scenario/text_file.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::string_view k_list_head =
    "# Files that monograin has written here, with their digests. A later result replaces or removes them.\n";
/// Empty file that marks a hidden folder whose files are being moved to the target.
constexpr std::string_view k_moving = ".moving";
constexpr std::string_view k_staged_infix = ".monograin-staged-";
constexpr std::size_t k_random_length = 6;  ///< characters that mkdtemp replaces
/// Characters of the target's name in that of the hidden folder; file systems allow 255 in all.
constexpr std::size_t k_longest_name = 200;
/// Time of a result above which its loss costs more than to flush it, which takes 10 to 40 ms on a busy disk.
constexpr double k_worth_flushing = 1.0;  // [s]
// Largest files that are read: for a digest or a list, and as a marker [bytes].
constexpr std::size_t k_largest_file = std::size_t{4} << 30U;
constexpr std::size_t k_largest_marker = std::size_t{256} << 20U;

[[noreturn]] void refuse(const fs::path& path, std::string_view problem) {
  throw std::runtime_error(fmt::format("{}: {}", path.string(), problem));
}

[[noreturn]] void refuse(const fs::path& path, std::string_view what, int error) {
  refuse(path, fmt::format("{}: {}", what, std::generic_category().message(error)));
}

/// Opens and locks a folder; is_held() is false if that is impossible. `operation` is that of flock.
class LockedFolder {
 public:
  LockedFolder(const fs::path& folder, int operation)
      : descriptor_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC)) {
    if (descriptor_ >= 0) is_held_ = flock(descriptor_, operation) == 0;
  }
  ~LockedFolder() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  LockedFolder(const LockedFolder&) = delete;
  LockedFolder& operator=(const LockedFolder&) = delete;

  [[nodiscard]] bool is_held() const noexcept { return is_held_; }
  /// Hands the lock over to the caller, who closes the descriptor.
  [[nodiscard]] int release() { return std::exchange(descriptor_, -1); }

 private:
  int descriptor_;
  bool is_held_ = false;
};

// --- the list of written files

using FileList = std::map<std::string, std::string>;  ///< digests by name

[[nodiscard]] std::string digest_of(const fs::path& file) {
  return text_digest(read_text_file(file, k_largest_file).text);
}

[[nodiscard]] bool is_regular(const fs::path& file) {
  std::error_code ignored;
  return fs::symlink_status(file, ignored).type() == fs::file_type::regular;
}

/// Reads the list of written files in a folder. Lines whose name is not that of a file directly in it are ignored.
[[nodiscard]] FileList read_list(const fs::path& folder) {
  FileList list;
  if (!is_regular(folder / k_written_files)) return list;
  const std::string text = read_text_file(folder / k_written_files, k_largest_file).text;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    const std::size_t space = line.find(' ');
    if (line.starts_with('#') || space == std::string_view::npos) continue;
    const std::string name(line.substr(space + 1));
    if (!name.empty() && name != "." && name != ".." && name.find('/') == std::string::npos) {
      list.emplace(name, line.substr(0, space));
    }
  }
  return list;
}

void write_list(const fs::path& folder) {
  std::string text(k_list_head);
  FileList list;
  for (const auto& entry : fs::directory_iterator(folder)) {
    list.emplace(entry.path().filename().string(), digest_of(entry.path()));
  }
  for (const auto& [name, digest] : list) text += fmt::format("{} {}\n", digest, name);
  write_text_file(folder / k_written_files, text);
}

// --- whose folder it is

/// True if this program has written the marker: its content or the list in its folder shows it.
[[nodiscard]] bool is_own_marker(const fs::path& folder, const std::string& marker) {
  if (read_list(folder).contains(marker)) return true;
  const Json json = Json::parse(read_text_file(folder / marker, k_largest_marker).text, nullptr, false);
  if (!json.is_object()) return false;
  const auto program = json.find("program");
  if (program != json.end()) return *program == "monograin";
  const auto versions = json.find("versions");  // early versions wrote no "program"
  return versions != json.end() && versions->is_object() && versions->contains("monograin");
}

[[nodiscard]] bool is_staged_name(std::string_view name, std::string_view prefix) {
  return name.starts_with(prefix) && name.size() == prefix.size() + k_random_length &&
         name.find('.', prefix.size()) == std::string_view::npos;
}

/// True if the target holds an earlier result of the kind, which may be replaced.
[[nodiscard]] bool holds_own_result(const fs::path& target, const std::string& marker) {
  if (!fs::exists(fs::symlink_status(target / marker))) {
    if (read_list(target).empty()) return false;
    refuse(target, fmt::format("holds a result of another kind (no {}); choose another folder", marker));
  }
  if (is_own_marker(target, marker)) return true;
  refuse(target, fmt::format("its {} is none that monograin has written, and would be replaced; choose another folder",
                             marker));
}

// --- putting a result in its place

/// Names of the files of a result, the marker last, without the list.
[[nodiscard]] std::vector<std::string> names_in(const fs::path& staged, const std::string& marker) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(staged)) {
    const std::string name = entry.path().filename().string();
    if (name != k_written_files && name != k_moving) names.push_back(name);
  }
  std::ranges::sort(names, {}, [&](const std::string& name) { return std::pair(name == marker, name); });
  return names;
}

/// Names of unchanged files of an earlier result in the target that the new result lacks. `list`: files of the new one.
[[nodiscard]] std::vector<std::string> stale_names(const FileList& list, const fs::path& target) {
  std::vector<std::string> names;
  for (const auto& [name, digest] : read_list(target)) {
    if (!list.contains(name) && is_regular(target / name) && digest_of(target / name) == digest) names.push_back(name);
  }
  return names;
}

/// Moves the files of a complete result from its hidden folder into the target, one by one. The list moves last: if
/// this process is killed, the next one finds the list in the hidden folder and completes the move.
void move_files(const fs::path& staged, const fs::path& target, const std::string& marker) {
  for (const std::string& name : stale_names(read_list(staged), target)) fs::remove(target / name);
  for (const std::string& name : names_in(staged, marker)) fs::rename(staged / name, target / name);
  fs::rename(staged / k_written_files, target / k_written_files);
}

[[nodiscard]] bool is_within(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

/// Exchanges the hidden folder and the target in one step, after all files that stay have got a hard link in the hidden
/// folder. Folders cannot be linked, a target with another owner would change its owner, and a process whose working
/// directory is the target would stay in the old folder: nothing is exchanged then.
/// @return true if the folders were exchanged; if false, nothing has changed
[[nodiscard]] bool exchange(const fs::path& staged, const fs::path& target) {
  struct stat is = {};
  if (stat(target.c_str(), &is) != 0 || is.st_uid != geteuid()) return false;
  std::error_code error;
  if (is_within(fs::current_path(error), target) || error || is_within(staged, target)) return false;
  const FileList list = read_list(staged);
  const std::vector<std::string> stale = stale_names(list, target);
  std::vector<std::string> kept;
  for (const auto& entry : fs::directory_iterator(target)) {
    const std::string name = entry.path().filename().string();
    if (name == k_written_files || list.contains(name) || std::ranges::find(stale, name) != stale.end()) continue;
    if (entry.symlink_status().type() == fs::file_type::directory) return false;
    kept.push_back(name);
  }
  std::size_t linked = 0;
  while (linked < kept.size() && link((target / kept[linked]).c_str(), (staged / kept[linked]).c_str()) == 0) ++linked;
  if (linked == kept.size() && chmod(staged.c_str(), is.st_mode & 07777U) == 0) {
    if (!kept.empty()) sync_to_disk(staged);  // the user's files are only here once the old folder is removed
    if (renameat2(AT_FDCWD, staged.c_str(), AT_FDCWD, target.c_str(), RENAME_EXCHANGE) == 0) return true;
  }
  while (linked > 0) fs::remove(staged / kept[--linked], error);
  return false;
}

/// Moves files that the list of an old folder lacks into the target, such as files made during the exchange.
void rescue(const fs::path& old, const fs::path& target) {
  const FileList list = read_list(old);
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(old, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name == k_written_files || list.contains(name) || fs::exists(fs::symlink_status(target / name, ignored)))
      continue;
    fs::rename(entry.path(), target / name, ignored);
  }
}

/// Completes or removes hidden folders of a target that killed processes have left; skips locked ones.
void clear_leftovers(const fs::path& folder, std::string_view prefix, const fs::path& target,
                     const std::string& marker) {
  std::vector<fs::path> leftovers;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (is_staged_name(entry.path().filename().string(), prefix)) leftovers.push_back(entry.path());
  }
  for (const fs::path& leftover : leftovers) {
    const LockedFolder lock(leftover, LOCK_EX | LOCK_NB);
    if (!lock.is_held()) continue;
    const auto held = hold_signals();
    // A hidden folder without list holds an incomplete result, or all its files have been moved.
    if (fs::exists(target) && fs::exists(leftover / k_written_files, ignored)) {
      if (fs::exists(leftover / k_moving, ignored)) {
        move_files(leftover, target, marker);
      } else {
        rescue(leftover, target);
      }
    }
    fs::remove_all(leftover, ignored);
  }
}

[[nodiscard]] std::string prefix_beside(const fs::path& target) {
  return fmt::format(".{}{}", target.filename().string().substr(0, k_longest_name), k_staged_infix);
}

}  // namespace

StagedFolder::StagedFolder(const fs::path& target, std::string_view marker, std::span<const std::string_view> names)
    : target_(destination_of(target)),
      shown_target_(target.has_filename() ? target : target.parent_path()),
      marker_(marker) {
  if (fs::exists(target_)) {
    if (!fs::is_directory(target_)) refuse(target_, "is a file; expected a folder for the result");
    {
      const LockedFolder one_at_a_time(target_, LOCK_EX);
      clear_leftovers(target_, k_staged_infix, target_, marker_);
      clear_leftovers(target_.parent_path(), prefix_beside(target_), target_, marker_);
      replaces_own_ = holds_own_result(target_, marker_);
    }
    for (const std::string_view name : names) check_name(std::string(name));
  } else {
    make_parents();
    clear_leftovers(target_.parent_path(), prefix_beside(target_), target_, marker_);
  }
  make_staged();
}

StagedFolder::~StagedFolder() {
  staged_ = {};
  if (lock_ >= 0) close(lock_);
  std::error_code ignored;
  for (auto parent = made_parents_.rbegin(); parent != made_parents_.rend(); ++parent) {
    fs::remove(*parent, ignored);  // fails unless the folder is empty
  }
}

void StagedFolder::make_parents() {
  for (fs::path parent = target_.parent_path(); !fs::exists(parent); parent = parent.parent_path()) {
    made_parents_.insert(made_parents_.begin(), parent);
  }
  std::error_code error;
  fs::create_directories(target_.parent_path(), error);
  if (error) refuse(target_.parent_path(), "cannot be created: " + error.message());
}

void StagedFolder::make_staged() {
  // The hidden folder lies beside the target, so that folders can be exchanged; or inside it, if the parent folder is
  // on another file system or cannot be written.
  struct stat target = {};
  struct stat parent = {};
  const bool exists = stat(target_.c_str(), &target) == 0;
  const bool is_apart =
      exists && (stat(target_.parent_path().c_str(), &parent) != 0 || target.st_dev != parent.st_dev ||
                 access(target_.parent_path().c_str(), W_OK | X_OK) != 0);
  const std::string prefix =
      (is_apart ? target_ / k_staged_infix : target_.parent_path() / prefix_beside(target_)).string();
  if (exists && access(target_.c_str(), W_OK | X_OK) != 0) refuse(target_, "cannot be written", errno);
  const auto held = hold_signals();
  do {  // repeats if another process removed the folder as a leftover before it was locked
    std::string pattern = prefix + std::string(k_random_length, 'X');
    if (mkdtemp(pattern.data()) == nullptr) refuse(target_, "cannot be written", errno);
    staged_ = HiddenPath(pattern, shown_target_);
    if (lock_ >= 0) close(lock_);
    lock_ = LockedFolder(path(), LOCK_EX).release();
  } while (!fs::exists(path()));
  // mkdtemp() lets only the owner in: gives the folder the permissions of any new folder. To ask for the mask of the
  // process would change it for an instant, in which another thread may write files.
  const fs::path sample = path() / "sample";
  struct stat made = {};
  if (mkdir(sample.c_str(), 0777) == 0 && stat(sample.c_str(), &made) == 0)
    chmod(path().c_str(), made.st_mode & 07777U);
  rmdir(sample.c_str());
}

/// @throws std::runtime_error if a folder or a file of the user has the name of a file of the result
void StagedFolder::check_name(const std::string& name) const {
  if (fs::is_directory(fs::symlink_status(target_ / name))) {
    refuse(target_ / name, "is a folder; a file is to go there");
  }
  if (!replaces_own_ && fs::exists(fs::symlink_status(target_ / name))) {
    refuse(target_ / name, "monograin has not written this file and would replace it; choose another folder");
  }
}

double StagedFolder::age() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

void StagedFolder::publish(double effort) {
  const auto flush = [is_worth_it = effort > k_worth_flushing](const fs::path& path) {
    if (is_worth_it) sync_to_disk(path);
  };
  const std::vector<std::string> names = names_in(path(), marker_);
  for (const std::string& name : names) flush(path() / name);
  write_list(path());
  flush(path() / k_written_files);
  flush(path());
  auto held = hold_signals();
  // An existing target is never renamed over, even if empty: a process that works in it would lose its folder.
  if (fs::exists(target_) || rename(path().c_str(), target_.c_str()) != 0) {
    held.unlock();  // another process may take its time
    const LockedFolder one_at_a_time(target_, LOCK_EX);
    held.lock();
    replaces_own_ = holds_own_result(target_, marker_);  // of another process, since this one began
    for (const std::string& name : names) check_name(name);
    if (exchange(path(), target_)) {
      rescue(path(), target_);
    } else {
      write_text_file(path() / k_moving, "");
      move_files(path(), target_, marker_);
      flush(target_);
    }
  }
  flush(target_.parent_path());
  made_parents_.clear();
  close(std::exchange(lock_, -1));
}

fs::path destination_of(fs::path path) {
  if (!path.has_filename()) path = path.parent_path();
  constexpr int k_most_links = 40;
  std::error_code ignored;
  for (int k = 0; k < k_most_links && fs::is_symlink(path, ignored) && !fs::exists(path, ignored); ++k) {
    path = path.parent_path() / fs::read_symlink(path);
  }
  fs::path result = fs::weakly_canonical(fs::absolute(path));
  return result.has_filename() ? result : result.parent_path();
}

void prepare_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) refuse(folder, "cannot be created: " + error.message());
  if (access(folder.c_str(), W_OK | X_OK) != 0) refuse(folder, "cannot be written", errno);
}

}  // namespace monograin
