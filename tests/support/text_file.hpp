/// Small text files as whole strings.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace monograin {

/// Empty where there is no such file.
[[nodiscard]] inline std::string read_text(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

}  // namespace monograin
