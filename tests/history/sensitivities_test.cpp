#include "history/sensitivities.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "history/run.hpp"
#include "scenario/faults.hpp"
#include "support/text_file.hpp"

namespace monograin::sensitivities_test {
namespace {

constexpr const char* k_hertz = R"toml(model = "hertz"
[particle]
radius = "10 mm"
[material]
youngs_modulus = "1 GPa"
poisson_ratio = 0.3
[loading]
configuration = "simple"
steps = [{ displacement = "0.02 R0", duration = "1 s" }]
[output]
points = 10
[sensitivities]
keys = ["material.youngs_modulus", "material.poisson_ratio", "particle.radius"]
)toml";

constexpr const char* k_die = R"toml(model = "mdr"
[particle]
radius = "10 mm"
[material]
youngs_modulus = "1 GPa"
poisson_ratio = 0.3
yield_stress = "50 MPa"
[loading]
configuration = "die"
steps = [
  { displacement = "0.4 R0", duration = "1 s" },
  { displacement = "0.31 R0", duration = "1 s" },
  { displacement = "0.42 R0", duration = "1 s" },
]
[output]
points = 20
[sensitivities]
keys = ["material.yield_stress"]
)toml";

using HistoryRun = monograin::Run;  // gtest has a Run of its own

HistoryRun run_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return run_scenario(parse_scenario(text, "s.toml", overrides));
}

std::vector<double> column(const HistoryRun& run, const std::string& name) { return run.record.history.column(name); }

double largest(const std::vector<double>& values) {
  double result = 0.0;
  for (const double value : values) result = std::fmax(result, std::abs(value));
  return result;
}

/// The first row of a table of events with that name.
std::size_t event_row(const HistoryRun& run, const std::string& name) {
  const Table& events = run.record.events;
  std::size_t row = 0;
  while (row < events.row_count() && events.word(row, *events.find("event")) != name) ++row;
  return row;
}

double of_event(const HistoryRun& run, std::size_t row, const std::string& name) {
  return run.record.events.at(row, *run.record.events.find(name));
}

// F = 4/3 E/(1 - nu^2) sqrt(R) d^(3/2), and d is a share of R.
TEST(Sensitivities, OfHertzAreThoseOfItsFormula) {
  const HistoryRun run = run_of(k_hertz);
  const std::vector<double> force = column(run, "axial.force");
  const std::array expected{1.0 / 1e9, 2.0 * 0.3 / (1.0 - 0.09), 2.0 / 0.01};
  const std::array keys{"material.youngs_modulus", "material.poisson_ratio", "particle.radius"};
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const std::vector<double> derivative = column(run, "d(axial.force)/d(" + std::string(keys[k]) + ")");
    ASSERT_EQ(derivative.size(), force.size());
    for (std::size_t row = 0; row < force.size(); ++row) {
      EXPECT_NEAR(derivative[row], expected[k] * force[row], 1e-8 * expected[k] * force.back()) << keys[k];
    }
    EXPECT_LT(run.sensitivities[k].error, 1e-7);
  }
  EXPECT_EQ(run.record.history.columns()[*run.record.history.find("d(axial.force)/d(particle.radius)")].unit, "N/m");
  EXPECT_EQ(run.record.history.columns()[*run.record.history.find("d(work)/d(material.poisson_ratio)")].unit, "J");
}

TEST(Sensitivities, HaveTheErrorThatTheySay) {
  const HistoryRun run = run_of(k_hertz);
  const std::vector<double> force = column(run, "axial.force");
  const std::vector<double> derivative = column(run, "d(axial.force)/d(material.poisson_ratio)");
  double error = 0.0;
  for (std::size_t row = 0; row < force.size(); ++row) {
    error = std::max(error, std::abs(derivative[row] - 0.6 / 0.91 * force[row]) / (0.6 / 0.91 * force.back()));
  }
  EXPECT_LT(error, run.sensitivities[1].error);
  EXPECT_GT(error, 1e-4 * run.sensitivities[1].error);
}

/// The die with other steps, and differentiated by another number.
std::string with_steps(const std::string& steps) {
  const std::string text = k_die;
  const std::size_t begin = text.find("steps = [") + 8;
  return text.substr(0, begin) + steps + text.substr(text.find("\n[output]"));
}
std::string with_key(const std::string& text, const std::string& key) {
  return text.substr(0, text.find("keys =")) + "keys = [\"" + key + "\"]\n";
}

std::string scene(const std::string& name) {
  return read_text(std::string(MONOGRAIN_SOURCE_DIR) + "/scenarios/" + name + ".toml");
}
std::string compressible() {
  std::string text = scene("compressible");
  return text.insert(text.find("compressible-unloading.csv"), std::string(MONOGRAIN_SOURCE_DIR) + "/scenarios/");
}
std::string scene_with_key(const std::string& name, const std::string& key) {
  return scene(name) + "\n[sensitivities]\nkeys = [\"" + key + "\"]\n";
}

TEST(Sensitivities, AreSolvedForAlsoIfTheRunIsIntegrated) {
  const std::string text = scene_with_key("nonlocal", "material.poisson_ratio");
  const HistoryRun direct = run_of(text);
  for (const char* integrator : {"odeint-dopri5", "arkode-erk"}) {
    const HistoryRun integrated = run_of(text, {fmt::format("numerics.integrator={}", integrator)});
    for (const char* name : {"lateral-x.force", "work"}) {
      const std::string heading = fmt::format("d({})/d(material.poisson_ratio)", name);
      const std::vector<double> expected = column(direct, heading);
      const std::vector<double> actual = column(integrated, heading);
      for (std::size_t row = 0; row < actual.size(); ++row) {
        EXPECT_NEAR(actual[row], expected[row], 1e-8 * largest(expected)) << integrator << ", " << name;
      }
    }
    EXPECT_LT(integrated.sensitivities[0].error, 2e-7) << integrator;
  }
}

