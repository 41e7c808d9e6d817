// Priors and known noise: posteriors in closed form, and what is refused.

#include "study/calibrate/prior.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "elastic/hertz.hpp"
#include "study/calibrate/calibration.hpp"
#include "support/scenario_texts.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"

namespace monograin::prior_test {
namespace {

constexpr double k_poisson = 0.22;
constexpr double k_radius = 0.01;
constexpr double k_modulus = 70e9;

/// Force per modulus of a Hertz contact: the fit is linear in Young's modulus, and its posterior is Gaussian.
double force_per_modulus(double displacement) {
  return hertz_force(1.0 / (1.0 - k_poisson * k_poisson), k_radius, displacement);
}

struct Datum {
  double x;
  double y;
  double deviation;
};

/// Mean and standard deviation of a Gaussian.
struct Gaussian {
  double mean;
  double deviation;
};

class LinearCalibration : public ::testing::Test {
 protected:
  void SetUp() override {
    write_text(folder_.path() / "s.toml", k_hertz_text);
    std::mt19937 generator(17);
    std::normal_distribution<double> noise;
    std::string text = "displacement[m],force[N],error[kN]\n";
    for (int i = 1; i <= 30; ++i) {
      const double x = 3e-6 * i;
      const double exact = k_modulus * force_per_modulus(x);
      const double deviation = std::hypot(5.0, 0.02 * exact);
      data.push_back({x, exact + deviation * noise(generator), deviation});
      text += fmt::format("{:.17g},{:.17g},{:.17g}\n", x, data.back().y, deviation / 1e3);
    }
    write_text(folder_.path() / "d.csv", text);
  }

  [[nodiscard]] Calibration read(const std::string& more_of_data, const std::string& rest) const {
    write_text(folder_.path() / "c.toml", fmt::format(R"(scenario = "s.toml"
[data]
file = "d.csv"
x = "displacement[m]"
y = "force[N]"
{}
[free]
"material.youngs_modulus" = {{ from = "10 GPa", to = "300 GPa" }}
{}
)",
                                                      more_of_data, rest));
    return read_calibration(folder_.path() / "c.toml");
  }

  [[nodiscard]] std::string fault(const std::string& more_of_data, const std::string& rest) const {
    try {
      static_cast<void>(read(more_of_data, rest));
    } catch (const ScenarioError& error) {
      const Fault& first = error.faults().front();
      return fmt::format("{}:{}: {}", first.where.line, first.where.column, first.message);
    }
    return {};
  }

  /// The posterior with noise of known size and a Gaussian prior.
  template <class Deviation>
  [[nodiscard]] Gaussian posterior(Deviation deviation_of, Gaussian prior) const {
    double precision = 1.0 / (prior.deviation * prior.deviation);
    double sum = prior.mean * precision;
    for (const Datum& datum : data) {
      const double c = force_per_modulus(datum.x) / deviation_of(datum);
      precision += c * c;
      sum += c * datum.y / deviation_of(datum);
    }
    return {sum / precision, 1.0 / std::sqrt(precision)};
  }

  std::vector<Datum> data;

 private:
  TemporaryFolder folder_;
};

const Gaussian k_prior{71e9, 2e8};
constexpr const char* k_prior_text = R"([prior]
"material.youngs_modulus" = { normal = ["71 GPa", "0.2 GPa"] })";

void expect_posterior(const CalibrationResult& result, const Gaussian& expected) {
  EXPECT_NEAR(result.solution.parameters[0] / expected.mean, 1.0, 1e-8);
  EXPECT_NEAR(result.uncertainty.standard_error(0) / expected.deviation, 1.0, 1e-6);
  EXPECT_NEAR(result.uncertainty.half_width(0) / expected.deviation, 1.959963984540054, 1e-5);  // normal quantile
}

TEST_F(LinearCalibration, HasTheGaussianPosteriorOfKnownNoiseAndANormalPrior) {
  expect_posterior(calibrate(read("noise = { column = \"error[kN]\" }", k_prior_text)),
                   posterior([](const Datum& datum) { return datum.deviation; }, k_prior));
  expect_posterior(calibrate(read("noise = { absolute = \"0.005 kN\" }", k_prior_text)),
                   posterior([](const Datum&) { return 5.0; }, k_prior));
  // Noise in proportion to the force is that of the fitted force.
  Gaussian expected{k_modulus, 0.0};
  for (int round = 0; round < 20; ++round) {
    const double modulus = expected.mean;
    expected = posterior(
        [modulus](const Datum& datum) { return std::hypot(5.0, 0.02 * modulus * force_per_modulus(datum.x)); },
        k_prior);
  }
  expect_posterior(calibrate(read("noise = { absolute = \"5 N\", relative = 0.02 }", k_prior_text)), expected);
}

