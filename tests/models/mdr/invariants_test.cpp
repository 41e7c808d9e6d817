// Changes that must not affect a curve of the MDR model, and properties of every curve.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "elastic/hertz.hpp"
#include "history/profile.hpp"
#include "mdr/system.hpp"
#include "models/accuracy.hpp"
#include "support/deviation.hpp"
#include "support/test_run.hpp"

namespace monograin::invariants_test {
namespace {

// A die that is loaded, unloaded until its axial walls separate, and loaded beyond: every regime and most events.
CheckedScenario die_cycle() { return mdr_scenario(Configuration::die, 20.0, 0.3, path({0.3, 0.2, 0.35})); }

// Three pairs of walls one after another; while the second and the third load, the pairs before retreat a little.
CheckedScenario triaxial_sequence() {
  const std::vector<std::vector<double>> programs{
      {0.20, 0.195, 0.19, 0.22}, {0.0, 0.20, 0.19, 0.22}, {0.0, 0.0, 0.20, 0.22}};
  std::vector<WallSpec> walls;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    const Eigen::Vector3d normal = Eigen::Vector3d::Unit(axis);
    const auto& program = programs[static_cast<std::size_t>(axis)];
    walls.push_back(wall(name + "+", normal, path(program)));
    walls.push_back(wall(name + "-", -normal, path(program)));
  }
  return between(mdr_scenario(Configuration::walls, 50.0, 0.25, {}), std::move(walls));
}

void expect_same_table(const Table& actual, const Table& expected, std::size_t first_column) {
  ASSERT_EQ(actual.row_count(), expected.row_count());
  for (std::size_t row = 0; row < actual.row_count(); ++row) {
    for (std::size_t c = first_column; c < actual.columns().size(); ++c) {
      ASSERT_EQ(actual.at(row, c), expected.at(row, c)) << actual.columns()[c].name << " in row " << row;
    }
  }
}

TEST(MdrInvariance, RateDoesNotMatter) {
  for (const char* integrator : k_integrators) {
    const TestRun normal = run(die_cycle(), integrator);
    for (const double duration : {1e-9, 1e9}) {
      CheckedScenario scenario = die_cycle();
      for (Step& step : scenario.loading.steps) step.duration = duration;
      // Bit for bit: within a step only the output column depends on seconds.
      expect_same_table(run(scenario, integrator).record.history, normal.record.history, 1);
    }
  }
}

TEST(MdrInvariance, UnitsDoNotMatter) {
  const TestRun unit = run(die_cycle());
  for (const double length : {1e-6, 1e6}) {
    for (const double stress : {1e-6, 1e6}) {
      CheckedScenario scenario = die_cycle();
      scenario.radius *= length;
      scenario.material["youngs_modulus"] *= stress;
      scenario.material["yield_stress"] *= stress;
      for (Step& step : scenario.loading.steps) step.target *= length;
      const TestRun scaled = run(scenario);
      EXPECT_EQ(scaled.events(), unit.events());
      const double force = stress * length * length;
      for (const auto& [column, scale] :
           {std::pair("axial.force", force), std::pair("lateral.force", force), std::pair("apparent_radius", length),
            std::pair("lateral.overlap", length), std::pair("work", force * length),
            std::pair("stored_energy", force * length)}) {
        std::vector<double> values = scaled.outputs(column);
        for (double& value : values) value /= scale;
        // Round-off of the scaled input, amplified by the steep unloading branch (factor 8.5) and the lateral overlaps.
        EXPECT_LE(difference(values, unit.outputs(column)), 1e-13)
            << column << ", lengths x " << length << ", stresses x " << stress;
      }
    }
  }
}

TEST(MdrInvariance, UnitsDoNotMatterToTheSurfaceUnderAContact) {
  const double length = 1e-6;
  const double stress = 1e9;
  CheckedScenario scenario = die_cycle();
  const Table unit = contact_profiles(scenario, 1.2);
  scenario.radius *= length;
  scenario.material["youngs_modulus"] *= stress;
  scenario.material["yield_stress"] *= stress;
  for (Step& step : scenario.loading.steps) step.target *= length;
  const Table scaled = contact_profiles(scenario, 1.2);
  ASSERT_EQ(scaled.row_count(), unit.row_count());
  for (const auto& [column, scale] : {std::pair("radius", length), std::pair("pressure", stress),
                                      std::pair("displacement", length), std::pair("relaxed_height", length)}) {
    const std::vector<double> expected = unit.column(column);
    const std::vector<double> values = scaled.column(column);
    const double largest_value = largest(expected);
    EXPECT_GT(largest_value, 0.0) << column;
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (std::isnan(expected[k])) {
        EXPECT_TRUE(std::isnan(values[k])) << column << ", row " << k;
      } else {
        EXPECT_NEAR(values[k] / scale, expected[k], 1e-11 * largest_value) << column << ", row " << k;
      }
    }
  }
}

