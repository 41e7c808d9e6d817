// Where the program takes the definitions from that come with it. For an installation tests/install/program_test.sh
// sees to that.

#include <gtest/gtest.h>

#include <string>

#include "cli/command_test.hpp"

namespace monograin::data_folder_command_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_list = "monograin atlas --list";

class DataFolder : public CommandTest {
 protected:
  /// A definition of this name in a folder.
  void write_definition(const std::string& folder, const std::string& name) const {
    fs::create_directories(path(folder));
    write_text(path(folder) / (name + ".toml"),
               "title = \"T\"\nsource = \"s\"\n[[panel]]\n"
               "curve = [{ parameter = { from = 0, to = 1 }, x = \"t\", y = \"t\" }]\n");
  }
};

TEST_F(DataFolder, IsTheCheckoutForAProgramInABuild) {
  const Outcome outcome = monograin("atlas --list");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("mdr-fe "), std::string::npos) << outcome.out;
}

TEST_F(DataFolder, IsTheCurrentOneWhereItHasWhatIsNeeded) {
  write_definition("plots", "mine");
  EXPECT_EQ(monograin("atlas --list").out, "mine  T\n");
}

TEST_F(DataFolder, IsThatOfTheEnvironmentFirstOfAll) {
  write_definition("plots", "mine");
  write_definition("other/plots", "yours");
  EXPECT_EQ(shell(std::string("export MONOGRAIN_DATA=other\n") + k_list).out, "yours  T\n");
  const Outcome empty = shell(std::string("export MONOGRAIN_DATA=\n") + k_list);
  EXPECT_EQ(empty.out, "mine  T\n");
}

TEST_F(DataFolder, OfTheEnvironmentHasToHaveWhatIsNeeded) {
  write_definition("plots", "mine");
  const Outcome outcome = shell(std::string("export MONOGRAIN_DATA=nowhere\n") + k_list);
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("MONOGRAIN_DATA = nowhere has no 'plots'; expected a folder with scenarios, plots and "
                             "curves"),
            std::string::npos)
      << outcome.err;
}

TEST_F(DataFolder, OfTheProgramIsNotWrittenTo) {
  write_definition("other/plots", "yours");
  const Outcome outcome = shell("export MONOGRAIN_DATA=other\nmonograin atlas yours");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(fs::exists(path("figures/yours.svg")));
  EXPECT_FALSE(fs::exists(path("other/plots/yours.svg")));
}

// A program that was copied alone has no data. Every command that needs them names the option that says where they are.
TEST_F(DataFolder, IsAskedForByACopyOfTheProgramAlone) {
  fs::copy_file(MONOGRAIN_PROGRAM, path("copy"));
  const auto expect_message = [&](const std::string& command, const std::string& message) {
    const Outcome outcome = shell("./copy " + command);
    EXPECT_EQ(outcome.code, 2) << command;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << outcome.err;
  };
  const std::string remedy = "run this in the project's folder, or name ";
  expect_message("atlas", "plots: no such folder; " + remedy + "it with --plots");
  expect_message("bench", "scenarios/bench/scenes.toml: no such file; " + remedy + "the list with --scenes");
  expect_message("bench --against-fe", "plots: no such folder; " + remedy + "it with --plots");
  expect_message("regress", "scenarios: no such folder; " + remedy + "it with --scenarios");
}

}  // namespace
}  // namespace monograin::data_folder_command_test
