// Errors in x: slopes, weights, errors that rows share, and how they enter fits and intervals.

#include "study/calibrate/errors_in_x.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "elastic/hertz.hpp"
#include "history/run.hpp"
#include "scenario/scenario.hpp"
#include "study/calibrate/calibration.hpp"
#include "study/calibrate/granule.hpp"
#include "support/refusal.hpp"
#include "support/scenario_texts.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"

namespace monograin::errors_in_x_test {
namespace {

TEST(SharedErrors, GiveTheSumOfSquaresOfTheirCovariance) {
  Eigen::MatrixXd effects(4, 2);
  effects << 0.5, 0.0, 1.0, -2.0, 0.3, 4.0, 0.0, 1.0;
  const Eigen::Vector4d residuals(1.0, -2.0, 0.5, 3.0);
  const Eigen::Matrix4d covariance = Eigen::Matrix4d::Identity() + effects * effects.transpose();
  const double expected = residuals.dot(covariance.llt().solve(residuals));
  Eigen::VectorXd left = residuals;
  const Eigen::VectorXd errors = SharedErrors(effects).take_from(left);
  EXPECT_NEAR(left.squaredNorm() + errors.squaredNorm(), expected, 1e-14 * expected);
  EXPECT_LT((left + effects * errors - residuals).norm(), 1e-14);
  EXPECT_NEAR(SharedErrors(effects).log_determinant(), std::log(covariance.determinant()), 1e-14);
  EXPECT_EQ(SharedErrors().log_determinant(), 0.0);
}

/// Fits the data of a folder, d.csv, with its scenario, s.toml.
/// @param rest  tables [free] and [fit]
CalibrationResult fit_of(const std::filesystem::path& folder, const std::string& noise, const std::string& rest) {
  write_text(folder / "c.toml", fmt::format(R"(scenario = "s.toml"
[data]
file = "d.csv"
x = "displacement[m]"
y = "force[N]"
noise = {}
{})",
                                            noise, rest));
  return calibrate(read_calibration(folder / "c.toml"));
}

constexpr double k_modulus = 70e9;  // of k_hertz_text

double force_at(double displacement) { return hertz_force(k_modulus / (1.0 - 0.22 * 0.22), 0.01, displacement); }

class HertzWithNoise : public ::testing::Test {
 protected:
  [[nodiscard]] CalibrationResult fit(const std::vector<double>& x, const std::string& noise,
                                      const std::string& of_fit = "") const {
    write_text(folder_.path() / "s.toml", k_hertz_text);
    std::string text = "displacement[m],force[N],error[N]\n";
    for (const double at : x) text += fmt::format("{:.17g},{:.17g},3\n", at, measured(at));
    write_text(folder_.path() / "d.csv", text);
    return fit_of(folder_.path(), noise,
                  fmt::format(R"([free]
"material.youngs_modulus" = {{ from = "10 GPa", to = "300 GPa" }}
{}
)",
                              of_fit));
  }

  static std::vector<double> loading() {
    std::vector<double> x;
    for (int k = -10; k <= 200; ++k) x.push_back(5e-7 * k);
    return x;
  }

  /// Mean force over a displacement with as much noise to either side: above the curve, which bends upwards.
  static double mean_force(double x) { return std::midpoint(force_at(x - k_noise), force_at(x + k_noise)); }

  static constexpr double k_noise = 0.9e-6;
  std::function<double(double)> measured = force_at;  ///< force over displacement

 private:
  TemporaryFolder folder_;
};

TEST_F(HertzWithNoise, WeighsARowByTheSlopeAtIt) {
  measured = mean_force;
  const std::vector<double> x = loading();
  const CalibrationResult result = fit(x, R"({ absolute = "4 N", x = "0.9 um" })");
  for (const std::size_t row : {0U, 5U}) EXPECT_EQ(result.weights[row], 0.25) << "nothing touches";
  for (const std::size_t row : {60U, 110U, 200U}) {
    const double slope = 1.5 * force_at(x[row]) / x[row];
    EXPECT_NEAR(result.weights[row] * std::hypot(4.0, 9e-7 * slope), 1.0, 2e-4) << row;
  }
}

TEST_F(HertzWithNoise, AddsNoiseOfXToAnyNoiseOfY) {
  measured = mean_force;
  const std::vector<double> x = loading();
  const CalibrationResult by_column = fit(x, R"({ column = "error[N]", x = "0.9 um" })");
  const CalibrationResult by_parts = fit(x, R"({ absolute = "4 N", relative = 0.1, x = "0.9 um" })");
  const double of_x = 9e-7 * 1.5 * force_at(x[110]) / x[110];
  EXPECT_NEAR(by_column.weights[110] * std::hypot(3.0, of_x), 1.0, 2e-4);
  EXPECT_NEAR(by_parts.weights[110] * std::hypot(4.0, 0.1 * force_at(x[110]), of_x), 1.0, 2e-4);
}

