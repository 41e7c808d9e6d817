// Calibration: parameters found again, errors in closed form, faults of files, and what is written.

#include "study/calibrate/calibration.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>
#include <string>
#include <vector>

#include "elastic/hertz.hpp"
#include "history/run.hpp"
#include "history/table.hpp"
#include "study/calibrate/calibration_text.hpp"
#include "support/refusal.hpp"
#include "support/scenario_texts.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"

namespace monograin::calibration_test {
namespace {

namespace fs = std::filesystem;

constexpr double k_radius = 0.01;
constexpr double k_poisson = 0.22;

constexpr const char* k_mdr = R"(model = "mdr"
[particle]
radius = "10 mm"
[material]
youngs_modulus = "1 GPa"
poisson_ratio = 0.3
yield_stress = "40 MPa"
[loading]
configuration = "simple"
[[loading.steps]]
displacement = "0.3 R0"
duration = "1 s"
)";

constexpr const char* k_calibration = R"(scenario = "s.toml"
[data]
file = "d.csv"
x = "displacement[m]"
y = "force[N]"
[free]
"material.youngs_modulus" = { from = "10 GPa", to = "300 GPa" }
)";

constexpr const char* k_data = "displacement[m],force[N]\n1e-5,35\n2e-5,100\n3e-5,180\n";

/// Force per modulus of the Hertz scenario.
double hertz_force_per_modulus(double displacement) {
  return hertz_force(1.0 / (1.0 - k_poisson * k_poisson), k_radius, displacement);
}

struct Row {
  double x;
  double y;
  double weight = 1.0;
};

std::string csv_of(const std::vector<Row>& rows, const std::string& headings) {
  std::string text = "# synthetic\n" + headings + '\n';
  for (const Row& row : rows) text += fmt::format("{:.17g},{:.17g},{:.17g}\n", row.x, row.y, row.weight);
  return text;
}

class CalibrationTest : public ::testing::Test {
 protected:
  void SetUp() override {
    write("s.toml", k_hertz_text);
    write("c.toml", k_calibration);
    write("d.csv", k_data);
  }

  void write(const std::string& name, const std::string& text) const { write_text(folder() / name, text); }
  [[nodiscard]] std::string text_of(const fs::path& file) const { return read_text(folder() / file); }

  [[nodiscard]] Calibration read() const { return read_calibration(folder() / "c.toml"); }

  /// The messages with which c.toml is refused, without the folder.
  [[nodiscard]] std::vector<std::string> faults() const {
    std::vector<std::string> messages;
    try {
      static_cast<void>(read());
    } catch (const ScenarioError& error) {
      for (const Fault& fault : error.faults()) {
        messages.push_back(fmt::format("{}:{}:{}: {}", fs::path(fault.where.file).filename().string(), fault.where.line,
                                       fault.where.column, fault.message));
      }
    }
    return messages;
  }

  /// Rows at output points of a scenario that is run with a program of its own.
  [[nodiscard]] static std::vector<Row> measure(const std::string& scenario, const std::vector<std::string>& overrides,
                                                const std::string& x = "axial.displacement",
                                                const std::string& y = "axial.force") {
    const Table history = run_scenario(parse_scenario(scenario, "s.toml", overrides)).record.history;
    std::vector<Row> rows;
    for (std::size_t i = 0; i < history.row_count(); ++i) {
      if (history.at(i, *history.find("row")) != 0.0) continue;
      rows.push_back({history.at(i, *history.find(x)), history.at(i, *history.find(y))});
    }
    return rows;
  }

  [[nodiscard]] const fs::path& folder() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

constexpr const char* k_two_free = R"(scenario = "s.toml"
[data]
file = "d.csv"
x = "axial.displacement[m]"
y = "axial.force[N]"
[free]
"material.youngs_modulus" = { from = "0.1 GPa", to = "10 GPa" }
"material.yield_stress" = { from = "5 MPa", to = "200 MPa" }
)";

// --- bounds beyond a law's end

constexpr const char* k_semimech = R"(model = "semimech"
[particle]
radius = "1 mm"
[material]
youngs_modulus = "2 GPa"
poisson_ratio = 0.3
yield_stress = "20 MPa"
[loading]
configuration = "simple"
[[loading.steps]]
displacement = "0.2 R0"
duration = "1 s"
)";

TEST_F(CalibrationTest, PassesOverCornersOfTheBoxInWhichTheLawEnds) {
  // E/((1-nu^2) Y) has to be 22 or more, and is 0.5 in one corner. The true values have 80.
  write("s.toml", k_semimech);
  write("c.toml", k_two_free);
  const auto rows =
      measure(k_semimech, {"material.youngs_modulus=2.2e9", "material.yield_stress=3e7", "output.points=25"});
  write("d.csv", csv_of({rows.begin() + 1, rows.end()}, "axial.displacement[m],axial.force[N],w[-]"));
  const CalibrationResult result = calibrate(read());
  EXPECT_NEAR(result.solution.parameters[0] / 2.2e9, 1.0, 1e-5);
  EXPECT_NEAR(result.solution.parameters[1] / 3e7, 1.0, 1e-5);
  EXPECT_GT(result.solution.failures, 0);
}

TEST_F(CalibrationTest, NamesTheBoundsWithinWhichTheLawHasNoPoint) {
  write("s.toml", k_semimech);
  write("d.csv", "axial.displacement[m],axial.force[N]\n0.0001,1\n0.0002,2\n0.0003,3\n");
  write("c.toml",
        replaced(replaced(k_two_free, "to = \"10 GPa\"", "to = \"0.3 GPa\""), "from = \"5 MPa\"", "from = \"20 MPa\""));
  const auto messages = faults();
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0].find("c.toml:7:1: the scenario does not take 'material.youngs_modulus' from 0.1 to 0.3 GPa: "
                             "E/((1-nu^2) Y) = "),
            0U)
      << messages[0];
  // Together with a yield stress that is free to fall, such a modulus has a law.
  write("c.toml", replaced(k_two_free, "to = \"10 GPa\"", "to = \"0.3 GPa\""));
  EXPECT_TRUE(faults().empty());
}

// --- fits

TEST_F(CalibrationTest, FindsTheParametersOfExactDataWithUnloadingAndReloading) {
  write("s.toml", k_mdr);
  write("c.toml", k_two_free);
  const auto rows = measure(
      k_mdr,
      {"material.youngs_modulus=1.3e9", "material.yield_stress=3.1e7", "output.points=12",
       "loading.steps=[{displacement='0.2 R0',duration=1},{displacement='0.19 R0',duration=1},{displacement='0.25 "
       "R0',duration=1},{displacement='0.235 R0',duration=1}]"});
  write("d.csv", csv_of(rows, "axial.displacement[m],axial.force[N],w"));
  const Calibration calibration = read();
  const CalibrationResult result = calibrate(calibration);
  EXPECT_EQ(result.program_steps, 4U);
  EXPECT_NEAR(result.solution.parameters[0] / 1.3e9, 1.0, 1e-9);
  EXPECT_NEAR(result.solution.parameters[1] / 3.1e7, 1.0, 1e-9);
  EXPECT_TRUE(result.solution.has_converged);
  // No interpolation: the model is evaluated at each datum.
  EXPECT_LT(result.goodness.largest, 1e-9 * 1e4);
  EXPECT_GT(result.goodness.r_squared, 1.0 - 1e-15);
}

/// Rows at equal times of a load to 0.2 R0 and an unloading at the same speed. The last row before the turn lies a
/// share of a step before it.
std::vector<std::string> rows_beside_the_turn(int rows, double share) {
  std::vector<std::string> instants;
  const double step = 1.0 / (rows + share);
  for (int row = 0; row * step < 1.2; ++row) instants.push_back(fmt::format("{:.17g}", row * step));
  return {"loading.steps=[{ displacement = \"0.2 R0\", duration = 1 }, { displacement = \"0.16 R0\", duration = 0.2 }]",
          fmt::format("output.times=[{}]", fmt::join(instants, ", "))};
}

TEST_F(CalibrationTest, FindsTheParametersWhereTheTurnLiesBetweenTwoRows) {
  write("s.toml", k_mdr);
  write("c.toml", k_two_free);
  for (const double share : {0.02, 0.3, 0.5, 0.8}) {
    const std::vector<Row> rows = measure(k_mdr, rows_beside_the_turn(50, share));
    write("d.csv", csv_of(rows, "axial.displacement[m],axial.force[N],w"));
    const CalibrationResult result = calibrate(read());
    EXPECT_NEAR(result.solution.parameters[0] / 1e9, 1.0, 1e-6) << share;
    EXPECT_NEAR(result.solution.parameters[1] / 40e6, 1.0, 1e-6) << share;
    // The curve of the figure passes through the fit at every row, and turns where that does.
    const FittedCurve& curve = result.curves.at(0);
    EXPECT_NEAR(std::ranges::max(curve.x), 0.2 * k_radius, 1e-9 * k_radius);
    std::size_t place = 0;
    for (std::size_t row = 0; row < rows.size(); ++row) {
      while (place < curve.x.size() && curve.x[place] != rows[row].x) ++place;
      ASSERT_LT(place, curve.x.size()) << row;
      EXPECT_NEAR(curve.y[place++], result.fit.y[row], 1e-9 * rows[50].y) << share << ", row " << row;
    }
  }
}

TEST_F(CalibrationTest, SaysWhereUnevenRowsMayHaveMissedTheTurn) {
  write("s.toml", k_mdr);
  write("c.toml", k_two_free);
  std::vector<Row> rows = measure(k_mdr, rows_beside_the_turn(50, 0.5));
  const auto note = [&](const std::vector<Row>& measured) {
    write("d.csv", csv_of(measured, "axial.displacement[m],axial.force[N],w"));
    const std::vector<std::string> notes = calibrate(read()).notes;
    const auto found = std::ranges::find_if(
        notes, [](const std::string& text) { return text.find("record the turn") != std::string::npos; });
    return found == notes.end() ? std::string() : *found;
  };
  EXPECT_EQ(note(rows), "");
  rows.erase(rows.begin() + 49);  // 48 and 50 are left before the turn
  EXPECT_NE(note(rows).find("axial.displacement turns in line 52, or beside it by up to"), std::string::npos)
      << note(rows);
}