/// Error of a derivative in the last output row before the contact is lost for the fifth time, over the largest
/// derivative of its column. The reference has differences of fourth order, with a step of 5e-6.
double error_before_fifth_loss(const HistoryRun& run, const std::string& key, const std::string& name) {
  const std::string heading = "d(" + name + ")/d(" + key + ")";
  const Table& history = run.record.history;
  std::size_t row = history.row_count() - 1;
  while (history.at(row, 2) != 0.0 || history.at(row, 0) > history.column("time").back() - 1e-4) --row;
  const double value = run.sensitivities[0].value;
  double expected = 0.0;
  const std::array<double, 4> places{-2.0, -1.0, 1.0, 2.0};
  const std::array<double, 4> weights{1.0 / 12.0, -8.0 / 12.0, 8.0 / 12.0, -1.0 / 12.0};
  for (std::size_t k = 0; k < 4; ++k) {
    const HistoryRun other = run_of(scene("cycles"), {fmt::format("{}={:.17g}", key, value * (1.0 + 5e-6 * places[k])),
                                                      fmt::format("output.times=[{:.17g}]", history.at(row, 0))});
    const Table& table = other.record.history;
    std::size_t at = 1;
    while (table.at(at, 2) != 0.0) ++at;
    expected += weights[k] * table.at(at, *table.find(name)) / (5e-6 * value);
  }
  return std::abs(column(run, heading)[row] - expected) / largest(column(run, heading));
}

TEST(Sensitivities, AreAccurateNextToTheSquareRootAtTheLossOfAContact) {
  for (const char* integrator : {"direct", "arkode-erk"}) {
    for (const char* key : {"material.youngs_modulus", "particle.radius"}) {
      const HistoryRun run = run_of(scene_with_key("cycles", key), {fmt::format("numerics.integrator={}", integrator)});
      for (const char* name : {"axial.contact_radius", "axial.pressure", "axial.force"}) {
        const double error = error_before_fifth_loss(run, key, name);
        EXPECT_LT(error, 2e-7) << integrator << ", " << key << ", " << name;
        EXPECT_LT(error, run.sensitivities[0].error) << integrator << ", " << key << ", " << name;
      }
    }
  }
}

/// Largest error of the derivatives of a column in output rows before the axial contact is lost, over the largest one.
/// The reference has differences of fourth order, with a step of 2e-5.
double error_before_loss(const HistoryRun& run, const std::string& text, const std::string& key,
                         const std::string& name) {
  const Table& history = run.record.history;
  const double value = run.sensitivities[0].value;
  const double lost = of_event(run, event_row(run, "contact-lost"), "time");
  std::vector<double> times;
  for (std::size_t row = 1; row < history.row_count() && history.at(row, 0) < (1.0 - 1e-6) * lost; ++row) {
    if (history.at(row, 2) == 0.0) times.push_back(history.at(row, 0));
  }
  const auto values_at = [&](const HistoryRun& of, const std::string& heading) {
    const Table& table = of.record.history;
    std::vector<double> values;
    for (std::size_t row = 1; values.size() < times.size(); ++row) {
      const bool is_at = table.at(row, 2) == 0.0 && std::abs(table.at(row, 0) - times[values.size()]) < 1e-12;
      if (is_at) values.push_back(table.at(row, *table.find(heading)));
    }
    return values;
  };
  const std::string heading = fmt::format("d({})/d({})", name, key);
  std::vector<double> errors = values_at(run, heading);
  const std::array<double, 4> places{-2.0, -1.0, 1.0, 2.0};
  const std::array<double, 4> weights{1.0 / 12.0, -8.0 / 12.0, 8.0 / 12.0, -1.0 / 12.0};
  for (std::size_t k = 0; k < 4; ++k) {
    const HistoryRun other = run_of(text, {fmt::format("{}={:.17g}", key, value * (1.0 + 2e-5 * places[k])),
                                           fmt::format("output.times=[{:.17g}]", fmt::join(times, ", "))});
    const std::vector<double> values = values_at(other, name);
    for (std::size_t i = 0; i < times.size(); ++i) errors[i] -= weights[k] * values[i] / (2e-5 * value);
  }
  return largest(errors) / largest(column(run, heading));
}

// The axial contact opens during the second step.
TEST(Sensitivities, AreAccurateNextToASquareRootWithoutASecondPairOfRuns) {
  const std::string points = "output.points=200";
  for (const char* name : {"uniaxial", "hydrostatic"}) {
    const long alone = run_of(scene(name), {points}).record.statistics.rhs_evaluations;
    for (const char* key : {"material.youngs_modulus", "material.yield_stress"}) {
      const HistoryRun run = run_of(scene_with_key(name, key), {points});
      EXPECT_LT(static_cast<double>(run.record.statistics.rhs_evaluations), 3.05 * static_cast<double>(alone));
      for (const char* column : {"axial.contact_radius", "axial.pressure", "axial.force", "volume"}) {
        const double error = error_before_loss(run, scene(name), key, column);
        EXPECT_LT(error, 1e-8) << name << ", " << key << ", " << column;
        EXPECT_LT(error, run.sensitivities[0].error) << name << ", " << key << ", " << column;
      }
    }
  }
}

// A contact radius is zero where the contact is made, whatever the number, but known only to round-off.
TEST(Sensitivities, AreUndefinedOrZeroWhereAGapClosesInAColumnOfRoundOff) {
  for (const char* integrator : {"direct", "arkode-erk"}) {
    const HistoryRun run = run_of(scene_with_key("late-wall", "material.yield_stress"),
                                  {fmt::format("numerics.integrator={}", integrator)});
    const std::size_t made = [&] {
      std::size_t row = event_row(run, "contact-made");
      while (row < run.record.events.row_count() && of_event(run, row, "time") == 0.0) ++row;
      return row;
    }();
    ASSERT_LT(made, run.record.events.row_count());
    const double at_event = of_event(run, made, "d(right.contact_radius)/d(material.yield_stress)");
    EXPECT_TRUE(std::isnan(at_event) || at_event == 0.0) << integrator << ": " << at_event;
    EXPECT_TRUE(std::isfinite(of_event(run, made, "d(time)/d(material.yield_stress)"))) << integrator;
    const Table& history = run.record.history;
    const std::vector<double> radius = column(run, "d(right.contact_radius)/d(material.yield_stress)");
    for (std::size_t row = 0; row < history.row_count(); ++row) {
      if (history.at(row, 2) != 0.0) continue;
      EXPECT_TRUE(std::isfinite(radius[row])) << integrator << ", row " << row;
    }
  }
}

