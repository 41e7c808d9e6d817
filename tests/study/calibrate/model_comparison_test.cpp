#include "study/calibrate/model_comparison.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "elastic/hertz.hpp"
#include "history/table.hpp"
#include "study/calibrate/calibration.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"

namespace monograin::model_comparison_test {
namespace {

constexpr double k_radius = 0.01;
constexpr double k_modulus = 2e9;

constexpr const char* k_hertz = R"(model = "hertz"
[particle]
radius = 0.01
[material]
youngs_modulus = 1e9
poisson_ratio = 0.0
[loading]
configuration = "simple"
steps = [{ displacement = 1e-4, duration = 1 }]
)";

constexpr const char* k_alone = "\"material.youngs_modulus\" = { from = \"0.2 GPa\", to = \"20 GPa\" }\n";
constexpr const char* k_offset = "\"data.offset\" = { from = \"-0.01 R0\", to = \"0.01 R0\" }\n";

/// Displacements of two cycles: up to the end of the first, back to half of it, up to the end, and back.
std::vector<double> two_cycles() {
  std::vector<double> x;
  for (int i = 0; i <= 20; ++i) x.push_back(2e-5 * i);
  for (int i = 1; i <= 10; ++i) x.push_back(4e-4 - 2e-5 * i);
  for (int i = 1; i <= 30; ++i) x.push_back(2e-4 + 2e-5 * i);
  for (int i = 1; i <= 20; ++i) x.push_back(8e-4 - 2e-5 * i);
  return x;
}

class ModelComparisonTest : public ::testing::Test {
 protected:
  ModelComparisonTest() {
    write_text(folder() / "s.toml", k_hertz);
    std::mt19937 generator(4);
    std::normal_distribution<double> noise;
    for (const double x : two_cycles()) {
      data_.push_back({x, hertz_force(k_modulus, k_radius, x) + k_noise * noise(generator)});
    }
  }

  /// Calibrations with other free parameters, of data with a share of their noise.
  [[nodiscard]] std::vector<Calibration> read(const std::vector<std::string>& free, double share = 1.0,
                                              const std::string& data = {}) const {
    std::string csv = "displacement[m],force[N]\n";
    for (const auto& [x, force] : data_) {
      csv += fmt::format("{:.17g},{:.17g}\n", x, std::lerp(hertz_force(k_modulus, k_radius, x), force, share));
    }
    write_text(folder() / "d.csv", csv);
    std::vector<Calibration> calibrations;
    for (std::size_t k = 0; k < free.size(); ++k) {
      const auto file = folder() / fmt::format("c{}.toml", k);
      write_text(file, fmt::format("scenario = \"s.toml\"\n[data]\nfile = \"d.csv\"\nx = \"displacement[m]\"\n"
                                   "y = \"force[N]\"\n{}\n[free]\n{}",
                                   data, free[k]));
      calibrations.push_back(read_calibration(file));
    }
    return calibrations;
  }

  static std::vector<CalibrationResult> fit(const std::vector<Calibration>& calibrations) {
    std::vector<CalibrationResult> results;
    for (const Calibration& calibration : calibrations) results.push_back(calibrate(calibration));
    return results;
  }

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }

  static constexpr double k_noise = 0.5;  // [N]
  struct Row {
    double x;
    double force;
  };
  std::vector<Row> data_;

 private:
  TemporaryFolder folder_;
};

TEST_F(ModelComparisonTest, CriteriaChargeAParameterThatTheDataDoNotAskFor) {
  const auto calibrations = read({k_alone, std::string(k_alone) + k_offset});
  const auto results = fit(calibrations);
  const ModelComparison found = compare_models(calibrations, results);
  const auto n = static_cast<double>(data_.size());
  const double gain = n * std::log(results[0].goodness.sum_of_squares / results[1].goodness.sum_of_squares);
  EXPECT_GT(gain, 0.0);
  EXPECT_NEAR(found.fits[1].aic - found.fits[0].aic, 2.0 - gain, 1e-9);
  EXPECT_NEAR(found.fits[1].bic - found.fits[0].bic, std::log(n) - gain, 1e-9);
  EXPECT_LT(found.fits[0].bic, found.fits[1].bic);
  const std::string text = comparison_text(calibrations, results, found);
  EXPECT_LT(text.find("\nc0"), text.find("\nc1")) << text;
}