// Rows at equal times pass the turn between two rows; those of a machine that measures at chosen displacements do not.
TEST_F(CalibrationTest, SaysWhereItTakesATurnBeyondTheRowsUnlessTheirLineIsRepeated) {
  write("s.toml", k_mdr);
  write("c.toml", k_two_free);
  std::vector<Row> rows = measure(k_mdr, rows_beside_the_turn(50, 0.3));
  const auto has_note = [&] {
    write("d.csv", csv_of(rows, "axial.displacement[m],axial.force[N],w"));
    return std::ranges::any_of(calibrate(read()).notes,
                               [](const std::string& text) { return contains(text, "repeat the line"); });
  };
  EXPECT_TRUE(has_note());
  const auto extreme = std::ranges::max_element(rows, {}, &Row::x);
  rows.insert(extreme, *extreme);
  EXPECT_FALSE(has_note());
}

TEST_F(CalibrationTest, NoiseInProportionToTheForceMakesItNeitherSmallerNorLarger) {
  // Forces a tenth too large and too small by turns. By the noise of each datum the small ones would count more: 68.6
  // GPa.
  std::vector<Row> rows;
  for (int i = 0; i < 40; ++i) {
    const double x = 1e-5 * (1 + i / 2);
    rows.push_back({x + 1e-9 * (i % 2), 70e9 * hertz_force_per_modulus(x) * (i % 2 == 0 ? 1.1 : 0.9)});
  }
  write("d.csv", csv_of(rows, "displacement[m],force[N],w"));
  std::string text = k_calibration;
  text.insert(text.find("[free]"), "noise = { relative = 0.1 }\n");
  write("c.toml", text);
  const CalibrationResult result = calibrate(read());
  EXPECT_NEAR(result.solution.parameters[0] / 70e9, 1.0, 1e-3);
  for (std::size_t row = 0; row < rows.size(); ++row) EXPECT_NEAR(result.weights[row] * result.fit.y[row], 10.0, 1e-4);
}

TEST_F(CalibrationTest, SaysThatAnOverrideOfAParameterOfTheFitHasNoEffect) {
  std::string text = k_calibration;
  text.insert(text.find("[free]"), "set = [\"material.youngs_modulus='2 GPa'\"]\n");
  write("c.toml", text);
  const std::vector<std::string> notes = calibrate(read()).notes;
  EXPECT_TRUE(std::ranges::any_of(
      notes, [](const std::string& note) { return note.find("has no effect: [free] has") != std::string::npos; }));
}

TEST_F(CalibrationTest, FindsTheParametersOfForceDrivenData) {
  write("s.toml", k_mdr);
  write("c.toml", replaced(replaced(k_two_free, "x = \"axial.displacement[m]\"", "x = \"force[kN]\""),
                           "y = \"axial.force[N]\"", "y = \"displacement[R0]\""));
  auto rows = measure(k_mdr,
                      {"material.youngs_modulus=1.3e9", "material.yield_stress=3.1e7", "output.points=10",
                       "loading.steps=[{force='5 kN',duration=1},{force='2 kN',duration=1}]"},
                      "axial.force", "axial.displacement");
  for (Row& row : rows) {
    row.x /= 1e3;
    row.y /= k_radius;
  }
  write("d.csv", csv_of(rows, "force[kN],displacement[R0],w"));
  const CalibrationResult result = calibrate(read());
  EXPECT_NEAR(result.solution.parameters[0] / 1.3e9, 1.0, 1e-8);
  EXPECT_NEAR(result.solution.parameters[1] / 3.1e7, 1.0, 1e-8);
}

// --- lengths

constexpr const char* k_free_radius = R"(scenario = "s.toml"
[data]
file = "d.csv"
x = "displacement[m]"
y = "force[N]"
noise = { relative = 0.01 }
[free]
"particle.radius" = { from = "1 mm", to = "50 mm" }
)";

/// Displacements from first touch, and the forces of elastic contacts of that radius.
std::vector<Row> hertz_of_radius(double radius, double deviation = 0.0) {
  std::mt19937 generator(11);
  std::normal_distribution<double> noise(0.0, 1.0);
  std::vector<Row> rows;
  for (int i = 1; i <= 80; ++i) {
    const double x = 1e-6 * i;
    const double force = hertz_force(50e9 / (1.0 - k_poisson * k_poisson), radius, x);
    rows.push_back({x, force * (1.0 + deviation * noise(generator))});
  }
  return rows;
}

TEST_F(CalibrationTest, FindsTheRadiusOfExactData) {
  write("c.toml", k_free_radius);
  write("d.csv", csv_of(hertz_of_radius(7.3e-3), "displacement[m],force[N],w"));
  const Calibration calibration = read();
  const CalibrationResult result = calibrate(calibration);
  EXPECT_NEAR(result.solution.parameters[0] / 7.3e-3, 1.0, 1e-6);
  const CheckedScenario fitted = parse_scenario(fitted_scenario_text(calibration, result), "fitted.toml");
  EXPECT_EQ(fitted.radius, result.solution.parameters[0]);
}

// F ~ sqrt(R): with forces known to 1 % each, the radius is known to 2 % over the root of their number.
TEST_F(CalibrationTest, KnowsTheRadiusTwiceAsBadlyAsTheForces) {
  write("c.toml", k_free_radius);
  write("d.csv", csv_of(hertz_of_radius(7.3e-3, 0.01), "displacement[m],force[N],w"));
  const CalibrationResult result = calibrate(read());
  const double expected = 7.3e-3 * 2.0 * 0.01 / std::sqrt(80.0);
  EXPECT_NEAR(result.uncertainty.standard_error(0) / expected, 1.0, 0.03);
  EXPECT_NEAR(result.solution.parameters[0], 7.3e-3, 3.0 * expected);
  EXPECT_GT(std::abs(result.solution.parameters[0] / 7.3e-3 - 1.0), 1e-5);
}

constexpr const char* k_free_gap = R"(scenario = "s.toml"
[data]
file = "d.csv"
x = "top.displacement[m]"
y = "late.force[N]"
noise = { absolute = "1 N" }
[free]
"loading.wall[1].gap" = { from = 0, to = "0.1 mm", start = 0 }
)";

/// Forces on a wall that goes from its gap to the displacement of another one, which touches from the start.
std::vector<Row> late_hertz(double gap, double radius, double deviation = 0.0) {
  std::mt19937 generator(3);
  std::normal_distribution<double> noise(0.0, deviation > 0.0 ? deviation : 1.0);
  const double end = 1e-4;
  std::vector<Row> rows;
  for (int i = 0; i <= 100; ++i) {
    const double x = end * i / 100.0;
    const double force = hertz_force(50e9 / (1.0 - k_poisson * k_poisson), radius, -gap + (end + gap) * x / end);
    rows.push_back({x, force + (deviation > 0.0 ? noise(generator) : 0.0)});
  }
  return rows;
}

// Symmetry makes both walls one class, which has the name of the first, where neither is late.
TEST(Replay, FindsAWallThatItsGapPutsIntoTheClassOfAnotherOne) {
  Replay replay(parse_scenario(k_late_wall_text, "s.toml"), {.driven = "top.displacement", .watched = "late.force"},
                path_through(std::vector{4e-5, 1e-4}));
  std::vector<double> forces(2);
  ASSERT_TRUE(replay.run(forces));
  EXPECT_LT(forces[0], 0.9 * 50e9 * hertz_force_per_modulus(4e-5));
  ASSERT_TRUE(replay.set("loading.wall[1].gap", 0.0));
  ASSERT_TRUE(replay.run(forces)) << replay.problem();
  EXPECT_NEAR(forces[0] / (50e9 * hertz_force_per_modulus(4e-5)), 1.0, 1e-9);
}

TEST_F(CalibrationTest, FindsTheGapOfALateWall) {
  write("s.toml", k_late_wall_text);
  write("c.toml", k_free_gap);
  write("d.csv", csv_of(late_hertz(3.7e-5, k_radius), "top.displacement[m],late.force[N],w"));
  const Calibration calibration = read();
  const CalibrationResult result = calibrate(calibration);
  EXPECT_NEAR(result.solution.parameters[0] / 3.7e-5, 1.0, 1e-6);
  const CheckedScenario fitted = parse_scenario(fitted_scenario_text(calibration, result), "fitted.toml");
  EXPECT_EQ(fitted.loading.walls[1].gap, result.solution.parameters[0]);
}

TEST_F(CalibrationTest, KnowsTheGapAsWellAsTheForcesTellIt) {
  write("s.toml", k_late_wall_text);
  write("c.toml", replaced(k_free_gap, "1 N", "5 N"));
  write("d.csv", csv_of(late_hertz(3.7e-5, k_radius, 5.0), "top.displacement[m],late.force[N],w"));
  const CalibrationResult result = calibrate(read());
  const auto above = late_hertz(3.7e-5 + 1e-9, k_radius);
  const auto below = late_hertz(3.7e-5 - 1e-9, k_radius);
  double information = 0.0;
  for (std::size_t i = 0; i < above.size(); ++i) information += std::pow((above[i].y - below[i].y) / 2e-9 / 5.0, 2);
  EXPECT_NEAR(result.uncertainty.standard_error(0) * std::sqrt(information), 1.0, 0.03);
  EXPECT_NEAR(result.solution.parameters[0], 3.7e-5, 3.0 / std::sqrt(information));
}

TEST_F(CalibrationTest, AGapInR0MovesWithTheRadius) {
  write("s.toml", k_late_wall_text);
  write("c.toml", replaced(replaced(k_free_radius, "x = \"displacement[m]\"", "x = \"top.displacement[m]\""),
                           "y = \"force[N]\"\nnoise = { relative = 0.01 }", "y = \"late.force[N]\""));
  write("d.csv", csv_of(late_hertz(0.002 * 7.3e-3, 7.3e-3), "top.displacement[m],late.force[N],w"));
  EXPECT_NEAR(calibrate(read()).solution.parameters[0] / 7.3e-3, 1.0, 1e-6);
}