TEST(Sensitivities, OfALawWithoutDirectFormAreIntegratedByAnotherRun) {
  const std::string text = scene_with_key("cel", "material.yield_stress");
  const HistoryRun run = run_of(text);
  const HistoryRun forward = run_of(text, {"numerics.integrator=cvode-bdf", "numerics.rtol=1e-10"});
  ASSERT_TRUE(forward.sensitivities[0].is_forward) << forward.sensitivities[0].why;
  EXPECT_TRUE(run.sensitivities[0].is_forward) << run.sensitivities[0].why;
  EXPECT_TRUE(run.record.warnings == forward.record.warnings);
  for (const char* name : {"lateral.contact_radius", "lateral.force", "work"}) {
    const std::string heading = fmt::format("d({})/d(material.yield_stress)", name);
    const std::vector<double> expected = column(forward, heading);
    const std::vector<double> actual = column(run, heading);
    ASSERT_EQ(actual.size(), expected.size());
    for (std::size_t row = 0; row < actual.size(); ++row) {
      if (run.record.history.at(row, 2) != 0.0) continue;
      EXPECT_NEAR(actual[row], expected[row], 1e-6 * largest(expected)) << name << ", row " << row;
    }
  }
}

TEST(Sensitivities, OfALawWithoutDirectFormAreDifferencesWithAWarningIfAnotherRunStops) {
  const HistoryRun run =
      run_of(scene_with_key("cel", "material.yield_stress"), {"loading.steps[2].displacement=0.8 R0"});
  ASSERT_NE(run.record.status, RunStatus::complete);
  EXPECT_FALSE(run.sensitivities[0].is_forward);
  EXPECT_TRUE(run.sensitivities[0].why.starts_with("the run is not complete: ")) << run.sensitivities[0].why;
  const std::string expected = "derivatives are differences of more runs: " + run.sensitivities[0].why;
  EXPECT_EQ(std::ranges::count(run.record.warnings, expected), 1);
}

TEST(Sensitivities, OfALawWithoutDirectFormAreIntegratedIfNothingIsWrittenAfterTheStart) {
  const HistoryRun run =
      run_of(scene_with_key("cel", "material.yield_stress"), {"output.points=0", "output.times=[0]"});
  EXPECT_TRUE(run.sensitivities[0].is_forward) << run.sensitivities[0].why;
}

// By the radius, a second pair of runs writes only the rows next to where the axial contact is lost.
TEST(Sensitivities, CountTheEvaluationsOfAllRuns) {
  const auto evaluations = [](const std::string& text) { return run_of(text).record.statistics.rhs_evaluations; };
  const long alone = evaluations(scene("cycles"));
  const long by_ratio = evaluations(scene_with_key("cycles", "material.poisson_ratio"));
  const long by_radius = evaluations(scene_with_key("cycles", "particle.radius"));
  EXPECT_GT(by_ratio, 2 * alone);
  EXPECT_LT(static_cast<double>(by_ratio), 3.05 * static_cast<double>(alone));
  EXPECT_GT(by_radius, by_ratio);
  EXPECT_LT(static_cast<double>(by_radius), 3.5 * static_cast<double>(alone));
}

TEST(Sensitivities, ByDifferencesTakeAtMostThreeMoreRuns) {
  const std::array<std::array<const char*, 3>, 3> cases{{{"cycles", "particle.radius", "output.points=50"},
                                                         {"die", "material.yield_stress", "output.points=20"},
                                                         {"die", "material.youngs_modulus", "output.points=20"}}};
  for (const auto& [name, key, points] : cases) {
    const long alone = run_of(scene(name), {points}).record.statistics.rhs_evaluations;
    const long with = run_of(scene_with_key(name, key), {points}).record.statistics.rhs_evaluations;
    EXPECT_LE(with, 4 * alone) << name << ", " << key;
  }
}

TEST(Sensitivities, CountTheEvaluationsOfAnAttemptThatIsGivenUp) {
  for (const char* integrator : {"cvode-bdf", "ida"}) {
    const std::vector<std::string> stopped{fmt::format("numerics.integrator={}", integrator), "numerics.rtol=1e-8",
                                           "loading.steps[2].displacement=0.9 R0"};
    std::string text = scene_with_key("cel", "material.yield_stress");
    const long alone = run_of(scene("cel"), stopped).record.statistics.rhs_evaluations;
    const HistoryRun run = run_of(text, stopped);
    ASSERT_FALSE(run.sensitivities[0].is_forward);
    EXPECT_GT(run.record.statistics.rhs_evaluations, 6 * alone)
        << integrator << ": differences take five, the attempt two";
  }
}

// The dissipation is a small difference of work and stored energy.
TEST(Sensitivities, IntegratedAreAccurateInTheDissipationAfterFiveCycles) {
  for (const char* key : {"material.youngs_modulus", "material.poisson_ratio"}) {
    const std::string text = scene_with_key("cycles", key);
    const std::string heading = fmt::format("d(dissipation)/d({})", key);
    const std::vector<double> expected = column(run_of(text), heading);
    for (const std::string integrator : {"cvode-bdf", "cvode-adams", "ida"}) {
      const HistoryRun run = run_of(text, {"numerics.integrator=" + integrator});
      ASSERT_TRUE(run.sensitivities[0].is_forward) << run.sensitivities[0].why;
      const double error = std::abs(column(run, heading).back() - expected.back()) / largest(expected);
      EXPECT_LT(error, 1e-7) << integrator << ", " << key;
    }
  }
}

const std::vector<std::string> k_forward{"numerics.integrator=cvode-bdf", "numerics.integrator=cvode-adams",
                                         "numerics.integrator=ida"};

constexpr double k_step = 1e-3 * 50e6;
constexpr std::array<double, 4> k_weights{1.0 / 12.0, -8.0 / 12.0, 8.0 / 12.0, -1.0 / 12.0};

/// Runs of the die with other yield stresses, for differences of fourth order.
std::array<HistoryRun, 4> neighbours() {
  std::array<HistoryRun, 4> runs;
  const std::array<double, 4> places{-2.0, -1.0, 1.0, 2.0};
  for (std::size_t k = 0; k < 4; ++k) {
    runs[k] = run_of(k_die, {"material.yield_stress=" + std::to_string(50e6 + places[k] * k_step)});
  }
  return runs;
}