TEST_F(ModelComparisonTest, CriteriaAskForAParameterThatTheDataNeed) {
  for (Row& row : data_) row.x += 1e-5;
  const auto calibrations = read({k_alone, std::string(k_alone) + k_offset});
  const auto results = fit(calibrations);
  const ModelComparison found = compare_models(calibrations, results);
  EXPECT_LT(found.fits[1].aic, found.fits[0].aic - 10.0);
  EXPECT_LT(found.fits[1].bic, found.fits[0].bic - 10.0);
  EXPECT_LT(found.fits[1].prediction, found.fits[0].prediction);
  EXPECT_NE(comparison_text(calibrations, results, found).find("the BIC is for 'c1'"), std::string::npos);
}

TEST_F(ModelComparisonTest, OfKnownNoiseTheCriteriaAreChiSquaredAndTheCharge) {
  const auto calibrations = read({k_alone}, 1.0, "noise = { absolute = \"0.5 N\" }");
  const auto results = fit(calibrations);
  const ModelComparison found = compare_models(calibrations, results);
  EXPECT_NEAR(found.fits[0].aic, results[0].goodness.sum_of_squares + 2.0, 1e-9);
  EXPECT_NEAR(found.fits[0].bic, results[0].goodness.sum_of_squares + std::log(static_cast<double>(data_.size())),
              1e-9);
}

TEST_F(ModelComparisonTest, TheTrueLawPredictsACycleThatItWasNotFittedTo) {
  const auto exact = read({k_alone}, 0.0);
  const ModelComparison found = compare_models(exact, fit(exact));
  EXPECT_EQ(found.parts, 2U);
  EXPECT_TRUE(found.are_cycles);
  EXPECT_LE(found.fits[0].prediction, 1e-8 * data_.back().force);
}

TEST_F(ModelComparisonTest, PredictionsAreThoseOfFitsToTheOtherCycle) {
  const auto calibrations = read({k_alone});
  const ModelComparison found = compare_models(calibrations, fit(calibrations));
  // The force is linear in the modulus: its fit to some of the rows has a closed form.
  const std::size_t turn = 31;  // rows of the first cycle
  double squares = 0.0;
  for (const bool is_first : {true, false}) {
    double products = 0.0;
    double weights = 0.0;
    for (std::size_t i = 0; i < data_.size(); ++i) {
      if ((i < turn) == is_first) continue;
      const double f = hertz_force(1.0, k_radius, data_[i].x);
      products += f * data_[i].force;
      weights += f * f;
    }
    for (std::size_t i = 0; i < data_.size(); ++i) {
      if ((i < turn) != is_first) continue;
      squares += std::pow(data_[i].force - products / weights * hertz_force(1.0, k_radius, data_[i].x), 2);
    }
  }
  EXPECT_NEAR(found.fits[0].prediction, std::sqrt(squares / static_cast<double>(data_.size())),
              1e-6 * found.fits[0].prediction);
}

TEST_F(ModelComparisonTest, CyclesOfStrainsBelowZeroBeginAsTheyDoAboveZero) {
  const TemporaryFolder cycles;
  std::string csv = "strain_axial[-],stress_axial[MPa]\n";
  for (const double x : two_cycles()) csv += fmt::format("{:.17g},{:.17g}\n", -50.0 * x, -2e5 * x - 1e8 * x * x);
  write_text(cycles.path() / "d.csv", csv);
  write_text(cycles.path() / "c.toml",
             R"([scenario]
model = "material-point"
[scenario.material]
preset = "MCC PH-200"
relative_density = 0.45
[scenario.loading]
configuration = "die"
steps = [{ strain = -0.04, duration = 1 }]
[data]
file = "d.csv"
x = "strain_axial[-]"
y = "stress_axial[MPa]"
[free]
"material.yield_pressure" = { from = "2 MPa", to = "200 MPa" }
)");
  const std::vector<Calibration> calibrations{read_calibration(cycles.path() / "c.toml")};
  const ModelComparison found = compare_models(calibrations, fit(calibrations));
  EXPECT_EQ(found.parts, 2U);
  EXPECT_TRUE(found.are_cycles);
}