// The driven wall begins behind its gap, and the late one is as late in time as that says.
TEST_F(CalibrationTest, TheStartOfADrivenWallMovesWithTheRadius) {
  const std::string scenario =
      replaced(k_late_wall_text, "normal = [0, 0, 1]", "normal = [0, 0, 1]\ngap = \"0.001 R0\"");
  write("s.toml", scenario);
  write("c.toml", replaced(replaced(k_free_radius, "x = \"displacement[m]\"", "x = \"top.displacement[m]\""),
                           "y = \"force[N]\"\nnoise = { relative = 0.01 }", "y = \"late.force[N]\""));
  write("d.csv", csv_of(measure(scenario, {"particle.radius=7.3 mm", "loading.steps[0].displacement=0.1 mm"},
                                "top.displacement", "late.force"),
                        "top.displacement[m],late.force[N],w"));
  EXPECT_NEAR(calibrate(read()).solution.parameters[0] / 7.3e-3, 1.0, 1e-6);
}

/// A plastic particle that two walls press until it meets fixed ones, all at one gap.
/// @param fixed  names and normals
std::string pressed_between(const std::vector<std::pair<std::string, std::string>>& fixed) {
  std::string text = R"(model = "mdr"
[particle]
radius = "10 mm"
[material]
youngs_modulus = "1 GPa"
poisson_ratio = 0.3
yield_stress = "40 MPa"
[loading]
configuration = "walls"
steps = [{ displacement = "0.4 R0", duration = "1 s" }]
)";
  const auto add = [&](const std::string& name, const std::string& normal, const char* rest) {
    text += "[[loading.wall]]\nname = \"" + name + "\"\nnormal = " + normal + "\n" + rest;
  };
  add("top", "[0, 0, 1]", "");
  add("bottom", "[0, 0, -1]", "");
  for (const auto& [name, normal] : fixed) add(name, normal, "gap = \"0.1 mm\"\nfixed = true\n");
  return text;
}

class CalibrationOfGaps : public CalibrationTest {
 protected:
  /// Writes a calibration that seeks a gap, and the data of a particle whose gap is 0.31 mm.
  /// @param path  of the gap
  void write_fit(const std::string& scenario, const std::string& path) const {
    write("s.toml", scenario);
    write("c.toml", replaced(replaced(k_free_gap, "late.force[N]", "side.force[N]"),
                             "loading.wall[1].gap\" = { from = 0, to = \"0.1 mm\", start = 0 }",
                             path + "\" = { from = \"0.01 R0\", to = \"0.08 R0\" }"));
    write("d.csv", csv_of(measure(scenario, {path + "=0.31 mm"}, "top.displacement", "side.force"),
                          "top.displacement[m],side.force[N],w"));
  }
};

TEST_F(CalibrationOfGaps, FindsTheGapOfAFixedWallThatAGrowingParticleMeets) {
  write_fit(pressed_between({{"side", "[1, 0, 0]"}}), "loading.wall[2].gap");
  EXPECT_NEAR(calibrate(read()).solution.parameters[0] / 3.1e-4, 1.0, 1e-6);
}

// A particle that is loose in its die: one clearance on all sides.
TEST_F(CalibrationOfGaps, FindsTheClearanceThatSeveralWallsShare) {
  write_fit(
      pressed_between({{"side", "[1, 0, 0]"}, {"left", "[-1, 0, 0]"}, {"front", "[0, 1, 0]"}, {"back", "[0, -1, 0]"}}),
      "loading.wall[2-5].gap");
  const Calibration calibration = read();
  const CalibrationResult result = calibrate(calibration);
  EXPECT_NEAR(result.solution.parameters[0] / 3.1e-4, 1.0, 1e-6);
  const CheckedScenario fitted = parse_scenario(fitted_scenario_text(calibration, result), "fitted.toml");
  for (std::size_t wall = 2; wall < 6; ++wall) EXPECT_EQ(fitted.loading.walls[wall].gap, result.solution.parameters[0]);
}

TEST_F(CalibrationTest, RefusesAGapThatIsFreeTwice) {
  write("s.toml", k_late_wall_text);
  write("c.toml", std::string(k_free_gap) + "\"loading.wall[0-1].gap\" = { from = 0, to = \"0.1 mm\" }\n");
  write("d.csv", csv_of(late_hertz(3.7e-5, k_radius), "top.displacement[m],late.force[N],w"));
  const std::vector<std::string> found = faults();
  ASSERT_GE(found.size(), 1U);
  EXPECT_EQ(found[0], "c.toml:9:1: 'loading.wall[1].gap' is free already; expected it once");
}

TEST_F(CalibrationTest, RefusesTheGapOfTheWallThatXDrives) {
  write("s.toml", k_late_wall_text);
  write("c.toml", replaced(k_free_gap, "wall[1]", "wall[0]"));
  write("d.csv", csv_of(late_hertz(3.7e-5, k_radius), "top.displacement[m],late.force[N],w"));
  ASSERT_EQ(faults().size(), 1U);
  EXPECT_EQ(faults()[0],
            "c.toml:7:1: 'loading.wall[0].gap' cannot be free: displacements of wall 'top', which x drives, count from "
            "first touch; expected \"data.offset\", or the gap of another wall");
}

constexpr const char* k_powder = R"(model = "material-point"
[material]
preset = "MCC PH-200"
relative_density = 0.45
yield_pressure = "5 MPa"
eta = 4
[loading]
configuration = "die"
[[loading.steps]]
strain = -0.3
duration = "1 s"
[numerics]
rtol = 1e-6
)";

constexpr const char* k_hardening = R"(scenario = "s.toml"
[data]
file = "d.csv"
x = "X"
y = "Y"
[free]
"material.yield_pressure" = { from = "2 MPa", to = "20 MPa" }
"material.eta" = { from = 2, to = 10 }
)";

// Loading, unloading and reloading in a die, by the method that integrates.
TEST_F(CalibrationTest, FindsTheHardeningOfAMaterialPoint) {
  write("s.toml", k_powder);
  write("c.toml", replaced(replaced(k_hardening, "\"X\"", "\"strain_axial\""), "\"Y\"", "\"stress_axial\""));
  const auto rows =
      measure(k_powder,
              {"material.yield_pressure=8.61e6", "material.eta=6.11", "output.points=5",
               "loading.steps=[{strain=-0.2,duration=1},{strain=-0.19,duration=1},{strain=-0.25,duration=1}]"},
              "strain_axial", "stress_axial");
  write("d.csv", csv_of(rows, "strain_axial[-],stress_axial[Pa],w"));
  const CalibrationResult result = calibrate(read());
  EXPECT_EQ(result.program_steps, 3U);
  EXPECT_NEAR(result.solution.parameters[0] / 8.61e6, 1.0, 1e-6);
  EXPECT_NEAR(result.solution.parameters[1] / 6.11, 1.0, 1e-6);
  EXPECT_TRUE(result.solution.has_converged);
}

// Density over pressure: the stress drives.
TEST_F(CalibrationTest, FindsTheHardeningBehindDensities) {
  write("s.toml", k_powder);
  write("c.toml",
        replaced(replaced(replaced(k_hardening, "\"X\"", "\"stress_axial\""), "\"Y\"", "\"relative_density\""),
                 "\"material.yield_pressure\" = { from = \"2 MPa\", to = \"20 MPa\" }\n", ""));
  const auto rows = measure(
      k_powder,
      {"material.eta=6.11", "output.points=6",
       "loading.steps=[{stress='-15 MPa',duration=1},{stress='-10 MPa',duration=1},{stress='-40 MPa',duration=1}]"},
      "stress_axial", "relative_density");
  write("d.csv", csv_of(rows, "stress_axial[Pa],relative_density[-],w"));
  const CalibrationResult result = calibrate(read());
  EXPECT_NEAR(result.solution.parameters[0] / 6.11, 1.0, 1e-6);
  EXPECT_TRUE(result.solution.has_converged);
}

// Numbers for which there is no yield surface are passed over.
TEST_F(CalibrationTest, TriesNoMaterialWithoutAYieldSurface) {
  write("s.toml", k_powder);
  write("c.toml", R"(scenario = "s.toml"
[data]
file = "d.csv"
x = "strain_axial"
y = "stress_axial"
[free]
"material.eps0" = { from = -0.4, to = 1.4, start = 0.3 }
)");
  write("d.csv", csv_of(measure(k_powder, {"output.points=12"}, "strain_axial", "stress_axial"),
                        "strain_axial[-],stress_axial[Pa],w"));
  const CalibrationResult result = calibrate(read());
  EXPECT_NEAR(result.solution.parameters[0], 0.147, 1e-6);
  EXPECT_GT(result.solution.failures, 0U);
}

TEST_F(CalibrationTest, DataDriveTheAxialDirectionAlone) {
  const std::string steps = "strain = -0.3\n";
  write("s.toml",
        replaced(replaced(k_powder, "\"die\"", "\"triaxial\""), steps, steps + "lateral_stress = \"-1 MPa\"\n"));
  write("c.toml", replaced(replaced(k_hardening, "\"X\"", "\"strain_axial\""), "\"Y\"", "\"stress_axial\""));
  write("d.csv", "strain_axial[-],stress_axial[Pa]\n-0.1,-1e6\n-0.2,-2e6\n-0.3,-4e6\n");
  const auto messages = faults();
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_TRUE(messages[0].starts_with("c.toml:1:12: the scenario's steps prescribe the lateral direction too"))
      << messages[0];
}

/// Noisy Hertz data, for which the fit has a closed form: force is linear in Young's modulus.
std::vector<Row> noisy_hertz() {
  std::mt19937 generator(11);
  std::normal_distribution<double> noise;
  std::vector<Row> rows;
  for (int i = 1; i <= 25; ++i) {
    const double x = 4e-6 * i;
    rows.push_back({x, 70e9 * hertz_force_per_modulus(x) * (1.0 + 0.03 * noise(generator)), 0.1 + 0.05 * i});
  }
  return rows;
}

struct ClosedForm {
  double modulus;
  double standard_error;
};

