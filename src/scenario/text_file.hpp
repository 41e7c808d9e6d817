/// Whole files that a user names.
#pragma once

#include <filesystem>
#include <string>

namespace monograin {

/// What a file holds, or why it cannot be read.
struct FileText {
  std::string text;
  std::string problem;  ///< "there is no such file"; empty: the text was read
};

/// Reads no more than a little beyond `largest` bytes, which is for the caller to refuse: pipes and devices need not
/// end.
[[nodiscard]] FileText read_text_file(const std::filesystem::path& file, std::size_t largest);

}  // namespace monograin