TEST_F(ModelComparisonTest, OneCycleIsTakenApartAtItsTurn) {
  data_.resize(31);
  const auto calibrations = read({k_alone});
  const ModelComparison found = compare_models(calibrations, fit(calibrations));
  EXPECT_EQ(found.parts, 2U);
  EXPECT_FALSE(found.are_cycles);
  EXPECT_TRUE(std::isfinite(found.fits[0].prediction));
}

TEST_F(ModelComparisonTest, DataThatNeitherTurnNorAreSeveralPredictNothing) {
  data_.resize(21);
  const auto calibrations = read({k_alone});
  const auto results = fit(calibrations);
  const ModelComparison found = compare_models(calibrations, results);
  EXPECT_EQ(found.parts, 0U);
  EXPECT_TRUE(std::isnan(found.fits[0].prediction));
  EXPECT_NE(comparison_text(calibrations, results, found).find("predictions: none"), std::string::npos);
}

TEST_F(ModelComparisonTest, FitsThatHaveNothingInCommonAreRefused) {
  const auto refused = [](std::vector<Calibration> calibrations) {
    try {
      check_comparable(calibrations);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused(read({k_alone, std::string(k_alone) + k_offset})), "");
  auto of_other_rows = read({k_alone, k_alone});
  of_other_rows[1].y.values.back() += 1.0;
  EXPECT_NE(refused(of_other_rows).find("c1.toml: its data are not those of"), std::string::npos);
  auto of_other_weights = read({k_alone, k_alone});
  of_other_weights[1].weights.back() *= 2.0;
  EXPECT_NE(refused(of_other_weights).find("its weights, or its noise, are not those of"), std::string::npos);
  auto robust = read({k_alone, k_alone});
  robust[1].loss = {.kind = Loss::huber, .scale = 0.01};
  EXPECT_NE(refused(robust).find("expected loss = \"linear\""), std::string::npos);
  auto namesakes = read({k_alone, k_alone});
  namesakes[1].name = namesakes[0].name;
  EXPECT_NE(refused(namesakes).find("are both called 'c0'"), std::string::npos);
}

TEST_F(ModelComparisonTest, LeavesATableAndAFigure) {
  const auto calibrations = read({k_alone, std::string(k_alone) + k_offset});
  const auto results = fit(calibrations);
  StagedFolder staged(folder() / "out", k_comparison_marker);
  EXPECT_EQ(write_comparison(calibrations, results, compare_models(calibrations, results), staged, true), "");
  const std::string report = read_text(folder() / "out/report.md");
  EXPECT_NE(report.find("the BIC is for 'c0'"), std::string::npos) << report;
  EXPECT_NE(report.find("- [c1](c1/report.md)"), std::string::npos) << report;
  const std::string table = read_text(folder() / "out/comparison.csv");
  EXPECT_EQ(table.substr(0, table.find('\n')),
            "fit,model,parameters,points,rms[N],r_squared,aic,bic,prediction_rms[N]");
  EXPECT_EQ(std::ranges::count(table, '\n'), 3);
  EXPECT_GT(std::filesystem::file_size(folder() / "out/comparison.svg"), 300U);
  const std::string script = read_text(folder() / "out/comparison.gp");
  EXPECT_NE(script.find("pt 6 ps 0.5 lw 1 lc rgb '#303030' title 'data'"), std::string::npos) << script;
}

}  // namespace
}  // namespace monograin::model_comparison_test