/// @param weight  factor of each residual
template <class Weight>
ClosedForm closed_form(const std::vector<Row>& rows, Weight weight) {
  double cc = 0.0;
  double cp = 0.0;
  for (const Row& row : rows) {
    const double c = weight(row) * hertz_force_per_modulus(row.x);
    cc += c * c;
    cp += c * weight(row) * row.y;
  }
  const double modulus = cp / cc;
  double squares = 0.0;
  for (const Row& row : rows) {
    squares += std::pow(weight(row) * (row.y - modulus * hertz_force_per_modulus(row.x)), 2);
  }
  return {modulus, std::sqrt(squares / static_cast<double>(rows.size() - 1) / cc)};
}

TEST_F(CalibrationTest, StandardErrorsAreThoseOfTheLinearFitInClosedForm) {
  const auto rows = noisy_hertz();
  write("d.csv", csv_of(rows, "displacement[m],force[N],w"));
  const std::vector<std::pair<std::string, ClosedForm>> cases{
      {"weights = \"absolute\"", closed_form(rows, [](const Row&) { return 1.0; })},
      {"weights = \"relative\"", closed_form(rows, [](const Row& row) { return 1.0 / row.y; })},
      {"weights = \"column\"\nweight_column = \"w\"", closed_form(rows, [](const Row& row) { return row.weight; })}};
  for (const auto& [weights, expected] : cases) {
    write("c.toml", replaced(k_calibration, "[free]", weights + "\n[free]"));
    const CalibrationResult result = calibrate(read());
    EXPECT_NEAR(result.solution.parameters[0] / expected.modulus, 1.0, 1e-9) << weights;
    EXPECT_NEAR(result.uncertainty.standard_error(0) / expected.standard_error, 1.0, 1e-7) << weights;
    EXPECT_EQ(result.uncertainty.degrees_of_freedom, 24U);
    // The band of a proportional law is proportional to it.
    const double share = result.uncertainty.half_width(0) / expected.modulus;
    for (const std::size_t row : {3U, 24U}) {
      EXPECT_NEAR(result.fit.band[row] / (share * result.fit.y[row]), 1.0, 1e-7) << weights;
    }
  }
}

TEST_F(CalibrationTest, WeightsOfTheSpacingLeaveTheErrorsToTheNoise) {
  std::vector<Row> rows = noisy_hertz();
  for (std::size_t k = 15; k < rows.size(); ++k) {
    rows[k].x += 1e-5 * static_cast<double>(k - 14);
    rows[k].y = 70e9 * hertz_force_per_modulus(rows[k].x) + (k % 2 == 0 ? 1.0 : -1.0);
  }
  write("d.csv", csv_of(rows, "displacement[m],force[N],w"));
  write("c.toml", replaced(k_calibration, "[free]", "weights = \"area\"\n[free]"));
  const CalibrationResult result = calibrate(read());
  // The weighted mean of equally noisy rows: each counts by the length of x around it.
  std::vector<double> lengths;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    lengths.push_back(0.5 * (rows[std::min(k + 1, rows.size() - 1)].x - rows[k == 0 ? 0 : k - 1].x));
  }
  double cc = 0.0;
  double cp = 0.0;
  double noise_of_mean = 0.0;
  double total = 0.0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double c = hertz_force_per_modulus(rows[k].x);
    cc += lengths[k] * c * c;
    cp += lengths[k] * c * rows[k].y;
    noise_of_mean += std::pow(lengths[k] * c, 2);
    total += lengths[k];
  }
  double squares = 0.0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    squares += lengths[k] * std::pow(rows[k].y - cp / cc * hertz_force_per_modulus(rows[k].x), 2);
  }
  const double variance = squares / (total - noise_of_mean / cc);
  EXPECT_NEAR(result.solution.parameters[0] / (cp / cc), 1.0, 1e-9);
  EXPECT_NEAR(result.uncertainty.standard_error(0) / (std::sqrt(variance * noise_of_mean) / cc), 1.0, 1e-7);
}

TEST_F(CalibrationTest, ARowOfWeightZeroOnlyDrives) {
  auto rows = noisy_hertz();
  for (Row& row : rows) row.weight = 1.0;
  rows[5].weight = 0.0;
  rows[5].y *= 100.0;
  write("d.csv", csv_of(rows, "displacement[m],force[N],w"));
  write("c.toml", replaced(k_calibration, "[free]", "weights = \"column\"\nweight_column = \"w\"\n[free]"));
  const CalibrationResult result = calibrate(read());
  rows.erase(rows.begin() + 5);
  const ClosedForm expected = closed_form(rows, [](const Row&) { return 1.0; });
  EXPECT_NEAR(result.solution.parameters[0] / expected.modulus, 1.0, 1e-9);
  EXPECT_NEAR(result.uncertainty.standard_error(0) / expected.standard_error, 1.0, 1e-7);
  EXPECT_EQ(result.points, 24U);
}

TEST_F(CalibrationTest, ARobustLossForgetsAnOutlier) {
  auto rows = noisy_hertz();
  const double before = closed_form(rows, [](const Row&) { return 1.0; }).modulus;
  rows[20].y *= 3.0;
  write("d.csv", csv_of(rows, "displacement[m],force[N],w"));
  EXPECT_GT(calibrate(read()).solution.parameters[0] / before, 1.05);
  for (const char* loss : {"huber", "soft-l1", "cauchy"}) {
    write("c.toml", std::string(k_calibration) + fmt::format("[fit]\nloss = \"{}\"\nloss_scale = 0.005\n", loss));
    const CalibrationResult result = calibrate(read());
    EXPECT_NEAR(result.solution.parameters[0] / before, 1.0, 0.02) << loss;
    EXPECT_NEAR(result.uncertainty.standard_error(0) / before, 0.005, 0.005) << loss;
  }
}

TEST_F(CalibrationTest, FindsIntervalsAsAskedAndSaysHow) {
  write("d.csv", csv_of(noisy_hertz(), "displacement[m],force[N],w"));
  const CalibrationResult usual = calibrate(read());
  EXPECT_EQ(usual.method, IntervalMethod::covariance);
  EXPECT_NE(usual.method_reason.find("is quadratic"), std::string::npos) << usual.method_reason;
  const double width = usual.intervals[0].upper - usual.intervals[0].lower;
  EXPECT_NEAR(width, 2.0 * usual.uncertainty.half_width(0), 1e-9 * width);
  // The force is linear in the modulus: all intervals are about one.
  for (const auto& [word, share] : {std::pair("covariance", 1e-9), {"profile", 3e-3}, {"bootstrap", 0.15}}) {
    write("c.toml", std::string(k_calibration) + fmt::format("[fit]\nintervals = \"{}\"\n", word));
    const Calibration calibration = read();
    const CalibrationResult result = calibrate(calibration);
    EXPECT_NEAR((result.intervals[0].upper - result.intervals[0].lower) / width, 1.0, share) << word;
    EXPECT_NE(calibration_text(calibration, result).find(fmt::format("intervals: {} (asked for", word)),
              std::string::npos);
  }
  write("c.toml", std::string(k_calibration) + "[fit]\nintervals = \"guess\"\n");
  EXPECT_EQ(faults().size(), 1U);
}

// Residuals of 1e-13 of the force are round-off: their sum of squares has no shape to examine.
TEST_F(CalibrationTest, IntervalsOfAnExactFitAreThoseOfTheCovariance) {
  std::vector<Row> rows;
  for (int k = 1; k <= 25; ++k) {
    const double x = 1e-6 * k;
    rows.push_back({x, 70e9 * hertz_force_per_modulus(x) * (1.0 + (k % 2 == 0 ? 1e-13 : -1e-13))});
  }
  write("d.csv", csv_of(rows, "displacement[m],force[N],w"));
  const CalibrationResult result = calibrate(read());
  EXPECT_EQ(result.method, IntervalMethod::covariance);
  EXPECT_EQ(result.method_reason, "the fit is exact");
}

// Over a share e of x, the derivatives by modulus and offset, x^(3/2) and x^(1/2), have an angle of e/sqrt(12): the
// data know one combination 2 sqrt(12)/e times as well as the other, 1400 times for half a percent.
TEST_F(CalibrationTest, IntervalsOfNearlyDependentNumbersAreProfiles) {
  write("c.toml", std::string(k_calibration) + "\"data.offset\" = { from = \"-1 um\", to = \"1 um\" }\n");
  const auto fit_over = [&](double share) {
    std::vector<Row> rows;
    for (int k = 0; k < 25; ++k) {
      const double x = 2e-5 * (1.0 + share * k / 24.0);
      rows.push_back({x, 70e9 * hertz_force_per_modulus(x) * (1.0 + (k % 2 == 0 ? 1e-6 : -1e-6))});
    }
    write("d.csv", csv_of(rows, "displacement[m],force[N],w"));
    return calibrate(read());
  };
  const CalibrationResult narrow = fit_over(0.005);
  EXPECT_EQ(narrow.method, IntervalMethod::profile);
  EXPECT_TRUE(contains(narrow.method_reason, "the covariance loses its digits")) << narrow.method_reason;
  EXPECT_EQ(fit_over(0.02).method, IntervalMethod::covariance);
}

TEST_F(CalibrationTest, LengthsInFreeMayBeSharesOfTheRadius) {
  write("c.toml", std::string(k_calibration) + "\"data.offset\" = { from = \"-0.01 R0\", to = \"0.02 R0\" }\n");
  const FreeParameter offset = read().free.at(1);
  EXPECT_DOUBLE_EQ(offset.lower, -0.01 * k_radius);
  EXPECT_DOUBLE_EQ(offset.upper, 0.02 * k_radius);
  EXPECT_EQ(offset.unit, "R0");
  EXPECT_DOUBLE_EQ(offset.unit_factor, k_radius);
}

TEST_F(CalibrationTest, ResidualsInWavesGetANote) {
  auto rows = noisy_hertz();
  const auto has_note = [this, &rows] {
    write("d.csv", csv_of(rows, "displacement[m],force[N],w"));
    return std::ranges::any_of(calibrate(read()).notes, [](const std::string& note) {
      return note.find("the residuals are not independent") != std::string::npos;
    });
  };
  EXPECT_FALSE(has_note());
  for (Row& row : rows) row.y = 70e9 * hertz_force_per_modulus(row.x) + 100.0 * std::sin(8e4 * row.x);
  EXPECT_TRUE(has_note());
}

