/// Reads and writes whole files that a user names.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace monograin {

/// Largest size of a TOML file that is parsed [byte].
inline constexpr std::size_t k_largest_text = 16U * 1024U * 1024U;

/// Content of a file, or the reason why it cannot be read.
struct FileText {
  std::string text;
  std::string problem;  ///< "there is no such file"; empty: the text was read
};

/// Kinds of files that may be opened.
enum class FileKind {
  any,      ///< pipes too, and `-` for standard input: for files named on the command line
  regular,  ///< for files named in other files, which could name a device, or a pipe without a writer
};

/// Reads a file, at most slightly more than `largest` bytes, because pipes and devices need not end. The caller has to
/// refuse a longer text.
[[nodiscard]] FileText read_text_file(const std::filesystem::path& file, std::size_t largest,
                                      FileKind kind = FileKind::regular);

/// Text of a TOML file, and the file's name in messages. Names in the text are relative to the folder of that name.
struct NamedText {
  std::string text;
  std::filesystem::path file;
};

/// Reads a TOML file that a user names.
/// @param expected  what the file should be: "a sweep file"
/// @throws ScenarioError if it cannot be read
[[nodiscard]] NamedText read_named_text(const std::filesystem::path& file, std::string_view expected,
                                        FileKind kind = FileKind::any);

/// Name of a file in messages and in names derived from it: `stdin` for standard input.
[[nodiscard]] std::filesystem::path name_of_file(const std::filesystem::path& file, FileKind kind = FileKind::any);

/// Writes a file completely or not at all: first under a hidden name in the same folder. A link with the file's name is
/// replaced, not followed.
/// @throws std::runtime_error naming the file and why it cannot be written
void write_text_file(const std::filesystem::path& file, std::string_view text);

/// Writes a text that comes in parts of any size, completely or not at all. `produce` passes each part to its sink.
using TextSink = std::function<void(std::string_view part)>;
void write_text_file(const std::filesystem::path& file, const std::function<void(const TextSink&)>& produce);

/// Writes a file by a library that opens it by its name, completely or not at all.
/// @param produce  fills the given hidden, empty file in the same folder
/// @throws std::runtime_error naming the file and why it cannot be written, and what `produce` throws
void write_file_by_name(const std::filesystem::path& file,
                        const std::function<void(const std::filesystem::path& hidden)>& produce);

/// Removes the hidden files that processes have left in a folder because they were killed while they wrote. No other
/// process may write there.
void remove_partial_files(const std::filesystem::path& folder);

/// Refuses to replace a file that the program has not written.
/// @param witness  the file itself, or one that the program writes beside it, whose first line shows who wrote it
/// @throws std::runtime_error if the file exists, and the witness is not the program's or does not exist
void expect_own_file(const std::filesystem::path& file, const std::filesystem::path& witness);

/// Files .toml of a folder, in the order of their names.
/// @param content  what such a file describes, for messages, such as "scenario"
/// @param option  of the command line that names the folder
/// @throws std::runtime_error if there is no such folder, or no such file in it
[[nodiscard]] std::vector<std::filesystem::path> toml_files(const std::filesystem::path& folder,
                                                            std::string_view content, std::string_view option);

/// Waits until a file, or the list of names in a folder, is on the disk.
/// @throws std::runtime_error naming the file and why it cannot be written
void sync_to_disk(const std::filesystem::path& file);

}  // namespace monograin
