// A material point, run as a user runs it: exit codes, files and messages.

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/command_test.hpp"
#include "history/table.hpp"

namespace monograin::material_point_command_test {
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

class MaterialPointCommand : public CommandTest {
 protected:
  MaterialPointCommand() { write_text(path("point.toml"), k_point); }
};

TEST_F(MaterialPointCommand, RunsAndSaysWhyItIntegrates) {
  ASSERT_EQ(monograin("check point.toml").code, 0) << text("stderr.txt");
  ASSERT_EQ(monograin("run point.toml").code, 0) << text("stderr.txt");
  const Table history = read_csv(path("runs/point/history.csv"));
  EXPECT_EQ(history.header_value("sign"), "tension positive");
  EXPECT_TRUE(history.find("strain_axial[-]").has_value());
  const auto run = nlohmann::json::parse(text("runs/point/run.json"));
  EXPECT_EQ(run.at("integrator").at("asked"), "auto");
  EXPECT_EQ(run.at("integrator").at("used"), "odeint-dopri5, cvode-bdf where stiff");
  EXPECT_NE(run.at("integrator").at("why").get<std::string>().find("depends on the path"), std::string::npos);
  EXPECT_TRUE(run.at("classes").empty());
}

TEST_F(MaterialPointCommand, KeepsTheHistoryUpToTheEndOfTheDomain) {
  EXPECT_EQ(monograin("run point.toml -o runs/point --set loading.steps[0].strain=-0.4").code, 3);
  EXPECT_NE(text("stderr.txt").find("the cap's centre has reached zero pressure"), std::string::npos);
  EXPECT_NE(text("runs/point/history.csv").find("# status: stopped"), std::string::npos);
  EXPECT_NE(text("runs/point/events.csv").find("cap-centre-tensile"), std::string::npos);
}

TEST_F(MaterialPointCommand, RefusesWhatDoesNotGoTogetherWithItsPlace) {
  EXPECT_EQ(monograin("run point.toml --set numerics.integrator=direct").code, 2);
  EXPECT_NE(text("stderr.txt").find("goes with yield_model = \"vm\""), std::string::npos) << text("stderr.txt");
  EXPECT_EQ(monograin("run point.toml --set \"material.preset='MCC PH-102'\"").code, 2);
  EXPECT_NE(text("stderr.txt").find("relative_density above 0.434177"), std::string::npos) << text("stderr.txt");
  EXPECT_EQ(monograin("run point.toml --set particle.radius=1").code, 2);
  EXPECT_NE(text("stderr.txt").find("is not used by model 'material-point'"), std::string::npos) << text("stderr.txt");
  EXPECT_FALSE(fs::exists(path("runs")));
}

TEST_F(MaterialPointCommand, DescribesTheModelAndItsConstants) {
  ASSERT_EQ(monograin("models material-point").code, 0);
  for (const char* word :
       {"yield_model", "\"MCC PH-200\", Table 4", "lateral_stress", "plastic-tension", "poisson-half"}) {
    EXPECT_NE(text("stdout.txt").find(word), std::string::npos) << word;
  }
  ASSERT_EQ(monograin("models material-point --parameters point.toml").code, 0);
  EXPECT_NE(text("stdout.txt").find("hydrostatic_strength"), std::string::npos);
  EXPECT_EQ(text("stdout.txt").find("radius  "), std::string::npos);
}

}  // namespace
}  // namespace monograin::material_point_command_test