TEST_F(LinearCalibration, OfUnknownNoiseWeighsAPriorByTheNoiseThatTheResidualsShow) {
  const CalibrationResult result = calibrate(read("", k_prior_text));
  double squares = 0.0;
  for (const Datum& datum : data) {
    squares += std::pow(datum.y - result.solution.parameters[0] * force_per_modulus(datum.x), 2);
  }
  const double noise = std::sqrt(squares / static_cast<double>(data.size() - 1));
  const Gaussian expected = posterior([noise](const Datum&) { return noise; }, k_prior);
  EXPECT_NEAR(result.solution.parameters[0] / expected.mean, 1.0, 1e-8);
  EXPECT_NEAR(result.uncertainty.standard_error(0) / expected.deviation, 1.0, 1e-6);
}

TEST_F(LinearCalibration, IsNotChangedByAWidePriorAndFollowsANarrowOne) {
  const CalibrationResult plain = calibrate(read("", ""));
  for (const char* wide : {R"(normal = ["100 GPa", "1e9 GPa"])", R"(lognormal = ["100 GPa", 1e8])",
                           R"(uniform = ["20 GPa", "250 GPa"])"}) {
    const CalibrationResult result =
        calibrate(read("", fmt::format("[prior]\n\"material.youngs_modulus\" = {{ {} }}", wide)));
    EXPECT_NEAR(result.solution.parameters[0] / plain.solution.parameters[0], 1.0, 1e-9) << wide;
    EXPECT_NEAR(result.uncertainty.half_width(0) / plain.uncertainty.half_width(0), 1.0, 1e-7) << wide;
  }
  const CalibrationResult normal =
      calibrate(read("", "[prior]\n\"material.youngs_modulus\" = { normal = [\"80 GPa\", \"1 kPa\"] }"));
  EXPECT_NEAR(normal.solution.parameters[0], 80e9, 1e3);
  EXPECT_NEAR(normal.uncertainty.standard_error(0), 1e3, 1.0);
  const CalibrationResult lognormal =
      calibrate(read("", "[prior]\n\"material.youngs_modulus\" = { lognormal = [\"80 GPa\", 1e-6] }"));
  EXPECT_NEAR(lognormal.solution.parameters[0] / 80e9, 1.0, 1e-6);
  EXPECT_NEAR(lognormal.uncertainty.standard_error(0) / 80e3, 1.0, 1e-3);
}

TEST_F(LinearCalibration, SaysWhereDataAndPriorContradictEachOther) {
  const Calibration calibration = read("noise = { relative = 0.02 }",
                                       "[prior]\n\"material.youngs_modulus\" = { normal = [\"90 GPa\", \"1 GPa\"] }");
  const CalibrationResult result = calibrate(calibration);
  bool is_said = false;
  for (const std::string& note : result.notes) is_said = is_said || note.find("contradict") != std::string::npos;
  EXPECT_TRUE(is_said);
  const std::string text = calibration_text(calibration, result);
  EXPECT_NE(text.find("normal 90 +- 1 GPa"), std::string::npos) << text;
  const auto json = nlohmann::json::parse(calibration_json(calibration, result));
  EXPECT_EQ(json["parameters"][0]["prior"]["distribution"], "normal");
  EXPECT_EQ(json["parameters"][0]["prior"]["values"][0], 90e9);
  EXPECT_LT(json["parameters"][0]["prior"]["deviation"], -3.0);
  EXPECT_EQ(json["fit"]["noise"], "known");
}

TEST_F(LinearCalibration, SaysThatANarrowPriorContradictsTheData) {
  // The fit lies a tenth of the prior's deviation from its centre, and the data tell 70 GPa to about 0.5 %.
  const auto notes_with = [this](const char* mean) {
    const std::string prior =
        fmt::format("[prior]\n\"material.youngs_modulus\" = {{ normal = [\"{}\", \"1 MPa\"] }}", mean);
    return calibrate(read("noise = { absolute = \"5 N\", relative = 0.02 }", prior)).notes;
  };
  const auto contradicts = [](const std::string& note) { return note.find("contradict") != std::string::npos; };
  EXPECT_TRUE(std::ranges::any_of(notes_with("80 GPa"), contradicts));
  EXPECT_FALSE(std::ranges::any_of(notes_with("70 GPa"), contradicts));
}

