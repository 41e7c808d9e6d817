// How often intervals hold the truth, over many synthetic experiments with a machine between them and the particle.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "history/run.hpp"
#include "history/table.hpp"
#include "study/calibrate/calibration.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"

namespace monograin::coverage_test {
namespace {

// Ten sets a law show gross faults within half a minute. MONOGRAIN_COVERAGE_SETS=1500 makes a measurement of it, and
// MONOGRAIN_COVERAGE_SEED draws other sets.

/// A law with its true numbers, and those that are sought beside offset and compliance.
struct Experiment {
  const char* model;
  const char* material;
  const char* steps;
  int points;  ///< in each step
  const char* free;
  std::vector<double> truth;
  double noise = 0.01;  ///< of the largest force
};

const std::vector<Experiment> k_experiments{
    {"hertz",
     "youngs_modulus = 2e9\npoisson_ratio = 0.3",
     "{ displacement = '0.05 R0', duration = 1 }",
     80,
     R"("material.youngs_modulus" = { from = "0.2 GPa", to = "20 GPa" })",
     {2e9}},
    {"mdr",
     "youngs_modulus = 1.2e9\npoisson_ratio = 0.3\nyield_stress = 45e6",
     "{ displacement = '0.25 R0', duration = 1 }, { displacement = '0.22 R0', duration = 1 }",
     60,
     R"("material.youngs_modulus" = { from = "0.1 GPa", to = "10 GPa" }
"material.yield_stress" = { from = "1 MPa", to = "200 MPa" })",
     {1.2e9, 45e6}},
    {"semimech",
     "youngs_modulus = 5e9\npoisson_ratio = 0.3\nyield_stress = 50e6\n[semimech]\nunloading = \"mdr\"",
     "{ displacement = '0.3 R0', duration = 1 }, { displacement = '0.28 R0', duration = 1 }",
     80,
     R"("material.youngs_modulus" = { from = "2 GPa", to = "50 GPa" }
"material.yield_stress" = { from = "5 MPa", to = "90 MPa" })",
     {5e9, 50e6},
     0.002},
    {"compressible",
     "yield_pressure = 150e6\nstiffness_ratio = 100\nshear_ratio = 1.0\ntensile_ratio = 0.01\nnu0 = 0.3\n"
     "[compressible]\nk = 3.0\na = 3.5",
     "{ displacement = '0.4 R0', duration = 1 }",
     80,
     R"("compressible.k" = { from = 0.1, to = 20 }
"compressible.a" = { from = 1, to = 10 })",
     {3.0, 3.5}}};

constexpr double k_radius = 0.01;  // [m]
constexpr int k_quick_sets = 10;

std::string scenario_of(const Experiment& experiment) {
  return fmt::format(
      "model = \"{}\"\n[particle]\nradius = {}\n[material]\n{}\n[loading]\nconfiguration = \"simple\"\n"
      "steps = [{}]\n[output]\npoints = {}\n",
      experiment.model, k_radius, experiment.material, experiment.steps, experiment.points);
}

constexpr double k_level = 0.95;
constexpr double k_share_off = 0.03;  // largest difference of the share of intervals that hold the truth from the level
constexpr double k_bias = 0.1;        // largest bias, over the standard error
constexpr double k_margin = 3.0;      // in standard errors of both, which add for few sets
constexpr double k_largest_offset = 0.02;      // of R0
constexpr double k_largest_compliance = 5e-8;  // [m/N]

/// One measured file: the machine adds an offset and its give.
std::string measured(const std::vector<double>& x, const std::vector<double>& force, double offset, double compliance,
                     double noise_share, std::mt19937_64& generator) {
  std::normal_distribution<double> noise(0.0, noise_share * std::ranges::max(force));
  std::string text = "displacement[m],force[N]\n";
  for (std::size_t i = 0; i < x.size(); ++i) {
    text += fmt::format("{:.17g},{:.17g}\n", x[i] + offset + compliance * force[i], force[i] + noise(generator));
  }
  return text;
}

