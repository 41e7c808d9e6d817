// The version of the program, and the files that have to agree with it.

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "cli/command_test.hpp"

namespace monograin::version_test {
namespace {

class Version : public CommandTest {};

std::string file_of_project(const std::string& name) { return read_text(MONOGRAIN_SOURCE_DIR "/" + name); }

/// The part of a text between two words; empty where they are not there.
std::string between(std::string_view text, std::string_view before, std::string_view after) {
  const std::size_t at = text.find(before);
  if (at == std::string_view::npos) return {};
  const std::size_t begin = at + before.size();
  const std::size_t end = text.find(after, begin);
  return end == std::string_view::npos ? std::string{} : std::string(text.substr(begin, end - begin));
}

TEST_F(Version, IsTheSameEverywhere) {
  const std::string version = between(file_of_project("CMakeLists.txt"), "project(monograin VERSION ", " ");
  ASSERT_FALSE(version.empty());
  EXPECT_EQ(monograin("--version").out, "monograin " + version + "\n");
  EXPECT_EQ(between(file_of_project("CITATION.cff"), "\nversion: ", "\n"), version);
}

TEST_F(Version, IsTheLatestOfTheChangelog) {
  const std::string version = between(file_of_project("CMakeLists.txt"), "project(monograin VERSION ", " ");
  const std::string changelog = file_of_project("CHANGELOG.md");
  const std::size_t unreleased = changelog.find("\n## [Unreleased]\n");
  ASSERT_NE(unreleased, std::string::npos);
  const std::string_view released = std::string_view(changelog).substr(unreleased + 1);
  EXPECT_EQ(between(released, "\n## [", "] - "), version);
  const std::string date = between(released, "\n## [" + version + "] - ", "\n");
  EXPECT_EQ(between(file_of_project("CITATION.cff"), "\ndate-released: ", "\n"), date);
}

TEST_F(Version, HasTheReferencesOfAllModelsInItsCitation) {
  const std::string entries = monograin("cite").out;
  const std::string citation = file_of_project("CITATION.cff");
  std::size_t dois = 0;
  for (std::size_t at = entries.find("doi = {"); at != std::string::npos; at = entries.find("doi = {", at + 1)) {
    const std::string doi = between(std::string_view(entries).substr(at), "doi = {", "}");
    EXPECT_NE(citation.find("doi: " + doi + "\n"), std::string::npos) << doi;
    ++dois;
  }
  EXPECT_GE(dois, 5U);
}

}  // namespace
}  // namespace monograin::version_test
