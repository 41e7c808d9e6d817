// Errors to expect of a planned experiment: closed forms, the errors of fits to such data, and what is refused.

#include "study/identify/identify.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "elastic/hertz.hpp"
#include "history/run.hpp"
#include "study/calibrate/calibration.hpp"
#include "study/identify/identify_files.hpp"
#include "support/scenario_texts.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"

namespace monograin::identify_test {
namespace {

constexpr double k_modulus = 50e9;

constexpr const char* k_hertz_plan = R"(scenario = "s.toml"
[free]
"material.youngs_modulus" = { from = "10 GPa", to = "300 GPa" }
[[program]]
name = "loading"
planned = true
points = 40
noise = { absolute = "5 N", relative = 0.02 }
)";

constexpr const char* k_mdr = R"(model = "mdr"
[particle]
radius = "10 mm"
[material]
youngs_modulus = "1 GPa"
poisson_ratio = 0.3
yield_stress = "40 MPa"
[loading]
configuration = "simple"
[[loading.steps]]
displacement = "0.2 R0"
duration = "1 s"
[[loading.steps]]
displacement = "0.17 R0"
duration = "1 s"
)";

constexpr const char* k_mdr_free = R"(scenario = "s.toml"
[free]
"material.youngs_modulus" = { from = "0.1 GPa", to = "10 GPa" }
"material.yield_stress" = { from = "1 MPa", to = "900 MPa" }
)";

constexpr const char* k_mdr_program = R"([[program]]
name = "unloading"
planned = true
points = 60
noise = { absolute = "30 N" }
)";

class PlanTest : public ::testing::Test {
 protected:
  [[nodiscard]] ExperimentPlan read(const std::string& scenario, const std::string& plan) const {
    write_text(folder() / "s.toml", scenario);
    write_text(folder() / "p.toml", plan);
    return read_experiment_plan(folder() / "p.toml");
  }