TEST(Sensitivities, MeetDifferencesOfHigherOrderThroughYieldAndReload) {
  const HistoryRun run = run_of(k_die);
  const std::array<HistoryRun, 4> others = neighbours();
  for (const char* name : {"axial.force", "lateral.force", "apparent_radius", "work", "stored_energy"}) {
    const std::vector<double> derivative = column(run, "d(" + std::string(name) + ")/d(material.yield_stress)");
    const double scale = largest(derivative);
    std::size_t compared = 0;
    const Table& history = run.record.history;
    for (std::size_t row = 0; row < history.row_count(); ++row) {
      if (history.at(row, 2) != 0.0) continue;
      const double time = history.at(row, 0);
      const auto near_event = [&](double at) { return std::abs(at - time) < 0.02; };
      if (std::ranges::any_of(run.record.events.column("time"), near_event)) continue;
      double other = 0.0;
      for (std::size_t k = 0; k < 4; ++k) {
        const Table& table = others[k].record.history;
        std::size_t at = 0;
        while (table.at(at, 2) != 0.0 || std::abs(table.at(at, 0) - time) > 1e-12) ++at;
        other += k_weights[k] * table.at(at, *table.find(name)) / k_step;
      }
      EXPECT_NEAR(derivative[row], other, 1e-8 * scale) << name << " at " << time;
      ++compared;
    }
    EXPECT_GT(compared, 45U);
  }
}

TEST(Sensitivities, AreThoseOfTheIntegratedForms) {
  const HistoryRun direct = run_of(k_die);
  for (const char* integrator : {"cvode-bdf", "cvode-adams", "ida", "odeint-dopri5"}) {
    const HistoryRun integrated = run_of(k_die, {"numerics.integrator=" + std::string(integrator)});
    const bool is_forward = std::string(integrator) != "odeint-dopri5";
    EXPECT_EQ(integrated.sensitivities[0].is_forward, is_forward);
    // Differences have to say how far off the contact radius is in the first row of the reload, which is 2.9e-5.
    EXPECT_LT(integrated.sensitivities[0].error, is_forward ? 2e-6 : 4e-5);
    for (const char* name : {"time", "apparent_radius", "lateral.force", "work"}) {
      const std::string heading = "d(" + std::string(name) + ")/d(material.yield_stress)";
      const std::vector<double> expected = column(direct, heading);
      const std::vector<double> actual = column(integrated, heading);
      ASSERT_EQ(actual.size(), expected.size());
      for (std::size_t row = 0; row < actual.size(); ++row) {
        EXPECT_NEAR(actual[row], expected[row], 1e-6 * largest(expected)) << integrator << ", " << name;
      }
    }
  }
}

/// Expects derivatives to be the differences of direct, over the largest of each column.
void expect_as_direct(const HistoryRun& forward, const HistoryRun& direct, const std::string& key,
                      const std::vector<std::string>& names) {
  ASSERT_TRUE(forward.sensitivities[0].is_forward) << forward.sensitivities[0].why;
  for (const std::string& name : names) {
    const std::string heading = "d(" + name + ")/d(" + key + ")";
    const std::vector<double> expected = column(direct, heading);
    const std::vector<double> actual = column(forward, heading);
    ASSERT_EQ(actual.size(), expected.size());
    ASSERT_GT(largest(expected), 0.0) << name;
    for (std::size_t row = 0; row < actual.size(); ++row) {
      EXPECT_NEAR(actual[row], expected[row], 1e-6 * largest(expected)) << name << ", row " << row;
    }
    const std::vector<double> of_events = direct.record.events.column(heading);
    for (std::size_t row = 0; row < of_events.size(); ++row) {
      EXPECT_NEAR(forward.record.events.column(heading)[row], of_events[row], 1e-6 * largest(of_events)) << name;
    }
  }
}

void expect_forward_as_direct(const std::string& text, const std::string& key, const std::vector<std::string>& names) {
  const HistoryRun direct = run_of(text);
  for (const std::string& integrator : k_forward) {
    SCOPED_TRACE(integrator + ", " + key);
    expect_as_direct(run_of(text, {integrator}), direct, key, names);
  }
}

/// Largest difference of a derivative in output rows of two runs, over the largest derivative.
double difference_in_rows(const HistoryRun& one, const HistoryRun& other, const std::string& heading) {
  const Table& history = one.record.history;
  EXPECT_EQ(history.row_count(), other.record.history.row_count());
  const std::vector<double> expected = column(other, heading);
  const std::vector<double> actual = column(one, heading);
  double difference = 0.0;
  for (std::size_t row = 0; row < std::min(actual.size(), expected.size()); ++row) {
    if (history.at(row, 2) != 0.0) continue;
    EXPECT_TRUE(std::isfinite(actual[row])) << heading << ", row " << row;
    difference = std::fmax(difference, std::abs(actual[row] - expected[row]));
  }
  return difference / largest(expected);
}

/// Expects integrated derivatives in output rows to be the differences of direct.
void expect_rows_as_direct(const std::string& text, const std::string& key, const std::vector<std::string>& names) {
  const HistoryRun direct = run_of(text);
  for (const std::string& integrator : k_forward) {
    const HistoryRun run = run_of(text, {integrator});
    ASSERT_TRUE(run.sensitivities[0].is_forward) << run.sensitivities[0].why;
    for (const std::string& name : names) {
      const std::string heading = fmt::format("d({})/d({})", name, key);
      EXPECT_LT(difference_in_rows(run, direct, heading), 1e-6) << integrator << ", " << heading;
    }
  }
}

// Unloading begins with an event 6e-6 of the step before an output row.
TEST(Sensitivities, IntegratedAreAccurateJustAfterAnEvent) {
  const std::string key = "material.surface_energy";
  expect_rows_as_direct(scene_with_key("adhesion", key), key, {"volume", "dissipation", "axial.pressure"});
}

TEST(Sensitivities, IntegratedAreAccurateJustBeforeTheLossOfAContact) {
  for (const char* key : {"particle.radius", "material.youngs_modulus"}) {
    expect_rows_as_direct(scene_with_key("uniaxial", key), key, {"axial.contact_radius"});
  }
}

// Under force the displacement ends like a square root at pull-off. It keeps its value, and the error of its
// derivative, after the event.
TEST(Sensitivities, IntegratedAreUndefinedInTheDisplacementAtPullOffUnderForceUnlessAccurate) {
  for (const char* key : {"material.youngs_modulus", "material.poisson_ratio"}) {
    const std::string text = scene_with_key("snap-off", key);
    const HistoryRun direct = run_of(text);
    const std::size_t row = event_row(direct, "pull-off");
    for (const std::string& integrator : k_forward) {
      const HistoryRun run = run_of(text, {integrator});
      ASSERT_TRUE(run.sensitivities[0].is_forward) << run.sensitivities[0].why;
      for (const char* name : {"time", "axial.displacement", "axial.overlap", "work"}) {
        const std::string heading = fmt::format("d({})/d({})", name, key);
        const double actual = of_event(run, row, heading);
        const bool may_be_undefined = std::string(name).starts_with("axial");
        if (may_be_undefined && std::isnan(actual)) continue;
        const std::vector<double> of_column = column(direct, heading);
        EXPECT_NEAR(actual, of_event(direct, row, heading), 1e-6 * largest(of_column)) << integrator << ", " << heading;
      }
    }
  }
}