TEST_F(CalibrationTest, TheIntervalOfAParameterAtItsBoundEndsThere) {
  write("d.csv", csv_of(noisy_hertz(), "displacement[m],force[N],w"));
  write("c.toml", replaced(k_calibration, "300 GPa", "50 GPa"));
  const Calibration calibration = read();
  const CalibrationResult result = calibrate(calibration);
  EXPECT_EQ(result.solution.parameters[0], 50e9);
  EXPECT_NE(calibration_text(calibration, result).find("at its upper bound"), std::string::npos);
  ASSERT_FALSE(result.notes.empty());
  EXPECT_NE(result.notes[0].find("sits at its upper bound"), std::string::npos) << result.notes[0];
  EXPECT_EQ(result.method, IntervalMethod::profile);
  EXPECT_EQ(result.intervals[0].upper, 50e9);
  EXPECT_TRUE(result.intervals[0].is_cut_above);
  EXPECT_LT(result.intervals[0].lower, 50e9);
}

TEST_F(CalibrationTest, SaysWhatTheDataDoNotDetermine) {
  // Elastic data know nothing of a yield stress that is never reached.
  write("s.toml", replaced(k_mdr, "40 MPa", "400 MPa"));
  write("c.toml", replaced(k_two_free, "from = \"5 MPa\", to = \"200 MPa\"", "from = \"300 MPa\", to = \"400 MPa\""));
  const auto rows = measure(k_mdr, {"material.yield_stress=3.5e8", "output.points=10",
                                    "loading.steps=[{displacement='0.01 R0',duration=1}]"});
  write("d.csv", csv_of(rows, "axial.displacement[m],axial.force[N],w"));
  const Calibration calibration = read();
  const CalibrationResult result = calibrate(calibration);
  EXPECT_NEAR(result.solution.parameters[0] / 1e9, 1.0, 1e-9);
  EXPECT_EQ(result.uncertainty.is_determined, (std::vector{true, false}));
  EXPECT_NE(calibration_text(calibration, result).find("not determined"), std::string::npos);
  EXPECT_EQ(correlation_rows(calibration.free, result.uncertainty)[1],
            (TextRow{calibration.free[0].key.path, "1.0000", "-"}));
  EXPECT_EQ(correlation_rows(calibration.free, result.uncertainty)[2],
            (TextRow{calibration.free[1].key.path, "-", "-"}));
}

TEST_F(CalibrationTest, AsManyPointsAsParametersGiveAFitWithoutErrors) {
  write("d.csv", fmt::format("displacement[m],force[N]\n1e-4,{:.17g}\n", 123e9 * hertz_force_per_modulus(1e-4)));
  const Calibration calibration = read();
  const CalibrationResult result = calibrate(calibration);
  EXPECT_NEAR(result.solution.parameters[0] / 123e9, 1.0, 1e-11);
  EXPECT_TRUE(std::isnan(result.uncertainty.standard_error(0)));
  ASSERT_FALSE(result.notes.empty());
  EXPECT_NE(result.notes.back().find("no errors and no intervals"), std::string::npos) << result.notes.back();
}

TEST_F(CalibrationTest, ColumnsMayBeNamedAndMeasuredOtherwise) {
  std::vector<Row> rows;
  for (int i = 1; i <= 5; ++i) rows.push_back({2e-3 * i, 70.0 * hertz_force_per_modulus(2e-3 * i * k_radius) * 1e9});
  write("d.csv", csv_of(rows, "gamma_over_2R[-],P[N],w"));
  write("c.toml", replaced(replaced(k_calibration, "\"displacement[m]\"",
                                    "{ column = \"gamma_over_2R[-]\", quantity = \"displacement\", unit = \"R0\" }"),
                           "\"force[N]\"", "{ column = \"P\", quantity = \"axial.force\", unit = \"N\" }"));
  EXPECT_NEAR(calibrate(read()).solution.parameters[0] / 70e9, 1.0, 1e-11);
}

