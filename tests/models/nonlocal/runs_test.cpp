// Whole runs of the nonlocal sphere: independent curves and events with 30 digits, in all forms; symmetries; random
// wall sets.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "history/table.hpp"
#include "models/accuracy.hpp"
#include "support/deviation.hpp"
#include "support/test_run.hpp"

namespace monograin::nonlocal_runs_test {
namespace {

using std::numbers::pi;

CheckedScenario nonlocal_scenario(Configuration configuration, double poisson_ratio, std::vector<Step> steps) {
  CheckedScenario scenario = hertz_scenario(configuration, std::move(steps));
  scenario.model = "nonlocal";
  scenario.material["poisson_ratio"] = poisson_ratio;
  scenario.options = {{"terms", std::string("4")},
                      {"contact_radius_rule", std::string("closed")},
                      {"influence", std::string("half-space")}};
  return scenario;
}

CheckedScenario oblique(CheckedScenario scenario, double angle, int walls = 2) {
  scenario.loading.oblique_angle = angle;
  scenario.loading.oblique_walls = walls;
  return scenario;
}

CheckedScenario with_free_centre(CheckedScenario scenario) {
  scenario.loading.centre_is_free = true;
  return scenario;
}

Table reference(const std::string& file) {
  return read_csv(MONOGRAIN_SOURCE_DIR "/tests/models/nonlocal/reference/" + file + ".csv");
}

/// The preset to which a reference file belongs.
CheckedScenario preset_of(const std::string& name, double poisson_ratio, std::vector<Step> steps) {
  if (name.starts_with("simple")) return nonlocal_scenario(Configuration::simple, poisson_ratio, std::move(steps));
  if (name.starts_with("hydrostatic")) {
    return nonlocal_scenario(Configuration::hydrostatic, poisson_ratio, std::move(steps));
  }
  if (name.starts_with("oblique-die")) {
    const double degrees =
        name.find("angle8") != std::string::npos || name.find("8 deg") != std::string::npos ? 8.0 : 37.5;
    return oblique(nonlocal_scenario(Configuration::oblique_die, poisson_ratio, std::move(steps)),
                   degrees * pi / 180.0);
  }
  return nonlocal_scenario(Configuration::die, poisson_ratio, std::move(steps));
}

/// The program of a reference file, recorded at its rows.
CheckedScenario case_of(const std::string& name, const Table& table) {
  const double nu = std::stod(std::string(table.header_value("poisson_ratio")));
  CheckedScenario scenario;
  double start = 0.0;
  if (name == "die_gaps_unload_terms4") {
    const std::vector<Step> drive{ramp(0.35), ramp(-0.02)};
    scenario =
        between(nonlocal_scenario(Configuration::walls, nu, {}),
                {wall("z+", {0, 0, 1}, drive), wall("z-", {0, 0, -1}, drive), wall("x+", {1, 0, 0}, {}, 0.03),
                 wall("x-", {-1, 0, 0}, {}, 0.03), wall("y+", {0, 1, 0}, {}, 0.05), wall("y-", {0, -1, 0}, {}, 0.05)});
  } else if (name == "trigonal_free_centre_terms3") {
    // The program starts with the axial walls a little inside.
    start = 1.0;
    const std::vector<Step> axial{ramp(1e-6), ramp(0.15), hold()};
    const auto lateral = [&](const char* label, double degrees, std::vector<Step> steps) {
      const double angle = degrees * pi / 180.0;
      return wall(label, {std::cos(angle), std::sin(angle), 0.0}, std::move(steps));
    };
    scenario = with_free_centre(between(
        nonlocal_scenario(Configuration::walls, nu, {}),
        {wall("z+", {0, 0, 1}, axial), wall("z-", {0, 0, -1}, axial), lateral("l0", 0.0, {}),
         lateral("l120", 120.0, {hold(), hold(), ramp(0.04)}), lateral("l240", 240.0, {hold(), hold(), ramp(-0.01)})}));
  } else if (name == "die_force_terms4") {
    scenario = nonlocal_scenario(Configuration::die, nu, {force_ramp(0.4 * pi)});
  } else {
    const double end = table.column("gamma_over_2R").back();
    scenario = preset_of(name, nu, {ramp(end, end)});
  }
  const std::size_t time = table.find("t") ? *table.find("t") : *table.find("gamma_over_2R");
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    if (const double t = table.at(row, time) + start; t > 0.0) scenario.output.times.push_back(t);
  }
  return with(scenario, "terms", std::string(table.header_value("terms")));
}

struct ColumnPair {
  std::string reference, run;
  double factor;
};

/// Columns that a reference table and a run have in common.
std::vector<ColumnPair> columns_of(const Table& table, const TestRun& run, const std::string& radius_column) {
  std::vector<ColumnPair> pairs{{"stored_energy_over_ER3", "stored_energy", 1.0}, {"margin", "margin", 1.0}};
  for (const ContactClass& c : run.scene.classes) {
    pairs.push_back({c.name + ".F_over_piR2E", c.name + ".force", pi});
    pairs.push_back({c.name + ".a_over_R", c.name + ".contact_radius", 1.0});
    pairs.push_back({c.name + "." + radius_column, c.name + ".contact_radius_deformed", 1.0});
    pairs.push_back({c.name + ".displacement_over_R", c.name + ".displacement", 1.0});
  }
  pairs.push_back({"gamma_over_2R", "axial.displacement", 1.0});
  for (const char* axis : {"centre_x", "centre_y", "centre_z"})
    pairs.push_back({std::string(axis) + "_over_R", axis, 1.0});
  std::erase_if(
      pairs, [&](const ColumnPair& pair) { return !table.find(pair.reference) || !run.record.history.find(pair.run); });
  return pairs;
}

/// Largest error of a run over each column's largest magnitude.
double error_of(const TestRun& run, const Table& table, const std::string& radius_column) {
  double worst = 0.0;
  const auto pairs = columns_of(table, run, radius_column);
  EXPECT_GE(pairs.size(), 5u);
  for (const auto& [reference_name, run_name, factor] : pairs) {
    const std::vector<double> expected = table.column(reference_name);
    const std::vector<double> actual = run.outputs(run_name);
    // The trigonal case has one more row, the unloaded start.
    EXPECT_GE(actual.size(), expected.size()) << run_name << ": " << run.record.message;
    if (actual.size() < expected.size()) return 1.0;
    const std::size_t shift = actual.size() - expected.size();
    // A column that is zero by symmetry, up to round-off, is measured in radii.
    const double largest_value = largest(expected) < 1e-12 ? 1.0 : largest(expected);
    for (std::size_t k = 0; k < expected.size(); ++k) {
      worst = std::max(worst, deviation(actual[k + shift], factor * expected[k]) / (std::abs(factor) * largest_value));
    }
  }
  return worst;
}

class NonlocalReference : public ::testing::TestWithParam<const char*> {};

TEST_P(NonlocalReference, IsMetInAllForms) {
  const Table table = reference(GetParam());
  const CheckedScenario scenario = case_of(GetParam(), table);
  for (const char* integrator : k_integrators) {
    const double bound = integrator == std::string_view("direct") ? 1e-12 : 1e-6;
    EXPECT_LE(error_of(run(scenario, integrator), table, "a_prime_eq14_over_R"), bound) << integrator;
  }
  if (table.find("axial.a_prime_eq8_over_R")) {
    EXPECT_LE(error_of(run(with(scenario, "contact_radius_rule", "integral")), table, "a_prime_eq8_over_R"), 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(Nonlocal, NonlocalReference,
                         ::testing::Values("simple_terms1", "simple_terms2", "simple_terms3", "simple_terms4",
                                           "die_terms1", "die_terms2", "die_terms3", "die_terms4", "hydrostatic_terms1",
                                           "hydrostatic_terms2", "hydrostatic_terms3", "hydrostatic_terms4",
                                           "oblique-die_terms1", "oblique-die_terms2", "oblique-die_terms3",
                                           "oblique-die_terms4", "oblique-die_angle8_terms4", "die_gaps_unload_terms4",
                                           "trigonal_free_centre_terms3", "die_force_terms4"));

// --- events

TEST(NonlocalEvents, FallWhereTheyWereComputedElsewhere) {
  const Table table = reference("events");
  const auto word = [&](std::size_t row, std::string_view column) {
    return std::string(table.word(row, *table.find(column)));
  };
  int compared = 0;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const std::string rule = word(row, "rule");
    CheckedScenario scenario = preset_of(word(row, "configuration"), 0.48, {ramp(0.6, 0.6)});
    scenario.options["terms"] = std::to_string(static_cast<int>(table.at(row, *table.find("terms"))));
    scenario = with(scenario, "contact_radius_rule",
                    rule == "eq8"           ? "integral"
                    : rule == "uncorrected" ? "none"
                                            : "closed");
    const TestRun now = run(scenario);
    const double expected = table.at(row, *table.find("gamma_over_2R"));
    const std::string event = word(row, "event");
    const std::string classes = event == "limit" ? "" : word(row, "classes") + ":";
    const auto names = now.events();
    const auto found = std::ranges::find(names, classes + event);
    ASSERT_NE(found, names.end()) << classes << event << " of row " << row;
    std::vector<double> times;
    const Table& events = now.record.events;
    for (std::size_t k = 0; k < events.row_count(); ++k) {
      const std::string label(events.word(k, *events.find("class")));
      if (events.word(k, *events.find("event")) == event && (event == "limit" || label + ":" == classes)) {
        times.push_back(events.at(k, *events.find("time")));
      }
    }
    ASSERT_EQ(times.size(), 1u) << classes << event;
    EXPECT_NEAR(times[0], expected, event == "limit" ? 1e-9 : 1e-12) << classes << event << ", row " << row;
    ++compared;
  }
  EXPECT_EQ(compared, static_cast<int>(table.row_count()));
}

TEST(NonlocalEvents, OfContactsMadeAndLostFallWhereTheyWereComputedElsewhere) {
  const Table table = reference("events_general");
  const Table curve = reference("die_gaps_unload_terms4");
  const CheckedScenario scenario = case_of("die_gaps_unload_terms4", curve);
  for (const char* integrator : k_integrators) {
    const TestRun now = run(scenario, integrator);
    const bool is_direct = integrator == std::string_view("direct");
    for (std::size_t row = 0; row < table.row_count(); ++row) {
      const std::string name = std::string(table.word(row, *table.find("wall")));
      if (name.ends_with("-")) continue;  // of the same class
      const std::string event = name + ":" + std::string(table.word(row, *table.find("event")));
      const Table& events = now.record.events;
      double time = std::nan("");
      for (std::size_t k = 0; k < events.row_count(); ++k) {
        if (std::string(events.word(k, *events.find("class"))) + ":" +
                std::string(events.word(k, *events.find("event"))) ==
            event) {
          time = events.at(k, *events.find("time"));
        }
      }
      EXPECT_NEAR(time, table.at(row, *table.find("t")), is_direct ? 1e-12 : 1e-7) << integrator << " " << event;
    }
  }
}

TEST(NonlocalEvents, WarnBeforeTheLimitAndStopThere) {
  const TestRun now = run(nonlocal_scenario(Configuration::hydrostatic, 0.48, {ramp(0.3)}));
  EXPECT_EQ(now.record.status, RunStatus::stopped);
  EXPECT_TRUE(now.record.message.find("limit of applicability") != std::string::npos) << now.record.message;
  EXPECT_EQ(now.events(), (std::vector<std::string>{"stiffening", "limit"}));
  ASSERT_EQ(now.record.warnings.size(), 1u);
  EXPECT_NEAR(now.at_event("stiffening", "margin"), 0.25, 1e-10);
  EXPECT_NEAR(now.last("axial.contact_radius"), 0.68428498, 1e-5);  // for every number of terms
}

TEST(NonlocalEvents, StopWhereAContactIsAsWideAsTheParticleOrWallsMeet) {
  // For nu = 0.3 a contact becomes as wide as the particle before the limit of applicability.
  const CheckedScenario wide = nonlocal_scenario(Configuration::die, 0.3, {ramp(0.98)});
  const TestRun now = run(wide);
  EXPECT_EQ(now.events().back(), "axial:radius-limit");
  EXPECT_NEAR(now.last("axial.contact_radius"), 1.0, 1e-12);
  EXPECT_FALSE(run(with(wide, "contact_radius_rule", "none")).has_event("radius-limit"));
  // For nu = 0.1 the walls meet before that.
  const TestRun flat = run(nonlocal_scenario(Configuration::die, 0.1, {ramp(1.2)}));
  EXPECT_EQ(flat.record.status, RunStatus::stopped);
  EXPECT_EQ(flat.events().back(), "axial:limit");
  EXPECT_TRUE(flat.record.message.find("centre of the particle") != std::string::npos) << flat.record.message;
  EXPECT_NEAR(flat.last("axial.displacement"), 1.0, 1e-12);
}

TEST(NonlocalEvents, AWallThatIsNeverPressedChangesNothing) {
  // 62 degrees from the lateral walls the surface moves away from an oblique wall that touches it.
  const TestRun die = run(nonlocal_scenario(Configuration::die, 0.48, {ramp(0.4)}));
  const TestRun more =
      run(oblique(nonlocal_scenario(Configuration::oblique_die, 0.48, {ramp(0.4)}), 62.0 * pi / 180.0));
  EXPECT_LE(difference(more.outputs("axial.force"), die.outputs("axial.force")), 1e-13);
  EXPECT_EQ(largest(more.column("oblique.force")), 0.0);
  EXPECT_EQ(die.events(), more.events());
}

// --- properties of an elastic particle

TEST(NonlocalRuns, UnloadingRetracesLoadingAndTheWorkIsStored) {
  for (const char* integrator : k_integrators) {
    const TestRun now = run(
        with_points(nonlocal_scenario(Configuration::die, 0.48, {ramp(0.4), ramp(0.0), ramp(0.4)}), 40), integrator);
    const auto force = now.outputs("lateral.force");
    const bool is_direct = integrator == std::string_view("direct");
    for (std::size_t k = 0; k <= 40; ++k) {
      EXPECT_NEAR(force[80 - k], force[k], (is_direct ? 1e-13 : 1e-6) * largest(force)) << integrator;
      EXPECT_NEAR(force[80 + k], force[k], (is_direct ? 1e-13 : 1e-6) * largest(force)) << integrator;
    }
    const double scale = largest(now.column("work"));
    const auto work = now.column("work");
    const auto stored = now.column("stored_energy");
    for (std::size_t k = 0; k < work.size(); ++k) EXPECT_NEAR(work[k], stored[k], 3e-7 * scale) << integrator;
  }
}

TEST(NonlocalRuns, HaveThePressureOfTheirForceOverTheContactArea) {
  const TestRun now = run(with_points(nonlocal_scenario(Configuration::die, 0.48, {ramp(0.4)}), 20));
  const std::vector<double> force = now.outputs("axial.force");
  const std::vector<double> radius = now.outputs("axial.contact_radius");
  const std::vector<double> pressure = now.outputs("axial.pressure");
  ASSERT_GT(force.back(), 0.0);
  for (std::size_t row = 0; row < force.size(); ++row) {
    EXPECT_NEAR(pressure[row] * pi * radius[row] * radius[row], force[row], 1e-14 * force.back()) << row;
  }
}

TEST(NonlocalRuns, ForceAndDisplacementControlAreTheSame) {
  const TestRun told = run(with_points(nonlocal_scenario(Configuration::die, 0.48, {ramp(0.42)}), 30));
  const double force = told.last("axial.force");
  for (const char* integrator : k_integrators) {
    const TestRun pressed = run(
        with_points(
            nonlocal_scenario(Configuration::die, 0.48, {force_ramp(force), force_ramp(0.0), force_ramp(force)}), 30),
        integrator);
    EXPECT_EQ(pressed.record.status, RunStatus::complete) << pressed.record.message;
    EXPECT_NEAR(pressed.last("axial.displacement"), 0.42, 1e-7) << integrator;
    EXPECT_NEAR(pressed.last("lateral.force"), told.last("lateral.force"), 1e-6 * force) << integrator;
    EXPECT_NEAR(pressed.last("work"), told.last("work"), 1e-6 * told.last("work")) << integrator;
  }
}

TEST(NonlocalRuns, AForcePressesAFreeParticleAgainstAFixedWallAsTwoForcesDo) {
  const std::vector<Step> press_and_release{force_ramp(0.1), force_ramp(0.0), force_ramp(0.05)};
  for (const char* influence : {"half-space", "sphere"}) {
    const TestRun both =
        run(with(nonlocal_scenario(Configuration::simple, 0.3, press_and_release), "influence", influence));
    const CheckedScenario walls = between(nonlocal_scenario(Configuration::walls, 0.3, {}),
                                          {wall("a", {0.6, 0, -0.8}, press_and_release), wall("b", {-0.6, 0, 0.8})});
    for (const char* integrator : k_integrators) {
      SCOPED_TRACE(std::string(integrator) + " " + influence);
      const TestRun now = run(with_free_centre(with(walls, "influence", influence)), integrator);
      ASSERT_EQ(now.record.status, RunStatus::complete) << now.record.message;
      EXPECT_LE(difference(now.outputs("b.force"), now.outputs("a.force")), 1e-6);
      EXPECT_LE(difference(now.outputs("b.contact_radius"), both.outputs("axial.contact_radius")), 1e-5);
      std::vector<double> twice = both.outputs("axial.displacement");
      for (double& displacement : twice) displacement *= 2.0;
      EXPECT_LE(difference(now.outputs("a.displacement"), twice), 1e-6);
      EXPECT_NEAR(now.last("work"), both.last("work"), 1e-6 * both.last("work"));
    }
  }
}

TEST(NonlocalRuns, LeaveADisplacementThatOfTheWallItself) {
  const CheckedScenario walls = between(nonlocal_scenario(Configuration::walls, 0.3, {}),
                                        {wall("top", {0, 0, 1}, path({0.1, 0.05})), wall("bottom", {0, 0, -1})});
  for (const char* integrator : k_integrators) {
    const TestRun now = run(with_free_centre(walls), integrator);
    EXPECT_EQ(now.outputs("top.displacement")[50], 0.1) << integrator;
    EXPECT_EQ(largest(now.column("bottom.displacement")), 0.0) << integrator;
    const auto centre = now.column("centre_z");
    const auto overlap = now.column("top.overlap");
    const auto displacement = now.column("top.displacement");
    for (std::size_t row = 0; row < centre.size(); ++row) {
      EXPECT_NEAR(overlap[row], displacement[row] + centre[row], 1e-15) << integrator << ", row " << row;
    }
  }
}

TEST(NonlocalRuns, OfOneTermWithoutCouplingAreHertzian) {
  // With a fixed centre, a single driven wall is independent of the others.
  CheckedScenario one = between(nonlocal_scenario(Configuration::walls, 0.3, {}),
                                {wall("a", {0, 0, 1}, {ramp(0.1)}), wall("b", {0, 0, -1}, {}, 0.5)});
  const TestRun now = run(with(one, "terms", "1"));
  EXPECT_NEAR(now.last("a.force"), 4.0 / 3.0 / 0.91 * std::pow(0.1, 1.5), 1e-15);
}

TEST(NonlocalRuns, DoNotDependOnTheDirectionOfTheWalls) {
  const Eigen::Matrix3d turn = Eigen::Quaterniond(0.3, -0.5, 0.7, 0.2).normalized().toRotationMatrix();
  for (const bool is_free : {false, true}) {
    const auto walls = [&](const Eigen::Matrix3d& rotation) {
      // A free centre has a definite position only if the lateral walls are pressed from the start.
      const double gap = is_free ? 0.0 : 0.01;
      const double slant = is_free ? 0.0 : 0.3;
      CheckedScenario scenario =
          between(nonlocal_scenario(Configuration::walls, 0.45, {}),
                  {wall("a", rotation * Eigen::Vector3d(0, 0, 1), {ramp(0.2), ramp(0.1)}),
                   wall("b", rotation * Eigen::Vector3d(0, 0, -1), {ramp(0.15), force_ramp(0.05)}),
                   wall("c", rotation * Eigen::Vector3d(1, 0.3, 0.3 * slant)),
                   wall("d", rotation * Eigen::Vector3d(-1, 0.1, 0), {}, gap),
                   wall("e", rotation * Eigen::Vector3d(0.1, -1, slant)),
                   wall("f", rotation * Eigen::Vector3d(-0.2, 1, 0.5 * slant), {}, gap)});
      return is_free ? with_free_centre(scenario) : scenario;
    };
    const TestRun straight = run(walls(Eigen::Matrix3d::Identity()));
    const TestRun turned = run(walls(turn));
    EXPECT_EQ(straight.record.status, RunStatus::complete) << straight.record.message;
    EXPECT_EQ(straight.events(), turned.events());
    for (const char* name : {"a", "b", "c", "d", "e", "f"}) {
      const std::string column = std::string(name) + ".force";
      EXPECT_LE(
          largest(turned.outputs(column)) == 0.0 ? 0.0 : difference(turned.outputs(column), straight.outputs(column)),
          1e-11)
          << column;
    }
  }
}

TEST(NonlocalRuns, LetAFreeCentreFollowManyWallsThatWithdrawTogether) {
  constexpr int k_walls = 52;
  CheckedScenario scenario = nonlocal_scenario(Configuration::walls, 0.3, {ramp(0.002), ramp(0.0)});
  for (int k = 0; k < k_walls; ++k) {
    const double height = 1.0 - (2.0 * k + 1.0) / k_walls;
    const double radius = std::sqrt(1.0 - height * height);
    const double angle = pi * (3.0 - std::sqrt(5.0)) * k;
    scenario.loading.walls.push_back(
        {.name = "w" + std::to_string(k), .normal = {radius * std::cos(angle), radius * std::sin(angle), height}});
  }
  const auto processor_time = [](const CheckedScenario& run) {
    double least = k_infinity;
    for (int repeat = 0; repeat < 5; ++repeat) {
      const std::clock_t start = std::clock();
      EXPECT_EQ(run_scenario(run).record.status, RunStatus::complete);
      least = std::min(least, static_cast<double>(std::clock() - start));
    }
    return least;
  };
  const double fixed = processor_time(scenario);
  EXPECT_LT(processor_time(with_free_centre(scenario)), 6.0 * fixed);  // 1.1 measured
}

TEST(NonlocalRuns, AreTheSameForWallsThatAreNotMerged) {
  for (const Configuration walls :
       {Configuration::simple, Configuration::die, Configuration::hydrostatic, Configuration::oblique_die}) {
    const CheckedScenario scenario = oblique(nonlocal_scenario(walls, 0.48, {ramp(0.15)}), 37.5 * pi / 180.0);
    const TestRun merged = run(scenario);
    const TestRun apart = run(scenario, "direct", {}, false);
    EXPECT_LE(difference(apart.outputs("work"), merged.outputs("work")), 1e-13);
    EXPECT_LE(difference(apart.outputs("margin"), merged.outputs("margin")), 1e-13);
  }
}

// --- random wall sets

/// 2 to 12 walls at least 15 degrees apart, with gaps and programs in and out by displacement or by force.
CheckedScenario random_walls(std::mt19937_64& generator) {
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(generator); };
  const int count = 2 + static_cast<int>(uniform(0.0, 11.0));
  std::vector<Eigen::Vector3d> normals;
  for (int tries = 0; tries < 1000 && static_cast<int>(normals.size()) < count; ++tries) {
    const double z = uniform(-1.0, 1.0);
    const double angle = uniform(0.0, 2.0 * pi);
    const Eigen::Vector3d n(std::sqrt(1.0 - z * z) * std::cos(angle), std::sqrt(1.0 - z * z) * std::sin(angle), z);
    const double closest = std::cos(15.0 * pi / 180.0);
    if (std::ranges::all_of(normals, [&](const Eigen::Vector3d& other) { return other.dot(n) < closest; })) {
      normals.push_back(n);
    }
  }
  std::vector<WallSpec> walls;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const std::string name = "w" + std::to_string(i);
    const double gap = uniform(0.0, 1.0) < 0.5 ? 0.0 : uniform(0.0, 0.05);
    if (i > 0 && uniform(0.0, 1.0) < 0.4) {
      walls.push_back(wall(name, normals[i], {}, gap));
      continue;
    }
    if (uniform(0.0, 1.0) < 0.2) {
      const double force = uniform(0.0, 0.05);
      walls.push_back(wall(name, normals[i], {force_ramp(force), force_ramp(0.3 * force), force_ramp(force)}, gap));
      continue;
    }
    const double depth = uniform(0.0, 0.12);
    walls.push_back(wall(name, normals[i], {ramp(depth), ramp(uniform(-0.01, depth)), ramp(depth)}, gap));
  }
  CheckedScenario scenario = between(nonlocal_scenario(Configuration::walls, uniform(0.0, 0.499), {}), walls);
  const char* const terms[] = {"1", "2", "3", "4", "inf"};
  scenario.options["terms"] = std::string(terms[static_cast<std::size_t>(uniform(0.0, 5.0))]);
  scenario.output.points = 5;
  return scenario;
}

TEST(NonlocalRandomWalls, EndCompleteOrAtANamedLimitAndGiveEverythingBack) {
  int complete = 0;
  int stopped = 0;
  for (unsigned seed = 1; seed <= 1000; ++seed) {
    std::mt19937_64 generator(seed);
    const TestRun now = run(random_walls(generator));
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + now.record.message);
    ASSERT_NE(now.record.status, RunStatus::failed);
    if (now.record.status == RunStatus::stopped) {
      ++stopped;
      ASSERT_FALSE(now.events().empty());
      const std::string& last = now.events().back();
      EXPECT_TRUE(last == "limit" || last.ends_with("radius-limit")) << last;
      continue;
    }
    ++complete;
    // The third step returns to the end of the first one.
    for (const ContactClass& c : now.scene.classes) {
      const auto force = now.outputs(c.name + ".force");
      ASSERT_EQ(force.size(), 16u);
      EXPECT_NEAR(force[15], force[5], 1e-12) << c.name;
      EXPECT_TRUE(std::ranges::none_of(force, [](double f) { return std::isnan(f) || f < 0.0; })) << c.name;
    }
    const auto work = now.outputs("work");
    EXPECT_NEAR(work[15], work[5], 1e-12 * std::max(1e-6, largest(work)));
  }
  RecordProperty("complete", complete);
  RecordProperty("stopped", stopped);
  EXPECT_GT(complete, 500);
}