TEST(Sensitivities, OfEventsAreThoseOfAFullHistoryIfNothingIsWrittenAfterTheStart) {
  for (const char* integrator : {"direct", "cvode-bdf", "ida"}) {
    const std::vector<std::string> with{fmt::format("numerics.integrator={}", integrator)};
    const HistoryRun full = run_of(k_die, with);
    const HistoryRun bare = run_of(k_die, {with[0], "output.points=0", "output.times=[0]"});
    for (const char* name : {"time", "axial.force", "work", "lateral.force"}) {
      const std::string heading = fmt::format("d({})/d(material.yield_stress)", name);
      const std::vector<double> expected = full.record.events.column(heading);
      const std::vector<double> actual = bare.record.events.column(heading);
      ASSERT_EQ(actual.size(), expected.size());
      for (std::size_t row = 0; row < actual.size(); ++row) {
        EXPECT_NEAR(actual[row], expected[row], 1e-6 * largest(expected)) << integrator << ", " << name << ", " << row;
      }
    }
  }
}

TEST(Sensitivities, IntegratedAreThoseOfDirectUnderForceAndConditions) {
  const std::string text = with_steps(R"([
  { force = "2 kN", duration = "1 s", until = { force = "1 kN" } },
  { displacement = "0 mm", duration = "1 s" },
  { displacement = "0.3 R0", rate = "4 mm/s" },
  { rate = "2 mm/s", detach = true },
])");
  for (const char* key : {"material.yield_stress", "material.poisson_ratio"}) {
    expect_forward_as_direct(with_key(text, key), key,
                             {"time", "axial.force", "apparent_radius", "work", "dissipation"});
  }
}

TEST(Sensitivities, IntegratedFollowAProgramThatTheNumberChanges) {
  const std::string text = with_steps(R"([
  { displacement = "0.2 R0", rate = "2 mm/s" },
  { displacement = "0.1 R0", rate = "1 mm/s" },
])");
  for (const char* key : {"loading.steps[0].rate", "loading.steps[0].displacement", "particle.radius"}) {
    expect_forward_as_direct(with_key(text, key), key, {"time", "axial.force", "work"});
  }
}

/// A scenario of semimech with one step, differentiated by one key.
/// @param target  of the step
std::string semimech(const std::string& target, const std::string& youngs_modulus, const std::string& yield_stress,
                     const std::string& key) {
  std::string text = with_key(with_steps("[{ " + target + ", duration = \"1 s\" }]"), key);
  text.replace(text.find("mdr"), 3, "semimech");
  text.replace(text.find("1 GPa"), 5, youngs_modulus);
  text.replace(text.find("50 MPa"), 6, yield_stress);
  return text;
}

TEST(Sensitivities, IntegratedAreThoseOfDirectWhereTheyGrowFasterThanTheStates) {
  const std::string text = semimech("displacement = \"0.489 R0\"", "100 GPa", "100 MPa", "material.poisson_ratio");
  expect_forward_as_direct(text, "material.poisson_ratio", {"axial.force", "work"});
}

// At the greatest pressure the second derivative of the force is infinite. The walls' displacement under force then has
// a rate whose derivative grows without bound towards this event.
TEST(Sensitivities, IntegratedAreThoseOfDirectWhereTheForceBendsWithoutBound) {
  std::string text = semimech("force = \"20 kN\"", "1 GPa", "30 MPa", "material.youngs_modulus");
  for (const char* configuration : {"simple", "die"}) {
    SCOPED_TRACE(configuration);
    text.replace(text.find("configuration"), text.find("steps") - text.find("configuration"),
                 fmt::format("configuration = \"{}\"\n", configuration));
    expect_forward_as_direct(text, "material.youngs_modulus", {"axial.displacement", "axial.contact_radius", "work"});
  }
}

TEST(Sensitivities, IntegratedAreUndefinedWhereRoundingOfAnInstantShows) {
  std::string text = with_steps(R"([
  { displacement = "0.2 R0", duration = "1 s" },
  { displacement = "0.1 R0", duration = "1 s" },
  { displacement = "0.25 R0", duration = "1 s" },
])");
  text.replace(text.find("mdr"), 3, "cel");
  for (const std::string& integrator : k_forward) {
    const HistoryRun run = run_of(text, {integrator});
    ASSERT_TRUE(run.sensitivities[0].is_forward) << integrator << ": " << run.sensitivities[0].why;
    const std::size_t made = event_row(run, "contact-made");
    ASSERT_LT(made, run.record.events.row_count());
    EXPECT_TRUE(std::isnan(of_event(run, made, "d(axial.contact_radius)/d(material.yield_stress)"))) << integrator;
    EXPECT_NEAR(of_event(run, made, "d(time)/d(material.yield_stress)"), -7.0076634e-9, 1e-6 * 7e-9) << integrator;
    for (std::size_t row = 0; row < run.record.history.row_count(); ++row) {
      if (run.record.history.at(row, 2) != 0.0) continue;
      EXPECT_TRUE(std::isfinite(column(run, "d(axial.contact_radius)/d(material.yield_stress)")[row])) << row;
    }
  }
}

TEST(Sensitivities, IntegratedTakeNoMoreThanTwoMoreRuns) {
  const std::string with = k_die;
  const std::string without = with.substr(0, with.find("[sensitivities]"));
  for (const char* name : {"cvode-bdf", "ida"}) {
    const std::string integrator = "numerics.integrator=" + std::string(name);
    const HistoryRun forward = run_of(with, {integrator});
    const HistoryRun alone = run_of(without, {integrator});
    ASSERT_TRUE(forward.sensitivities[0].is_forward) << integrator << ": " << forward.sensitivities[0].why;
    EXPECT_LT(forward.record.statistics.rhs_evaluations, 3 * alone.record.statistics.rhs_evaluations) << integrator;
  }
}

TEST(Sensitivities, IntegratedHaveTheErrorThatTheySay) {
  for (const std::string& integrator : k_forward) {
    const HistoryRun run = run_of(k_hertz, {integrator});
    const std::vector<double> work = column(run, "work");
    const std::vector<double> derivative = column(run, "d(work)/d(material.poisson_ratio)");
    const double exact = 0.6 / 0.91;
    double error = 0.0;
    for (std::size_t row = 0; row < work.size(); ++row) {
      error = std::max(error, std::abs(derivative[row] / (exact * work.back()) - work[row] / work.back()));
    }
    ASSERT_TRUE(run.sensitivities[1].is_forward) << integrator;
    EXPECT_LT(error, run.sensitivities[1].error) << integrator;
    EXPECT_GT(error, 3e-3 * run.scenario.numerics.rtol) << integrator;
  }
}