TEST_F(HertzWithNoise, HasTheErrorsOfNoiseOfYWhereThatOfXVanishes) {
  std::vector<double> x = loading();
  for (int k = 1; k <= 150; ++k) x.push_back(1e-4 - 5e-7 * k);
  const CalibrationResult without = fit(x, R"({ absolute = "4 N" })");
  const CalibrationResult with = fit(x, R"({ absolute = "4 N", x = "1e-6 um" })");
  EXPECT_NEAR(with.uncertainty.standard_error(0) / without.uncertainty.standard_error(0), 1.0, 1e-6);
  for (std::size_t row = 0; row < x.size(); ++row) EXPECT_NEAR(with.weights[row], without.weights[row], 1e-8) << row;
}

TEST_F(HertzWithNoise, KnowsTheMeanOfACurvedResponse) {
  measured = mean_force;
  std::vector<double> x;
  for (int k = 10; k <= 200; ++k) x.push_back(5e-7 * k);
  const double without = fit(x, R"({ absolute = "4 N" })").solution.parameters[0];
  const double with = fit(x, R"({ absolute = "4 N", x = "0.9 um" })").solution.parameters[0];
  EXPECT_GT(without / k_modulus - 1.0, 3e-5);
  EXPECT_LT(std::abs(with / k_modulus - 1.0), 0.2 * (without / k_modulus - 1.0));
}

TEST_F(HertzWithNoise, FitsASingleRow) {
  const CalibrationResult result = fit({1e-4}, R"({ absolute = "4 N", x = "0.9 um" })");
  EXPECT_NEAR(result.solution.parameters[0] / k_modulus, 1.0, 1e-9);
}

TEST_F(HertzWithNoise, RefusesALossWhoseErrorsOfTurnsAreNotThoseOfLeastSquares) {
  const std::string loss = "[fit]\nloss = \"huber\"\nloss_scale = 0.01";
  EXPECT_NO_THROW(static_cast<void>(fit(loading(), R"({ absolute = "4 N" })", loss)));
  try {
    static_cast<void>(fit(loading(), R"({ absolute = "4 N", x = "0.9 um" })", loss));
    ADD_FAILURE() << "it was taken";
  } catch (const ScenarioError& error) {
    EXPECT_TRUE(contains(error.what(), "loss = \"huber\" with noise of x")) << error.what();
  }
}

TEST_F(HertzWithNoise, CountsItsOwnCovarianceWhereModelsAreCompared) {
  std::vector<double> x = loading();
  for (int k = 1; k <= 150; ++k) x.push_back(1e-4 - 5e-7 * k);
  EXPECT_EQ(fit(x, R"({ absolute = "4 N" })").goodness.noise_growth, 0.0);
  const CalibrationResult result = fit(x, R"({ absolute = "4 N", x = "0.9 um" })");
  double of_rows = 0.0;
  for (const double weight : result.weights) of_rows -= 2.0 * std::log(4.0 * weight);
  EXPECT_GT(of_rows, 0.0);
  EXPECT_GE(result.goodness.noise_growth, of_rows) << "the turn adds to it";
}

/// A granule that is pressed by a program, with noise of x of 0.2 um and of y of 0.15 N.
class NoisyRecord {
 public:
  /// @param text  of the scenario
  explicit NoisyRecord(const std::string& text) {
    write_text(folder_.path() / "s.toml", text);
    const Table history = run_scenario(parse_scenario(text, "s.toml")).record.history;
    for (std::size_t row = 0; row < history.row_count(); ++row) {
      if (history.column("row")[row] != 0.0) continue;
      force_.push_back(history.column("axial.force")[row]);
      x_.push_back(history.column("axial.displacement")[row]);
    }
  }

  [[nodiscard]] CalibrationResult fit(unsigned seed, const std::string& noise_of_x, const std::string& method) const {
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    std::string text = "displacement[m],force[N]\n";
    for (std::size_t row = 0; row < x_.size(); ++row) {
      text +=
          fmt::format("{:.9f},{:.3f}\n", x_[row] + 2e-7 * normal(generator), force_[row] + 0.15 * normal(generator));
    }
    write_text(folder_.path() / "d.csv", text);
    return fit_of(folder_.path(), fmt::format(R"({{ absolute = "0.15 N"{} }})", noise_of_x),
                  fmt::format(R"([fit]
intervals = "{}"
[free]
"material.youngs_modulus" = {{ from = "0.1 GPa", to = "10 GPa" }}
"material.yield_stress" = {{ from = "1 MPa", to = "200 MPa" }}
)",
                              method));
  }

 private:
  TemporaryFolder folder_;
  std::vector<double> x_, force_;
};

