/// Whole files that a user names.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace monograin {

/// What a file holds, or why it cannot be read.
struct FileText {
  std::string text;
  std::string problem;  ///< "there is no such file"; empty: the text was read
};

/// What may be opened.
enum class FileKind {
  any,      ///< pipes too, and `-` for standard input: for files named on the command line
  regular,  ///< for files named by other files, which could name a device or a pipe that nobody writes to
};

/// Reads no more than a little beyond `largest` bytes, which is for the caller to refuse: pipes and devices need not
/// end.
[[nodiscard]] FileText read_text_file(const std::filesystem::path& file, std::size_t largest,
                                      FileKind kind = FileKind::regular);

/// The name of a file in messages and of what is made from it: `stdin` for standard input.
[[nodiscard]] std::filesystem::path name_of_file(const std::filesystem::path& file, FileKind kind = FileKind::any);

/// Writes a file whole or not at all: under a hidden name beside its place first. A link of that name is replaced, not
/// followed.
/// @throws std::runtime_error naming the file and why it cannot be written
void write_text_file(const std::filesystem::path& file, std::string_view text);

/// Writes a text that comes in parts, whole or not at all: `produce` hands each part to the sink that it is given.
using TextSink = std::function<void(std::string_view part)>;
void write_text_file(const std::filesystem::path& file, const std::function<void(const TextSink&)>& produce);

/// The scenario files (.toml) of a folder, in the order of their names.
/// @throws std::runtime_error where there is no such folder, or none in it
[[nodiscard]] std::vector<std::filesystem::path> scenario_files(const std::filesystem::path& folder);

/// Waits until a file, or the list of names in a folder, is on the disk.
/// @throws std::runtime_error naming the file and why it cannot be written
void sync_to_disk(const std::filesystem::path& file);

}  // namespace monograin