  [[nodiscard]] std::string first_fault(const std::string& scenario, const std::string& plan) const {
    try {
      static_cast<void>(identify(read(scenario, plan)));
    } catch (const ScenarioError& error) {
      const Fault& first = error.faults().front();
      return fmt::format("{}:{}: {}", first.where.line, first.where.column, first.message);
    }
    return {};
  }

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

double standard_error(const IdentifyResult& result, std::size_t k) {
  return result.planned->uncertainty.standard_error(k);
}

TEST_F(PlanTest, OfALawThatIsLinearInItsModulusHasTheErrorInClosedForm) {
  double precision = 0.0;
  for (int k = 0; k < 40; ++k) {
    const double force = hertz_force(k_modulus / (1.0 - 0.22 * 0.22), 0.01, 1e-4 * (k + 0.5) / 40);
    precision += std::pow(force / k_modulus / std::hypot(5.0, 0.02 * force), 2);
  }
  const IdentifyResult result = identify(read(k_hertz_text, k_hertz_plan));
  EXPECT_NEAR(standard_error(result, 0) * std::sqrt(precision), 1.0, 1e-6);
  EXPECT_NEAR(result.planned->relative_variances * precision * k_modulus * k_modulus, 1.0, 1e-6);
}

// F ~ sqrt(R) at displacements in metres.
TEST_F(PlanTest, KnowsTheRadiusByTheRootInTheForce) {
  const std::string plan =
      replaced(k_hertz_plan, "\"material.youngs_modulus\" = { from = \"10 GPa\", to = \"300 GPa\" }",
               "\"particle.radius\" = { from = \"1 mm\", to = \"50 mm\" }");
  double precision = 0.0;
  for (int k = 0; k < 40; ++k) {
    const double force = hertz_force(k_modulus / (1.0 - 0.22 * 0.22), 0.01, 1e-4 * (k + 0.5) / 40);
    precision += std::pow(0.5 * force / 0.01 / std::hypot(5.0, 0.02 * force), 2);
  }
  const IdentifyResult result = identify(read(replaced(k_hertz_text, "0.01 R0", "0.1 mm"), plan));
  EXPECT_NEAR(standard_error(result, 0) * std::sqrt(precision), 1.0, 1e-6);
  EXPECT_EQ(first_fault(k_hertz_text, plan).substr(0, 64),
            "4:1: 'particle.radius' is free, and steps are given in R0; expec");
}

TEST_F(PlanTest, RefusesTheGapOfTheWallThatIsDriven) {
  const std::string walls = replaced(k_hertz_text, "\"simple\"", "\"walls\"") +
                            "[[loading.wall]]\nname = \"top\"\nnormal = [0, 0, 1]\ngap = \"1 um\"\n";
  const std::string plan =
      replaced(k_hertz_plan, "\"material.youngs_modulus\" = { from = \"10 GPa\", to = \"300 GPa\" }",
               "\"loading.wall[0].gap\" = { from = 0, to = \"50 um\" }");
  EXPECT_EQ(first_fault(walls, plan),
            "4:1: 'loading.wall[0].gap' cannot be free: displacements of wall 'top' count from first touch");
}

TEST_F(PlanTest, HasTheErrorsThatAFitToSuchDataReports) {
  const ExperimentPlan plan = read(k_mdr, std::string(k_mdr_free) + k_mdr_program);
  const IdentifyResult result = identify(plan);
  CheckedScenario scenario = plan.scenario;
  scenario.output = {.points = 0, .times = {}};
  for (int k = 0; k < 60; ++k) scenario.output.times.push_back(2.0 * (k + 0.5) / 60);
  const Table history = run_scenario(scenario).record.history;
  std::mt19937 generator(5);
  std::normal_distribution<double> noise(0.0, 30.0);
  std::string data = "displacement[m],force[N]\n";
  for (std::size_t row = 0; row < history.row_count(); ++row) {
    if (history.at(row, *history.find("row")) != 0.0 || history.at(row, 0) == 0.0) continue;
    data += fmt::format("{:.17g},{:.17g}\n", history.at(row, *history.find("axial.displacement")),
                        history.at(row, *history.find("axial.force")) + noise(generator));
  }
  write_text(folder() / "d.csv", data);
  write_text(folder() / "c.toml", std::string(k_mdr_free) + R"([data]
file = "d.csv"
x = "displacement[m]"
y = "force[N]"
noise = { absolute = "30 N" }
)");
  const CalibrationResult fit = calibrate(read_calibration(folder() / "c.toml"));
  ASSERT_EQ(fit.points, 60U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(standard_error(result, k) / fit.uncertainty.standard_error(k), 1.0, 0.03) << k;
  }
  EXPECT_NEAR(result.planned->uncertainty.correlation(0, 1), fit.uncertainty.correlation(0, 1), 0.02);
}

// --- the testing machine

constexpr const char* k_machine_free = R"("data.offset" = { from = "-0.5 mm", to = "0.5 mm" }
"data.compliance" = { from = 0, to = "200 nm/N" }
)";

constexpr const char* k_machine = R"([data]
offset = "30 um"
compliance = "20 nm/N"
)";

class MachinePlanTest : public PlanTest {
 protected:
  /// A fit to rows that the machine of k_machine records in the plan's first program.
  /// @param columns  lines of [data] that name x and y
  [[nodiscard]] CalibrationResult fit_with_noise(const ExperimentPlan& plan, const std::string& columns,
                                                 const std::string& noise, bool is_noise_of_force) const {
    CheckedScenario scenario = plan.programs.front().scenario;
    scenario.sensitivities.clear();
    scenario.output = {.points = 0, .times = {}};
    const int points = plan.programs.front().points;
    for (int k = 0; k < points; ++k) scenario.output.times.push_back(2.0 * (k + 0.5) / points);
    const Table history = run_scenario(scenario).record.history;
    std::mt19937 generator(5);
    std::normal_distribution<double> noise_of_y(0.0, plan.programs.front().absolute_noise);
    std::string data = "displacement[m],force[N]\n";
    for (std::size_t row = 0; row < history.row_count(); ++row) {
      if (history.at(row, *history.find("row")) != 0.0 || history.at(row, 0) == 0.0) continue;
      const double force = history.at(row, *history.find("axial.force"));
      const double displacement = history.at(row, *history.find("axial.displacement")) + 30e-6 + 20e-9 * force;
      const double deviation = noise_of_y(generator);
      data += fmt::format("{:.17g},{:.17g}\n", displacement + (is_noise_of_force ? 0.0 : deviation),
                          force + (is_noise_of_force ? deviation : 0.0));
    }
    write_text(folder() / "d.csv", data);
    write_text(folder() / "c.toml", std::string(k_mdr_free) + k_machine_free + "[data]\nfile = \"d.csv\"\n" + columns +
                                        "noise = { absolute = \"" + noise + "\" }\n");
    return calibrate(read_calibration(folder() / "c.toml"));
  }

