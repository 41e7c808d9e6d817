// Many rows: fewer of them while the fit is sought, all of them in the end.

#include "study/calibrate/thinning.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "elastic/hertz.hpp"
#include "support/scenario_texts.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"

namespace monograin::thinning_test {
namespace {

constexpr double k_radius = 0.01;
constexpr double k_plane_strain = 70e9 / (1.0 - 0.22 * 0.22);

/// A Hertz contact that is loaded to 1e-4 m and half unloaded, in 8001 rows; noise in the forces.
class ThinnedCalibration : public ::testing::Test {
 protected:
  static constexpr std::size_t k_top = 5333;
  static constexpr std::size_t k_rows = 8001;

  void SetUp() override {
    write_text(folder_.path() / "s.toml", k_hertz_text);
    write_text(folder_.path() / "c.toml", R"(scenario = "s.toml"
[data]
file = "d.csv"
x = "displacement[m]"
y = "force[N]"
[free]
"material.youngs_modulus" = { from = "10 GPa", to = "300 GPa" }
)");
    std::mt19937 generator(3);
    std::normal_distribution<double> noise(0.0, 0.02);
    std::string text = "displacement[m],force[N]\n";
    for (std::size_t row = 0; row < k_rows; ++row) {
      const double x =
          1e-4 * (row <= k_top ? static_cast<double>(row) : 2.0 * k_top - static_cast<double>(row)) / k_top;
      const double top = hertz_force(k_plane_strain, k_radius, 1e-4);
      const double force = hertz_force(k_plane_strain, k_radius, x) + top * noise(generator);
      text += fmt::format("{:.17g},{:.17g}\n", x, force);
    }
    write_text(folder_.path() / "d.csv", text);
    calibration = read_calibration(folder_.path() / "c.toml");
  }

  Calibration calibration;

 private:
  TemporaryFolder folder_;
};

TEST_F(ThinnedCalibration, KeepsBothEndsTheTurnAndAboutAsManyRowsAsAsked) {
  const Calibration thin = thinned(calibration, 100);
  EXPECT_GE(thin.lines.size(), 90U);
  EXPECT_LE(thin.lines.size(), 110U);
  EXPECT_EQ(thin.lines.size(), thin.x.values.size());
  EXPECT_EQ(thin.lines.size(), thin.y.values.size());
  EXPECT_EQ(thin.lines.size(), thin.weights.size());
  EXPECT_EQ(thin.curves.front().end, thin.lines.size());
  EXPECT_EQ(thin.x.values.front(), calibration.x.values.front());
  EXPECT_EQ(thin.x.values.back(), calibration.x.values.back());
  EXPECT_EQ(*std::ranges::max_element(thin.x.values), calibration.x.values[k_top]);
}

TEST_F(ThinnedCalibration, LeavesTheNoiseOfTheDisplacementsOutOfThePath) {
  std::mt19937 generator(4);
  std::normal_distribution<double> noise(0.0, 1e-7);  // five times the distance of rows
  for (double& x : calibration.x.values) x += noise(generator);
  const Calibration thin = thinned(calibration, 400);
  const auto turns = [](const std::vector<double>& x) {
    std::size_t count = 0;
    for (std::size_t row = 2; row < x.size(); ++row) {
      if ((x[row] - x[row - 1]) * (x[row - 1] - x[row - 2]) < 0.0) ++count;
    }
    return count;
  };
  EXPECT_GT(turns(calibration.x.values), 1000U);
  EXPECT_EQ(turns(thin.x.values), 1U);
}

TEST_F(ThinnedCalibration, EndsAtTheFitOfAllRows) {
  double cc = 0.0;
  double cy = 0.0;
  for (std::size_t row = 0; row < k_rows; ++row) {
    const double c = hertz_force(1.0 / (1.0 - 0.22 * 0.22), k_radius, calibration.x.values[row]);
    cc += c * c;
    cy += c * calibration.y.values[row];
  }
  const CalibrationResult result = calibrate(calibration);
  EXPECT_EQ(result.points, k_rows);
  EXPECT_NEAR(result.solution.parameters[0] / (cy / cc), 1.0, 1e-9);
}

}  // namespace
}  // namespace monograin::thinning_test
