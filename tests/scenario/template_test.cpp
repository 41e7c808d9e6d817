// A scenario's text that is parsed once and checked with many numbers.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scenario/faults.hpp"
#include "scenario/scenario.hpp"
#include "scenario/text_file.hpp"

namespace monograin::template_test {
namespace {

const std::filesystem::path k_ready = std::filesystem::path(MONOGRAIN_SOURCE_DIR) / "scenarios";

void expect_same(const CheckedScenario& one, const CheckedScenario& other) {
  EXPECT_EQ(one.name, other.name);
  EXPECT_EQ(one.text, other.text);
  EXPECT_EQ(one.overrides, other.overrides);
  EXPECT_EQ(one.model, other.model);
  EXPECT_EQ(one.radius, other.radius);
  EXPECT_EQ(one.material, other.material);
  EXPECT_EQ(one.options, other.options);
  EXPECT_EQ(one.output.points, other.output.points);
  ASSERT_EQ(one.loading.steps.size(), other.loading.steps.size());
  for (std::size_t k = 0; k < one.loading.steps.size(); ++k) {
    EXPECT_EQ(one.loading.steps[k].target, other.loading.steps[k].target) << "step " << k;
  }
}

/// Scenario of a file with these overrides.
CheckedScenario written(const ScenarioSource& source, std::span<const std::string> keys,
                        std::span<const double> numbers) {
  std::vector<std::string> overrides;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    overrides.push_back(fmt::format("{}={}", keys[k], numbers[k]));
  }
  return parse_scenario(source.text, source.origin, overrides);
}

ScenarioSource source_of(const std::filesystem::path& file) {
  return {.text = read_text_file(file, 1 << 20).text, .origin = file.string()};
}

TEST(ScenarioTemplate, SetsNumbersOfTheMaterialAsItsTextWould) {
  for (const std::filesystem::path& file : toml_files(k_ready, "scenario", "")) {
    SCOPED_TRACE(file);
    const ScenarioSource source = source_of(file);
    const ScenarioTemplate prepared(source);
    const CheckedScenario given = prepared.with({});
    std::vector<std::string> keys;
    std::vector<double> numbers;
    for (const auto& [name, value] : given.material) {
      const std::string key = "material." + name;
      // An unset key stands for its default, and Ludwik's table for two.
      if (!prepared.problem_of_number(key).empty() || source.text.find(name) == std::string::npos) continue;
      if (source.text.find("ludwik") != std::string::npos) continue;
      keys.push_back(key);
      numbers.push_back(value);
    }
    // The first call reads all of it, the others the numbers alone.
    for (const double factor : {1.0, 0.99, 0.98}) {
      std::vector<double> changed = numbers;
      for (double& number : changed) number *= factor;
      expect_same(prepared.with({}, keys, changed), written(source, keys, changed));
    }
  }
}

TEST(ScenarioTemplate, ForgetsTheNumbersOfOtherCalls) {
  const ScenarioSource source = source_of(k_ready / "uniaxial.toml");
  const ScenarioTemplate prepared(source);
  const std::vector<std::string> both{"material.youngs_modulus", "material.yield_stress"};
  const std::vector<std::string> one{"material.youngs_modulus"};
  static_cast<void>(prepared.with({}, both, std::array{2e9, 7e7}));
  static_cast<void>(prepared.with({}, both, std::array{3e9, 8e7}));
  expect_same(prepared.with({}, one, std::array{4e9}), written(source, one, std::array{4e9}));
  expect_same(prepared.with({}), written(source, {}, {}));
  const std::vector<std::string> with_points{"material.youngs_modulus", "output.points"};
  for (const double points : {10.0, 20.0, 20.0}) {
    EXPECT_EQ(prepared.with({}, with_points, std::array{2e9, points}).output.points, static_cast<int>(points));
  }
}

TEST(ScenarioTemplate, ReportsFaultyNumbersAsItsTextWould) {
  struct Case {
    std::string file;
    std::string key;
    double good, bad;
  };
  for (const Case& one : {Case{"uniaxial.toml", "material.poisson_ratio", 0.3, 0.7},
                          Case{"uniaxial.toml", "material.youngs_modulus", 1e9, -1.0},
                          // The law objects to soft materials.
                          Case{"semimech.toml", "material.yield_stress", 1e8, 9e9}}) {
    SCOPED_TRACE(one.key);
    const ScenarioSource source = source_of(k_ready / one.file);
    const ScenarioTemplate prepared(source);
    const std::vector<std::string> keys{one.key};
    static_cast<void>(prepared.with({}, keys, std::array{one.good}));
    std::string of_text = "none";
    std::string of_template = "none";
    try {
      static_cast<void>(written(source, keys, std::array{one.bad}));
    } catch (const ScenarioError& error) {
      of_text = error.what();
    }
    try {
      static_cast<void>(prepared.with({}, keys, std::array{one.bad}));
    } catch (const ScenarioError& error) {
      of_template = error.what();
    }
    EXPECT_NE(of_text, "none");
    EXPECT_EQ(of_template, of_text);
  }
}

TEST(ScenarioTemplate, FitsLudwiksLawAnewForEveryModulus) {
  const ScenarioSource source = source_of(k_ready / "similarity.toml");
  const ScenarioTemplate prepared(source);
  const std::vector<std::string> keys{"material.youngs_modulus"};
  for (const double modulus : {16e9, 32e9, 8e9}) {
    const CheckedScenario made = prepared.with({}, keys, std::array{modulus});
    expect_same(made, written(source, keys, std::array{modulus}));
  }
  EXPECT_NE(prepared.with({}, keys, std::array{16e9}).material.at("hardening_exponent"),
            prepared.with({}, keys, std::array{8e9}).material.at("hardening_exponent"));
}

}  // namespace
}  // namespace monograin::template_test