  static void expect_same_errors(const IdentifyResult& planned, const CalibrationResult& fit) {
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(standard_error(planned, k) / fit.uncertainty.standard_error(k), 1.0, 0.02) << k;
      for (std::size_t j = 0; j < k; ++j) {
        EXPECT_NEAR(planned.planned->uncertainty.correlation(j, k), fit.uncertainty.correlation(j, k), 0.03);
      }
    }
  }
};

TEST_F(MachinePlanTest, HasTheErrorsThatAFitOfFrameAndFirstTouchReports) {
  const std::string program = replaced(k_mdr_program, "30 N", "3 N");
  const ExperimentPlan plan = read(k_mdr, std::string(k_mdr_free) + k_machine_free + k_machine + program);
  const IdentifyResult result = identify(plan);
  expect_same_errors(result, fit_with_noise(plan, "x = \"displacement[m]\"\ny = \"force[N]\"\n", "3 N", true));
  // An unloading hardly distinguishes a soft particle from a soft frame.
  EXPECT_GT(standard_error(result, 0),
            5.0 * standard_error(identify(read(k_mdr, std::string(k_mdr_free) + program)), 0));
  const std::string text = identify_text(plan, result);
  EXPECT_NE(text.find("data.offset              0.03 mm"), std::string::npos) << text;
  EXPECT_NE(text.find("data.compliance          20 nm/N"), std::string::npos) << text;
}

TEST_F(MachinePlanTest, HasTheErrorsThatAFitWithNoiseOfXReports) {
  const std::string parts = "absolute = \"3 N\", x = \"3 um\"";
  const std::string program = replaced(k_mdr_program, "absolute = \"30 N\"", parts);
  const ExperimentPlan plan = read(k_mdr, std::string(k_mdr_free) + k_machine_free + k_machine + program);
  const IdentifyResult result = identify(plan);
  const std::string columns = "x = \"displacement[m]\"\ny = \"force[N]\"\n";
  expect_same_errors(result, fit_with_noise(plan, columns, "3 N\", x = \"3 um", true));
  const IdentifyResult without = identify(
      read(k_mdr, std::string(k_mdr_free) + k_machine_free + k_machine + replaced(k_mdr_program, "30 N", "3 N")));
  for (std::size_t k = 0; k < 4; ++k) EXPECT_GT(standard_error(result, k), 2.0 * standard_error(without, k)) << k;
}

TEST_F(PlanTest, HasNoiseOfXWithoutAMachine) {
  const auto error_with = [this](const std::string& parts) {
    return standard_error(
        identify(read(k_mdr, std::string(k_mdr_free) + replaced(k_mdr_program, "absolute = \"30 N\"", parts))), 0);
  };
  const double without = error_with("absolute = \"30 N\"");
  EXPECT_NEAR(error_with("absolute = \"30 N\", x = \"1e-6 um\"") / without, 1.0, 1e-3);
  EXPECT_GT(error_with("absolute = \"30 N\", x = \"20 um\""), 2.0 * without);
}

TEST_F(MachinePlanTest, HasTheErrorsOfAFitAlongTheForce) {
  const std::string forces = replaced(replaced(k_mdr, "displacement = \"0.2 R0\"", "force = \"30 kN\""),
                                      "displacement = \"0.17 R0\"", "force = \"5 kN\"");
  const std::string program = replaced(k_mdr_program, "noise = { absolute = \"30 N\" }",
                                       "y = \"axial.displacement\"\nnoise = { absolute = \"2 um\" }");
  const ExperimentPlan plan = read(forces, std::string(k_mdr_free) + k_machine_free + k_machine + program);
  expect_same_errors(identify(plan),
                     fit_with_noise(plan, "x = \"force[N]\"\ny = \"displacement[m]\"\n", "2 um", false));
}

