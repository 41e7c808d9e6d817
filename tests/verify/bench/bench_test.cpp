#include "verify/bench/bench.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>
#include <set>

#include "history/run.hpp"
#include "scenario/text_file.hpp"
#include "scene/scene.hpp"
#include "support/refusal.hpp"
#include "support/svg_figure.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"
#include "verify/probe/profiled_system.hpp"

namespace monograin::bench_test {
namespace {

namespace fs = std::filesystem;

const fs::path k_scenes = fs::path(MONOGRAIN_SOURCE_DIR) / "scenarios/bench/scenes.toml";

CheckedScenario die(const std::vector<std::string>& overrides = {}) {
  return parse_scenario(default_scenario_text(), "die.toml", overrides);
}

const BenchPoint& point_of(const BenchScene& scene, std::string_view integrator, double rtol) {
  for (const BenchPoint& point : scene.points) {
    if (point.integrator == integrator && point.rtol == rtol) return point;
  }
  throw std::logic_error("no such point");
}

// --- a scene

TEST(BenchScene, HasErrorsThatFollowTheTolerance) {
  const BenchScene scene = measure_scene(die({"output.points=20"}),
                                         {.integrators = {"auto", "direct", "cvode-adams"},
                                          .tolerances = {1e-4, 1e-7, 1e-10},
                                          .least_time = 0.0,
                                          .least_runs = 1},
                                         {});
  EXPECT_EQ(scene.chosen, "direct");
  EXPECT_EQ(scene.reference, "direct");
  EXPECT_NE(scene.check, "direct");
  EXPECT_LT(scene.agreement, 1e-11);
  EXPECT_GT(scene.rows, 60U);
  EXPECT_GT(scene.setup, 0.0);
  EXPECT_GT(scene.evaluation, 0.0);
  ASSERT_EQ(scene.points.size(), 9U);
  for (const double rtol : {1e-4, 1e-7, 1e-10}) {
    EXPECT_LT(point_of(scene, "direct", rtol).curve_error, 1e-2 * rtol) << "only its work has a tolerance";
    const BenchPoint& point = point_of(scene, "cvode-adams", rtol);
    EXPECT_GT(point.curve_error, 1e-2 * rtol);
    EXPECT_LT(point.curve_error, 100.0 * rtol);
    EXPECT_LE(point.end_error, point.curve_error);
    EXPECT_LT(point.event_error, 10.0 * rtol);
    EXPECT_LE(point.fastest, point.median);
    EXPECT_GT(point.statistics.steps, 0);
    EXPECT_EQ(point.fault, "");
  }
}

TEST(BenchScene, DirectFormIntegratesItsWorkNoBetterThanAsked) {
  const std::vector<double> tolerances{1e-2, 1e-4, 1e-6, 1e-8};
  const BenchScene scene =
      measure_scene(die({"material.yield_stress=160 MPa", "mdr.radius_rule=gated", "output.points=20"}),
                    {.integrators = {"direct"}, .tolerances = tolerances, .least_time = 0.0, .least_runs = 1}, {});
  for (const double rtol : tolerances) EXPECT_LT(point_of(scene, "direct", rtol).curve_error, 1e-2 * rtol);
  EXPECT_GT(point_of(scene, "direct", 1e-2).curve_error, 1e-10) << "the work is not part of the curve";
  EXPECT_LT(point_of(scene, "direct", 1e-2).statistics.rhs_evaluations,
            0.7 * static_cast<double>(point_of(scene, "direct", 1e-8).statistics.rhs_evaluations));
}

TEST(BenchScene, WithoutADirectFormIsHeldAgainstTwoOthers) {
  const fs::path file = fs::path(MONOGRAIN_SOURCE_DIR) / "scenarios/material-point.toml";
  const BenchScene scene =
      measure_scene(read_scenario(file, {"output.points=20"}),
                    {.integrators = {"direct", "ida"}, .tolerances = {1e-6}, .least_time = 0.0, .least_runs = 1}, {});
  ASSERT_EQ(scene.points.size(), 1U) << "there is no direct form";
  EXPECT_NE(scene.reference, scene.check);
  EXPECT_LT(scene.agreement, 1e-9);
  EXPECT_LT(scene.points.front().curve_error, 1e-5);
}

TEST(BenchScene, IsMeasuredFromTheRunsThatAgreeBest) {
  // At their tightest tolerances the two methods differ by 1e-11: the direct form is better at 1e-11.
  const BenchScene scene =
      measure_scene(read_scenario(fs::path(MONOGRAIN_SOURCE_DIR) / "scenarios/hollomon.toml", {"output.points=20"}),
                    {.integrators = {"direct"}, .tolerances = {1e-11}, .least_time = 0.0, .least_runs = 1}, {});
  EXPECT_LT(scene.agreement, 1e-12);
}

TEST(BenchProfile, HasSharesOfOneRunThatFillNoMoreThanItsTime) {
  const BenchProfile profile = profile_scene(die({"output.points=20"}), "ida");
  EXPECT_GT(profile.law, 0.0);
  EXPECT_GT(profile.linear_algebra, 0.0);
  EXPECT_LE(profile.law + profile.linear_algebra + profile.guards + profile.recording, profile.total);
}

TEST(BenchScene, TimeToAnErrorIsThatOfTheFastestRunThatReachesIt) {
  BenchScene scene{.name = "a", .title = {}, .chosen = {}, .reference = {}, .check = {}, .points = {}};
  const auto add = [&](const char* name, double error, double time) {
    BenchPoint point{.integrator = name, .statistics = {}, .fault = {}};
    point.curve_error = error;
    point.fastest = time;
    scene.points.push_back(point);
  };
  add("ida", 1e-3, 1.0);
  add("ida", 1e-6, 3.0);
  add("ida", 1e-7, 2.0);
  add("ida", std::nan(""), 0.1);
  EXPECT_EQ(time_to_error(scene, "ida", 1e-2), 1.0);
  EXPECT_EQ(time_to_error(scene, "ida", 1e-5), 2.0);
  EXPECT_TRUE(std::isnan(time_to_error(scene, "ida", 1e-8)));
  EXPECT_TRUE(std::isnan(time_to_error(scene, "direct", 1.0)));
}

// --- the scenes there are

TEST(BenchScenes, EachRunsToItsEnd) {
  std::set<std::string> names;
  for (const CheckedScenario& scenario : read_bench_list(k_scenes).scenes) {
    EXPECT_TRUE(names.insert(scenario.name).second) << scenario.name;
    const monograin::Run run = run_scenario(scenario);
    EXPECT_EQ(run.record.status, RunStatus::complete) << scenario.name << ": " << run.record.message;
  }
  for (const fs::path& ready : toml_files(k_scenes.parent_path().parent_path(), "scenario", "")) {
    EXPECT_TRUE(names.contains(ready.stem().string())) << ready << " is not measured";
  }
}

TEST(BenchScenes, HaveTheNamesAndTitlesOfTheirFilesWhereTheListGivesNone) {
  const BenchList list = read_bench_list(k_scenes);
  const auto found = std::ranges::find(list.scenes, "force", &CheckedScenario::name);
  ASSERT_NE(found, list.scenes.end());
  EXPECT_EQ(found->title, read_scenario(k_scenes.parent_path().parent_path() / "force.toml").title);
}

TEST(BenchScenes, FaultsHaveTheirPlaces) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "scenes.toml";
  fs::create_directory(folder.path() / "many");
  std::ofstream(folder.path() / "many/one.toml") << default_scenario_text();
  std::ofstream(file) << "[[scene]]\nname = \"a\"\nscenario = \"none.toml\"\ncolour = 3\n"
                         "[[scene]]\nname = \"b\"\nscenario = \"many\"\n";
  try {
    static_cast<void>(read_bench_list(file));
    FAIL() << "no fault";
  } catch (const ScenarioError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("scenes.toml:4:1: unknown key 'colour'"), std::string::npos) << text;
    EXPECT_NE(text.find("scenes.toml:6:1: a folder of scenarios has no name of its own"), std::string::npos) << text;
    EXPECT_NE(text.find("none.toml"), std::string::npos) << text;
  }
  EXPECT_THROW(static_cast<void>(read_bench_list(folder.path() / "none.toml")), ScenarioError);
}

