#include "verify/stress/stress.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <string_view>

#include "history/run.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"
#include "verify/stress/check/checks.hpp"
#include "verify/stress/check/distance.hpp"
#include "verify/stress/check/events.hpp"
#include "verify/stress/check/turn.hpp"
#include "verify/stress/draw/generator.hpp"
#include "verify/stress/draw/scene.hpp"
#include "verify/stress/shrink/shrink.hpp"

namespace monograin::stress_test {
namespace {

namespace fs = std::filesystem;

class StressScenes : public ::testing::Test {
 protected:
  StressScenes() { write_stress_tables(folder_.path()); }
  [[nodiscard]] const fs::path& tables() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

TEST_F(StressScenes, AreTheSameForTheSameSeedAndOthersForAnother) {
  for (const std::uint64_t index : {0U, 7U, 91U}) {
    const std::string text = scenario_text(draw_stress_scene(5, index, tables()));
    EXPECT_EQ(text, scenario_text(draw_stress_scene(5, index, tables())));
    EXPECT_NE(text, scenario_text(draw_stress_scene(6, index, tables())));
    EXPECT_NE(text, scenario_text(draw_stress_scene(5, index + 1, tables())));
  }
}

TEST_F(StressScenes, AreScenariosOfEveryModelOfTheCatalogue) {
  std::set<std::string> models;
  for (std::uint64_t index = 0; index < 300; ++index) {
    const std::string text = scenario_text(draw_stress_scene(2, index, tables()));
    try {
      models.insert(parse_stress_text(text, tables()).model);
    } catch (const ScenarioError& error) {
      ADD_FAILURE() << "scene " << index << ": " << error.what() << '\n' << text;
    }
  }
  for (const Model& model : model_catalogue()) EXPECT_TRUE(models.contains(std::string(model.name))) << model.name;
}

TEST_F(StressScenes, AreOfTheModelsThatAreAskedForAndTheSameInAnyOrder) {
  const Model* const hertz = find_model("hertz");
  const Model* const packing = find_model("packing");
  std::set<const Model*> drawn;
  for (std::uint64_t index = 0; index < 30; ++index) {
    const StressScene scene = draw_stress_scene(5, index, tables(), {packing, hertz});
    EXPECT_EQ(scene, draw_stress_scene(5, index, tables(), {hertz, packing}));
    drawn.insert(scene.model);
    EXPECT_EQ(draw_stress_scene(5, index, tables(), {packing}).model, packing);
  }
  EXPECT_EQ(drawn, (std::set{hertz, packing}));
}

TEST(StressReports, SayHowAFailingSceneIsDrawnAgain) {
  StressReport report;
  report.seed = 7;
  report.failures.emplace_back().index = 12;
  EXPECT_NE(report.text().find("monograin stress --seed 7 --first 12 --scenes 1"), std::string::npos);
  report.drawn_from = {find_model("mdr"), find_model("hertz")};
  EXPECT_NE(report.text().find("monograin stress --model hertz,mdr --seed 7 --first 12 --scenes 1"), std::string::npos);
}

/// The history of a run with one number changed.
Run with_number(Run run, const std::string& column, std::size_t row, double value) {
  const Table& whole = run.record.history;
  Table broken(whole.columns());
  for (std::size_t r = 0; r < whole.row_count(); ++r) {
    std::vector<double> values(whole.row(r).begin(), whole.row(r).end());
    if (r == row) values[*whole.find(column)] = value;
    broken.append(values);
  }
  run.record.history = broken;
  return run;
}

bool breaks(const std::vector<Violation>& violations, const std::string& check) {
  return std::ranges::any_of(violations, [&](const Violation& v) { return v.check == check; });
}

class BrokenHistory : public ::testing::Test {
 protected:
  monograin::Run run_ = run_scenario(parse_scenario(default_scenario_text(), "default", {"mdr.radius_rule=yielded"}));
  std::size_t row_ = run_.record.history.row_count() / 2;
};

TEST_F(BrokenHistory, IsNoneAsItWasRun) {
  EXPECT_TRUE(check_run(run_).empty());
  EXPECT_EQ(stated_end(run_), "complete");
}

TEST_F(BrokenHistory, IsFoundByTheRuleThatItBreaks) {
  const double radius = run_.scenario.radius;
  EXPECT_TRUE(breaks(check_run(with_number(run_, "axial.overlap", row_, std::nan(""))), "no-number"));
  EXPECT_TRUE(breaks(check_run(with_number(run_, "axial.force", row_, -1.0)), "tension"));
  const auto steps = run_.record.history.column("step");
  const auto start = static_cast<std::size_t>(std::ranges::find(steps, 2.0) - steps.begin());
  EXPECT_TRUE(breaks(check_run(with_number(run_, "axial.overlap", start, 0.9 * radius)), "jump"));
  EXPECT_TRUE(breaks(check_run(with_number(run_, "dissipation", row_, 1.0)), "energy-balance"));
  const double work = run_.record.history.column("work")[row_];
  const auto generous = with_number(with_number(run_, "stored_energy", row_, 1e3), "dissipation", row_, work - 1e3);
  EXPECT_TRUE(breaks(check_run(generous), "energy-made"));
  EXPECT_TRUE(breaks(check_run(with_number(run_, "apparent_radius", row_, 0.9 * radius)), "shrinking"));
  EXPECT_TRUE(breaks(check_run(with_number(run_, "time", row_, -1.0)), "time"));
  const std::size_t last = run_.record.history.row_count() - 1;
  EXPECT_TRUE(breaks(check_run(with_number(run_, "axial.displacement", last, 0.9 * radius)), "program"));
}

TEST_F(BrokenHistory, IsFoundWhereTheDissipationFallsWithoutAWarning) {
  const std::size_t last = run_.record.history.row_count() - 1;
  const double work = run_.record.history.column("work")[last];
  const double dissipation = run_.record.history.column("dissipation")[last];
  // Well above zero, and a thousandth of the work below what it was.
  const double fallen = dissipation - 1e-3 * work;
  ASSERT_GT(fallen, 0.1 * work);
  monograin::Run fell =
      with_number(with_number(run_, "dissipation", last, fallen), "stored_energy", last, work - fallen);
  EXPECT_TRUE(breaks(check_run(fell), "energy-made"));
  fell.record.creates_energy = true;
  EXPECT_FALSE(breaks(check_run(fell), "energy-made"));
}

TEST_F(BrokenHistory, IsFoundWhereWorkIsOutOfProportion) {
  run_.record.statistics.rhs_evaluations = 1'000'000;
  EXPECT_TRUE(breaks(check_run(run_), "work"));
}

TEST_F(BrokenHistory, IsFoundWhereARunEndsWithoutReason) {
  run_.record.status = RunStatus::failed;
  EXPECT_TRUE(breaks(check_run(run_), "solver"));
  run_.record.status = RunStatus::stopped;
  run_.record.limit = monograin::Limit::no_solution;
  EXPECT_TRUE(breaks(check_run(run_), "unstated-limit"));
  run_.record.limit = monograin::Limit::wall_at_centre;
  EXPECT_TRUE(check_run(run_).empty());
  // Round-off makes an integrator give up on a step; other ends do not follow from it.
  run_.record.status = RunStatus::failed;
  run_.record.limit.reset();
  run_.record.difficulty = monograin::Difficulty::below_resolution;
  run_.record.failure = monograin::Failure::no_step;
  EXPECT_TRUE(check_run(run_).empty());
  run_.record.failure = monograin::Failure::chattering;
  EXPECT_TRUE(breaks(check_run(run_), "solver"));
}

TEST(BrokenEnd, IsFoundWhereAWallThatTouchesHoldsTheCentre) {
  const auto pressed_against = [](std::string_view other) {
    return run_scenario(parse_scenario(fmt::format(R"(model = "hertz"
particle = {{ radius = 1 }}
material = {{ youngs_modulus = 1e9, poisson_ratio = 0.3 }}
[loading]
configuration = "walls"
centre = "equilibrium"
[[loading.wall]]
name = "top"
normal = [0, 0, 1]
steps = [{{ force = 1e4, duration = 1 }}]
[[loading.wall]]
name = "other"
{}
fixed = true
)",
                                                   other),
                                       "pressed.toml"));
  };
  monograin::Run held = pressed_against("normal = [0, 0, -1]");
  ASSERT_EQ(held.record.status, RunStatus::complete) << held.record.message;
  held.record.status = RunStatus::stopped;
  held.record.limit = monograin::Limit::centre_driven_away;
  EXPECT_TRUE(breaks(check_run(held), "held-centre"));
  const monograin::Run driven = pressed_against("normal = [1, 0, 0]");
  EXPECT_EQ(stated_end(driven), "centre-not-held") << driven.record.message;
  EXPECT_TRUE(check_run(driven).empty());
  const monograin::Run taken = pressed_against("normal = [0, 0, -1]\ngap = 1e-3");
  EXPECT_EQ(stated_end(taken), "complete") << taken.record.message;
}

constexpr std::string_view k_cell = R"(model = "mdr"
particle = { radius = 0.01 }
material = { youngs_modulus = 1e9, poisson_ratio = 0.3, yield_stress = 2e7 }
output = { points = 20 }
[loading]
configuration = "walls"
centre = "equilibrium"
[[loading.wall]]
name = "w0"
normal = [1, 0, 0]
fixed = true
[[loading.wall]]
name = "w1"
normal = [0.2, 1, 0]
fixed = true
[[loading.wall]]
name = "w2"
normal = [-1, 0, 0.3]
steps = [{ force = 100, duration = 1 }]
[[loading.wall]]
name = "w3"
normal = [0, -1, 0.4]
steps = [{ displacement = 1e-4, duration = 1 }]
[[loading.wall]]
name = "w4"
normal = [0, 0, -1]
fixed = true
)";

class CopiesOfAScene : public ::testing::Test {
 protected:
  CheckedScenario scenario_ = parse_scenario(k_cell, "cell.toml");
  monograin::Run run_ = run_scenario(scenario_);
};

TEST_F(CopiesOfAScene, AgreeWallByWallOnceTurnedBack) {
  ASSERT_EQ(run_.record.status, RunStatus::complete) << run_.record.message;
  const Eigen::Matrix3d rotation = stress_rotation(1);
  const monograin::Run copy = run_scenario(*turned(scenario_, rotation));
  const Table own = by_wall(run_).record.history;
  EXPECT_LT(distance_between(own, by_wall(copy, rotation).record.history).value, 1e-10);
  EXPECT_GT(distance_between(own, by_wall(copy).record.history).value, 1e-3) << "the centre moved with the walls";
  const monograin::Run other = run_scenario(*reordered(scenario_));
  EXPECT_EQ(other.classes.front().name, "w4");
  EXPECT_LT(distance_between(own, by_wall(other).record.history).value, 1e-10);
}

TEST_F(CopiesOfAScene, AgreeOnceTheMotionOfAllWallsIsAdded) {
  const SharedMotion motion = shared_motion(scenario_, 3).value();
  EXPECT_GT(motion.at(1.0).norm(), 1e-5);
  EXPECT_LT((motion.at(0.5) - 0.5 * motion.at(1.0)).norm(), 1e-18) << "at a constant velocity";
  const monograin::Run copy = run_scenario(carried(scenario_, motion));
  ASSERT_EQ(copy.record.status, RunStatus::complete) << copy.record.message;
  EXPECT_LT(distance_between(by_wall(run_, motion).record.history, by_wall(copy).record.history).value, 1e-10);
  const Distance still = distance_between(by_wall(run_).record.history, by_wall(copy).record.history);
  EXPECT_GT(still.value, 0.1) << "the walls move";
}

TEST_F(CopiesOfAScene, AreCarriedOnlyWhereTheProgramSaysWhenAStepEnds) {
  const auto until = [](std::string_view end) {
    return parse_scenario(k_cell, "cell.toml", {fmt::format("loading.wall[3].steps[0].{}", end)});
  };
  EXPECT_TRUE(shared_motion(until("duration=1"), 3));
  EXPECT_FALSE(shared_motion(until("until={force=1}"), 3));
}

TEST_F(CopiesOfAScene, TellEventsByTheWallsOfTheirClasses) {
  const CheckedScenario die = parse_scenario(default_scenario_text(), "default");
  const monograin::Run run = by_wall(run_scenario(die));
  const monograin::Run copy = by_wall(run_scenario(*turned(die, stress_rotation(2))));
  EXPECT_EQ(sorted_events(run), sorted_events(copy));
  EXPECT_TRUE(run.record.history.find("lateral-x+.force")) << "a column for each wall";
}

TEST_F(CopiesOfAScene, BreakARuleWhereAStopIsNotShared) {
  const auto is_first = [](const CheckedScenario& of, std::string_view name) {
    return of.loading.configuration == Loading::Configuration::walls && of.loading.walls.front().name == name;
  };
  const auto stopped = [](monograin::Run run) {
    run.record.status = RunStatus::stopped;
    run.record.limit = monograin::Limit::wall_at_centre;
    return run;
  };
  const auto checks_with = [&](const RunMaker& make_run) {
    std::set<std::string> broken;
    for (const Violation& violation : check_scene(scenario_, {.seconds = 60.0, .make_run = make_run}).violations) {
      broken.insert(violation.check);
    }
    return broken;
  };
  EXPECT_TRUE(checks_with(run_scenario).empty());
  // A limit that depends on where the walls stand.
  EXPECT_EQ(checks_with([&](const CheckedScenario& of, const SystemWrapper& wrap) {
              const bool stands_there = of.loading.walls.front().normal[1] == 0.0;
              return stands_there && is_first(of, "w0") ? stopped(run_scenario(of, wrap)) : run_scenario(of, wrap);
            }),
            (std::set<std::string>{"order", "turned"}));
  // One that depends on the order of the walls.
  EXPECT_EQ(checks_with([&](const CheckedScenario& of, const SystemWrapper& wrap) {
              return is_first(of, "w4") ? stopped(run_scenario(of, wrap)) : run_scenario(of, wrap);
            }),
            (std::set<std::string>{"order"}));
  // One that depends on the size of the particle.
  EXPECT_EQ(checks_with([&](const CheckedScenario& of, const SystemWrapper& wrap) {
              return of.radius > 1.0 ? stopped(run_scenario(of, wrap)) : run_scenario(of, wrap);
            }),
            (std::set<std::string>{"scale"}));
  // One that depends on a wall at rest.
  EXPECT_EQ(checks_with([&](const CheckedScenario& of, const SystemWrapper& wrap) {
              return of.loading.walls.front().is_fixed ? run_scenario(of, wrap) : stopped(run_scenario(of, wrap));
            }),
            (std::set<std::string>{"carried"}));
  // One of an integrated form.
  EXPECT_EQ(checks_with([&](const CheckedScenario& of, const SystemWrapper& wrap) {
              return of.numerics.integrator == "ida" ? stopped(run_scenario(of, wrap)) : run_scenario(of, wrap);
            }),
            (std::set<std::string>{"form"}));
}

TEST_F(CopiesOfAScene, BreakARuleWhereAStopComesAtAnotherTime) {
  scenario_ =
      parse_scenario(k_cell, "cell.toml", {"loading.wall[3].steps[0].displacement=0.02", "loading.centre=fixed"});
  ASSERT_EQ(run_scenario(scenario_).record.status, RunStatus::stopped);
  EXPECT_TRUE(check_scene(scenario_).violations.empty()) << check_scene(scenario_).violations.front().detail;
  const auto earlier = [](const CheckedScenario& of, const SystemWrapper& wrap) {
    monograin::Run run = run_scenario(of, wrap);
    if (of.loading.walls.front().name != "w4") return run;
    Table shorter(run.record.history.columns());
    for (std::size_t row = 0; row + 4 < run.record.history.row_count(); ++row)
      shorter.append(run.record.history.row(row));
    run.record.history = shorter;
    return run;
  };
  const StressVerdict verdict = check_scene(scenario_, {.seconds = 60.0, .make_run = earlier});
  ASSERT_EQ(verdict.violations.size(), 1U);
  EXPECT_EQ(verdict.violations.front().check, "order");
  EXPECT_NE(verdict.violations.front().detail.find("of a step apart"), std::string::npos);
}

TEST_F(BrokenHistory, IsFarFromTheWholeOne) {
  const auto output = *run_.record.history.find("row");
  const auto force = *run_.record.history.find("axial.force");
  for (row_ = 0; run_.record.history.at(row_, output) != 0.0 || run_.record.history.at(row_, force) <= 0.0;) ++row_;
  const double value = run_.record.history.at(row_, force);
  const auto other = with_number(run_, "axial.force", row_, 1.01 * value);
  const Distance apart = distance_between(run_.record.history, other.record.history);
  EXPECT_EQ(apart.column, "axial.force");
  EXPECT_GT(apart.value, 0.0);
  EXPECT_LE(apart.value, 0.01 + 1e-12);
  EXPECT_EQ(distance_between(run_.record.history, run_.record.history).value, 0.0);
  EXPECT_GT(distance_between(run_.record.history, run_.record.history, {}, {.length = 2.0}).value, 0.5);
}

TEST(BrokenMaterialPoint, IsFoundByTheRuleThatItBreaks) {
  const monograin::Run run = run_scenario(read_scenario(MONOGRAIN_SOURCE_DIR "/scenarios/material-point.toml"));
  const std::size_t row = run.record.history.row_count() / 2;
  EXPECT_TRUE(check_run(run).empty()) << check_run(run).front().detail;
  EXPECT_TRUE(breaks(check_run(with_number(run, "p", row, 0.0)), "stress-invariants"));
  EXPECT_TRUE(breaks(check_run(with_number(run, "yield_function", row, 0.1)), "yield"));
  EXPECT_TRUE(breaks(check_run(with_number(run, "relative_density", row, 0.9)), "mass"));
  EXPECT_TRUE(breaks(check_run(with_number(run, "relative_density", row, 1.1)), "density"));
}

TEST(BrokenPacking, IsFoundByTheRuleThatItBreaks) {
  const monograin::Run run = run_scenario(read_scenario(MONOGRAIN_SOURCE_DIR "/scenarios/packing.toml"));
  const std::size_t row = run.record.history.row_count() / 2;
  EXPECT_TRUE(check_run(run).empty()) << check_run(run).front().detail;
  EXPECT_TRUE(breaks(check_run(with_number(run, "packing_fraction", row, 1.1)), "density"));
  EXPECT_TRUE(breaks(check_run(with_number(run, "stress", row, -1e6)), "tension"));
  EXPECT_TRUE(breaks(check_run(with_number(run, "plastic_fraction", row, 1.5)), "plastic-fraction"));
  EXPECT_TRUE(breaks(check_run(with_number(run, "plastic_fraction", row, 0.0)), "shrinking"));
}

TEST_F(StressScenes, ShrinkToWhatIsFaulty) {
  StressScene scene = draw_stress_scene(1, 0, tables());
  scene.model = find_model("mdr");
  scene.material = {{"youngs_modulus", 1.0}, {"poisson_ratio", 0.2837}, {"yield_stress", 0.0123456}};
  scene.options = {{"radius_rule", std::string("seed")}, {"strict", true}};
  scene.configuration = "die";
  scene.cycles = 12;
  scene.radius = 3.217e-4;
  scene.steps.clear();
  for (const double target : {0.123, 0.0456, 0.3019, 0.2004, 0.1})
    scene.steps.push_back({.target = target, .lateral = {}, .until = {}, .until_event = {}});
  // Faulty is what goes farther than 0.3 and then back.
  const auto is_faulty = [](const StressScene& candidate) {
    for (std::size_t i = 1; i < candidate.steps.size(); ++i) {
      if (candidate.steps[i - 1].target > 0.25 && candidate.steps[i].target < candidate.steps[i - 1].target)
        return true;
    }
    return false;
  };
  ASSERT_TRUE(is_faulty(scene));
  const StressScene small = shrink(scene, is_faulty);
  EXPECT_TRUE(is_faulty(small));
  EXPECT_EQ(small.steps.size(), 2U);
  EXPECT_EQ(small.steps[0].target, 0.3);
  EXPECT_EQ(small.cycles, 1);
  EXPECT_TRUE(small.options.empty());
  EXPECT_EQ(small.radius, 1.0);
  EXPECT_EQ(small.material.at("yield_stress"), 0.01);
}

TEST_F(StressScenes, ThatTakeTooLongBreakARule) {
  const CheckedScenario scenario = parse_stress_text(scenario_text(draw_stress_scene(33, 0, tables())), tables());
  EXPECT_TRUE(check_scene(scenario).violations.empty());
  const StressVerdict verdict = check_scene(scenario, {.seconds = 0.0});
  ASSERT_EQ(verdict.violations.size(), 1U);
  EXPECT_EQ(verdict.violations.front().check, k_time_rule);
}

TEST(StressTestRuns, GiveTheSameReportWhateverTheNumberOfThreads) {
  const TemporaryFolder folder;
  const auto report = [&](int threads) {
    const fs::path target = folder.path() / std::to_string(threads);
    const StressReport found =
        run_stress({.seed = 33, .seconds = 300.0, .scenes = 40, .threads = threads, .folder = target, .progress = {}});
    EXPECT_EQ(found.text(), read_text(target / "report.txt"));
    return found.text();
  };
  EXPECT_EQ(report(1), report(3));
}

TEST(StressTestRuns, PassEightyScenes) {
  const TemporaryFolder folder;
  const StressReport report = run_stress(
      {.seed = 33, .seconds = 600.0, .scenes = 80, .threads = 0, .folder = folder.path() / "stress", .progress = {}});
  EXPECT_EQ(report.scenes, 80U);
  EXPECT_TRUE(report.failures.empty()) << report.text();
}

}  // namespace
}  // namespace monograin::stress_test
