// Prepared scenarios give what edited ones give, bit by bit.

#include "monograin/prepared.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "api/ready.hpp"

namespace monograin {
namespace {

/// Every number of both histories has the same bits.
void expect_same(const History& a, const History& b) {
  ASSERT_EQ(a.names(), b.names());
  ASSERT_EQ(a.row_count(), b.row_count());
  for (const std::string_view name : a.names()) {
    for (std::size_t row = 0; row < a.row_count(); ++row) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(a[name][row]), std::bit_cast<std::uint64_t>(b[name][row]))
          << name << ", row " << row;
    }
  }
}

struct Variation {
  std::string file;
  std::string key;
  double value = 0.0;
};

class PreparedScenarioOf : public testing::TestWithParam<Variation> {};

TEST_P(PreparedScenarioOf, EqualsTheEditedText) {
  const auto& [file, key, value] = GetParam();
  const Scenario scenario = ready_scenario(file);
  Scenario edited = scenario;
  edited.set(key, value);
  const RunResult expected = run(edited);
  const RunResult actual = PreparedScenario(scenario, {key}).run(std::vector{value});
  EXPECT_EQ(actual.status, expected.status);
  EXPECT_EQ(actual.warnings, expected.warnings);
  expect_same(actual.history, expected.history);
  expect_same(actual.events, expected.events);
}

INSTANTIATE_TEST_SUITE_P(Keys, PreparedScenarioOf,
                         testing::Values(Variation{"die.toml", "material.yield_stress", 41.7e6},
                                         Variation{"die.toml", "particle.radius", 0.0123},
                                         Variation{"die.toml", "loading.steps[0].displacement", 0.0031},
                                         Variation{"die.toml", "output.points", 37.0},
                                         Variation{"die.toml", "numerics.rtol", 1e-6},
                                         Variation{"adhesion.toml", "material.surface_energy", 0.3},
                                         Variation{"nonlocal.toml", "material.poisson_ratio", 0.46},
                                         Variation{"compressible.toml", "particle.radius", 0.004},
                                         Variation{"material-point-triaxial.toml", "loading.steps[0].duration", 0.7},
                                         Variation{"semimech.toml", "material.youngs_modulus", 1.7e11},
                                         Variation{"cycles.toml", "material.poisson_ratio", 0.1}));

TEST(PreparedScenario, RefusesKeysThatHoldNoNumber) {
  const Scenario scenario = ready_scenario("die.toml");
  for (const char* key : {"model", "material.yield_strain", "loading.steps[9].rate", "loading.steps", "a b"}) {
    EXPECT_THROW(PreparedScenario(scenario, {key}), ScenarioError) << key;
  }
}

TEST(PreparedScenario, RefusesAKeyThatIsListedTwice) {
  const std::vector<std::string> keys(2, "material.yield_stress");
  EXPECT_THROW(static_cast<void>(PreparedScenario(ready_scenario("die.toml"), keys)), ScenarioError);
}

TEST(PreparedScenario, RefusesToVaryNothingAndToRunOnFewerThreadsThanNone) {
  EXPECT_THROW(PreparedScenario(ready_scenario("die.toml"), {}), std::invalid_argument);
  const PreparedScenario prepared(ready_scenario("die.toml"), {"material.yield_stress"});
  EXPECT_THROW(
      static_cast<void>(prepared.map(std::vector{45e6}, std::vector<std::string>{"max(axial.force)"}, {.threads = -1})),
      std::invalid_argument);
}

TEST(PreparedScenario, TakesTheHeadingOfAColumn) {
  const PreparedScenario prepared(ready_scenario("hertz.toml"), {"material.youngs_modulus"});
  const MapResult table =
      prepared.map(std::vector{1e9}, std::vector<std::string>{"max(axial.force)", "max(axial.force[N])"});
  EXPECT_GT(table.values[0], 0.0);
  EXPECT_EQ(table.values[0], table.values[1]);
}

TEST(PreparedScenario, RefusesValuesThatAreNotAdmissible) {
  const PreparedScenario prepared(ready_scenario("die.toml"), {"material.poisson_ratio"});
  EXPECT_THROW(static_cast<void>(prepared.run(std::vector{0.7})), ScenarioError);
  EXPECT_THROW(static_cast<void>(prepared.run(std::vector{std::nan("")})), ScenarioError);
  EXPECT_THROW(static_cast<void>(prepared.run(std::vector{0.1, 0.2})), std::invalid_argument);
}

