// Hidden files and folders: what becomes of them, and how messages show them.

#include "scenario/hidden_path.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>
#include <utility>

#include "scenario/text_file.hpp"
#include "support/refusal.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"

namespace monograin::hidden_path_test {
namespace {

namespace fs = std::filesystem;

class HiddenFolder : public ::testing::Test {
 protected:
  [[nodiscard]] HiddenPath make() const {
    fs::create_directories(place() / "sub");
    write_text(place() / "sub" / "file", "half a line");
    return {place(), "shown/r"};
  }
  [[nodiscard]] fs::path place() const { return folder_.path() / ".hidden"; }

 private:
  TemporaryFolder folder_;
};

TEST_F(HiddenFolder, IsRemovedWithItsContent) {
  {
    HiddenPath first = make();
    const HiddenPath second = std::move(first);
    EXPECT_EQ(second.path(), place());
    EXPECT_TRUE(fs::exists(place()));
  }
  EXPECT_FALSE(fs::exists(place()));
}

TEST_F(HiddenFolder, StaysOnceItIsReleased) {
  {
    HiddenPath hidden = make();
    hidden.release();
    EXPECT_EQ(shown_path(place()), place());
  }
  EXPECT_TRUE(fs::exists(place()));
}

TEST_F(HiddenFolder, IsShownAsWhatItStandsFor) {
  const HiddenPath hidden = make();
  EXPECT_EQ(shown_path(place()), "shown/r");
  EXPECT_EQ(shown_path(place() / "sub" / "file"), "shown/r/sub/file");
  EXPECT_EQ(shown_path(place().parent_path() / ".hidden2"), place().parent_path() / ".hidden2");
  const std::string said = refusal<std::runtime_error>([&] { write_text_file(place() / "none" / "file", "text"); });
  EXPECT_TRUE(contains(said, "shown/r/none/file: cannot be written: No such file or directory")) << said;
}

}  // namespace
}  // namespace monograin::hidden_path_test
