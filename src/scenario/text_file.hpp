/// Whole files that a user names.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace monograin {

/// What a file holds, or why it cannot be read.
struct FileText {
  std::string text;
  std::string problem;  ///< "there is no such file"; empty: the text was read
};

/// Reads no more than a little beyond `largest` bytes, which is for the caller to refuse: pipes and devices need not
/// end.
[[nodiscard]] FileText read_text_file(const std::filesystem::path& file, std::size_t largest);

/// Writes a file whole or not at all: beside its place first, under the name FILE.partial.
/// @throws std::runtime_error naming the file and why it cannot be written
void write_text_file(const std::filesystem::path& file, std::string_view text);

}  // namespace monograin
