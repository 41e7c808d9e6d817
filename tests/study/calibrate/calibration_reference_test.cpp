// Calibrations of the hardening law against fits computed elsewhere with an analytic Jacobian, and of the other models.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "hardening/law.hpp"
#include "history/run.hpp"
#include "history/table.hpp"
#include "models/accuracy.hpp"
#include "study/calibrate/calibration.hpp"
#include "support/temporary_folder.hpp"

namespace monograin::calibration_reference_test {
namespace {

/// Numbers of a header line such as "weights 1/P_max: kappa = 6.09 MPa, 1/m = 0.66, se = 0.05, 0.008, ...".
struct ExpectedFit {
  double strength, exponent, strength_error, exponent_error, correlation, sum_of_squares;
};

ExpectedFit parse_fit(std::string_view line) {
  const std::string text(line.substr(line.find("kappa")));
  const std::regex number(R"(([-+]?[0-9]+\.[0-9]+([eE][-+]?[0-9]+)?))");
  std::vector<double> found;
  for (std::sregex_iterator it(text.begin(), text.end(), number), end; it != end; ++it) {
    found.push_back(std::stod(it->str()));
  }
  return {found.at(0) * 1e6, found.at(1), found.at(2) * 1e6, found.at(3), found.at(4), found.at(5)};
}

class HardeningCalibration : public ::testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path() / name, std::ios::binary) << text;
    return folder_.path() / name;
  }

  /// Fits strength and exponent to a data file, whose columns are gamma/2R and force.
  [[nodiscard]] CalibrationResult fit(const std::string& data, double radius, const std::string& weights,
                                      const std::string& start = {}) const {
    static_cast<void>(write("s.toml", fmt::format("model = \"hardening\"\n[particle]\nradius = {:.17g}\n[material]\n"
                                                  "strength = \"20 MPa\"\nhardening_exponent = 0.4\n[loading]\n"
                                                  "configuration = \"simple\"\n[[loading.steps]]\n"
                                                  "displacement = \"0.5 R0\"\nduration = \"1 s\"\n",
                                                  radius)));
    const auto file =
        write("c.toml",
              fmt::format("scenario = \"s.toml\"\n[data]\nfile = \"{}\"\n"
                          "x = {{ column = \"gamma_over_2R[-]\", quantity = \"displacement\", unit = \"R0\" }}\n"
                          "y = {{ column = \"P[N]\", quantity = \"force\", unit = \"N\" }}\nweights = \"{}\"\n[free]\n"
                          "\"material.strength\" = {{ from = \"1 MPa\", to = \"100 MPa\" }}\n"
                          "\"material.hardening_exponent\" = {{ from = 0, to = 1{} }}\n",
                          data, weights, start));
    return calibrate(read_calibration(file));
  }

  TemporaryFolder folder_;
};

TEST_F(HardeningCalibration, MeetsFitsComputedElsewhere) {
  for (const std::string name : {"calibration_mcc_synthetic", "calibration_small_strain"}) {
    const std::string file = MONOGRAIN_SOURCE_DIR "/tests/study/calibrate/reference/" + name + ".csv";
    const Table table = read_csv(file);
    const std::string truth(table.header_value("truth"));
    const double radius = 1e-6 * std::stod(truth.substr(truth.find("R = ") + 4));
    for (const std::string weights : {"absolute", "relative"}) {
      const ExpectedFit expected = parse_fit(table.header_value("fit_" + weights));
      const CalibrationResult result = fit(file, radius, weights);
      const auto& values = result.solution.parameters;
      const auto error = [&](std::size_t k) { return result.uncertainty.standard_error(k); };
      // Printed with ten digits. Largest errors found: parameters 4e-9, standard errors 7e-9.
      EXPECT_LE(relative_error(values.at(0), expected.strength), 2e-8) << name << " " << weights;
      EXPECT_LE(relative_error(values.at(1), expected.exponent), 2e-8) << name << " " << weights;
      EXPECT_LE(relative_error(error(0), expected.strength_error), 1e-6) << name << " " << weights;
      EXPECT_LE(relative_error(error(1), expected.exponent_error), 1e-6) << name << " " << weights;
      EXPECT_NEAR(result.uncertainty.correlation(0, 1), expected.correlation, 1e-7) << name << " " << weights;
      EXPECT_LE(relative_error(result.goodness.sum_of_squares, expected.sum_of_squares), 1e-7)
          << name << " " << weights;
    }
  }
}

