// Properties that guards state about themselves.

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/test_run.hpp"

namespace monograin::guards_test {
namespace {

/// A system at the end of a run, which can go on.
class Onward {
 public:
  explicit Onward(const CheckedScenario& scenario) : run_(run(scenario)), y_(system().unknowns().size()) {
    y_[0] = run_.last("apparent_radius") - 1.0;
  }
  [[nodiscard]] HybridSystem& system() { return *run_.scene.system; }

  /// Begins the step that takes the first class to a displacement; the others stay.
  void begin(double displacement) {
    std::vector<Ramp> ramps;
    for (const ContactClass& contact_class : system().classes()) {
      const double now = run_.last(contact_class.name + ".displacement");
      ramps.push_back({now, ramps.empty() ? displacement : now});
    }
    std::vector<Event> log;
    system().begin_step(ramps, y_, log);
  }

  /// Guards at so many places of the step, a row each.
  [[nodiscard]] std::vector<std::vector<double>> guards(int places) {
    std::vector<std::vector<double>> rows;
    for (int j = 0; j <= places; ++j) {
      const double xi = static_cast<double>(j) / places;
      rows.emplace_back(system().guards().size());
      system().solve(xi, y_);
      system().guard_values(xi, y_, rows.back());
    }
    return rows;
  }

 private:
  TestRun run_;
  std::vector<double> y_;
};

bool all_go_one_way(Onward& onward) {
  const auto guards = onward.system().guards();
  return !guards.empty() && std::ranges::all_of(guards, &Guard::is_monotone);
}

std::vector<CheckedScenario> loaded() {
  std::vector<CheckedScenario> result;
  for (const double modulus_over_yield : {6.25, 50.0, 1e4}) {
    for (const auto configuration : {Configuration::simple, Configuration::die, Configuration::hydrostatic}) {
      for (const double surface_energy : {0.0, 1e-5}) {
        CheckedScenario scenario = mdr_scenario(configuration, modulus_over_yield, 0.3, path({0.16}));
        scenario.material["surface_energy"] = surface_energy;
        result.push_back(scenario);
      }
    }
  }
  return result;
}

TEST(MdrGuards, ThatGoOneWayDoSoToTheEndOfTheStep) {
  for (const CheckedScenario& scenario : loaded()) {
    for (const double target : {0.1599, 0.1, 0.0}) {
      Onward onward(scenario);
      onward.begin(target);
      EXPECT_TRUE(all_go_one_way(onward)) << describe(scenario);
      const auto rows = onward.guards(200);
      for (std::size_t g = 0; g < rows.front().size(); ++g) {
        const double way = rows.back()[g] - rows.front()[g];
        for (std::size_t row = 1; row < rows.size(); ++row) {
          const double step = rows[row][g] - rows[row - 1][g];
          EXPECT_GE(way > 0.0 ? step : -step, -1e-12 * std::abs(way))
              << onward.system().guards()[g].name << ", row " << row << ", to " << target << ", " << describe(scenario);
        }
      }
    }
  }
}

TEST(MdrGuards, ObserveCapsOnlyWhereTheyMayMeet) {
  const CheckedScenario scenario = mdr_scenario(Configuration::die, 50.0, 0.3, path({0.3}));
  const auto observes_caps = [&](double displacement) {
    Onward onward(scenario);
    onward.begin(displacement);
    return std::ranges::any_of(onward.system().guards(), [](const Guard& g) { return g.name == "caps-intersect"; });
  };
  EXPECT_TRUE(observes_caps(0.31));   // the radius grows
  EXPECT_FALSE(observes_caps(0.29));  // the axial caps shrink
}

TEST(MdrGuards, DoNotSayThatTheyGoOneWayWhereTheRadiusGrowsOrForcesAreGiven) {
  const CheckedScenario scenario = mdr_scenario(Configuration::die, 50.0, 0.3, path({0.16}));
  Onward grows(scenario);
  grows.begin(0.2);
  EXPECT_FALSE(all_go_one_way(grows));
  const CheckedScenario pressed = mdr_scenario(Configuration::simple, 50.0, 0.3, {force_ramp(0.01), force_ramp(0.005)});
  EXPECT_FALSE(std::ranges::any_of(run(pressed).scene.system->guards(), &Guard::is_monotone));
}

}  // namespace
}  // namespace monograin::guards_test