TEST_F(CalibrationTest, DisplacementsBeginAtTheGapOfTheirWall) {
  write("s.toml", replaced(k_hertz_text, "configuration = \"simple\"\n", R"(configuration = "walls"
wall = [{ name = "near", normal = [0, 0, 1] },
        { name = "far", normal = [0, 0, -1], gap = "1 mm" }]
)"));
  std::vector<Row> rows;
  for (int i = -5; i <= 5; ++i) rows.push_back({2e-5 * i, 70e9 * hertz_force_per_modulus(2e-5 * i)});
  write("c.toml", replaced(replaced(k_calibration, "\"displacement", "\"far.displacement"), "\"force", "\"far.force"));
  write("d.csv", csv_of(rows, "far.displacement[m],far.force[N],w"));
  const CalibrationResult result = calibrate(read());
  EXPECT_NEAR(result.solution.parameters[0] / 70e9, 1.0, 1e-11);
  EXPECT_EQ(result.program_steps, 1U);
}

TEST_F(CalibrationTest, ARunWithAFreeCentreReturnsItsOwnParameters) {
  // The punch goes twice as far as either contact is deep; the data hold its own travel.
  for (const char* model : {"hertz", "nonlocal"}) {
    const std::string scenario =
        replaced(replaced(k_hertz_text, "model = \"hertz\"", fmt::format("model = \"{}\"", model)),
                 "configuration = \"simple\"\n", R"(configuration = "walls"
centre = "equilibrium"
wall = [{ name = "punch", normal = [0, 0, 1] }, { name = "anvil", normal = [0, 0, -1], fixed = true }]
)");
    write("s.toml", scenario);
    write("c.toml",
          replaced(replaced(k_calibration, "\"displacement", "\"punch.displacement"), "\"force", "\"punch.force"));
    const auto rows =
        measure(scenario, {"material.youngs_modulus=65e9", "output.points=9"}, "punch.displacement", "punch.force");
    write("d.csv", csv_of(rows, "punch.displacement[m],punch.force[N],w"));
    EXPECT_NEAR(calibrate(read()).solution.parameters[0] / 65e9, 1.0, 1e-9) << model;
  }
}

TEST_F(CalibrationTest, OtherQuantitiesCanBeFitted) {
  std::vector<Row> rows;
  for (int i = 1; i <= 5; ++i) {
    const double x = 2e-5 * i;  // a^2 = R x
    rows.push_back({x, 70e9 * hertz_force_per_modulus(x) / (3.14159265358979324 * k_radius * x) / 1e6});
  }
  write("d.csv", csv_of(rows, "displacement[m],pressure[MPa],w"));
  write("c.toml", replaced(k_calibration, "force[N]", "pressure[MPa]"));
  EXPECT_NEAR(calibrate(read()).solution.parameters[0] / 70e9, 1.0, 1e-11);
}

TEST_F(CalibrationTest, TheScenarioMayStandInTheFileItself) {
  write("d.csv", csv_of(noisy_hertz(), "displacement[m],force[N],w"));
  const double modulus = calibrate(read()).solution.parameters[0];
  std::string own = replaced(k_hertz_text, "model", "[scenario]\nmodel");
  for (const char* table : {"[particle]", "[material]", "[loading]", "[[loading.steps]]"}) {
    const std::string name = table;
    own =
        replaced(own, name, replaced(name, name[1] == '[' ? "[[" : "[", name[1] == '[' ? "[[scenario." : "[scenario."));
  }
  write("c.toml", replaced(k_calibration, "scenario = \"s.toml\"\n", "") + own);
  const Calibration calibration = read();
  const CalibrationResult result = calibrate(calibration);
  EXPECT_EQ(result.solution.parameters[0], modulus);
  const CheckedScenario fitted = parse_scenario(fitted_scenario_text(calibration, result), "fitted.toml");
  EXPECT_EQ(fitted.material.at("youngs_modulus"), modulus);
}

DataProgram program_of(const std::vector<double>& x) {
  const DataPath path = path_through(x);
  return program_along(path, path.x, Step::Kind::displacement, 0.0);
}

TEST(DataProgram, HasAStepForEachStretchAndAnInstantForEachValue) {
  const std::vector<double> x{0.0, 1.0, 4.0, 4.0, 2.0, 3.0};
  EXPECT_EQ(path_through(x).x, (std::vector{0.0, 1.0, 4.0, 2.0, 3.0}));
  EXPECT_EQ(path_through(x).point_of, (std::vector<std::size_t>{0, 1, 2, 2, 3, 4}));
  const DataProgram program = program_of(x);
  ASSERT_EQ(program.steps.size(), 3U);
  EXPECT_EQ(program.steps[0].target, 4.0);
  EXPECT_EQ(program.steps[1].target, 2.0);
  EXPECT_EQ(program.steps[2].target, 3.0);
  EXPECT_EQ(program.times, (std::vector{0.25, 1.0, 2.0, 3.0}));
  EXPECT_EQ(program.instants, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
}

TEST(DataProgram, TakesNoiseForNoTurnAndPassesItsValuesInOrder) {
  std::mt19937 generator(2);
  std::normal_distribution<double> noise(0.0, 0.02);
  std::vector<double> x{0.0};
  for (int k = 1; k <= 600; ++k) x.push_back((k <= 400 ? 0.01 * k : 8.0 - 0.01 * k) + noise(generator));
  x[1] = -0.03;
  const DataPath path = path_through(x);
  const DataProgram program = program_of(x);
  ASSERT_EQ(program.steps.size(), 3U) << "behind the start, up, and down";
  const double top = program.steps[1].target;
  EXPECT_NEAR(top, 4.0, 0.02);
  EXPECT_LT(program.steps[0].target, 0.0);
  EXPECT_TRUE(std::ranges::is_sorted(program.times));
  for (std::size_t k = 1; k < x.size(); ++k) {
    const std::size_t point = path.point_of[k];
    EXPECT_NEAR(path.x[point], std::min(x[k], top), 1e-11) << k;
    const double time = program.times[program.instants[point] - 1];
    const Step& step = program.steps[static_cast<std::size_t>(std::ceil(time)) - 1];
    const double from = time > 2.0 ? top : (time > 1.0 ? program.steps[0].target : 0.0);
    EXPECT_NEAR(from + (time - std::ceil(time) + 1.0) * (step.target - from), path.x[point], 1e-11) << k;
  }
}

TEST(DataProgram, GoesToWhereDataOfAnUnloadingBegin) {
  const DataProgram program = program_of({5.0, 4.0, 3.0});
  ASSERT_EQ(program.steps.size(), 2U);
  EXPECT_EQ(program.steps[0].target, 5.0);
  EXPECT_EQ(program.times, (std::vector{1.0, 1.5, 2.0}));
  EXPECT_EQ(program.instants, (std::vector<std::size_t>{1, 2, 3}));
}

// --- what is written

TEST_F(CalibrationTest, TheFittedScenarioIsTheOldOneWithTheNumbersPutIn) {
  write("d.csv", csv_of(noisy_hertz(), "displacement[m],force[N],w"));
  const Calibration calibration = read();
  const CalibrationResult result = calibrate(calibration);
  const std::string text = fitted_scenario_text(calibration, result);
  const CheckedScenario fitted = parse_scenario(text, "fitted.toml");
  EXPECT_EQ(fitted.material.at("youngs_modulus"), result.solution.parameters[0]);
  EXPECT_EQ(fitted.loading.steps.size(), 1U);
  EXPECT_EQ(fitted.loading.steps[0].target, 0.01 * k_radius);
}

TEST_F(CalibrationTest, TheFittedScenarioHasTheOverridesThatAllCurvesShare) {
  write("d.csv", csv_of(noisy_hertz(), "displacement[m],force[N],w"));
  const auto fitted_with = [&](const std::string& first, const std::string& second) {
    const std::string data = replaced(k_calibration, "[data]", "[[data]]");
    const std::string free = data.substr(data.find("[free]"));
    const std::string curve = data.substr(data.find("[[data]]"), data.find("[free]") - data.find("[[data]]"));
    write("c.toml", data.substr(0, data.find("[[data]]")) + curve + first + curve + second + free);
    const Calibration calibration = read();
    return fitted_scenario_text(calibration, calibrate(calibration));
  };
  const std::string set = "set = [\"material.poisson_ratio=0.2\", \"title=softer\"]\n";
  const CheckedScenario both = parse_scenario(fitted_with(set, set), "fitted.toml");
  EXPECT_EQ(both.material.at("poisson_ratio"), 0.2);
  const CheckedScenario one = parse_scenario(fitted_with(set, ""), "fitted.toml");
  EXPECT_EQ(one.material.at("poisson_ratio"), k_poisson);
  // The text has no place for a title.
  EXPECT_TRUE(contains(fitted_with(set, set), "# The fit holds with --set 'title=softer'\n"));
}

std::string written(const Calibration& calibration, const CalibrationResult& result, const fs::path& target) {
  StagedFolder staged(target, k_calibration_marker);
  return write_calibration(calibration, result, staged);
}

TEST_F(CalibrationTest, TablesThatTheScenarioNamesGoWithIt) {
  write("s.toml", std::string(k_mdr) + "[mdr]\npressure_table = \"p.csv\"\n");
  write("p.csv", "x,p\n0,2.75\n0.1,2.5\n0.5,1.9\n2,1.5\n");
  write("c.toml", replaced(k_two_free, "\"material.youngs_modulus\" = { from = \"0.1 GPa\", to = \"10 GPa\" }\n", ""));
  write("d.csv", "axial.displacement[m],axial.force[N]\n1e-4,150\n5e-4,1500\n1e-3,3500\n");
  const Calibration calibration = read();
  const CalibrationResult result = calibrate(calibration);
  EXPECT_EQ(written(calibration, result, folder() / "out"), "");
  fs::remove(folder() / "p.csv");
  const CheckedScenario fitted = read_scenario(folder() / "out/fitted.toml");
  EXPECT_EQ(fitted.material.at("yield_stress"), result.solution.parameters[0]);
  EXPECT_EQ(fitted.curves.at("pressure_table").x.size(), 4U);
}

TEST_F(CalibrationTest, FilesHoldDataFitAndStatistics) {
  const auto rows = noisy_hertz();
  write("d.csv", csv_of(rows, "displacement[m],force[N],w"));
  const Calibration calibration = read();
  const CalibrationResult result = calibrate(calibration);
  EXPECT_EQ(written(calibration, result, folder() / "out"), "");
  const Table fit = read_csv(folder() / "out/fit.csv");
  ASSERT_EQ(fit.row_count(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(fit.column("axial.force[N]")[i], rows[i].y);
    EXPECT_EQ(fit.column("residual")[i], rows[i].y - fit.column("fit")[i]);
    EXPECT_LT(fit.column("band_lower")[i], fit.column("fit")[i]);
    EXPECT_GT(fit.column("band_upper")[i], fit.column("fit")[i]);
  }
  const auto json = nlohmann::json::parse(text_of("out/calibration.json"));
  EXPECT_EQ(json["parameters"][0]["key"], "material.youngs_modulus");
  EXPECT_EQ(json["parameters"][0]["value"].get<double>(), result.solution.parameters[0]);
  EXPECT_EQ(json["parameters"][0]["standard_error"].get<double>(), result.uncertainty.standard_error(0));
  EXPECT_EQ(json["parameters"][0]["unit"], "GPa");
  EXPECT_EQ(json["statistics"]["points"], 25);
  EXPECT_EQ(json["correlation"][0][0], 1.0);
  EXPECT_EQ(json["intervals"]["method"], "covariance");
  EXPECT_EQ(json["intervals"]["reason"], result.method_reason);
  EXPECT_EQ(json["parameters"][0]["interval_is_cut"], nlohmann::json::parse("[false, false]"));
  EXPECT_TRUE(json["residual_tests"]["are_independent"]);
  for (const char* file : {"figure.svg", "figure.gp", "figure.dat"}) {
    EXPECT_GT(fs::file_size(folder() / "out" / file), 300U) << file;
  }
}

TEST_F(CalibrationTest, AReportHasARowForEachParameterWhereOnlyOneIsAtItsBound) {
  auto rows = noisy_hertz();
  write("c.toml",
        replaced(k_calibration, "300 GPa", "50 GPa") + "\"data.offset\" = { from = \"-0.1 mm\", to = \"0.1 mm\" }\n");
  write("d.csv", csv_of(rows, "displacement[m],force[N],w"));
  const Calibration calibration = read();
  const std::string report = calibration_report(calibration, calibrate(calibration), "");
  const auto cells_of = [&](const std::string& name) {
    const std::size_t begin = report.find("| " + name + " ");
    const std::string row = report.substr(begin, report.find('\n', begin) - begin);
    return std::ranges::count(row, '|');
  };
  EXPECT_EQ(cells_of("material.youngs_modulus"), cells_of("parameter")) << report;
  EXPECT_EQ(cells_of("data.offset"), cells_of("parameter")) << report;
}

TEST_F(CalibrationTest, AReportHasDataFigureParametersResidualsAndWhatIsWrong) {
  auto rows = noisy_hertz();
  write("c.toml", "title = \"Steel on steel\"\n" + replaced(k_calibration, "300 GPa", "50 GPa"));
  write("d.csv", csv_of(rows, "displacement[m],force[N],w"));
  const Calibration calibration = read();
  const CalibrationResult result = calibrate(calibration);
  StagedFolder staged(folder() / "out", k_calibration_marker);
  EXPECT_EQ(write_calibration(calibration, result, staged, true), "");
  // Columns are aligned by blanks.
  const std::string report = std::regex_replace(text_of("out/report.md"), std::regex(" +"), " ");
  EXPECT_EQ(report.find("# Steel on steel\n"), 0U);
  std::size_t last = 0;
  for (const std::string part :
       {"\n## Data\n", "`d.csv`: 25 rows", "![data, fit and residuals](figure.svg)", "\n## Parameters\n",
        "| material.youngs_modulus | 50 GPa | - |", "at its upper bound |", "intervals: profile", "\n## Residuals\n",
        "| points | 25 |", "\n## Notes\n", "sits at its upper bound", "\n## Sources of the model\n"}) {
    const std::size_t place = report.find(part, last);
    EXPECT_NE(place, std::string::npos) << part << " in\n" << report;
    if (place != std::string::npos) last = place;
  }
  EXPECT_EQ(text_of("out/report.pdf").substr(0, 5), "%PDF-");
  const std::string page = text_of("out/report.gp");
  for (const char* part : {"'Steel on steel'", "'- d.csv: 25 rows", "'material.youngs_modulus  50 GPa  ",
                           "sits at its upper bound", "'Sources of the model'"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part << " in\n" << page;
  }
  EXPECT_EQ(written(calibration, result, folder() / "out"), "");
  EXPECT_FALSE(fs::exists(folder() / "out/report.pdf"));
  EXPECT_FALSE(fs::exists(folder() / "out/report.md")) << "a report of an older result would mislead";
}

TEST_F(CalibrationTest, ANewResultReplacesItsFilesAndNoOthers) {
  const Calibration calibration = read();
  const CalibrationResult result = calibrate(calibration);
  static_cast<void>(written(calibration, result, folder() / "out"));
  write("out/notes.txt", "keep me");
  write("out/fit.csv", "old");
  static_cast<void>(written(calibration, result, folder() / "out"));
  EXPECT_EQ(text_of("out/notes.txt"), "keep me");
  EXPECT_NE(text_of("out/fit.csv"), "old");
  fs::create_directory(folder() / "mine");
  write("mine/fit.csv", "keep me");
  EXPECT_THROW(static_cast<void>(written(calibration, result, folder() / "mine")), std::runtime_error);
  EXPECT_EQ(text_of("mine/fit.csv"), "keep me");
}

// --- faults

struct FaultCase {
  const char* name;
  const char* file;  ///< c.toml, d.csv or s.toml
  const char* old;   ///< what is replaced in it; empty: all of it
  const char* by;
  const char* message;  ///< how the first fault begins
};

class CalibrationFaults : public CalibrationTest, public ::testing::WithParamInterface<FaultCase> {};

TEST_P(CalibrationFaults, AreReportedWithTheirPlace) {
  const FaultCase& c = GetParam();
  const std::string name = c.file;
  const std::string text = name == "c.toml" ? k_calibration : name == "d.csv" ? k_data : k_hertz_text;
  write(name, *c.old == '\0' ? c.by : replaced(text, c.old, c.by));
  const auto messages = faults();
  ASSERT_FALSE(messages.empty());
  EXPECT_EQ(messages[0].substr(0, std::string(c.message).size()), c.message) << fmt::format("{}", messages[0]);
}

constexpr FaultCase k_faults[] = {
    {"NotToml", "c.toml", "[data]", "[data", "c.toml:2:6: not valid TOML"},
    {"UnknownKey", "c.toml", "[data]", "scenaro = 1\n[data]",
     "c.toml:2:1: unknown key 'scenaro' in the calibration; did you mean 'scenario'?"},
    {"NoScenario", "c.toml", "scenario = \"s.toml\"\n", "", "c.toml:1:1: key 'scenario' is missing in the calibration"},
    {"NoSuchScenario", "c.toml", "\"s.toml\"", "\"t.toml\"",
     "c.toml:1:12: scenario = \"t.toml\": there is no such file"},
    {"FaultInScenario", "s.toml", "youngs_modulus", "youngs_moduls", "s.toml:5:1: unknown key 'youngs_moduls'"},
    {"NoData", "c.toml", "[data]\n", "[dta]\n",
     "c.toml:2:2: unknown key 'dta' in the calibration; did you mean 'data'?"},
    {"NoSuchData", "c.toml", "\"d.csv\"", "\"e.csv\"", "c.toml:3:8: file = \"e.csv\": there is no such file"},
    {"MissingColumn", "c.toml", "force[N]", "forse[N]", "c.toml:5:5: y = \"forse[N]\": "},
    {"XIsNoDrive", "c.toml", "x = \"displacement[m]\"",
     "x = { column = \"displacement[m]\", quantity = \"contact_radius\", unit = \"m\" }",
     "c.toml:4:46: 'axial.contact_radius' cannot drive the particle; expected one of axial.displacement, axial.force"},
    {"QuantityMisspelt", "c.toml", "x = \"displacement[m]\"",
     "x = { column = \"displacement[m]\", quantity = \"displacment\", unit = \"m\" }",
     "c.toml:4:46: 'displacment' is no quantity of this scenario; expected one of "},
    {"UnitMisspelt", "c.toml", "x = \"displacement[m]\"",
     "x = { column = \"displacement[m]\", quantity = \"displacement\", unit = \"mmm\" }",
     "c.toml:4:69: column = \"displacement[m]\": unknown unit 'mmm'; expected a length"},
    {"WeightsUnknown", "c.toml", "[free]", "weights = \"relativ\"\n[free]",
     "c.toml:6:11: weights = \"relativ\": expected one of absolute, relative, column, area; did you mean 'relative'?"},
    {"WeightColumnMissing", "c.toml", "[free]", "weights = \"column\"\n[free]",
     "c.toml:6:11: weights = \"column\" needs the column"},
    {"WeightColumnUnused", "c.toml", "[free]", "weight_column = \"w\"\n[free]",
     "c.toml:6:1: key 'weight_column' belongs to weights = \"column\"; this is \"absolute\""},
    {"LossWithoutScale", "c.toml", "[free]", "[fit]\nloss = \"huber\"\n[free]",
     "c.toml:7:8: loss = \"huber\" needs a scale"},
    {"ScaleWithoutLoss", "c.toml", "[free]", "[fit]\nloss_scale = 0.1\n[free]",
     "c.toml:7:1: key 'loss_scale' is not used by the linear loss"},
    {"NothingFree", "c.toml", "\"material.youngs_modulus\" = { from = \"10 GPa\", to = \"300 GPa\" }\n", "",
     "c.toml:6:1: free = an empty table: expected a table"},
    {"FreeUnknown", "c.toml", "material.youngs_modulus", "material.youngs_modulos",
     "c.toml:7:1: unknown key 'material.youngs_modulos' in [free]; did you mean 'material.youngs_modulus'?"},
    {"FreeIsNoNumber", "c.toml", "material.youngs_modulus", "loading.configuration",
     "c.toml:7:1: unknown key 'loading.configuration' in [free]; expected one of material.youngs_modulus, "
     "material.poisson_ratio"},
    {"FreeStep", "c.toml", "material.youngs_modulus", "loading.steps[0].displacement",
     "c.toml:7:1: key 'loading.steps[0].displacement' cannot be free: steps are what a test prescribes"},
    {"FreeGapOfNoWall", "c.toml", "material.youngs_modulus", "loading.wall[0].gap",
     "c.toml:7:1: key 'loading.wall[0].gap' cannot be free; expected the gap of a wall of configuration = \"walls\""},
    {"RadiusInRadii", "c.toml", "\"material.youngs_modulus\" = { from = \"10 GPa\", to = \"300 GPa\" }",
     "\"particle.radius\" = { from = \"0.5 R0\", to = \"20 mm\" }", "c.toml:7:30: from = \"0.5 R0\": "},
    {"FreeWithoutQuotes", "c.toml", "\"material.youngs_modulus\"", "material.youngs_modulus",
     "c.toml:7:1: key 'material' is a table; expected the whole path in quotes"},
    {"BoundsInverted", "c.toml", "from = \"10 GPa\", to = \"300 GPa\"", "from = \"300 GPa\", to = \"10 GPa\"",
     "c.toml:7:54: to = \"10 GPa\" is not above from = \"300 GPa\""},
    {"BoundMissing", "c.toml", ", to = \"300 GPa\"", "",
     "c.toml:7:29: key 'to' is missing in \"material.youngs_modulus\"; expected for example to = \"50 MPa\""},
    {"BoundInWrongUnit", "c.toml", "10 GPa", "10 mm", "c.toml:7:38: from = \"10 mm\": 'mm' is a unit of length"},
    {"BoundOutOfRange", "c.toml", "10 GPa", "-10 GPa", "c.toml:7:38: from = \"-10 GPa\": out of range"},
    {"StartOutside", "c.toml", "to = \"300 GPa\"", "to = \"300 GPa\", start = \"1 GPa\"",
     "c.toml:7:72: start = \"1 GPa\" is not between the bounds"},
    {"EmptyFile", "d.csv", "", "", "d.csv:1:1: the file is empty; expected a row of headings"},
    {"OnlyHeadings", "d.csv", "", "displacement[m],force[N]\n", "d.csv:1:1: the file has headings but no data"},
    {"NoHeadings", "d.csv", "displacement[m],force[N]\n", "",
     "d.csv:1:1: a number where a row of headings is expected"},
    {"RaggedRow", "d.csv", "2e-5,100", "2e-5,100,7", "d.csv:3:1: 3 cells where there are 2 headings"},
    {"NotANumber", "d.csv", "100", "1oo", "d.csv:3:6: force[N] = 1oo: expected a finite number"},
    {"Nan", "d.csv", "100", "nan", "d.csv:3:6: force[N] = nan: expected a finite number"},
    {"EmptyCell", "d.csv", "2e-5,", ",", "d.csv:3:1: displacement[m] = (nothing): expected a finite number"},
    {"TwoHeadings", "d.csv", "force[N]", "displacement[m]", "c.toml:4:5: x = \"displacement[m]\": columns 1 and 2 of "},
    {"NeverChanges", "d.csv", "", "displacement[m],force[N]\n0,1\n0,2\n",
     "c.toml:4:5: x = \"displacement[m]\": it never "},
    {"AllZero", "d.csv", "", "displacement[m],force[N]\n1e-5,0\n2e-5,0\n", "d.csv:2:6: y is zero in every row"},
};

INSTANTIATE_TEST_SUITE_P(All, CalibrationFaults, ::testing::ValuesIn(k_faults),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_F(CalibrationTest, AllFaultsAreReportedAtOnce) {
  write("c.toml", replaced(replaced(k_calibration, "file", "fil"), "to = \"300 GPa\"", "to = \"3 kg\""));
  EXPECT_EQ(faults().size(), 2U);
  write("c.toml", replaced(k_calibration, "from = \"10 GPa\"", "from = \"10 kg\""));
  write("s.toml", replaced(k_hertz_text, "\"hertz\"", "\"hertzz\""));
  write("d.csv", "displacement[m],force[N]\n1,x\ny,2\n");
  const auto messages = faults();
  EXPECT_EQ(messages.size(), 3U) << "one in the scenario, two in the data";
}

TEST_F(CalibrationTest, HeadingsTellQuantityAndUnit) {
  write("c.toml", replaced(k_calibration, "force[N]", "force"));
  const auto complaint = [this](const std::string& heading) {
    write("d.csv", replaced(k_data, "force[N]", heading));
    const auto messages = faults();
    return messages.empty() ? std::string() : messages[0];
  };
  EXPECT_EQ(complaint("force[mN]"), "");
  EXPECT_EQ(complaint("force[furlong]"),
            "c.toml:5:5: y = \"force\": unknown unit 'furlong'; expected a force, for example \"10 N\"");
  EXPECT_EQ(complaint("force").substr(0, 72),
            "c.toml:5:5: y = \"force\": the heading has no unit; expected a force such ");
  write("c.toml", replaced(k_calibration, "force[N]", "load"));
  EXPECT_EQ(complaint("load[N]").substr(0, 73),
            "c.toml:5:5: 'load' is no quantity of this scenario; expected one of work,");
}

TEST_F(CalibrationTest, DataThatBeginWithUnloadingAreReachedFromRest) {
  write("d.csv", fmt::format("displacement[m],force[N]\n3e-5,{:.17g}\n2e-5,{:.17g}\n",
                             70e9 * hertz_force_per_modulus(3e-5), 70e9 * hertz_force_per_modulus(2e-5)));
  const CalibrationResult result = calibrate(read());
  EXPECT_NEAR(result.solution.parameters[0] / 70e9, 1.0, 1e-11);
  EXPECT_EQ(result.program_steps, 2U);
  ASSERT_FALSE(result.notes.empty());
  EXPECT_NE(result.notes.back().find("begin with unloading"), std::string::npos) << result.notes.back();
}

TEST_F(CalibrationTest, ANumberThatTheScenarioHasNoPlaceForIsRefused) {
  std::string inline_material =
      replaced(k_mdr, "[material]\nyoungs_modulus = \"1 GPa\"\npoisson_ratio = 0.3\nyield_stress = \"40 MPa\"\n", "");
  write("s.toml", "material = { youngs_modulus = 1e9, poisson_ratio = 0.3, yield_stress = 4e7 }\n" + inline_material);
  EXPECT_TRUE(faults().empty());
  write("c.toml", replaced(replaced(k_calibration, "youngs_modulus", "surface_energy"), "\"10 GPa\", to = \"300 GPa\"",
                           "0, to = 1"));
  const auto messages = faults();
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0].find("c.toml:7:1: the scenario does not give 'material.surface_energy'"), 0U) << messages[0];
}

TEST_F(CalibrationTest, MoreParametersThanPointsAreRefused) {
  write("c.toml", std::string(k_calibration) + "\"material.poisson_ratio\" = { from = 0, to = 0.5 }\n");
  write("d.csv", "displacement[m],force[N]\n1e-5,35\n");
  const auto messages = faults();
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0], "c.toml:6:1: 2 parameters cannot be fitted to 1 point; expected at least as many points");
}

TEST_F(CalibrationTest, AZeroHasNoRelativeWeight) {
  write("c.toml", replaced(k_calibration, "[free]", "weights = \"relative\"\n[free]"));
  write("d.csv", "displacement[m],force[N]\n0,0\n1e-5,35\n");
  const auto messages = faults();
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0].find("d.csv:2:3: y = 0 has no relative weight"), 0U) << messages[0];
}

