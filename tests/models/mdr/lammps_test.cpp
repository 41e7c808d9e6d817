// Comparison with an independent implementation of the model: single-particle curves of LAMMPS (see the files'
// headers).

#include <gtest/gtest.h>

#include <cmath>

#include "history/table.hpp"
#include "support/reference_case.hpp"
#include "support/test_run.hpp"

namespace monograin::lammps_test {
namespace {

/// A curve over the path length of the walls, which grows from row to row.
struct PeerCurve {
  Table table;
  std::vector<double> path_lengths;
};

PeerCurve load(const std::string& name) {
  PeerCurve curve{read_csv(test_file("models/mdr/lammps/" + name + ".csv")), {0.0}};
  const std::vector<double> displacements = curve.table.column("delta_o_over_R0");
  for (std::size_t i = 1; i < displacements.size(); ++i) {
    curve.path_lengths.push_back(curve.path_lengths.back() + std::abs(displacements[i] - displacements[i - 1]));
  }
  return curve;
}

/// Ramps at unit speed, so that time equals path length.
std::vector<Step> at_unit_speed(const std::vector<double>& displacements) {
  std::vector<Step> steps;
  double from = 0.0;
  for (const double to : displacements) {
    steps.push_back(ramp(to, std::abs(to - from)));
    from = to;
  }
  return steps;
}

TestRun run_along(const PeerCurve& curve, CheckedScenario scenario, const char* radius_rule) {
  scenario.output.times.assign(curve.path_lengths.begin() + 1, curve.path_lengths.end());
  return run(with(scenario, "radius_rule", radius_rule));
}

TEST(MdrAgainstLammps, UniaxialForceIsTheSame) {
  const PeerCurve curve = load("mdr_uniaxial_EY100");
  const CheckedScenario scenario = mdr_scenario(Configuration::simple, 100.0, 0.3, at_unit_speed({0.30, 0.24, 0.32}));
  for (const char* rule : {"gated", "yielded"}) {
    const TestRun ours = run_along(curve, scenario, rule);
    // The peer's curves are extrapolated to zero step with an error of some 1e-6 (file header).
    EXPECT_LE(difference(ours.outputs("axial.force"), curve.table.column("F_z_h0_without_wall_factor")), 1e-5) << rule;
  }
}

struct PeerRow {
  const char* radius_rule;
  double axial, lateral;  ///< deviations in the table that compares the three rules with the peer
  double printed_axial, printed_lateral;
};

TEST(MdrAgainstLammps, DieForcesDifferAsTabulated) {
  const PeerCurve curve = load("mdr_die_EY40_nu02");
  const CheckedScenario scenario = mdr_scenario(Configuration::die, 40.0, 0.2, at_unit_speed({0.32, 0.24}));
  // With `yielded`, what is left is of second order in 1 - V/V0: the peer lets all contacts into the volume of its
  // growth law, and R grow on unloading.
  for (const PeerRow& row : {PeerRow{"gated", 2.2e-3, 1.2e-2, 5e-5, 5e-4}, PeerRow{"seed", 2.2e-3, 1.2e-2, 5e-5, 5e-4},
                             PeerRow{"yielded", 1.9e-3, 6.1e-4, 5e-5, 5e-6}}) {
    const TestRun ours = run_along(curve, scenario, row.radius_rule);
    const double axial = difference(ours.outputs("axial.force"), curve.table.column("F_z_h0_without_wall_factor"));
    const double lateral = difference(ours.outputs("lateral.force"), curve.table.column("F_x_h0_without_wall_factor"));
    EXPECT_NEAR(axial, row.axial, row.printed_axial) << row.radius_rule;
    EXPECT_NEAR(lateral, row.lateral, row.printed_lateral) << row.radius_rule;
  }
}

TEST(MdrAgainstLammps, RatchetOfTheSeedsRuleIsNotTheirs) {
  const PeerCurve curve = load("mdr_uniaxial_EY100");
  const CheckedScenario scenario = mdr_scenario(Configuration::simple, 100.0, 0.3, at_unit_speed({0.30, 0.24, 0.32}));
  const TestRun ours = run_along(curve, scenario, "seed");
  EXPECT_NEAR(difference(ours.outputs("axial.force"), curve.table.column("F_z_h0_without_wall_factor")), 0.13, 5e-3);
}

}  // namespace
}  // namespace monograin::lammps_test