// --- profile and savings

/// Same rows, same columns, bit by bit.
void expect_same(const Table& a, const Table& b) {
  ASSERT_EQ(a.row_count(), b.row_count());
  ASSERT_EQ(a.columns().size(), b.columns().size());
  for (std::size_t i = 0; i < a.row_count(); ++i) {
    for (std::size_t c = 0; c < a.columns().size(); ++c) {
      const double x = a.at(i, c);
      const double y = b.at(i, c);
      EXPECT_TRUE(x == y || (std::isnan(x) && std::isnan(y))) << a.columns()[c].name << " in row " << i;
    }
  }
}

void expect_looks_on_only(const CheckedScenario& scenario, std::initializer_list<const char*> integrators) {
  for (const char* integrator : integrators) {
    Scene plain = make_scene(scenario);
    if (std::string_view(integrator) == "direct" && !plain.system->is_solvable()) continue;
    SCOPED_TRACE(scenario.name + ", " + integrator);
    SystemProfile profile;
    Scene timed = make_scene(scenario);
    timed.system = profiled(std::move(timed.system), profile);
    const RunRecord a = record_run(plain, integrator, {}, scenario.output);
    const RunRecord b = record_run(timed, integrator, {}, scenario.output);
    expect_same(a.history, b.history);
    EXPECT_EQ(a.warnings, b.warnings);
    EXPECT_GT(profile.law.calls, 0);
    EXPECT_GT(profile.recording.calls, 0);
    EXPECT_GT(profile.law.seconds, 0.0);
  }
}

