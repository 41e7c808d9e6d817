// A material point, run as a user runs it: exit codes, files and messages.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "history/table.hpp"
#include "support/temporary_folder.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_point = R"(model = "material-point"
[material]
preset = "Base case"
[loading]
configuration = "die"
[[loading.steps]]
strain = -0.2
duration = "1 s"
[[loading.steps]]
strain = 0
duration = "1 s"
until = { stress_axial = 0 }
)";

std::string read_text(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class MaterialPointCommand : public ::testing::Test {
 protected:
  MaterialPointCommand() { std::ofstream(folder_.path() / "point.toml", std::ios::binary) << k_point; }

  [[nodiscard]] int monograin(const std::string& arguments) const {
    const std::string command = "cd '" + folder_.path().string() + "' && '" MONOGRAIN_PROGRAM "' " + arguments +
                                " > stdout.txt 2> stderr.txt < /dev/null";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  [[nodiscard]] std::string text(const std::string& file) const { return read_text(folder_.path() / file); }
  [[nodiscard]] fs::path path(const std::string& file) const { return folder_.path() / file; }

 private:
  TemporaryFolder folder_;
};

TEST_F(MaterialPointCommand, RunsAndSaysWhyItIntegrates) {
  ASSERT_EQ(monograin("check point.toml"), 0) << text("stderr.txt");
  ASSERT_EQ(monograin("run point.toml"), 0) << text("stderr.txt");
  const Table history = read_csv(path("runs/point/history.csv"));
  EXPECT_EQ(history.header_value("sign"), "tension positive");
  EXPECT_TRUE(history.find("strain_axial[-]").has_value());
  const auto run = nlohmann::json::parse(text("runs/point/run.json"));
  EXPECT_EQ(run.at("integrator").at("asked"), "auto");
  EXPECT_EQ(run.at("integrator").at("used"), "odeint-dopri5, cvode-bdf where stiff");
  EXPECT_NE(run.at("integrator").at("why").get<std::string>().find("depends on the way"), std::string::npos);
  EXPECT_TRUE(run.at("classes").empty());
}

TEST_F(MaterialPointCommand, KeepsTheHistoryUpToTheEndOfTheDomain) {
  EXPECT_EQ(monograin("run point.toml --set loading.steps[0].strain=-0.4"), 3);
  EXPECT_NE(text("stderr.txt").find("the cap's centre has reached zero pressure"), std::string::npos);
  EXPECT_NE(text("runs/point/history.csv").find("# status: stopped"), std::string::npos);
  EXPECT_NE(text("runs/point/events.csv").find("cap-centre-tensile"), std::string::npos);
}

TEST_F(MaterialPointCommand, RefusesWhatDoesNotGoTogetherWithItsPlace) {
  EXPECT_EQ(monograin("run point.toml --set numerics.integrator=direct"), 2);
  EXPECT_NE(text("stderr.txt").find("goes with yield_model = \"vm\""), std::string::npos) << text("stderr.txt");
  EXPECT_EQ(monograin("run point.toml --set \"material.preset='MCC PH-102'\""), 2);
  EXPECT_NE(text("stderr.txt").find("relative_density above 0.434177"), std::string::npos) << text("stderr.txt");
  EXPECT_EQ(monograin("run point.toml --set particle.radius=1"), 2);
  EXPECT_NE(text("stderr.txt").find("is not used by model 'material-point'"), std::string::npos) << text("stderr.txt");
  EXPECT_FALSE(fs::exists(path("runs")));
}

TEST_F(MaterialPointCommand, DescribesTheModelAndItsConstants) {
  ASSERT_EQ(monograin("models material-point"), 0);
  for (const char* word :
       {"yield_model", "MCC PH-200 (Table 4)", "lateral_stress", "plastic-tension", "poisson-half"}) {
    EXPECT_NE(text("stdout.txt").find(word), std::string::npos) << word;
  }
  ASSERT_EQ(monograin("models material-point --parameters point.toml"), 0);
  EXPECT_NE(text("stdout.txt").find("hydrostatic_strength"), std::string::npos);
  EXPECT_EQ(text("stdout.txt").find("radius  "), std::string::npos);
}

}  // namespace
}  // namespace monograin