TEST(Sensitivities, IntegratedPassPullOffUnderEitherControl) {
  const std::string displaced = R"([
  { displacement = "0.2 R0", duration = "1 s" },
  { displacement = "0.15 R0", duration = "1 s", until = { event = "pull-off" } },
])";
  const std::string forced = R"([
  { force = "20 mN", duration = "1 s" },
  { force = "-10 mN", duration = "1 s", until = { event = "pull-off" } },
])";
  for (const std::string& steps : {displaced, forced}) {
    std::string text = with_steps(steps);
    const auto put = [&text](const char* old, const char* now) { text.replace(text.find(old), std::strlen(old), now); };
    put("10 mm", "10 um");
    put("1 GPa", "5 GPa");
    put("\"50 MPa\"", "\"100 MPa\"\nsurface_energy = \"0.5 J/m^2\"");
    put("die", "simple");
    for (const char* key : {"material.yield_stress", "material.surface_energy"}) {
      const HistoryRun run = run_of(with_key(text, key));
      ASSERT_LT(event_row(run, "pull-off"), run.record.events.row_count()) << steps;
      expect_forward_as_direct(with_key(text, key), key, {"time", "axial.displacement", "work"});
    }
  }
}

TEST(Sensitivities, AreDifferencesWithAWarningWhereTheyCannotBeIntegrated) {
  for (const std::string& integrator : k_forward) {
    const HistoryRun at_range = run_of(k_hertz, {integrator, "material.poisson_ratio=0.5"});
    EXPECT_FALSE(at_range.sensitivities[0].is_forward);
    ASSERT_EQ(at_range.record.warnings.size(), 2U) << integrator;
    EXPECT_TRUE(std::ranges::any_of(at_range.record.warnings, [](const std::string& warning) {
      return warning.find("derivatives are differences") != std::string::npos;
    }));
  }
}

TEST(Sensitivities, FollowEvents) {
  const HistoryRun run = run_of(k_die);
  const std::array<HistoryRun, 4> others = neighbours();
  for (const char* event : {"yield", "contact-lost", "dent-touched", "reload"}) {
    const std::size_t row = event_row(run, event);
    ASSERT_LT(row, run.record.events.row_count()) << event;
    for (const char* name : {"time", "axial.displacement", "work", "lateral.force"}) {
      double expected = 0.0;
      for (std::size_t k = 0; k < 4; ++k) {
        expected += k_weights[k] * of_event(others[k], event_row(others[k], event), name) / k_step;
      }
      const double scale = std::abs(of_event(run, row, name)) / 50e6;
      EXPECT_NEAR(of_event(run, row, "d(" + std::string(name) + ")/d(material.yield_stress)"), expected, 2e-8 * scale)
          << name << " at " << event;
    }
  }
  const std::size_t yield = event_row(run, "yield");
  const double time = of_event(run, yield, "time");
  const std::vector<double> times = column(run, "d(time)/d(material.yield_stress)");
  const Table& history = run.record.history;
  for (std::size_t row = 0; row < history.row_count(); ++row) {
    const bool is_at_yield = history.at(row, 0) == time;
    if (is_at_yield) {
      EXPECT_EQ(times[row], of_event(run, yield, "d(time)/d(material.yield_stress)"));
    } else if (history.at(row, 2) == 0.0) {
      EXPECT_NEAR(times[row], 0.0, 1e-13 / 50e6) << "output rows stay where they are";
    }
  }
}

// Everything scales with the radius. At the end of the first step the run itself has rows for the end and for the
// reversal, the runs beside it have rows for both together.
TEST(Sensitivities, CompareInstantsAtWhichEventsMeetInAnyNumberOfRows) {
  const std::string text = R"toml(model = "semimech"
particle.radius = "10 mm"
material = { youngs_modulus = "10 GPa", poisson_ratio = 0.3, yield_stress = "50 MPa" }
semimech.unloading = "mdr"
[loading]
configuration = "die"
steps = [
  { displacement = "0.1 R0", duration = "1 s" },
  { displacement = "0.09 R0", duration = "1 s" },
  { displacement = "0.11 R0", duration = "1 s" },
]
[output]
points = 10
[sensitivities]
keys = ["particle.radius"]
)toml";
  for (const char* integrator : {"direct", "cvode-bdf", "odeint-dopri5"}) {
    const HistoryRun run = run_of(text, {fmt::format("numerics.integrator={}", integrator)});
    const std::vector<double> force = column(run, "axial.force");
    const std::vector<double> by_radius = column(run, "d(axial.force)/d(particle.radius)");
    const double largest = *std::ranges::max_element(force);
    EXPECT_GE(std::ranges::count(column(run, "time"), 1.0), 4) << "the end of the step and the reversal have own rows";
    for (std::size_t row = 0; row < force.size(); ++row) {
      EXPECT_NEAR(by_radius[row] * 0.01 / largest, 2.0 * force[row] / largest, 1e-6) << integrator << ", row " << row;
    }
    EXPECT_LT(run.sensitivities.front().error, 1e-6) << integrator;
  }
}

TEST(Sensitivities, EndWhereTheEventsAreOthers) {
  // The yield stress at which the contact just does not yield lies within the step.
  std::string text = k_die;
  text.replace(text.find("{ displacement = \"0.31"), text.size(),
               "]\n[output]\npoints = 5\n[sensitivities]\nkeys = [\"material.yield_stress\"]\n");
  const HistoryRun yields = run_of(text);
  const double depth = of_event(yields, event_row(yields, "yield"), "axial.displacement");
  char to_there[64];
  std::snprintf(to_there, sizeof to_there, "loading.steps[0].displacement=%.17g", depth * (1.0 + 1e-7));
  for (const char* integrator : {"direct", "cvode-bdf", "ida"}) {
    const HistoryRun run = run_of(text, {to_there, "numerics.integrator=" + std::string(integrator)});
    const std::vector<double> derivative = column(run, "d(axial.force)/d(material.yield_stress)");
    EXPECT_FALSE(run.sensitivities[0].is_forward);
    EXPECT_TRUE(std::isfinite(derivative.front()));
    EXPECT_TRUE(std::isnan(derivative.back()));
  }
}

