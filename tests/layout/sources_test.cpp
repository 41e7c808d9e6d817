// Sources are cited by author and year, never by the name of a file that somebody has a copy in.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>

namespace monograin::sources_test {
namespace {

namespace fs = std::filesystem;

bool is_hex(char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; }

/// Whether the text names a file by a running number of three digits and a digest: "00N_" and ten hex digits or more.
bool names_a_copy(std::string_view text) {
  constexpr std::size_t k_digest = 10;
  for (std::size_t at = text.find('_'); at != std::string_view::npos; at = text.find('_', at + 1)) {
    if (at < 3 || text[at - 3] != '0' || text[at - 2] != '0' || text[at - 1] < '0' || text[at - 1] > '4') continue;
    const std::string_view digest = text.substr(at + 1, k_digest);
    if (digest.size() == k_digest && std::ranges::all_of(digest, is_hex)) return true;
  }
  return false;
}

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

TEST(Sources, FindTheNameOfACopy) {
  const std::string name = std::string("001") + "_" + "0123456789abcdef.txt";
  EXPECT_TRUE(names_a_copy("see " + name + ", eq. 3"));
  EXPECT_FALSE(names_a_copy("see " + name.substr(0, 13)));
  EXPECT_FALSE(names_a_copy("Hertz (1882); mean_of_001_runs"));
}

TEST(Sources, AreNowhereNamedByACopy) {
  std::size_t files = 0;
  for (auto entry = fs::recursive_directory_iterator(MONOGRAIN_SOURCE_DIR); entry != fs::end(entry); ++entry) {
    const std::string name = entry->path().filename().string();
    // Folders of builds and of runs.
    if (entry->is_directory() && (name == ".git" || name.starts_with("build") || name == "runs")) {
      entry.disable_recursion_pending();
    }
    if (!entry->is_regular_file()) continue;
    ++files;
    EXPECT_FALSE(names_a_copy(name) || names_a_copy(text_of(entry->path()))) << entry->path();
  }
  EXPECT_GT(files, 500U);
}

}  // namespace
}  // namespace monograin::sources_test