TEST_F(MachinePlanTest, KnowsWhatAPriorSaysOfTheFrame) {
  const std::string text = std::string(k_mdr_free) + k_machine_free + k_machine + k_mdr_program;
  const IdentifyResult open = identify(read(k_mdr, text));
  const IdentifyResult with_prior =
      identify(read(k_mdr, text + "[prior]\n\"data.compliance\" = { normal = [\"20 nm/N\", \"0.1 nm/N\"] }\n"));
  EXPECT_LT(standard_error(with_prior, 3), 0.1001e-9);
  EXPECT_LT(standard_error(with_prior, 0), 0.5 * standard_error(open, 0));
}

TEST_F(MachinePlanTest, TakesTheOffsetForZeroAndLeavesItOutOfTheCriteria) {
  const std::string offset = "\"data.offset\" = { from = \"-0.5 mm\", to = \"0.5 mm\" }\n";
  const ExperimentPlan plan = read(k_mdr, std::string(k_mdr_free) + offset + k_mdr_program);
  const IdentifyResult result = identify(plan);
  const auto relative = [&](std::size_t k) { return std::pow(standard_error(result, k) / plan.values[k], 2); };
  EXPECT_EQ(plan.values[2], 0.0);
  EXPECT_NEAR(result.planned->relative_variances / (relative(0) + relative(1)), 1.0, 1e-9);
  const std::string text = identify_text(plan, result);
  EXPECT_NE(text.find("data.offset                0 mm"), std::string::npos) << text;
}

TEST_F(MachinePlanTest, DoesNotDependOnTheOrderOfTheFreeNumbers) {
  const std::string frame_last = std::string(k_mdr_free) + k_machine_free + k_machine + k_mdr_program;
  const std::string frame_first =
      replaced(std::string(k_mdr_free), "[free]\n", std::string("[free]\n") + k_machine_free) + k_machine +
      k_mdr_program;
  const IdentifyResult last = identify(read(k_mdr, frame_last));
  const IdentifyResult first = identify(read(k_mdr, frame_first));
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(standard_error(first, (k + 2) % 4) / standard_error(last, k), 1.0, 1e-6) << k;
  }
}

TEST_F(MachinePlanTest, RefusesAMachineThatCannotMeasureSo) {
  const auto fault = [&](const std::string& plan) { return first_fault(k_mdr, plan); };
  const std::string plan = std::string(k_mdr_free) + k_machine_free + k_machine + k_mdr_program;
  EXPECT_EQ(fault(replaced(plan, "20 nm/N", "300 nm/N")),
            "6:1: 'data.compliance' is 300 nm/N in [data], which is not between the bounds");
  write_text(folder() / "frame.csv", "force[N],displacement[um]\n0,0\n100,2\n300,5\n");
  EXPECT_EQ(fault(replaced(plan, "\"20 nm/N\"",
                           "{ table = \"frame.csv\", force = \"force[N]\", displacement = \"displacement[um]\" }")),
            "6:1: 'data.compliance' is free, and [data] has a table of deflections; expected one of them");
  EXPECT_EQ(fault(replaced(plan, "offset = \"30 um\"", "file = \"d.csv\"")),
            "8:1: key 'file' belongs to a calibration file; expected offset, force_offset or compliance");
  EXPECT_EQ(
      fault(replaced(plan, "points = 60", "y = \"axial.contact_radius\"")),
      "13:5: compliance and force_offset take force and displacement of the same walls; y is 'axial.contact_radius'");
  EXPECT_EQ(fault(std::string("scenario = \"s.toml\"\n[free]\n") + k_machine_free + k_machine + k_mdr_program),
            "2:1: expected at least one free number of the scenario");
}

// --- what the data cannot tell, and criteria