TEST_F(HardeningCalibration, PassesOverTheSecondMinimumNearNoHardeningFromAnyStart) {
  // The contact radius has a term in mu^0.4616, which makes a second minimum of the cost near mu = 0.
  for (const double exponent : {0.03, 0.05}) {
    const auto law = hardening::make_law(exponent, plastic::Configuration::simple);
    std::mt19937_64 generator(7);
    std::normal_distribution noise(0.0, 0.001);
    std::string data = "gamma_over_2R[-],P[N]\n";
    for (int k = 1; k <= 40; ++k) {
      const double x = 0.0125 * k;
      const double force = state_at(law, x).force * 5e6 * 1e-8 * (1.0 + noise(generator));
      data += fmt::format("{:.17g},{:.17g}\n", x, force);
    }
    const std::string file = write("d.csv", data).string();
    for (const std::string start : {", start = 0.001", ", start = 0.9"}) {
      const CalibrationResult result = fit(file, 1e-4, "relative", start);
      EXPECT_NEAR(result.solution.parameters.at(1), exponent, 0.01) << exponent << start;
      EXPECT_NEAR(result.solution.parameters.at(0), 5e6, 1e5) << exponent << start;
    }
  }
}

TEST(ReadyCalibration, OfTwoParametersTakesAtMostThreeHundredTrialRuns) {
  for (const char* name : {"uniaxial", "cellulose", "cel"}) {
    const CalibrationResult result =
        calibrate(read_calibration(fmt::format("{}/scenarios/calibrate/{}.toml", MONOGRAIN_SOURCE_DIR, name)));
    EXPECT_LE(result.solution.evaluations, 300) << name;
    EXPECT_TRUE(result.solution.has_converged) << name;
  }
}

/// Modulus and yield stress of a noisy compression, with more of the file after them.
CalibrationResult fit_compression(const TemporaryFolder& folder, const std::string& set, const std::string& more) {
  std::ofstream(folder.path() / "c.toml") << fmt::format(
      "scenario = \"{0}/scenarios/uniaxial.toml\"\n[data]\nfile = \"{0}/scenarios/calibrate/uniaxial.csv\"\n"
      "x = \"displacement[mm]\"\ny = \"force[kN]\"\n{1}\n[free]\n"
      "\"material.youngs_modulus\" = {{ from = \"0.1 GPa\", to = \"10 GPa\" }}\n"
      "\"material.yield_stress\" = {{ from = \"1 MPa\", to = \"200 MPa\" }}\n{2}",
      MONOGRAIN_SOURCE_DIR, set, more);
  return calibrate(read_calibration(folder.path() / "c.toml"));
}

TEST(ReadyCalibration, IntervalOfPoissonsRatioEndsWhereFitsWithItHeldAreThatMuchWorse) {
  const TemporaryFolder folder;
  const CalibrationResult result =
      fit_compression(folder, "", "\"material.poisson_ratio\" = { from = 0, to = 0.49 }\n");
  EXPECT_EQ(result.method, IntervalMethod::profile);
  EXPECT_NE(result.method_reason.find("has a kink"), std::string::npos) << result.method_reason;
  const auto n = static_cast<double>(result.uncertainty.degrees_of_freedom);
  const double t = result.uncertainty.t_quantile;
  const Interval& interval = result.intervals.at(2);
  EXPECT_FALSE(interval.is_cut_below || interval.is_cut_above);
  EXPECT_GT(interval.upper - interval.lower, 0.08);
  // A jump of the force at yield, which the fit puts next to a datum, is no derivative.
  EXPECT_NEAR(result.uncertainty.standard_error(2), 0.026, 0.0026);
  EXPECT_NEAR(result.uncertainty.half_width(2), 0.5 * (interval.upper - interval.lower), 1e-12);
  EXPECT_LT(result.uncertainty.correlation(0, 2), -0.95);
  EXPECT_LT(std::ranges::max(result.fit.band), 0.01 * std::ranges::max(result.fit.y));
  EXPECT_LT(std::ranges::max(result.curves.at(0).band), 0.01 * std::ranges::max(result.fit.y));
  for (const double end : {interval.lower, interval.upper}) {
    const CalibrationResult held =
        fit_compression(folder, fmt::format("set = [\"material.poisson_ratio={:.17g}\"]", end), "");
    EXPECT_NEAR((held.goodness.sum_of_squares / result.goodness.sum_of_squares - 1.0) * n, t * t, 0.03 * t * t) << end;
  }
}