TEST_F(CalibrationTest, WallsWithProgramsOfTheirOwnAreRefused) {
  write("s.toml", replaced(k_hertz_text, "configuration = \"simple\"\n", R"(configuration = "walls"
wall = [{ name = "a", normal = [0, 0, 1], steps = [{ displacement = "1 mm", duration = 1 }] },
        { name = "b", normal = [0, 0, -1] }]
)"));
  const auto messages = faults();
  ASSERT_FALSE(messages.empty());
  EXPECT_EQ(messages[0].find("c.toml:1:12: wall 'a' of the scenario has steps of its own"), 0U) << messages[0];
}

TEST_F(CalibrationTest, TheBestResponseIsThatOfTheFitHoweverBad) {
  write("d.csv", "displacement[m],force[N]\n1e-5,100\n2e-5,35\n3e-5,-60\n");
  const Calibration calibration = read();
  const CalibrationResult result = calibrate(calibration);
  ASSERT_FALSE(result.warnings.empty());
  const auto response = best_response(calibration);
  ASSERT_TRUE(response);
  EXPECT_EQ(*response, result.fit.y);
}

TEST_F(CalibrationTest, ThereIsNoBestResponseWhereNoParametersCanFollowTheData) {
  write("c.toml", replaced(replaced(k_calibration, "displacement[m]", "force[N]"), "y = \"force[N]\"",
                           "y = \"displacement[m]\""));
  write("d.csv", "force[N],displacement[m]\n10,1e-6\n-10,0\n-20,0\n");
  EXPECT_FALSE(best_response(read()));
}

TEST_F(CalibrationTest, DataThatNoParametersCanFollowAreRefusedWithTheRow) {
  // A particle without adhesion bears no tension.
  write("c.toml", replaced(replaced(k_calibration, "displacement[m]", "force[N]"), "y = \"force[N]\"",
                           "y = \"displacement[m]\""));
  write("d.csv", "force[N],displacement[m]\n10,1e-6\n-10,0\n-20,0\n");
  const Calibration calibration = read();
  try {
    static_cast<void>(calibrate(calibration));
    FAIL() << "no error";
  } catch (const ScenarioError& error) {
    const Fault& fault = error.faults().front();
    EXPECT_EQ(fs::path(fault.where.file).filename(), "d.csv");
    EXPECT_EQ(fault.where.line, 3U);
    EXPECT_NE(fault.message.find("cannot follow the data beyond this row"), std::string::npos) << fault.message;
  }
}

// --- several curves

constexpr const char* k_two_curves = R"(scenario = "s.toml"
[[data]]
file = "d.csv"
x = "displacement[m]"
y = "force[N]"
[[data]]
file = "e.csv"
set = ["material.poisson_ratio=0.4"]
x = "displacement[m]"
y = "force[N]"
[free]
"material.youngs_modulus" = { from = "10 GPa", to = "300 GPa" }
)";

