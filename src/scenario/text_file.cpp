#include "scenario/text_file.hpp"

#include <array>
#include <cerrno>
#include <fstream>
#include <stdexcept>
#include <system_error>

namespace monograin {

FileText read_text_file(const std::filesystem::path& file, std::size_t largest) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) return {{}, "there is no such file"};
  if (std::filesystem::is_directory(status)) return {{}, "this is a directory"};
  std::ifstream stream(file, std::ios::binary);
  std::string text;
  std::array<char, 65536> chunk{};
  while (stream && text.size() <= largest) {
    stream.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    text.append(chunk.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (!stream.is_open() || stream.bad()) return {{}, "the file cannot be read, perhaps for want of permission"};
  return {std::move(text), {}};
}

void write_text_file(const std::filesystem::path& file, std::string_view text) {
  const std::filesystem::path partial = file.string() + ".partial";
  std::ofstream stream(partial, std::ios::binary);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (!stream) {
    throw std::runtime_error(partial.string() + ": cannot be written: " + std::generic_category().message(errno));
  }
  std::filesystem::rename(partial, file);
}

}  // namespace monograin
