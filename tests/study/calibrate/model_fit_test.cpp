// Calibrations of the compressible law, which brings the procedure of its source along.

#include "study/calibrate/model_fit.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compressible/law.hpp"
#include "history/table.hpp"
#include "models/accuracy.hpp"
#include "study/calibrate/calibration.hpp"
#include "support/temporary_folder.hpp"

namespace monograin::model_fit_test {
namespace {

namespace fs = std::filesystem;

const std::string k_scenario = R"(model = "compressible"
[particle]
radius = "2 mm"
[material]
stiffness_ratio = 100
shear_ratio = 1.0
nu0 = 0.3
yield_pressure = "30 MPa"
[compressible]
alpha = 1.5
beta = 1.0
[loading]
configuration = "simple"
[[loading.steps]]
displacement = "0.5 R0"
duration = "1 s"
)";

constexpr double k_force_unit = 3.14159265358979323846 * 2e-3 * 2e-3 * 30e6;

class CompressibleCalibration : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path() / name, std::ios::binary) << text;
  }

  /// Fits to displacements over R0 and forces over pi R0^2 sigma_y0.
  [[nodiscard]] Calibration prepared(const std::vector<double>& d, const std::vector<double>& f,
                                     const std::string& more = {}, const std::string& weights = "area") const {
    std::string data = "d[-],F[N]\n";
    for (std::size_t i = 0; i < d.size(); ++i) data += fmt::format("{:.17g},{:.17g}\n", d[i], f[i] * k_force_unit);
    write("d.csv", data);
    write("s.toml", k_scenario);
    write("c.toml", fmt::format("scenario = \"s.toml\"\n[data]\nfile = \"d.csv\"\nweights = \"{}\"\n"
                                "x = {{ column = \"d[-]\", quantity = \"displacement\", unit = \"R0\" }}\n"
                                "y = {{ column = \"F[N]\", quantity = \"force\", unit = \"N\" }}\n[free]\n"
                                "\"compressible.k\" = {{ from = 0.1, to = 20 }}\n"
                                "\"compressible.delta_t\" = {{ from = 0.005, to = 0.495 }}\n"
                                "\"compressible.a\" = {{ from = 0.05, to = 12 }}\n{}",
                                weights, more));
    return read_calibration(folder_.path() / "c.toml");
  }

  TemporaryFolder folder_;
};

double number_in(const std::string& text, const std::string& name) {
  return std::stod(text.substr(text.find(name + "=") + name.size() + 1));
}

TEST_F(CompressibleCalibration, MeetsTheStoredFits) {
  for (const char* file : {"E100_G1_L0.01", "E12_G0.5_L1", "E4.5_G1_L0.01", "E500_G0.25_L1"}) {
    const Table table = read_csv(fmt::format("{}/plots/fe/compressible_{}.csv", MONOGRAIN_SOURCE_DIR, file));
    const Calibration calibration = prepared(table.column("delta_over_R0"), table.column("F_over_pi_R0^2_sigma_y0"));
    const CalibrationResult result = calibrate(calibration);
    ASSERT_EQ(result.procedures.fits.size(), 3u);
    const std::vector<std::string> names{"nested", "joint", "this fit"};
    for (std::size_t k = 0; k < names.size(); ++k) {
      const ProcedureFit& fit = result.procedures.fits[k];
      const std::string stored(table.header_value(k == 0 ? "fit_nested" : "fit_joint_least_squares"));
      EXPECT_EQ(fit.procedure, names[k]);
      EXPECT_LE(fit.area_error, number_in(stored, "area_error") + 1e-6) << file << " " << names[k];
      fmt::print("{} {}: k {:.8f} delta_t {:.6f} a {:.8f} e_a {:.8f} e_p {:.8f} (stored e_a {:.8f})\n", file, names[k],
                 fit.parameters[0], fit.parameters[1], fit.parameters[2], fit.area_error, fit.peak_error,
                 number_in(stored, "area_error"));
    }
    // The weighted sum of squares is that of eq. 7.
    EXPECT_NEAR(result.procedures.fits[2].area_error, result.procedures.fits[1].area_error, 1e-7) << file;
    const std::vector<double> d = table.column("delta_over_R0");
    const std::vector<double> f = table.column("F_over_pi_R0^2_sigma_y0");
    double area = 0.0;
    for (std::size_t i = 1; i < d.size(); ++i) area += 0.5 * (f[i] + f[i - 1]) * (d[i] - d[i - 1]);
    const double integral = result.goodness.sum_of_squares * std::pow(*std::ranges::max_element(f), 2) * d.back() /
                            static_cast<double>(d.size());
    EXPECT_LE(relative_error(std::sqrt(integral) / area, result.procedures.fits[2].area_error), 1e-10) << file;
    for (std::size_t k = 0; k < 3; ++k) EXPECT_TRUE(std::isfinite(result.uncertainty.standard_error(k))) << file;
  }
}

