#include "study/sweep/joint_normal.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "study/sweep/sweep_file_test.hpp"
#include "support/scenario_texts.hpp"
#include "support/text_file.hpp"

namespace monograin::joint_normal_test {
namespace {

constexpr const char* k_fit = R"json({
"parameters": [
  {"key": "material.youngs_modulus", "value": 1.2e9, "standard_error": 6e7},
  {"key": "data.offset", "value": 1e-6, "standard_error": 1e-7},
  {"key": "material.yield_stress", "value": 45e6, "standard_error": 2e6}],
"correlation": [[1.0, 0.3, -0.6], [0.3, 1.0, 0.2], [-0.6, 0.2, 1.0]]})json";

constexpr const char* k_sweep = R"toml(design = "random"
runs = 4000
calibration = "fit"
[scenario]
model = "mdr"
[scenario.particle]
radius = "10 mm"
[scenario.material]
youngs_modulus = "1 GPa"
poisson_ratio = 0.3
yield_stress = "40 MPa"
[scenario.loading]
configuration = "simple"
steps = [{ displacement = "0.1 R0", duration = "1 s" }]
)toml";

class CorrelatedSweep : public SweepFileTest {
 protected:
  CorrelatedSweep() {
    std::filesystem::create_directory(folder() / "fit");
    write_fit(k_fit);
  }
  void write_fit(const std::string& text) const { write_text(folder() / "fit/calibration.json", text); }
};

TEST_F(CorrelatedSweep, DrawsMeansErrorsAndCorrelationOfTheCalibration) {
  for (const char* design : {"random", "lhs", "sobol", "halton"}) {
    const Sweep sweep = read(replaced(k_sweep, "random", design));
    ASSERT_EQ(sweep.factors.size(), 2U);
    EXPECT_EQ(sweep.factors[0].key, "material.youngs_modulus");
    EXPECT_EQ(sweep.factors[1].key, "material.yield_stress");
    const auto n = static_cast<double>(sweep.runs.size());
    std::vector<double> z[2];
    for (std::size_t run = 0; run < sweep.runs.size(); ++run) {
      z[0].push_back((std::get<double>(sweep.runs[run][0]) - 1.2e9) / 6e7);
      z[1].push_back((std::get<double>(sweep.runs[run][1]) - 45e6) / 2e6);
    }
    double products[2][2] = {};
    double means[2] = {};
    for (std::size_t run = 0; run < z[0].size(); ++run) {
      for (std::size_t i = 0; i < 2; ++i) {
        means[i] += z[i][run] / n;
        for (std::size_t j = 0; j < 2; ++j) products[i][j] += z[i][run] * z[j][run] / n;
      }
    }
    // Four standard errors of 4000 draws.
    EXPECT_NEAR(means[0], 0.0, 4.0 / std::sqrt(n)) << design;
    EXPECT_NEAR(means[1], 0.0, 4.0 / std::sqrt(n)) << design;
    EXPECT_NEAR(products[0][0], 1.0, 4.0 * std::sqrt(2.0 / n)) << design;
    EXPECT_NEAR(products[1][1], 1.0, 4.0 * std::sqrt(2.0 / n)) << design;
    EXPECT_NEAR(products[0][1], -0.6, 4.0 / std::sqrt(n)) << design;
  }
}

TEST_F(CorrelatedSweep, VariesOtherKeysBesideThem) {
  const Sweep sweep = read(
      replaced(k_sweep, "[scenario]", "[vary]\n\"material.poisson_ratio\" = { from = 0.2, to = 0.4 }\n[scenario]"));
  ASSERT_EQ(sweep.factors.size(), 3U);
  double product = 0.0;
  for (std::size_t run = 0; run < sweep.runs.size(); ++run) {
    product +=
        (std::get<double>(sweep.runs[run][0]) - 0.3) / 0.1 * (std::get<double>(sweep.runs[run][1]) - 1.2e9) / 6e7;
  }
  EXPECT_NEAR(product / 4000.0, 0.0, 4.0 / std::sqrt(3.0 * 4000.0)) << "and they know nothing of each other";
}

TEST_F(CorrelatedSweep, OfAnotherFitIsAnotherSweep) {
  const std::string before = read(k_sweep).digest;
  write_fit(replaced(k_fit, "6e7", "7e7"));
  EXPECT_NE(read(k_sweep).digest, before);
}

TEST_F(CorrelatedSweep, SaysWhatIsWrongWithTheCalibration) {
  EXPECT_NE(fault(replaced(k_sweep, "\"fit\"", "\"nowhere\"")).find("s.toml:3:15: calibration = \"nowhere\": "),
            std::string::npos);
  EXPECT_NE(fault(replaced(k_sweep, "[scenario]",
                           "[vary]\n\"material.yield_stress\" = { mean = \"1 MPa\", std = \"1 "
                           "kPa\" }\n[scenario]"))
                .find("'material.yield_stress' is varied in [vary], too"),
            std::string::npos);
  EXPECT_NE(fault(replaced(k_sweep, "\"random\"", "\"maxpro\"")).find("key 'calibration' goes with design = sobol"),
            std::string::npos);
  for (const auto& [text, problem] :
       {std::pair(replaced(k_fit, "2e6", "null"), "'material.yield_stress' has no standard error"),
        {std::string("{}"), "it is no result of monograin calibrate"},
        {std::string("x"), "it is no result of monograin calibrate"},
        {replaced(replaced(k_fit, "-0.6]", "1.0]"), "[-0.6", "[1.0"), "its numbers depend on each other"},
        {replaced(replaced(k_fit, "material.youngs_modulus", "data.a"), "material.yield_stress", "data.b"),
         "it has found no number of the scenario"},
        {replaced(k_fit, "material.yield_stress", "material.strength"), "key 'strength' is not used by model 'mdr'"}}) {
    write_fit(text);
    EXPECT_NE(fault(k_sweep).find(problem), std::string::npos) << problem << " in\n" << fault(k_sweep);
  }
}

}  // namespace
}  // namespace monograin::joint_normal_test