TEST(NoiseOfX, ShiftsNoModulusHoweverManyRowsThereAre) {
  const std::string text = k_granule;
  const std::size_t steps = text.find("steps = [");
  const NoisyRecord record(
      replaced(text.substr(0, steps) +
                   "steps = [{ displacement = \"0.15 R0\", duration = 60 }, { force = \"2 N\", duration = 60 }]\n" +
                   text.substr(text.find("[output]")),
               "points = 60", "points = 1000"));
  constexpr unsigned k_sets = 12;
  double mean = 0.0;  // deviation from the truth over its standard error
  for (unsigned seed = 1; seed <= k_sets; ++seed) {
    const CalibrationResult result = record.fit(seed, ", x = \"0.2 um\"", "covariance");
    mean += (result.solution.parameters[0] - 2e9) / result.uncertainty.standard_error(0) / k_sets;
  }
  // With weights that do not follow the slope of the trial it is -1.3.
  EXPECT_LT(std::abs(mean), 0.7);
}

/// A granule with or without a hold at its first peak.
class GranuleWithNoiseOfX : public NoisyRecord, public ::testing::TestWithParam<bool> {
 protected:
  GranuleWithNoiseOfX()
      : NoisyRecord(GetParam() ? k_granule : replaced(k_granule, "{ hold = true, duration = 60 },", "")) {}
};

INSTANTIATE_TEST_SUITE_P(Hold, GranuleWithNoiseOfX, ::testing::Bool(),
                         [](const auto& held) { return held.param ? "Held" : "NotHeld"; });

TEST_P(GranuleWithNoiseOfX, HasErrorsAsLargeAsTheScatter) {
  constexpr unsigned k_sets = 40;
  constexpr double k_truth[] = {2e9, 60e6};
  double squares[2] = {};        // of the deviations from the truth over their standard errors
  double chi_squared = 0.0;      // over the degrees of freedom
  double squares_without = 0.0;  // where noise of x is not given: of the modulus
  for (unsigned seed = 1; seed <= k_sets; ++seed) {
    const CalibrationResult result = fit(seed, ", x = \"0.2 um\"", "covariance");
    chi_squared += result.goodness.sum_of_squares / static_cast<double>(result.uncertainty.degrees_of_freedom) / k_sets;
    for (std::size_t k = 0; k < 2; ++k) {
      const double deviation = result.solution.parameters[k] - k_truth[k];
      squares[k] += std::pow(deviation / result.uncertainty.standard_error(k), 2) / k_sets;
    }
    const CalibrationResult without = fit(seed, "", "covariance");
    squares_without +=
        std::pow((without.solution.parameters[0] - k_truth[0]) / without.uncertainty.standard_error(0), 2) / k_sets;
  }
  // Mean squares of 40 normal values are below 2 in all but 0.02 % of cases. With slopes alone they are near 4.
  for (const double mean : squares) {
    EXPECT_GT(mean, 0.5);
    EXPECT_LT(mean, 2.0);
  }
  EXPECT_NEAR(chi_squared, 1.0, 0.08);
  EXPECT_GT(squares_without, 4.0);
}

TEST_P(GranuleWithNoiseOfX, DrawsTheErrorsOfTurnsInABootstrap) {
  const CalibrationResult by_covariance = fit(3, ", x = \"0.2 um\"", "covariance");
  const CalibrationResult drawn = fit(3, ", x = \"0.2 um\"", "bootstrap");
  ASSERT_EQ(drawn.method, IntervalMethod::bootstrap);
  for (std::size_t k = 0; k < 2; ++k) {
    const double error = by_covariance.uncertainty.standard_error(k);
    EXPECT_NEAR(drawn.uncertainty.standard_error(k) / error, 1.0, 0.2) << k;
    const double middle = std::midpoint(drawn.intervals[k].lower, drawn.intervals[k].upper);
    EXPECT_NEAR(middle, drawn.solution.parameters[k], 0.3 * error) << k;
  }
}

TEST_P(GranuleWithNoiseOfX, KeepsTheWeightsOfYInAHold) {
  const CalibrationResult result = fit(1, ", x = \"0.2 um\"", "covariance");
  const auto held = std::ranges::count_if(result.weights, [](double weight) { return weight == 1.0 / 0.15; });
  // Before the hold and after it, the slope is above 0.2 N/um.
  if (GetParam()) {
    EXPECT_NEAR(static_cast<double>(held), 61.0, 3.0);
  } else {
    EXPECT_LT(held, 3);
  }
  EXPECT_TRUE(std::ranges::any_of(result.notes, [](const std::string& note) {
    return note.find("Weights and intervals contain the noise given, 2e-07 m") != std::string::npos;
  }));
}

}  // namespace
}  // namespace monograin::errors_in_x_test