TEST_F(CompressibleCalibration, RecoversAnExactCurve) {
  const Table table = read_csv(MONOGRAIN_SOURCE_DIR "/tests/models/compressible/reference/fit_synthetic_exact.csv");
  for (const char* weights : {"area", "absolute"}) {
    const CalibrationResult result =
        calibrate(prepared(table.column("delta_over_R0"), table.column("F_over_pi_R0^2_sigma_y0"), {}, weights));
    EXPECT_LE(relative_error(result.solution.parameters[0], 3.9), 1e-8) << weights;
    EXPECT_LE(relative_error(result.solution.parameters[1], 0.113), 1e-8) << weights;
    EXPECT_LE(relative_error(result.solution.parameters[2], 3.65), 1e-8) << weights;
    EXPECT_LE(result.procedures.fits[2].area_error, 1e-9) << weights;
  }
}

TEST_F(CompressibleCalibration, FindsUnloadingTooAndBeginsWhereItsOwnFitEnds) {
  using namespace compressible;
  const LoadingLaw law{3.1, 0.12, 2.7};
  const UnloadingCurve curve =
      unloading_from(law, hertz_stiffness(100.0, 0.3), UnloadingRule(UnloadingShape{1.35, 2.2}), 0.35);
  std::vector<double> d, f;
  for (int i = 0; i <= 70; ++i) {
    d.push_back(0.005 * i);
    f.push_back(loading_force(law, d.back()));
  }
  for (int i = 1; i <= 30; ++i) {
    d.push_back(0.35 - curve.length * i / 29.0);
    f.push_back(d.back() > curve.separation() ? unloading_force(curve, d.back()) : 0.0);
  }
  const Calibration calibration = prepared(d, f,
                                           "\"compressible.alpha\" = { from = 1, to = 4 }\n"
                                           "\"compressible.beta\" = { from = 0.2, to = 20 }\n",
                                           "absolute");
  const ModelFits fits = model_fits(calibration);
  EXPECT_NEAR(fits.starts.at("compressible.alpha"), 1.35, 1e-4);
  EXPECT_NEAR(fits.starts.at("compressible.beta"), 2.2, 1e-3);
  const CalibrationResult result = calibrate(calibration);
  const std::vector<double> expected{3.1, 0.12, 2.7, 1.35, 2.2};
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_LE(relative_error(result.solution.parameters[k], expected[k]), 1e-7) << k;
  }
}

TEST_F(CompressibleCalibration, HasNoProcedureForOtherQuestions) {
  const std::vector<double> d{0.0, 0.1, 0.2, 0.3, 0.4};
  const std::vector<double> f{0.0, 0.3, 0.5, 0.7, 1.0};
  EXPECT_TRUE(model_fits(prepared(d, f, "\"material.yield_pressure\" = { from = 1e6, to = 1e9 }\n")).fits.empty());
  Calibration driven_by_force = prepared(d, f);
  driven_by_force.curves.front().control = Step::Kind::force;
  EXPECT_TRUE(model_fits(driven_by_force).fits.empty());
  Calibration two = prepared(d, f);
  two.free.pop_back();
  EXPECT_TRUE(model_fits(two).fits.empty());
  EXPECT_EQ(model_fits(prepared(d, f)).fits.size(), 2u);
}

TEST_F(CompressibleCalibration, IsReportedAndRunsAgain) {
  const Table table = read_csv(MONOGRAIN_SOURCE_DIR "/plots/fe/compressible_E100_G1_L0.01.csv");
  const Calibration calibration = prepared(table.column("delta_over_R0"), table.column("F_over_pi_R0^2_sigma_y0"));
  const CalibrationResult result = calibrate(calibration);
  const std::string text = calibration_text(calibration, result);
  for (const char* word : {"nested", "joint", "this fit", "area error", "peak error", "0.0775"}) {
    EXPECT_NE(text.find(word), std::string::npos) << word << "\n" << text;
  }
  StagedFolder out(folder_.path() / "out", k_calibration_marker);
  static_cast<void>(write_calibration(calibration, result, out));
  std::ifstream file(folder_.path() / "out" / "calibration.json");
  const auto json = nlohmann::json::parse(file);
  EXPECT_EQ(json.at("fit").at("procedures").size(), 3u);
  EXPECT_NEAR(json["fit"]["procedures"][0]["area_error"].get<double>(), 0.07752917, 1e-6);
  const CheckedScenario fitted = read_scenario(folder_.path() / "out" / "fitted.toml");
  EXPECT_EQ(std::get<double>(fitted.options.at("k")), result.solution.parameters[0]);
}

}  // namespace
}  // namespace monograin::model_fit_test