TEST(BenchProfile, LooksOnOnly) {
  for (const CheckedScenario& scenario : read_bench_list(k_scenes).scenes) {
    expect_looks_on_only(scenario, {"direct", "cvode-bdf", "ida"});
  }
  // A singular start, which none of the bench's own scenes has.
  expect_looks_on_only(read_scenario(MONOGRAIN_SOURCE_DIR "/tests/findings/nonlocal/false-end/"
                                                          "force-against-a-resting-wall.toml"),
                       {"direct", "cvode-bdf"});
}

TEST(BenchProfile, KnowsTheLinearAlgebraOfSundialsOnly) {
  EXPECT_GT(profile_scene(die(), "cvode-bdf").linear_algebra, 0.0);
  EXPECT_GT(profile_scene(die(), "ida").linear_algebra, 0.0);
  EXPECT_EQ(profile_scene(die(), "cvode-adams").linear_algebra, 0.0);
  const BenchProfile direct = profile_scene(die(), "auto");
  EXPECT_EQ(direct.integrator, "direct");
  EXPECT_EQ(direct.linear_algebra, 0.0);
  EXPECT_GT(direct.law, 0.0);
  EXPECT_GT(direct.total, direct.recording);
}

TEST(BenchSavings, LookBeyondTheEndOfAStep) {
  // Too shallow to yield before it ends.
  const CheckedScenario scenario = die({"loading.steps=[{displacement=\"1e-4 R0\",duration=1}]"});
  std::vector<std::string> guards;
  for (const double factor : {1.0, 1000.0}) {
    Scene scene = make_scene(scenario);
    scene.system = sampling_beyond(std::move(scene.system), factor);
    std::vector<double> y(scene.system->unknowns().size());
    std::vector<Event> log;
    std::vector<Ramp> ramps(scene.classes.size());
    ramps[0].end = scenario.loading.steps[0].target;
    scene.system->start(y);
    scene.system->begin_step(ramps, y, log);
    guards.emplace_back();
    for (const Guard& guard : scene.system->guards()) guards.back() += std::string(guard.name) + " ";
  }
  EXPECT_EQ(guards[0].find("yield"), std::string::npos) << guards[0];
  EXPECT_NE(guards[1].find("yield"), std::string::npos) << guards[1];
}