TEST_F(CalibrationTest, FitsSeveralCurvesTogetherEachWithItsOverrides) {
  const auto curve = [](double poisson, std::initializer_list<double> displacements) {
    std::string text = "displacement[m],force[N]\n";
    for (const double d : displacements) {
      text += fmt::format("{:.17g},{:.17g}\n", d, hertz_force(70e9 / (1.0 - poisson * poisson), k_radius, d));
    }
    return text;
  };
  write("d.csv", curve(0.22, {1e-5, 2e-5, 3e-5}));
  write("e.csv", curve(0.4, {2e-5, 1e-5}));
  write("c.toml", k_two_curves);
  const Calibration calibration = read();
  ASSERT_EQ(calibration.curves.size(), 2U);
  EXPECT_EQ(calibration.curves[1].begin, 3U);
  EXPECT_EQ(calibration.curves[1].end, 5U);
  EXPECT_EQ(calibration.counted(), 5U);
  const CalibrationResult result = calibrate(calibration);
  EXPECT_NEAR(result.solution.parameters[0] / 70e9, 1.0, 1e-9);
  EXPECT_LT(result.goodness.sum_of_squares, 1e-18);
  EXPECT_EQ(result.fit.y.size(), 5U);
  EXPECT_EQ(result.curves.size(), 2U);
  EXPECT_EQ(result.program_steps, 3U);  // the second curve turns
  EXPECT_EQ(written(calibration, result, folder() / "out"), "");
  const Table fit = read_csv(folder() / "out" / "fit.csv");
  EXPECT_EQ(fit.column("curve"), (std::vector<double>{1, 1, 1, 2, 2}));
  const auto json = nlohmann::json::parse(text_of("out/calibration.json"));
  ASSERT_EQ(json.at("data").size(), 2U);
  EXPECT_EQ(json.at("data")[1].at("set")[0], "material.poisson_ratio=0.4");
}

TEST_F(CalibrationTest, DrawsTheResidualsOfEachCurveInAPanelOfItsOwn) {
  const auto rows = noisy_hertz();
  write("d.csv", csv_of(rows, "displacement[m],force[N],w"));
  write("e.csv", csv_of(std::vector<Row>(rows.begin(), rows.begin() + 12), "displacement[m],force[N],w"));
  write("c.toml", k_two_curves);
  const Calibration calibration = read();
  EXPECT_EQ(written(calibration, calibrate(calibration), folder() / "out"), "");
  const std::string script = text_of("out/figure.gp");
  for (const char* part : {"set label 5 'd' at graph", "set label 5 'poisson\\_ratio=0.4' at graph", "'(c)' at graph",
                           "'data: poisson\\_ratio=0.4"}) {
    EXPECT_TRUE(contains(script, part)) << part << '\n' << script;
  }
  EXPECT_FALSE(contains(script, "'(d)' at graph")) << script;
  const std::regex range("set yrange (\\[[^\\]]+\\])");
  std::vector<std::string> ranges;
  for (std::sregex_iterator it(script.begin(), script.end(), range), end; it != end; ++it) ranges.push_back((*it)[1]);
  ASSERT_EQ(ranges.size(), 3U) << script;
  EXPECT_EQ(ranges[1], ranges[2]) << "to compare the residuals";
  // Residuals, not forces, of the second curve alone.
  const std::string data = text_of("out/figure.dat");
  const std::size_t begin = data.find("# panel 3 series 1.");
  ASSERT_NE(begin, std::string::npos) << data;
  EXPECT_EQ(std::ranges::count(data.substr(begin), '\n'), 1 + 12) << data.substr(begin);
}

TEST_F(CalibrationTest, RefusesADirectSolutionThatTheSceneDoesNotHave) {
  const std::string message = "integrator = \"direct\": the state of this scene depends on the path to it";
  const std::string coupled = replaced(k_mdr, "\"mdr\"", "\"cel\"");
  write("s.toml", coupled + "[numerics]\nintegrator = \"direct\"\n");
  ASSERT_EQ(faults().size(), 1U);
  EXPECT_TRUE(faults()[0].starts_with("s.toml:14:14: " + message)) << faults()[0];
  write("s.toml", coupled);
  write("c.toml", replaced(k_calibration, "[free]", "set = [\"numerics.integrator=direct\"]\n[free]"));
  ASSERT_EQ(faults().size(), 1U);
  EXPECT_TRUE(faults()[0].starts_with("c.toml:6:7: " + message)) << faults()[0];
}

TEST_F(CalibrationTest, ReportsTheFaultsOfEveryCurve) {
  write("e.csv", k_data);
  write("c.toml", replaced(k_two_curves, "poisson_ratio=0.4", "poisson_ratio=0.7"));
  EXPECT_EQ(faults(),
            (std::vector<std::string>{"c.toml:8:7: poisson_ratio = 0.7: out of range; expected a number above "
                                      "-1 and up to 0.5"}));
  write("c.toml", replaced(k_two_curves, "poisson_ratio=0.4\"]", "poisson_ratio=0.4\"]\nweights = \"relative\""));
  EXPECT_EQ(faults(), (std::vector<std::string>{"c.toml:9:11: weights = \"relative\": those of the first curve are "
                                                "\"absolute\"; expected the same for all"}));
  write("c.toml", replaced(k_two_curves, "file = \"e.csv\"", "file = \"absent.csv\""));
  ASSERT_EQ(faults().size(), 1U);
  EXPECT_TRUE(faults()[0].starts_with("c.toml:7:8: file = \"absent.csv\"")) << faults()[0];
}

}  // namespace
}  // namespace monograin::calibration_test