/// Output rows of a run: instant -> (number of rows at corners before, row).
std::map<double, std::pair<std::size_t, std::size_t>> output_rows(const HistoryRun& run) {
  std::map<double, std::pair<std::size_t, std::size_t>> rows;
  std::size_t corners = 0;
  for (std::size_t row = 0; row < run.record.history.row_count(); ++row) {
    if (run.record.history.at(row, 2) != 0.0) {
      ++corners;
    } else {
      rows[run.record.history.at(row, 0)] = {corners, row};
    }
  }
  return rows;
}

/// Derivatives of a column in the output rows of a run, by differences of fourth order; NaN where an event has passed
/// the row.
/// @param others  runs with the key's value and two steps less, one less, one more and two more
std::vector<double> reference(const HistoryRun& run, const std::array<HistoryRun, 4>& others, std::size_t column,
                              double step) {
  std::vector<double> derivatives(run.record.history.row_count(), std::nan(""));
  std::array<std::map<double, std::pair<std::size_t, std::size_t>>, 4> rows;
  for (std::size_t k = 0; k < 4; ++k) rows[k] = output_rows(others[k]);
  for (const auto& [time, place] : output_rows(run)) {
    double derivative = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto found = rows[k].find(time);
      const bool is_in_segment = found != rows[k].end() && found->second.first == place.first;
      derivative += is_in_segment ? k_weights[k] * others[k].record.history.at(found->second.second, column) / step
                                  : std::nan("");
    }
    derivatives[place.second] = derivative;
  }
  return derivatives;
}

/// Expects that derivatives in output rows are as accurate as the run says, in all columns that depend on the key.
/// @param steps  two steps of reference differences, over the value: they count as far as they agree
/// @param integrator  of the run, not of those for the reference
/// @param words  only columns with one of these in their names; empty: all
void expect_stated_error(const std::string& text, const std::string& key, const std::vector<std::string>& overrides,
                         const std::array<double, 2>& steps, const std::string& integrator = "auto",
                         const std::vector<std::string>& words = {}) {
  std::vector<std::string> of_run = overrides;
  of_run.push_back("numerics.integrator=" + integrator);
  const HistoryRun run = run_of(text + "\n[sensitivities]\nkeys = [\"" + key + "\"]\n", of_run);
  EXPECT_EQ(run.sensitivities[0].is_forward, integrator != "auto");
  const double value = run.sensitivities[0].value;
  std::array<std::array<HistoryRun, 4>, 2> others;
  for (std::size_t s = 0; s < 2; ++s) {
    for (std::size_t k = 0; k < 4; ++k) {
      const std::array<double, 4> places{-2.0, -1.0, 1.0, 2.0};
      std::vector<std::string> with = overrides;
      with.push_back(fmt::format("{}={:.17g}", key, value * (1.0 + steps[s] * places[k])));
      others[s][k] = run_of(text, with);
    }
  }
  const Table& history = run.record.history;
  std::size_t compared = 0;
  for (std::size_t c = 3; c < history.columns().size(); ++c) {
    const auto derivative = history.find(fmt::format("d({})/d({})", history.columns()[c].name, key));
    const auto has = [&](const std::string& word) { return contains(history.columns()[c].name, word); };
    if (!derivative || (!words.empty() && std::ranges::none_of(words, has))) continue;
    const std::vector<double> actual = column(run, history.columns()[*derivative].name);
    const double round_off = 1e-14 * largest(column(run, history.columns()[c].name)) / (steps[1] * value);
    if (largest(actual) < 10.0 * round_off) continue;
    const std::vector<double> first = reference(run, others[0], c, steps[0] * value);
    const std::vector<double> second = reference(run, others[1], c, steps[1] * value);
    for (std::size_t row = 0; row < actual.size(); ++row) {
      const double uncertainty = std::abs(first[row] - second[row]) + round_off;
      if (std::isnan(actual[row]) || std::isnan(uncertainty)) continue;
      ++compared;
      EXPECT_LE(std::abs(actual[row] - second[row]), run.sensitivities[0].error * largest(actual) + 3.0 * uncertainty)
          << key << " = " << value << ", " << history.columns()[c].name << " at " << history.at(row, 0);
    }
  }
  EXPECT_GT(compared, 80U);
}

/// An override that writes rows at instants next to the events of a run, too.
std::string rows_next_to_events(const HistoryRun& run, const std::vector<double>& shares) {
  const double end = column(run, "time").back();
  std::vector<double> times;
  for (int k = 1; k < 20; ++k) times.push_back(end * k / 20.0);
  for (const double event : run.record.events.column("time")) {
    for (const double share : shares) times.push_back(event + share * end);
  }
  std::erase_if(times, [&](double time) { return time <= 0.0 || time >= end; });
  std::ranges::sort(times);
  times.erase(std::ranges::unique(times).begin(), times.end());
  return fmt::format("output.times=[{:.17g}]", fmt::join(times, ", "));
}

// Rows whose derivatives are a few per cent of the largest one count as well.
TEST(Sensitivities, HaveTheErrorThatTheySayNextToEveryEvent) {
  const std::array<std::pair<const char*, const char*>, 4> cases{{{"compressible", "particle.radius"},
                                                                  {"hydrostatic", "material.poisson_ratio"},
                                                                  {"uniaxial", "material.yield_stress"},
                                                                  {"uniaxial", "material.youngs_modulus"}}};
  for (const auto& [name, key] : cases) {
    const std::string text = std::string(name) == "compressible" ? compressible() : scene(name);
    const std::string rows = rows_next_to_events(run_of(text), {-1e-3, -1e-4, -1e-5, -1e-6, 1e-3, 1e-4, 1e-5, 1e-6});
    expect_stated_error(text, key, {rows}, {3e-6, 8e-7});
  }
}

// The contact radius ends like a square root where a contact is lost. Where its difference quotient shows no derivative
// any more, there is none.
TEST(Sensitivities, IntegratedHaveTheErrorThatTheySayBeforeEveryEvent) {
  for (const char* key : {"loading.steps[0].displacement", "material.yield_stress"}) {
    for (const char* name : {"uniaxial", "die"}) {
      const std::string text = scene(name);
      const std::string rows = rows_next_to_events(run_of(text), {-1e-2, -1e-3, -1e-4, -1e-5});
      for (const std::string integrator : {"cvode-bdf", "ida"}) {
        SCOPED_TRACE(name + (", " + integrator));
        expect_stated_error(text, key, {rows}, {3e-6, 8e-7}, integrator, {"contact_radius", "pressure", "force"});
      }
    }
  }
}