/// Recovers a parameter of a model from its own exact data.
void expect_recovery(const TemporaryFolder& folder, const std::string& scenario, const std::string& key, double truth,
                     const std::string& bounds, const Table& history) {
  std::ofstream(folder.path() / "s.toml") << scenario;
  {
    std::ofstream data(folder.path() / "d.csv");
    data << "displacement[m],force[N]\n";
    const auto rows = history.column("row");
    const auto x = history.column("axial.displacement");
    const auto force = history.column("axial.force");
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (rows[k] == 0.0 && x[k] > 0.0) data << fmt::format("{:.17g},{:.17g}\n", x[k], force[k]);
    }
  }
  std::ofstream(folder.path() / "c.toml") << "scenario = \"s.toml\"\n[data]\nfile = \"d.csv\"\nx = "
                                             "\"displacement[m]\"\ny = \"force[N]\"\n[free]\n\""
                                          << key << "\" = " << bounds << "\n";
  const CalibrationResult result = calibrate(read_calibration(folder.path() / "c.toml"));
  EXPECT_LE(relative_error(result.solution.parameters.at(0), truth), 1e-8) << key;
}

std::string plastic_scenario(const std::string& model, const std::string& material, const std::string& more = {}) {
  return "model = \"" + model + "\"\n[particle]\nradius = 0.001\n[material]\n" + material +
         "\n[output]\npoints = 30\n[loading]\nconfiguration = \"die\"\n[[loading.steps]]\ndisplacement = "
         "\"0.4 R0\"\nduration = 1\n" +
         more;
}

TEST(PlasticCalibration, RecoversTheConstantsOfEveryModel) {
  const TemporaryFolder folder;
  const auto recover = [&](const std::string& scenario, const std::string& key, double truth,
                           const std::string& bounds) {
    const monograin::Run run = run_scenario(parse_scenario(scenario, "s.toml"));
    expect_recovery(folder, scenario, key, truth, bounds, run.record.history);
  };
  const std::string steel = "youngs_modulus = 1e11\npoisson_ratio = 0.3\nyield_stress = 2e8";
  // Bounds that reach beyond what the law allows, E/((1-nu^2) Y) above 22.
  recover(plastic_scenario("semimech", steel), "material.yield_stress", 2e8, "{ from = \"20 MPa\", to = \"20 GPa\" }");
  recover(plastic_scenario("semimech", steel), "material.poisson_ratio", 0.3, "{ from = 0.1, to = 0.49 }");
  recover(plastic_scenario("similarity", "strength = 1e7\nhardening_exponent = 0.2"), "material.hardening_exponent",
          0.2, "{ from = 0, to = 1 }");
  // With unloading on the way.
  recover(plastic_scenario("semimech", steel,
                           "[[loading.steps]]\ndisplacement = \"0.398 R0\"\nduration = 1\n"
                           "[[loading.steps]]\ndisplacement = \"0.399 R0\"\nduration = 1\n"
                           "[semimech]\nunloading = \"mdr\"\n"),
          "material.youngs_modulus", 1e11, "{ from = \"20 GPa\", to = \"500 GPa\" }");
}

/// Calibration of scenarios/calibrate/cel.toml, whose data are made with R0 = 10 mm, E = 2 GPa and Y = 20 MPa.
class CelCalibration : public ::testing::Test {
 protected:
  static constexpr double k_radius = 10e-3;
  static constexpr double k_modulus = 2e9;
  static constexpr double k_yield_stress = 20e6;
  Calibration calibration = read_calibration(MONOGRAIN_SOURCE_DIR "/scenarios/calibrate/cel.toml");
};