TEST(NonlocalRandomWalls, AgreeInAllForms) {
  for (unsigned seed = 2001; seed <= 2060; ++seed) {
    std::mt19937_64 generator(seed);
    const CheckedScenario scenario = random_walls(generator);
    const TestRun direct = run(scenario);
    if (direct.record.status != RunStatus::complete) continue;
    for (const char* integrator : {"cvode-adams", "cvode-bdf", "ida"}) {
      const TestRun now = run(scenario, integrator);
      SCOPED_TRACE("seed " + std::to_string(seed) + " " + integrator + ": " + now.record.message);
      ASSERT_EQ(now.record.status, RunStatus::complete);
      double scale = 0.0;
      for (const auto& force : direct.outputs_by_class("force")) scale = std::max(scale, largest(force));
      const auto expected = direct.outputs_by_class("force");
      const auto actual = now.outputs_by_class("force");
      for (std::size_t c = 0; c < expected.size(); ++c) {
        ASSERT_EQ(actual[c].size(), expected[c].size());
        for (std::size_t k = 0; k < expected[c].size(); ++k) EXPECT_NEAR(actual[c][k], expected[c][k], 1e-6 * scale);
      }
      EXPECT_LE(difference(now.outputs("work"), direct.outputs("work")), 1e-6);
    }
  }
}

}  // namespace
}  // namespace monograin::nonlocal_runs_test