TEST(BenchSavings, LookBeyondStepsInEveryFormOfEveryModel) {
  for (const CheckedScenario& scenario : read_bench_list(k_scenes).scenes) {
    for (const char* integrator : {"direct", "cvode-bdf", "ida"}) {
      Scene plain = make_scene(scenario);
      if (std::string_view(integrator) == "direct" && !plain.system->is_solvable()) continue;
      SCOPED_TRACE(scenario.name + ", " + integrator);
      Scene longer = make_scene(scenario);
      longer.system = sampling_beyond(std::move(longer.system), 10.0);
      const RunRecord a = record_run(plain, integrator, {}, scenario.output);
      const RunRecord b = record_run(longer, integrator, {}, scenario.output);
      ASSERT_EQ(b.status, RunStatus::complete) << b.message;
      // A force or a stress.
      const auto column = std::ranges::find_if(a.history.columns(), [](const Column& one) {
        return one.name.ends_with(".force") || one.name == "stress" || one.name == "stress_axial";
      });
      const std::string& name = column->name;
      // The largest, and the last.
      const auto size_of = [](double size, double value) { return std::max(size, std::abs(value)); };
      const auto x = a.history.column(name);
      const auto y = b.history.column(name);
      const double largest = std::accumulate(x.begin(), x.end(), 0.0, size_of);
      EXPECT_NEAR(std::accumulate(y.begin(), y.end(), 0.0, size_of), largest, 1e-6 * largest);
      EXPECT_NEAR(y.back(), x.back(), 1e-6 * largest);
    }
  }
}

TEST(BenchSavings, LeaveTheCurvesAsTheyAre) {
  const std::vector<BenchSaving> savings =
      measure_savings({.least_time = 0.0, .least_runs = 1}, read_bench_list(k_scenes).savings);
  std::set<std::string> names;
  for (const BenchSaving& saving : savings) names.insert(saving.what);
  EXPECT_EQ(names.size(), 9U);
  for (const BenchSaving& saving : savings) {
    EXPECT_LT(saving.difference, 1e-6) << saving.what << ", " << saving.scene;
    EXPECT_GT(saving.undone, 0.0);
  }
}

// --- what it leaves

TEST(BenchFiles, AreATableItsNumbersAndFigures) {
  const TemporaryFolder folder;
  const std::vector<BenchScene> scenes{measure_scene(
      die({"output.points=10"}),
      {.integrators = {"auto", "cvode-bdf"}, .tolerances = {1e-4, 1e-6}, .least_time = 0.0, .least_runs = 1}, {})};
  const std::vector<BenchProfile> profiles{profile_scene(die(), "cvode-bdf")};
  const auto files = write_bench(scenes, profiles, {}, folder.path() / "new");
  ASSERT_EQ(files.size(), 5U);
  for (const fs::path& file : files) EXPECT_GT(fs::file_size(file), 100U) << file;
  const Table csv = read_csv(folder.path() / "new/bench.csv");
  EXPECT_EQ(csv.row_count(), 4U);
  EXPECT_EQ(csv.word(0, *csv.find("scene")), "die");
  EXPECT_GT(csv.column("fastest[s]").at(1), 0.0);
  const std::string text = bench_text(scenes, profiles, {});
  for (const char* heading : {"## `auto`", "## Tolerances", "## Where the time goes", "## die"}) {
    EXPECT_NE(text.find(heading), std::string::npos) << heading;
  }
  EXPECT_EQ(text.find("## What is not computed"), std::string::npos) << "no savings were measured";
}

TEST(BenchFiles, AreDrawnAnewFromTheNumbersAsTheCommittedFigures) {
  const fs::path plots = MONOGRAIN_SOURCE_DIR "/plots";
  const TemporaryFolder folder;
  const auto files = redraw_bench(plots / "bench.csv", folder.path());
  for (const fs::path& file : files) {
    const auto found = differences(read_svg(file), read_svg(plots / file.filename()));
    EXPECT_TRUE(found.empty()) << file.filename() << ": " << found.size() << " differences: " << found.front();
  }
  for (const auto& entry : fs::directory_iterator(plots)) {
    const fs::path name = entry.path().filename();
    if (name.extension() != ".svg" || !name.string().starts_with("bench-")) continue;
    EXPECT_TRUE(fs::exists(folder.path() / name)) << name << " is of no scene in bench.csv";
  }
}

