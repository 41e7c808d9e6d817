#include "history/staged_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <string>

#include "support/refusal.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"

namespace monograin {
namespace {

constexpr std::string_view k_marker = "result.csv";

/// Writes a result with one more file than its marker.
void write_result(const StagedFolder& staged, const std::string& text) {
  write_text(staged.path() / k_marker, "# program: monograin 0.1.0\n" + text);
  write_text(staged.path() / "more.csv", text);
}

class StagedFolderTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path target() const { return folder_.path() / "result"; }
  [[nodiscard]] std::string more() const { return read_text(target() / "more.csv"); }

 private:
  TemporaryFolder folder_;
};

TEST_F(StagedFolderTest, TheLastOfTwoResultsThatBeganInOneNewFolderStays) {
  StagedFolder first(target(), k_marker);
  StagedFolder second(target(), k_marker);
  write_result(first, "first");
  write_result(second, "second");
  first.publish(0.0);
  EXPECT_EQ(more(), "first");
  second.publish(0.0);
  EXPECT_EQ(more(), "second");
}

TEST_F(StagedFolderTest, AFileOfTheUserThatCameMeanwhileStays) {
  StagedFolder staged(target(), k_marker);
  write_result(staged, "result");
  std::filesystem::create_directory(target());
  write_text(target() / "more.csv", "mine");
  EXPECT_TRUE(contains(refusal<std::runtime_error>([&] {
                         staged.publish(0.0);
                         return 0;
                       }),
                       "more.csv: monograin has not written this file"));
  EXPECT_EQ(more(), "mine");
  EXPECT_FALSE(std::filesystem::exists(target() / k_marker));
}

TEST_F(StagedFolderTest, AResultOfAnotherKindThatCameMeanwhileStays) {
  StagedFolder late(target(), k_marker);
  write_result(late, "late");
  StagedFolder other(target(), "other.csv");
  write_text(other.path() / "other.csv", "# program: monograin 0.1.0\n");
  other.publish(0.0);
  EXPECT_TRUE(contains(refusal<std::runtime_error>([&] {
                         late.publish(0.0);
                         return 0;
                       }),
                       "holds a result of another kind (no result.csv)"));
  EXPECT_FALSE(std::filesystem::exists(target() / "more.csv"));
}

}  // namespace
}  // namespace monograin
