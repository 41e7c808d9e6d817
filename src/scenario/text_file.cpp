#include "scenario/text_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "scenario/faults.hpp"
#include "scenario/hidden_path.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view k_standard_input = "-";
constexpr std::string_view k_partial_extension = ".partial";

[[noreturn]] void fail(const fs::path& file, int error) {
  throw std::runtime_error(shown_path(file).string() +
                           ": cannot be written: " + std::generic_category().message(error));
}

/// Owns a partly written file, which is removed unless it is moved to its final name.
class PartialFile {
 public:
  /// @param file  the final name
  explicit PartialFile(const fs::path& file) {
    static std::atomic<unsigned> count{0};
    const auto held = hold_signals();
    fs::path path;
    do {  // O_EXCL: never opens an existing file or link
      path = file.parent_path() / fmt::format(".{}-{}{}", getpid(), count++, k_partial_extension);
      descriptor_ = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (descriptor_ < 0 && errno == EEXIST);
    if (descriptor_ < 0) fail(file, errno);
    hidden_ = HiddenPath(path, file);
  }
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;
  ~PartialFile() {
    if (descriptor_ >= 0) close(descriptor_);
  }

  [[nodiscard]] const fs::path& path() const noexcept { return hidden_.path(); }

  /// @return true if everything was written; otherwise errno has the reason
  [[nodiscard]] bool write(std::string_view text) {
    while (!text.empty()) {
      const ssize_t written = ::write(descriptor_, text.data(), text.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return false;
      text.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
  }

  [[nodiscard]] bool move_to(const fs::path& file) {
    if (close(std::exchange(descriptor_, -1)) != 0) return false;
    const auto held = hold_signals();
    if (rename(path().c_str(), file.c_str()) != 0) return false;
    hidden_.release();
    return true;
  }

 private:
  HiddenPath hidden_;
  int descriptor_ = -1;
};

/// True for the name of a PartialFile: .PID-COUNT.partial
[[nodiscard]] bool is_partial(const fs::path& name) {
  const std::string numbers = name.stem().string();
  if (!numbers.starts_with('.') || name.extension() != k_partial_extension) return false;
  const auto is_number = [](std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
  };
  const std::size_t dash = std::min(numbers.find('-'), numbers.size() - 1);
  return is_number(std::string_view(numbers).substr(1, dash - 1)) &&
         is_number(std::string_view(numbers).substr(dash + 1));
}

/// Reads an open file. A stream would take some errors, such as that of a folder as standard input, for the end.
FileText read_descriptor(int descriptor, std::size_t largest) {
  std::string text;
  std::array<char, 65536> chunk{};
  while (text.size() <= largest) {
    const ssize_t count = ::read(descriptor, chunk.data(), chunk.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return {{}, fmt::format("it cannot be read: {}", std::generic_category().message(errno))};
    if (count == 0) break;
    text.append(chunk.data(), static_cast<std::size_t>(count));
  }
  return {std::move(text), {}};
}

}  // namespace

FileText read_text_file(const fs::path& file, std::size_t largest, FileKind kind) {
  if (kind == FileKind::any && file == k_standard_input) return read_descriptor(STDIN_FILENO, largest);
  std::error_code error;
  const auto status = fs::status(file, error);
  if (status.type() == fs::file_type::none) return {{}, error.message()};
  if (!fs::exists(status)) return {{}, "there is no such file"};
  if (fs::is_directory(status)) return {{}, "this is a directory"};
  if (kind == FileKind::regular && !fs::is_regular_file(status)) return {{}, "this is a device or a pipe"};
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return {{}, "the file cannot be read, perhaps for want of permission"};
  const struct Closed {
    int descriptor;
    ~Closed() { close(descriptor); }
  } closed{descriptor};
  return read_descriptor(descriptor, largest);
}

fs::path name_of_file(const fs::path& file, FileKind kind) {
  return kind == FileKind::any && file == k_standard_input ? fs::path("stdin") : file;
}

void write_text_file(const fs::path& file, std::string_view text) {
  PartialFile partial(file);
  if (!partial.write(text) || !partial.move_to(file)) fail(file, errno);
}

void write_text_file(const fs::path& file, const std::function<void(const TextSink&)>& produce) {
  constexpr std::size_t k_block = std::size_t{1} << 20U;  // bytes that are written at once
  PartialFile partial(file);
  std::string block;
  produce([&](std::string_view part) {
    block += part;
    if (block.size() < k_block) return;
    if (!partial.write(block)) fail(file, errno);
    block.clear();
  });
  if (!partial.write(block) || !partial.move_to(file)) fail(file, errno);
}

void write_file_by_name(const fs::path& file, const std::function<void(const fs::path& hidden)>& produce) {
  PartialFile partial(file);
  produce(partial.path());
  if (!partial.move_to(file)) fail(file, errno);
}

void remove_partial_files(const fs::path& folder) {
  std::vector<fs::path> left;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (is_partial(entry.path().filename())) left.push_back(entry.path());
  }
  for (const fs::path& file : left) fs::remove(file);
}

void expect_own_file(const fs::path& file, const fs::path& witness) {
  // First words of the tables, records and gnuplot scripts that the program writes.
  constexpr std::array<std::string_view, 6> k_own{
      "# program: monograin ",          "# sweep: ", "# scenario: ", "# title: ", "# Draws '",
      "{\n  \"program\": \"monograin\""};
  constexpr std::size_t k_longest = 32;
  std::error_code error;
  const fs::file_type type = fs::symlink_status(file, error).type();
  if (type == fs::file_type::not_found || type == fs::file_type::symlink) return;  // a link is replaced, not its target
  if (type == fs::file_type::none) fail(file, error.value());
  if (type == fs::file_type::directory) fail(file, EISDIR);
  const FileText read = read_text_file(witness, k_longest);
  if (std::ranges::any_of(k_own, [&](std::string_view words) { return read.text.starts_with(words); })) return;
  if (!read.problem.empty() && witness == file) {
    throw std::runtime_error(
        fmt::format("{}: would be replaced, but whose it is cannot be seen: {}", file.string(), read.problem));
  }
  throw std::runtime_error(
      fmt::format("{}: monograin has not written this file and would replace it; move it away, or choose another place",
                  file.string()));
}

std::vector<fs::path> toml_files(const fs::path& folder, std::string_view content, std::string_view option) {
  if (!fs::is_directory(folder)) {
    throw std::runtime_error(fmt::format("{}: no such folder; run this in the project's folder, or name it with {}",
                                         folder.string(), option));
  }
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  if (files.empty()) throw std::runtime_error(fmt::format("{}: holds no {} (.toml)", folder.string(), content));
  std::ranges::sort(files);
  return files;
}

void sync_to_disk(const fs::path& file) {
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor < 0) fail(file, errno);
  const bool is_done = fsync(descriptor) == 0 || errno == EINVAL;  // EINVAL: the file system cannot synchronize
  const int error = errno;
  close(descriptor);
  if (!is_done) fail(file, error);
}

NamedText read_named_text(const fs::path& file, std::string_view expected, FileKind kind) {
  // The parser refuses a text beyond the limit.
  auto [text, problem] = read_text_file(file, k_largest_text, kind);
  fs::path name = name_of_file(file, kind);
  if (!problem.empty()) throw_fault({name.string()}, fmt::format("{}; expected {}", problem, expected));
  return {.text = std::move(text), .file = std::move(name)};
}

}  // namespace monograin