// The kink at 100 lies within the step of the differences, 5.4e-4.
TEST(Sensitivities, HaveTheErrorThatTheySayNextToAKink) {
  const std::string key = "material.stiffness_ratio";
  std::vector<double> times;
  for (int k = 1; k <= 61; ++k) times.push_back(0.05 * k);
  for (const double distance : {-0.6, -0.2, 0.2, 0.6}) {
    const std::vector<std::string> overrides{fmt::format("{}={:.17g}", key, 100.0 + distance * 5.386e-4),
                                             fmt::format("output.times=[{}]", fmt::join(times, ", "))};
    expect_stated_error(compressible(), key, overrides, {5e-7, 2.5e-7});
  }
}

// The table of unloadings has a material at E0/Gamma0 = 100, beyond which its shapes do not change.
TEST(Sensitivities, AreMeansOfTheTwoSidesWithAWarningAtAKink) {
  const std::string key = "material.stiffness_ratio";
  const std::string text = compressible();
  const std::string with = text + "\n[sensitivities]\nkeys = [\"" + key + "\"]\n";
  const HistoryRun alone = run_of(text);
  const HistoryRun run = run_of(with);
  const auto is_of_kink = [](const std::string& warning) {
    return warning.find("have a kink at 100,") < warning.size();
  };
  EXPECT_EQ(std::ranges::count_if(run.record.warnings, is_of_kink), 1);
  EXPECT_LT(static_cast<double>(run.record.statistics.rhs_evaluations),
            3.3 * static_cast<double>(alone.record.statistics.rhs_evaluations));
  std::array<double, 3> forces{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double ratio = 100.0 + 1e-4 * (static_cast<double>(k) - 1.0);
    const HistoryRun other = run_of(text, {fmt::format("{}={:.17g}", key, ratio), "output.times=[3.05]"});
    std::size_t row = 1;
    while (other.record.history.at(row, 2) != 0.0) ++row;
    forces[k] = other.record.history.at(row, *other.record.history.find("axial.force"));
  }
  const HistoryRun there = run_of(with, {"output.times=[3.05]"});
  std::size_t row = 1;
  while (there.record.history.at(row, 2) != 0.0) ++row;
  const double derivative = column(there, "d(axial.force)/d(" + key + ")")[row];
  const double below = (forces[1] - forces[0]) / 1e-4;
  const double above = (forces[2] - forces[1]) / 1e-4;
  EXPECT_GT(std::abs(above - below), std::abs(above));
  EXPECT_NEAR(derivative, std::midpoint(below, above), 1e-4 * std::abs(derivative));
  EXPECT_GT(run.sensitivities[0].error, 0.3);
}

TEST(Sensitivities, HaveNoWarningBesideAKink) {
  const std::string key = "material.stiffness_ratio";
  const std::string with = compressible() + "\n[sensitivities]\nkeys = [\"" + key + "\"]\n";
  for (const char* integrator : {"direct", "odeint-dopri5"}) {
    const std::string by = fmt::format("numerics.integrator={}", integrator);
    EXPECT_EQ(run_of(with, {by}).record.warnings.size(), run_of(compressible(), {by}).record.warnings.size() + 1);
    const HistoryRun beside = run_of(with, {by, key + "=99"});
    EXPECT_TRUE(beside.record.warnings == run_of(compressible(), {by, key + "=99"}).record.warnings) << integrator;
    EXPECT_LT(beside.sensitivities[0].error, 1e-6) << integrator;
  }
}

// The step is so short that round-off of the derivatives exceeds 1 % in many rows.
TEST(Sensitivities, HaveNoKinkInRoundOff) {
  for (const char* name : {"cycles", "nonlocal"}) {
    const std::vector<std::string> small{"material.poisson_ratio=1e-8"};
    const HistoryRun run = run_of(scene_with_key(name, "material.poisson_ratio"), small);
    EXPECT_TRUE(run.record.warnings == run_of(scene(name), small).record.warnings) << name;
  }
}

TEST(Sensitivities, AtTheEndOfARangeAreUndefinedWithAWarning) {
  const HistoryRun run = run_of(k_hertz, {"material.poisson_ratio=0.5"});
  EXPECT_TRUE(std::isnan(column(run, "d(axial.force)/d(material.poisson_ratio)").back()));
  EXPECT_TRUE(std::isfinite(column(run, "d(axial.force)/d(particle.radius)").back()));
  ASSERT_EQ(run.record.warnings.size(), 1U);
  EXPECT_NE(run.record.warnings[0].find("no derivatives by material.poisson_ratio"), std::string::npos);
}

TEST(Sensitivities, AtTheEndOfARangeAreUndefinedInEveryStep) {
  const std::string key = "material.shear_ratio";
  for (const char* integrator : {"direct", "cvode-bdf"}) {
    const HistoryRun run = run_of(compressible() + "\n[sensitivities]\nkeys = [\"" + key + "\"]\n",
                                  {fmt::format("numerics.integrator={}", integrator)});
    EXPECT_TRUE(
        std::ranges::all_of(column(run, "d(axial.force)/d(" + key + ")"), [](double d) { return std::isnan(d); }));
  }
}

TEST(Sensitivities, NameWhatCannotBeDifferentiatedBy) {
  std::string text = k_hertz;
  text.replace(
      text.find("keys = ["), std::string::npos,
      "keys = [\"material.youngs_modulos\", \"output.points\", \"material.yield_stress\", \"loading.steps[0].rate\","
      " \"particle.radius\", \"particle.radius\"]\n");
  std::vector<std::string> messages;
  try {
    static_cast<void>(parse_scenario(text, "s.toml"));
  } catch (const ScenarioError& error) {
    for (const Fault& fault : error.faults()) messages.push_back(fault.message);
  }
  ASSERT_EQ(messages.size(), 5U);
  EXPECT_NE(messages[0].find("did you mean 'youngs_modulus'?"), std::string::npos) << messages[0];
  EXPECT_NE(messages[1].find("'output.points' is no quantity"), std::string::npos) << messages[1];
  EXPECT_NE(messages[3].find("does not give 'loading.steps[0].rate'"), std::string::npos) << messages[3];
  EXPECT_NE(messages[4].find("is there twice"), std::string::npos) << messages[4];
}

}  // namespace
}  // namespace monograin::sensitivities_test