/// A whole number of the environment.
int asked_for(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atoi(text);
}

class Coverage : public ::testing::TestWithParam<Experiment> {};

TEST_P(Coverage, OfIntervalsIsThatOfTheirLevelWithOffsetAndComplianceSought) {
  const Experiment& experiment = GetParam();
  const int sets = asked_for("MONOGRAIN_COVERAGE_SETS", k_quick_sets);
  const TemporaryFolder folder;
  const std::string scenario = scenario_of(experiment);
  write_text(folder.path() / "s.toml", scenario);
  write_text(folder.path() / "c.toml", fmt::format("scenario = \"s.toml\"\n[data]\nfile = \"d.csv\"\n"
                                                   "x = \"displacement[m]\"\ny = \"force[N]\"\n[free]\n{}\n"
                                                   "\"data.offset\" = {{ from = \"-0.05 R0\", to = \"0.05 R0\" }}\n"
                                                   "\"data.compliance\" = {{ from = 0, to = \"500 nm/N\" }}\n",
                                                   experiment.free));
  const Table history = run_scenario(parse_scenario(scenario, "s.toml")).record.history;
  std::vector<double> x;
  std::vector<double> force;
  for (std::size_t row = 0; row < history.row_count(); ++row) {
    if (history.column("row")[row] != 0.0) continue;
    x.push_back(history.column("axial.displacement")[row]);
    force.push_back(history.column("axial.force")[row]);
  }
  const std::size_t count = experiment.truth.size() + 2;
  std::vector<int> held(count, 0);
  std::vector<double> bias(count, 0.0);
  std::vector<double> spread(count, 0.0);
  std::mt19937_64 generator(static_cast<std::uint64_t>(asked_for("MONOGRAIN_COVERAGE_SEED", 17)));
  std::uniform_real_distribution<double> uniform;
  for (int set = 0; set < sets; ++set) {
    std::vector<double> truth = experiment.truth;
    truth.push_back(k_largest_offset * k_radius * uniform(generator));
    truth.push_back(k_largest_compliance * uniform(generator));
    write_text(folder.path() / "d.csv",
               measured(x, force, truth[count - 2], truth[count - 1], experiment.noise, generator));
    const CalibrationResult result = calibrate(read_calibration(folder.path() / "c.toml"));
    for (std::size_t k = 0; k < count; ++k) {
      const Interval& interval = result.intervals[k];
      if (truth[k] >= interval.lower && truth[k] <= interval.upper) ++held[k];
      bias[k] += (result.solution.parameters[k] - truth[k]) / sets;
      spread[k] += std::pow(result.solution.parameters[k] - truth[k], 2) / sets;
    }
  }
  const std::vector<FreeParameter> free = read_calibration(folder.path() / "c.toml").free;
  // Few sets tell less than the bars ask for.
  const double chance = k_margin * std::sqrt(k_level * (1.0 - k_level) / sets) + 0.5 / sets;
  const double share_bar = std::max(k_share_off, chance);
  const double bias_bar = k_bias + k_margin / std::sqrt(sets);
  for (std::size_t k = 0; k < count; ++k) {
    const double share = static_cast<double>(held[k]) / sets;
    const double bias_over_error = bias[k] / std::sqrt(spread[k]);
    EXPECT_NEAR(share, k_level, share_bar) << free[k].key.path << " is held in " << held[k] << " of " << sets;
    EXPECT_LE(std::abs(bias_over_error), bias_bar) << free[k].key.path;
    if (sets != k_quick_sets) {
      fmt::print("{}, {}: held in {:.1f} %, bias {:.3f} of the standard error {:.3g}\n", experiment.model,
                 free[k].key.path, 100.0 * share, bias_over_error, std::sqrt(spread[k]));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, Coverage, ::testing::ValuesIn(k_experiments),
                         [](const auto& test) { return std::string(test.param.model); });

}  // namespace
}  // namespace monograin::coverage_test