TEST_F(PlanTest, SaysThatElasticLoadingDoesNotTellTheYieldStress) {
  const std::string scenario = replaced(replaced(k_mdr, "40 MPa", "80 MPa"), "0.2 R0", "0.0001 R0");
  const std::string elastic = replaced(scenario, "0.17 R0", "0.00005 R0");
  const ExperimentPlan plan = read(elastic, std::string(k_mdr_free) + k_mdr_program + R"([[program]]
name = "far"
set = ["loading.steps[0].displacement=0.2 R0", "loading.steps[1].displacement=0.17 R0"]
noise = { absolute = "30 N" }
)");
  const IdentifyResult result = identify(plan);
  EXPECT_TRUE(result.planned->uncertainty.is_determined[0]);
  EXPECT_FALSE(result.planned->uncertainty.is_determined[1]);
  EXPECT_TRUE(std::isinf(result.planned->log_determinant));
  const std::string text = identify_text(plan, result);
  EXPECT_NE(text.find("material.yield_stress    80 MPa"), std::string::npos) << text;
  EXPECT_NE(text.find("not determined\n"), std::string::npos) << text;
  // A program far beyond first yield determines it.
  ASSERT_EQ(result.candidates.size(), 1U);
  EXPECT_TRUE(result.candidates[0].errors.uncertainty.is_determined[1]);
  EXPECT_TRUE(std::isnan(result.candidates[0].volume));
  EXPECT_EQ(result.best_by_volume, 0U);
}

TEST(ReadyPlan, HasNoErrorThatAProgramMoreMakesLarger) {
  const ExperimentPlan plan = read_experiment_plan(MONOGRAIN_SOURCE_DIR "/scenarios/design/uniaxial.toml");
  const IdentifyResult result = identify(plan);
  ASSERT_EQ(result.candidates.size(), 2U);
  for (const CandidateErrors& candidate : result.candidates) {
    for (std::size_t k = 0; k < plan.free.size(); ++k) {
      EXPECT_LT(candidate.errors.uncertainty.standard_error(k), standard_error(result, k));
    }
    EXPECT_LT(candidate.volume, 1.0);
  }
  EXPECT_LT(result.candidates[*result.best_by_volume].volume, 0.5);
}

TEST_F(PlanTest, KnowsNoMoreThanThePriorWhereTheNoiseIsLarge) {
  const std::string loud = replaced(k_mdr_program, "30 N", "1e12 N");
  const ExperimentPlan plan = read(k_mdr, std::string(k_mdr_free) + loud + R"([prior]
"material.youngs_modulus" = { normal = ["1.1 GPa", "0.05 GPa"] }
"material.yield_stress" = { lognormal = ["50 MPa", 0.1] }
)");
  const IdentifyResult result = identify(plan);
  EXPECT_NEAR(standard_error(result, 0) / 0.05e9, 1.0, 1e-9);
  EXPECT_NEAR(standard_error(result, 1) / (0.1 * 40e6), 1.0, 1e-9);
}