TEST_F(LinearCalibration, ComparesResidualsWithTheNoiseGiven) {
  const auto note_with = [this](const char* noise) {
    const CalibrationResult result = calibrate(read(noise, ""));
    return result.notes.empty() ? std::string() : result.notes.front();
  };
  EXPECT_EQ(note_with("noise = { absolute = \"5 N\", relative = 0.02 }"), "");
  EXPECT_NE(note_with("noise = { absolute = \"1 N\", relative = 0.004 }").find("larger than the noise given"),
            std::string::npos);
  EXPECT_NE(note_with("noise = { absolute = \"50 N\", relative = 0.2 }").find("intervals are too wide"),
            std::string::npos);
}

TEST_F(LinearCalibration, RefusesPriorsAndNoiseThatMakeNoSense) {
  const auto prior = [this](const std::string& text) { return fault("", "[prior]\n" + text); };
  const std::string modulus = "\"material.youngs_modulus\" = ";
  EXPECT_EQ(prior("\"material.youngs_modulos\" = { normal = [1, 1] }"),
            "10:1: unknown key 'material.youngs_modulos' in [prior]; did you mean 'material.youngs_modulus'?");
  EXPECT_EQ(prior("\"material.poisson_ratio\" = { normal = [0.3, 0.1] }"),
            "10:1: key 'material.poisson_ratio' is not free; expected it in [free], too");
  EXPECT_EQ(prior(modulus + "{ normal = [\"70 GPa\", \"0 GPa\"] }"),
            "10:51: normal: the standard deviation is 0 GPa; expected one above zero");
  EXPECT_EQ(prior(modulus + "{ normal = [\"70 GPa\", \"1 mm\"] }").substr(0, 40),
            "10:51: normal: 'mm' is a unit of length;");
  EXPECT_EQ(prior(modulus + "{ normal = [\"70 GPa\"] }"), "10:40: normal = 1 value; expected two");
  EXPECT_EQ(prior(modulus + "{ lognormal = [\"70 GPa\", \"1 GPa\"] }").substr(0, 39),
            "10:54: lognormal: '1 GPa' is no number;");
  EXPECT_EQ(prior(modulus + "{ gauss = [1, 1] }").substr(0, 30), "10:31: unknown key 'gauss' in ");
  EXPECT_EQ(prior(modulus + "{ normal = [1e9, 1], uniform = [1e9, 1e10] }").substr(0, 33),
            "10:29: a prior with 2 distributio");
  EXPECT_EQ(prior(modulus + "{ uniform = [\"400 GPa\", \"500 GPa\"] }").substr(0, 38),
            "10:42: uniform: expected an interval t");
  EXPECT_EQ(prior(modulus + "{ normal = [\"9000 GPa\", \"1 GPa\"] }").substr(0, 81),
            "10:41: normal: 9000 GPa is outside of the bounds in [free], by 8.7e+03 standard d");
  EXPECT_EQ(prior(modulus + "{ normal = [\"9000 GPa\", \"5000 GPa\"] }"), "") << "a wide one reaches the bounds";
  EXPECT_EQ(fault("noise = { absolute = \"2 N\" }\nweights = \"relative\"", "").substr(0, 34),
            "7:1: key 'weights' does not go wit");
  EXPECT_EQ(fault("noise = { absolute = \"2 mm\" }", "").substr(0, 47),
            "6:22: absolute = \"2 mm\": 'mm' is a unit of leng");
  EXPECT_EQ(fault("noise = { column = \"errors\" }", "").substr(0, 25), "6:20: column = \"errors\": ");
  EXPECT_EQ(fault("noise = { column = \"error\", relative = 0.01 }", ""),
            "6:20: a column has the whole standard deviation of y; expected neither absolute nor relative");
  EXPECT_EQ(fault("noise = { absolute = \"2 N\", x = \"0.2 N\" }", "").substr(0, 42),
            "6:33: x = \"0.2 N\": 'N' is a unit of force;");
  EXPECT_EQ(fault("noise = { absolute = \"2 N\", x = 0 }", "").substr(0, 12), "6:33: x = 0:");
  EXPECT_EQ(fault("noise = { x = \"0.2 um\" }", ""),
            "6:15: noise of x changes nothing where y is constant; expected noise of y, too: for example absolute");
}

TEST(Prior, SlopeIsTheDerivativeOfTheDeviation) {
  for (const Prior& prior : {Prior{Prior::Kind::normal, 2.0, 0.3}, Prior{Prior::Kind::lognormal, 2.0, 0.3}}) {
    const double h = 1e-6;
    EXPECT_NEAR((prior.deviation(1.7 + h) - prior.deviation(1.7 - h)) / (2.0 * h), prior.slope(1.7), 1e-8);
    EXPECT_EQ(prior.deviation(2.0), 0.0);
  }
}

}  // namespace
}  // namespace monograin::prior_test