TEST(MdrInvariance, RotationOfTheWallsDoesNotMatter) {
  const Eigen::Quaterniond rotation = Eigen::Quaterniond(0.3, -0.5, 0.7, 0.2).normalized();
  for (const CheckedScenario& original : {triaxial_sequence(), die_cycle()}) {
    std::vector<WallSpec> walls = written_out(original);
    for (WallSpec& w : walls) {
      w = wall(w.name, rotation * Eigen::Vector3d(w.normal[0], w.normal[1], w.normal[2]), w.steps);
    }
    const TestRun expected = run(original);
    const TestRun rotated = run(between(original, walls));
    EXPECT_EQ(rotated.scene.classes.size(), expected.scene.classes.size());
    // Normals enter only the angles between caps. These end pieces and so change guesses, and R is a root up to
    // round-off.
    EXPECT_LE(difference(rotated, expected), 16 * k_epsilon);
  }
}

TEST(MdrInvariance, OrderOfTheWallsDoesNotMatter) {
  const CheckedScenario original = triaxial_sequence();
  const TestRun expected = run(original);
  CheckedScenario shuffled = original;
  std::vector<WallSpec>& walls = shuffled.loading.walls;
  std::ranges::rotate(walls, walls.begin() + 3);
  std::swap(walls[0], walls[2]);
  const TestRun actual = run(shuffled);
  for (const char* axis : {"x", "y", "z"}) {
    const auto force = [axis](const TestRun& result) {
      for (const ContactClass& c : result.scene.classes) {
        if (c.name.starts_with(axis)) return result.outputs(c.name + ".force");
      }
      return std::vector<double>{};
    };
    EXPECT_LE(difference(force(actual), force(expected)), 1e-13) << axis;  // sums in another order
  }
  EXPECT_LE(difference(actual.outputs("work"), expected.outputs("work")), 1e-13);
}

TEST(MdrInvariance, ClassesGiveTheCurveOfTheFullWallSet) {
  const CheckedScenario hydrostatic = mdr_scenario(Configuration::hydrostatic, 50.0, 0.25, path({0.16, 0.14, 0.17}));
  for (const CheckedScenario& scenario : {die_cycle(), hydrostatic, triaxial_sequence()}) {
    const TestRun reduced = run(scenario);
    const TestRun full = run(scenario, "direct", {}, false);
    ASSERT_LT(reduced.scene.classes.size(), full.scene.classes.size());
    // Sums over six walls instead of products with a multiplicity.
    for (const char* column : {"apparent_radius", "volume", "work", "stored_energy", "dissipation"}) {
      EXPECT_LE(difference(full.outputs(column), reduced.outputs(column)), 1e-13)
          << column << ", " << describe(scenario);
    }
    for (std::size_t c = 0; c < reduced.scene.classes.size(); ++c) {
      const auto force = reduced.outputs(reduced.scene.classes[c].name + ".force");
      for (const std::string& w : reduced.scene.walls[c]) {
        const auto found = std::ranges::find(full.scene.walls, std::vector<std::string>{w});
        const std::string& name = full.scene.classes[static_cast<std::size_t>(found - full.scene.walls.begin())].name;
        EXPECT_LE(difference(full.outputs(name + ".force"), force), 1e-13) << w << ", " << describe(scenario);
      }
    }
  }
}

TEST(MdrInvariance, UnloadingAndReloadingIsAClosedLoopWhileTheRadiusRests) {
  for (const char* rule : {"gated", "yielded"}) {
    CheckedScenario scenario =
        with(mdr_scenario(Configuration::die, 20.0, 0.3, path({0.35, 0.345, 0.35})), "radius_rule", rule);
    const TestRun result = run(scenario);
    const auto force = result.outputs("axial.force");
    const auto work = result.outputs("work");
    const std::size_t top = 50;
    for (std::size_t k = 1; k <= 50; ++k) {
      // A displacement of one round-off on a steep branch: 8.5 times the slope of the primary branch, which is of order
      // 1.
      EXPECT_NEAR(force[top + 50 + k], force[top + 50 - k], 20 * k_epsilon * force[top]) << rule << ", row " << k;
    }
    EXPECT_NEAR(work[top + 100], work[top], 20 * k_epsilon * work[top]) << rule;
    EXPECT_EQ(result.outputs("apparent_radius")[top + 100], result.outputs("apparent_radius")[top]) << rule;
  }
}