TEST_F(CelCalibration, HasTheDataOfFiniteElements) {
  const Table elements = read_csv(MONOGRAIN_SOURCE_DIR "/plots/fe/ep_simple_EY100_nu0.30.csv");
  EXPECT_EQ(elements.header_number("E_over_Y[-]"), k_modulus / k_yield_stress);
  const std::vector<double> d = elements.column("delta_o_over_R0");
  const std::vector<double> F = elements.column("F_over_E_R0^2");
  const Table data = read_csv(MONOGRAIN_SOURCE_DIR "/scenarios/calibrate/cel.csv");
  const std::vector<double> displacement = data.column("displacement");
  const std::vector<double> force = data.column("force");
  ASSERT_EQ(data.row_count(), 90U);
  std::size_t next = 0;
  for (std::size_t row = 0; row < data.row_count(); ++row) {
    // Written with seven digits, in mm and N.
    const auto is_row = [&](std::size_t k) {
      return std::abs(displacement[row] * 1e-3 - d[k] * k_radius) <= 1e-6 * k_radius * d[k] &&
             std::abs(force[row] - F[k] * k_modulus * k_radius * k_radius) <= 1e-6 * std::abs(force[row]);
    };
    while (next < d.size() && !is_row(next)) ++next;
    ASSERT_LT(next, d.size()) << "row " << row << " of the data is no row of the finite elements";
    ++next;
  }
}

TEST_F(CelCalibration, BringsBackTheMaterialAsNearAsTheLawIsToFiniteElements) {
  const CalibrationResult result = calibrate(calibration);
  ASSERT_EQ(calibration.free[0].key.path, "material.youngs_modulus");
  EXPECT_NEAR(result.solution.parameters[0], 1.053 * k_modulus, 0.005 * k_modulus);
  EXPECT_NEAR(result.solution.parameters[1], 1.013 * k_yield_stress, 0.005 * k_yield_stress);
  // Residuals are over the largest force.
  EXPECT_LT(std::sqrt(result.goodness.sum_of_squares / static_cast<double>(calibration.y.values.size())), 0.015);
}

/// Numbers after a word of a header line, up to a semicolon.
std::vector<double> numbers_after(const std::string& line, const std::string& word) {
  std::istringstream rest(line.substr(line.find(word) + word.size()));
  std::vector<double> numbers;
  for (std::string item; rest >> item && item != ";";) {
    const std::size_t equals = item.find('=');
    numbers.push_back(std::stod(equals == std::string::npos ? item : item.substr(equals + 1)));
  }
  return numbers;
}

TEST(PackingCalibration, OfFourCurvesTogetherMeetsTheFitComputedElsewhere) {
  const Table table = read_csv(MONOGRAIN_SOURCE_DIR "/tests/models/packing/reference/pack06_fit_data.csv");
  const std::string line(table.header_value("fit_estimate"));
  const std::vector<double> estimates = numbers_after(line, "");  // four and the rms
  const std::vector<double> errors = numbers_after(line, "standard_errors:");
  ASSERT_EQ(estimates.size(), 5U) << line;
  ASSERT_EQ(errors.size(), 4U) << line;
  const Calibration calibration = read_calibration(MONOGRAIN_SOURCE_DIR "/scenarios/calibrate/packing.toml");
  ASSERT_EQ(calibration.curves.size(), 4U);
  EXPECT_EQ(calibration.y.values.size(), table.row_count());
  const CalibrationResult result = calibrate(calibration);
  for (std::size_t k = 0; k < 4; ++k) {
    // Printed with nine digits.
    EXPECT_NEAR(result.solution.parameters[k], estimates[k], 1e-8) << calibration.free[k].key.path;
    EXPECT_NEAR(result.uncertainty.standard_error(k), errors[k], 1e-7) << calibration.free[k].key.path;
  }
  EXPECT_NEAR(result.uncertainty.correlation(0, 2), 0.987, 5e-4);
  // s = sqrt(sum/(n - p)) is what the header calls rms.
  EXPECT_NEAR(std::sqrt(result.goodness.sum_of_squares / 140.0), estimates[4], 1e-10);
  const auto tells = [&result](const std::string& text) {
    return std::ranges::any_of(result.notes,
                               [&](const std::string& note) { return note.find(text) != std::string::npos; });
  };
  EXPECT_TRUE(tells("determine 'packing.c1' poorly"));
  EXPECT_TRUE(tells("outside the model's domain"));  // f_E below f_G was tried
  EXPECT_EQ(result.curves.size(), 4U);
}

}  // namespace
}  // namespace monograin::calibration_reference_test