TEST_F(PlanTest, AddsWhatThePriorKnowsToWhatTheDataTell) {
  const double alone = standard_error(identify(read(k_hertz_text, k_hertz_plan)), 0);
  const double prior = 0.2e9;
  const double both = standard_error(identify(read(k_hertz_text, std::string(k_hertz_plan) + R"([prior]
"material.youngs_modulus" = { normal = ["60 GPa", "0.2 GPa"] }
)")),
                                     0);
  EXPECT_NEAR(std::pow(both, -2.0) / (std::pow(alone, -2.0) + std::pow(prior, -2.0)), 1.0, 1e-9);
}

TEST_F(PlanTest, HalvesTheVarianceByTheSameProgramOnceMore) {
  const std::string again = replaced(replaced(k_mdr_program, "\"unloading\"", "\"again\""), "true", "false");
  const IdentifyResult result = identify(read(k_mdr, std::string(k_mdr_free) + k_mdr_program + again));
  const CandidateErrors& candidate = result.candidates.front();
  EXPECT_NEAR(candidate.errors.relative_variances / result.planned->relative_variances, 0.5, 1e-9);
  EXPECT_NEAR(candidate.volume, 0.5, 1e-9);  // of two parameters, each by a root of two
}

TEST(ExpectedErrors, AreTheInverseOfTheInformation) {
  std::vector<FreeParameter> free(2);
  for (FreeParameter& parameter : free) parameter.upper = 10.0;
  const std::vector<double> values{2.0, 4.0};
  ProgramInformation information{.jacobian = Eigen::MatrixXd(3, 2), .largest = 5.0, .notes = {}};
  information.jacobian << 1.0, 2.0, 0.0, 1.0, 2.0, 1.0;  // J^T J = [5 4; 4 6], det = 14
  const std::vector<const ProgramInformation*> programs{&information};
  const ExpectedErrors errors = expected_errors(free, values, programs);
  EXPECT_NEAR(errors.uncertainty.standard_error(0), std::sqrt(6.0 / 14.0), 1e-12);
  EXPECT_NEAR(errors.uncertainty.standard_error(1), std::sqrt(5.0 / 14.0), 1e-12);
  EXPECT_NEAR(errors.uncertainty.correlation(0, 1), -4.0 / std::sqrt(30.0), 1e-12);
  EXPECT_NEAR(errors.relative_variances, 6.0 / 14.0 / 4.0 + 5.0 / 14.0 / 16.0, 1e-12);
  EXPECT_NEAR(errors.log_determinant, std::log(1.0 / 14.0 / 64.0), 1e-12);

  information.jacobian << 1.0, 2.0, 0.5, 1.0, 2.0, 4.0;  // only p + 2 q is determined
  const ExpectedErrors none = expected_errors(free, values, programs);
  EXPECT_FALSE(none.uncertainty.is_determined[0]);
  EXPECT_FALSE(none.uncertainty.is_determined[1]);
  EXPECT_TRUE(std::isinf(none.relative_variances));

  information.jacobian = Eigen::MatrixXd(1, 2);
  information.jacobian << 1.0, 2.0;  // one datum
  EXPECT_FALSE(expected_errors(free, values, programs).uncertainty.is_determined[0]);
}

TEST_F(PlanTest, CountsTheRowsThatHaveNoDerivatives) {
  const std::string detach =
      replaced(replaced(k_mdr, "displacement = \"0.17 R0\"\nduration = \"1 s\"", "detach = true\nrate = \"1 mm/s\""),
               "duration = \"1 s\"", "duration = \"1 ms\"");
  const ExperimentPlan plan = read(detach, std::string(k_mdr_free) + replaced(k_mdr_program, "60", "100000"));
  const IdentifyResult result = identify(plan);
  const ProgramInformation& information = result.programs.front();
  // Contact is lost earlier or later with other values, and the last rows come before it or after.
  ASSERT_GT(information.left_out, 0U);
  EXPECT_LT(information.left_out, 100U);
  EXPECT_EQ(static_cast<std::size_t>(information.jacobian.rows()) + information.left_out, 100000U);
  EXPECT_NE(information.notes.front().find("rows left out"), std::string::npos) << information.notes.front();
}

TEST_F(PlanTest, GoesAlongTheDisplacementWhateverTheProgramPrescribes) {
  const auto errors_of = [this](const std::string& scenario) {
    const IdentifyResult result = identify(read(scenario, std::string(k_mdr_free) + k_mdr_program));
    return std::pair(standard_error(result, 0), standard_error(result, 1));
  };
  const auto with_steps = [](const char* loading, const char* unloading) {
    return replaced(replaced(k_mdr, "displacement = \"0.2 R0\"\nduration = \"1 s\"", loading),
                    "displacement = \"0.17 R0\"\nduration = \"1 s\"", unloading);
  };
  const char* force = "force = \"20 kN\"\nduration = \"1 s\"";
  const char* less_force = "force = \"10 kN\"\nduration = \"1 s\"";
  const auto run = run_scenario(parse_scenario(with_steps(force, less_force), "s.toml"));
  const Table& history = run.record.history;
  const auto place_at = [&](double instant) {
    std::size_t row = 0;
    while (history.at(row, 0) < instant) ++row;
    return fmt::format("displacement = {:.17g}\nduration = \"1 s\"",
                       history.at(row, *history.find("axial.displacement")));
  };
  const std::string there = place_at(1.0);
  const std::string back = place_at(2.0);
  const auto [modulus, yield_stress] = errors_of(with_steps(there.c_str(), back.c_str()));
  for (const auto& steps :
       {with_steps(force, less_force), with_steps(there.c_str(), less_force),
        with_steps("displacement = \"1 R0\"\nrate = \"5 mm/s\"\nuntil = { force = \"20 kN\" }", less_force)}) {
    const auto [other_modulus, other_stress] = errors_of(steps);
    EXPECT_NEAR(other_modulus, modulus, 0.02 * modulus) << steps;  // rows are elsewhere if a step takes another time
    EXPECT_NEAR(other_stress, yield_stress, 0.02 * yield_stress) << steps;
  }
}

TEST_F(PlanTest, GoesAlongTheDisplacementOfWallsThatShareStepsOrAClass) {
  const std::string head = std::string(k_mdr).substr(0, std::string(k_mdr).find("[loading]"));
  const std::string steps =
      "steps = [{ force = \"20 kN\", duration = 1 }, { hold = true, duration = 1 }, "
      "{ force = 0, duration = 1 }, { force = \"10 kN\", duration = 1 }]\n";
  const std::string walls = "[loading]\nconfiguration = \"walls\"\n";
  const std::string one = "[[loading.wall]]\nname = \"axial\"\nnormal = [0, 0, 1]\n";
  const std::string other = "[[loading.wall]]\nname = \"b\"\nnormal = [0, 0, -1]\n";
  std::vector<double> errors;
  for (const std::string& loading : {"[loading]\nconfiguration = \"simple\"\n" + steps, walls + steps + one + other,
                                     walls + one + steps + other + steps}) {
    const IdentifyResult result = identify(read(head + loading, std::string(k_mdr_free) + k_mdr_program));
    EXPECT_NE(result.programs.front().notes.front().find("steps 1, 2, 3, 4: replaced by the displacements"),
              std::string::npos)
        << result.programs.front().notes.front();
    EXPECT_EQ(result.programs.front().left_out, 0U) << "the contact is lost as the third step ends";
    errors.push_back(standard_error(result, 0));
  }
  EXPECT_NEAR(errors[1], errors[0], 1e-6 * errors[0]);
  EXPECT_NEAR(errors[2], errors[0], 1e-6 * errors[0]);
}

TEST_F(PlanTest, SaysThatAPrescribedQuantityTellsNothing) {
  const std::string plan = std::string(k_mdr_free) + replaced(k_mdr_program, "noise = { absolute = \"30 N\" }",
                                                              "y = \"displacement\"\nnoise = { absolute = \"1 um\" }");
  const IdentifyResult result = identify(read(k_mdr, plan));
  EXPECT_FALSE(result.planned->uncertainty.is_determined[0]);
  EXPECT_NE(result.programs.front().notes.front().find("tells nothing"), std::string::npos);
}

TEST_F(PlanTest, ShowsNoBestCandidateWhereNoneDeterminesAll) {
  const std::string elastic = replaced(replaced(k_mdr, "0.2 R0", "0.001 R0"), "0.17 R0", "0.0005 R0");
  const std::string plan_text = std::string(k_mdr_free) + replaced(k_mdr_program, "planned = true\n", "");
  const ExperimentPlan plan = read(elastic, plan_text);
  const IdentifyResult result = identify(plan);
  EXPECT_FALSE(result.planned);
  EXPECT_FALSE(result.best_by_volume);
  EXPECT_NE(identify_text(plan, result).find("best: none"), std::string::npos);
  // The displacement under a force that makes it yield tells both.
  const std::string force = replaced(replaced(k_mdr, "displacement = \"0.2 R0\"", "force = \"20 kN\""),
                                     "displacement = \"0.17 R0\"", "force = \"10 kN\"");
  const IdentifyResult travel =
      identify(read(force, replaced(plan_text, "noise = { absolute = \"30 N\" }",
                                    "y = \"displacement\"\nnoise = { absolute = \"1 um\" }")));
  EXPECT_EQ(travel.best_by_volume, 0U);
}

TEST_F(PlanTest, WritesARowForEachSetAndParameter) {
  const ExperimentPlan plan = read_experiment_plan(MONOGRAIN_SOURCE_DIR "/scenarios/design/uniaxial.toml");
  const IdentifyResult result = identify(plan);
  StagedFolder staged(folder() / "out", k_identify_marker);
  EXPECT_EQ(write_identify(plan, result, staged), "");
  const Table table = read_csv(folder() / "out/errors.csv");
  ASSERT_EQ(table.row_count(), 6U);
  EXPECT_EQ(table.word(0, *table.find("with")), "planned");
  EXPECT_EQ(table.word(5, *table.find("with")), "two_unloadings");
  EXPECT_EQ(table.word(5, *table.find("key")), "material.yield_stress");
  EXPECT_EQ(table.word(5, *table.find("SI")), "Pa");
  EXPECT_EQ(table.at(1, *table.find("standard_error")), standard_error(result, 1));
  EXPECT_EQ(table.at(0, *table.find("correlation(material.yield_stress)")),
            result.planned->uncertainty.correlation(0, 1));
  EXPECT_TRUE(std::filesystem::exists(folder() / "out/figure.svg"));
  const auto record = nlohmann::json::parse(read_text(folder() / "out/design.json"));
  EXPECT_EQ(record.at("text"), read_text(MONOGRAIN_SOURCE_DIR "/scenarios/design/uniaxial.toml"));
  EXPECT_EQ(record.at("scenario").at("text"), read_text(MONOGRAIN_SOURCE_DIR "/scenarios/uniaxial.toml"));
  EXPECT_EQ(record.at("scenario").at("values").at("material.yield_stress"), plan.values[1]);
}

TEST_F(PlanTest, RefusesWhatItDoesNotUnderstand) {
  const auto fault = [&](const std::string& what, const std::string& by) {
    return first_fault(k_hertz_text, replaced(k_hertz_plan, what, by));
  };
  EXPECT_EQ(fault("points = 40", "point = 40"), "7:1: unknown key 'point' in [[program]]; did you mean 'points'?");
  EXPECT_EQ(fault("name = \"loading\"\n", "").substr(0, 5), "4:1: ");
  EXPECT_NE(fault("noise = { absolute = \"5 N\", relative = 0.02 }", "").find("'noise'"), std::string::npos);
  EXPECT_EQ(fault("noise = {", "noise = { column = 3,").substr(0, 5), "8:9: ");
  EXPECT_EQ(fault("5 N", "5 mm").substr(0, 6), "8:22: ");
  EXPECT_EQ(fault("relative = 0.02", "x = \"1 N\"").substr(0, 40), "8:33: x = \"1 N\": 'N' is a unit of force;");
  EXPECT_NE(fault("points", "y = \"axial.forse\"\npoints")
                .find("7:5: y = \"axial.forse\" is no quantity of this "
                      "scenario"),
            std::string::npos);
  EXPECT_EQ(fault("points", "set = [\"material.youngs_modulus=60 GPa\"]\npoints"),
            "7:7: 'material.youngs_modulus' is free; expected its one value in the scenario");
  EXPECT_EQ(fault("points", "set = [\"material.yuongs_modulus=60 GPa\"]\npoints").substr(0, 5), "7:7: ");
  EXPECT_EQ(fault("10 GPa", "100 GPa"),
            "3:1: 'material.youngs_modulus' is 50 GPa in the scenario, which is not between the bounds");
  EXPECT_EQ(fault("scenario = \"s.toml\"", "scenario = \"s.toml\"\n[fit]\nloss = \"huber\""),
            "2:2: key 'fit' belongs to a calibration file");
  EXPECT_NE(fault("s.toml", "t.toml").find("1:12: scenario = \"t.toml\": there is no such file"), std::string::npos);
  const std::string twice =
      std::string(k_hertz_plan) + "[[program]]\nname = \"loading\"\nnoise = { absolute = \"5 N\" }\n";
  EXPECT_EQ(first_fault(k_hertz_text, twice), "10:8: two programs are named 'loading'");
}

TEST_F(PlanTest, RefusesRowsWithoutNoise) {
  const std::string apart = std::string(k_hertz_text) +
                            "[[loading.steps]]\ndisplacement = \"0 R0\"\nduration = \"1 s\"\n"
                            "[[loading.steps]]\nhold = true\nduration = \"1 s\"\n";
  const std::string fault = first_fault(apart, replaced(k_hertz_plan, "absolute = \"5 N\", ", ""));
  EXPECT_NE(fault.find("8:9: axial.force = 0 at "), std::string::npos) << fault;
  EXPECT_EQ(first_fault(apart, k_hertz_plan), "");
}

}  // namespace
}  // namespace monograin::identify_test