TEST(PreparedScenario, MapsSamplesToResultsOnManyThreads) {
  const PreparedScenario prepared(ready_scenario("die.toml"), {"material.yield_stress", "material.poisson_ratio"});
  const std::vector<double> samples{45e6, 0.3, 30e6, 0.2, 30e6, 0.7};
  const std::vector<std::string> formulas{"max(axial.force)", "end(apparent_radius) / 1e-3"};
  for (const int threads : {1, 3}) {
    const MapResult table = prepared.map(samples, formulas, {.threads = threads});
    for (std::size_t i = 0; i < 2; ++i) {
      const RunResult one = prepared.run(std::vector{samples[2 * i], samples[2 * i + 1]});
      double largest = 0.0;
      for (const double force : one.history["axial.force"]) largest = std::fmax(largest, force);
      EXPECT_NEAR(table.values[2 * i], largest, 1e-13 * largest);
      EXPECT_NEAR(table.values[2 * i + 1], one.history["apparent_radius"].back() / 1e-3, 1e-12);
      EXPECT_EQ(table.status[i], "complete");
    }
    EXPECT_EQ(table.status[2], "refused");
    EXPECT_NE(table.message[2].find("poisson_ratio"), std::string::npos) << table.message[2];
    EXPECT_TRUE(std::isnan(table.values[4]));
  }
}

/// Names of ready scenarios.
std::vector<std::string> ready_names() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(MONOGRAIN_SOURCE_DIR "/scenarios")) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().filename().string());
  }
  return names;
}

class MapOf : public testing::TestWithParam<std::string> {};

TEST_P(MapOf, AFewNumbersFindsThoseOfTheWholeRun) {
  const PreparedScenario prepared(ready_scenario(GetParam()), {"numerics.rtol"});
  const std::vector<double> sample{1e-9};
  const History whole = prepared.run(sample).history;
  std::size_t numbers = 0;
  for (const std::string_view name : whole.names()) {
    if (name == "row" || !whole.column(name).labels.empty()) continue;
    const auto values = whole[name];
    double greatest = 0.0;
    for (const double value : values) {
      if (std::isfinite(value)) greatest = std::max(greatest, std::abs(value));
    }
    for (const char* function : {"end", "last"}) {
      const std::vector<std::string> formula{std::string(function) + "(`" + std::string(name) + "`)"};
      const double found = prepared.map(sample, formula, {.threads = 1}).values.front();
      if (std::isnan(values.back()) && formula.front().starts_with("end")) {
        EXPECT_TRUE(std::isnan(found)) << formula.front();
      } else if (!std::isnan(values.back())) {
        EXPECT_NEAR(found, values.back(), 1e-11 * greatest) << formula.front();
        ++numbers;
      }
    }
  }
  EXPECT_GE(numbers, 8U);
}

INSTANTIATE_TEST_SUITE_P(ReadyScenarios, MapOf, testing::ValuesIn(ready_names()), [](const auto& test) {
  std::string name = test.param.substr(0, test.param.find('.'));
  std::ranges::replace(name, '-', '_');
  return name;
});

TEST(PreparedScenario, MapsTheEndOfARunWithoutItsRows) {
  const PreparedScenario prepared(ready_scenario("die.toml"), {"material.yield_stress"});
  const std::vector<double> samples(50, 45e6);
  const auto processor_time = [&](const char* formula) {
    const std::clock_t start = std::clock();
    static_cast<void>(prepared.map(samples, std::vector<std::string>{formula}, {.threads = 1}));
    return static_cast<double>(std::clock() - start);
  };
  double of_end = std::numeric_limits<double>::infinity();
  double of_rows = std::numeric_limits<double>::infinity();
  for (int repeat = 0; repeat < 5; ++repeat) {
    of_end = std::min(of_end, processor_time("end(axial.force)"));
    of_rows = std::min(of_rows, processor_time("max(work)"));
  }
  EXPECT_LT(of_end, 0.6 * of_rows);  // 0.23 measured
}

TEST(PreparedScenario, EndsAMapWhenItIsTold) {
  const PreparedScenario prepared(ready_scenario("die.toml"), {"material.yield_stress"});
  const std::vector<double> samples(1000, 45e6);
  int questions = 0;
  const MapResult table = prepared.map(samples, std::vector<std::string>{"max(axial.force)"},
                                       {.threads = 1, .stop = [&] { return ++questions > 5; }});
  EXPECT_EQ(table.status.front(), "complete");
  EXPECT_EQ(table.status.back(), "") << "its row was not done";
}

TEST(PreparedScenario, RefusesFormulasWithoutOneValue) {
  const PreparedScenario prepared(ready_scenario("die.toml"), {"material.yield_stress"});
  for (const char* formula : {"axial.force", "max(axial.forse)", "max(", "end(axial.regime)"}) {
    EXPECT_THROW(static_cast<void>(prepared.map(std::vector{45e6}, std::vector<std::string>{formula})),
                 std::invalid_argument)
        << formula;
  }
}

}  // namespace
}  // namespace monograin