// --- along one curve

/// Defect of the volume balance, which the implicit form has in its first row; 0 while the radius is held.
double balance_defect(HybridSystem& system, double xi, std::span<const double> y) {
  const std::vector<double> dy(y.size(), 0.0);
  std::vector<double> residual(y.size());
  system.residual(xi, y, dy, residual);
  return residual.front();
}

/// Largest drift of the volume balance at the ends of all internal steps of one ramp.
double largest_drift(const CheckedScenario& scenario, std::string_view integrator, double rtol) {
  const Scene scene = make_scene(scenario);
  HybridSystem& system = *scene.system;
  std::vector<double> y(system.unknowns().size());
  std::vector<Event> log;
  std::vector<Ramp> ramps;
  for (const Channel& channel : scene.channels) {
    ramps.push_back({0.0, channel.program.empty() ? 0.0 : channel.program[0].target});
  }
  system.start(y);
  system.begin_step(ramps, y, log);
  GuardSet watch(system);
  watch.begin_leg({}, 0.0, y);
  const auto integrator_used = make_integrator(integrator, system, watch, relative(rtol));
  double worst = 0.0;
  double xi = 0.0;
  while (xi < 1.0) {
    integrator_used->begin(xi, y);
    bool hit_guard = false;
    while (xi < 1.0 && !hit_guard) {
      const auto advance = integrator_used->advance();
      xi = advance.xi;
      hit_guard = advance.hit_guard;
      integrator_used->dense_output(xi, y);
      worst = std::max(worst, deviation(balance_defect(system, xi, y), 0.0));
    }
    if (hit_guard) {
      const std::vector<std::size_t> fired(integrator_used->fired().begin(), integrator_used->fired().end());
      system.fire(fired, xi, y, log);
      watch.renew();
    }
  }
  return worst;
}

TEST(MdrVolumeBalance, DriftsByNoMoreThanTheTolerance) {
  for (const char* rule : {"gated", "yielded", "seed"}) {
    const CheckedScenario scenario =
        with(mdr_scenario(Configuration::die, 20.0, 0.3, path({0.4})), "radius_rule", rule);
    EXPECT_LE(largest_drift(scenario, "direct", 1e-8), 1e-15) << rule;  // rounding of the balance itself
    for (const char* integrator : {"cvode-adams", "cvode-bdf", "ida"}) {
      for (const double rtol : {1e-6, 1e-8, 1e-10}) {
        EXPECT_LE(largest_drift(scenario, integrator, rtol), rtol) << rule << ", " << integrator << ", rtol = " << rtol;
      }
    }
  }
}

struct YieldRow {
  double modulus_over_yield;
  double jump;  ///< of the force with the ellipse, as the spec prints it
  double printed;
};

TEST(MdrYield, ForceJumpsWithTheEllipseOnly) {
  for (const YieldRow& row :
       {YieldRow{6.25, 0.021, 5e-4}, YieldRow{20.0, 0.0047, 5e-5}, YieldRow{200.0, 6.5e-5, 5e-7}}) {
    for (const char* profile : {"ellipse", "parabola"}) {
      const CheckedScenario scenario = with(
          mdr_scenario(Configuration::simple, row.modulus_over_yield, 0.3, path({0.3})), "elastic_profile", profile);
      const TestRun result = run(scenario);
      const double yield = result.time_of("yield");
      const auto time = result.column("time");
      const auto force = result.column("axial.force");
      const auto before = static_cast<std::size_t>(std::ranges::find(time, yield) - time.begin());
      const auto after =
          static_cast<std::size_t>(std::ranges::find(time.rbegin(), time.rend(), yield).base() - time.begin()) - 1;
      const double jump = force[after] / force[before] - 1.0;
      if (profile == std::string("parabola")) {
        EXPECT_NEAR(jump, 0.0, 1e-12) << describe(scenario);  // located to 1e-15 of a step; c from the root of eq. 41
        continue;
      }
      EXPECT_NEAR(jump, row.jump, row.printed) << describe(scenario);
      // Plastic force and Hertz's are the same at yield, so the jump is that between the two elastic profiles.
      const double overlap = result.at_event("yield", "axial.overlap");
      const double radius = result.at_event("yield", "apparent_radius");
      const double modulus = composite_modulus(1.0, 0.3);
      const double hertz = hertz_force(modulus, radius, overlap);
      const double ellipse = mdr::elastic_contact(mdr::ElasticProfile::ellipse, modulus, radius, overlap).force;
      EXPECT_NEAR(jump, hertz / ellipse - 1.0, 1e-12) << describe(scenario);
    }
  }
}

}  // namespace
}  // namespace monograin::invariants_test