TEST(BenchFiles, SaySoWhereRunsThatAreTheSameTakeUnlikeTimes) {
  const auto point = [](const char* integrator, double seconds) {
    BenchPoint made;
    made.integrator = integrator;
    made.rtol = 1e-8;
    made.curve_error = 1e-9;
    made.fastest = seconds;
    return made;
  };
  BenchScene scene;
  scene.name = "made up";
  scene.chosen = "direct";
  scene.points = {point("auto", 1.0e-3), point("direct", 1.3e-3), point("ida", 5e-3)};
  const std::string text = bench_text({scene}, {}, {});
  EXPECT_NE(text.find("by 30.0 % in the median and by 30.0 % at"), std::string::npos) << text;
}

TEST(BenchFiles, KnowNoErrorBetterThanTheReferencesAgree) {
  BenchScene scene;
  scene.name = "made up";
  scene.agreement = 3e-9;
  BenchPoint point;
  point.integrator = "ida";
  point.rtol = 1e-12;
  point.curve_error = 1e-15;
  scene.points = {point};
  const std::string text = bench_text({scene}, {}, {});
  EXPECT_NE(text.find("| ida        |     0 |      0 |       3e-09 |"), std::string::npos) << text;
}

TEST(BenchFiles, AreNotDrawnFromAFileOfSomethingElse) {
  const TemporaryFolder folder;
  write_text(folder.path() / "other.csv", "scene,rtol\n1,2\n");
  EXPECT_THROW(redraw_bench(folder.path() / "other.csv", folder.path()), std::runtime_error);
}

TEST(BenchFiles, AreNotDrawnFromAFileWithoutOneOfTheColumns) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "bench.csv";
  const std::string heading = "scene,integrator,rtol,curve_error,event_error,fastest[s]\n";
  for (const std::string name : {"rtol", "curve_error", "event_error", "fastest"}) {
    write_text(file, std::string(heading).replace(heading.find(name), name.size(), "other") + "a,ida,1,1,1,1\n");
    const std::string message = refusal<std::runtime_error>([&] { return redraw_bench(file, folder.path()); });
    EXPECT_TRUE(message.ends_with("bench.csv: has no numbers in a column '" + name + "'")) << message;
  }
}

TEST(BenchFiles, CompareBdfWithAutoAtTheErrorThatAutoHasByDefault) {
  const auto point = [](const char* integrator, double rtol, double error, double seconds) {
    BenchPoint made;
    made.integrator = integrator;
    made.rtol = rtol;
    made.curve_error = error;
    made.fastest = made.median = seconds;
    return made;
  };
  BenchScene scene;
  scene.name = "made up";
  scene.chosen = "direct";
  scene.rows = 1;
  scene.evaluation = 1e-6;
  // The run at 1e-4 is faster, and not what is compared.
  scene.points = {point("auto", 1e-4, 1e-5, 1e-6), point("auto", 1e-8, 2e-11, 1e-5),
                  point("cvode-bdf", 1e-8, 1e-9, 1e-4), point("cvode-bdf", 1e-10, 1e-11, 2.5e-4),
                  point("cvode-bdf", 1e-12, 1e-12, 4e-4)};
  const auto shown = [&] { return bench_text({scene}, {}, {}); };
  EXPECT_NE(shown().find(" 25 |             10 |\n"), std::string::npos) << shown();
  // What it does not come to it is compared with at the least error that it comes to.
  scene.points[1].curve_error = 1e-13;
  EXPECT_NE(shown().find(" > 40 |             10 |\n"), std::string::npos) << shown();
  scene.points.erase(scene.points.begin() + 2, scene.points.end());
  EXPECT_NE(shown().find(" - |             10 |\n"), std::string::npos) << shown();
}

}  // namespace
}  // namespace monograin::bench_test
