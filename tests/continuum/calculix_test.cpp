#include "continuum/calculix.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <numbers>
#include <set>
#include <sstream>

#include "support/refusal.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"

namespace monograin {
namespace {

SectorProblem die_problem() {
  constexpr double k_angle = std::numbers::pi / 4.0;
  return {.sector = {.angle = k_angle, .is_axisymmetric = false, .walls = {{2, 0, 8.0}, {0, 1, 4.0}}},
          .mesh = sector_mesh({16, 4, 1.0}, k_angle),
          .material = {.youngs_modulus = 2e9, .poisson_ratio = 0.3, .flow = {{0.0, 4e7}, {0.1, 6e7}}},
          .instants = {{0.01, 0.0}, {0.02, 0.005}}};
}

TEST(CalculixInput, HasAStepForEachInstantInWhichTheWallsMoveInward) {
  const std::string text = calculix_input(die_problem());
  EXPECT_TRUE(contains(text, "*BOUNDARY\nWALL0,3,3,-0.1\nWALL1,1,1,-0\n"));
  EXPECT_TRUE(contains(text, "*BOUNDARY\nWALL0,3,3,-0.2\nWALL1,1,1,-0.05\n"));
}

TEST(CalculixInput, ScalesTheFlowCurveToItsOwnUnits) {
  EXPECT_TRUE(contains(calculix_input(die_problem()), "*ELASTIC\n1000,0.3\n*PLASTIC\n20,0\n30,0.1\n*SOLID"));
  SectorProblem elastic = die_problem();
  elastic.material.flow.clear();
  EXPECT_TRUE(contains(calculix_input(elastic), "*PLASTIC\n10000,0.\n*SOLID"));
}

TEST(CalculixInput, NumbersEveryNodeAndElementOnce) {
  std::istringstream lines(calculix_input(die_problem()));
  std::set<std::string> nodes;
  std::set<std::string> elements;
  std::string line;
  std::string keyword;
  while (std::getline(lines, line)) {
    if (line.starts_with('*')) {
      keyword = line.substr(0, line.find(','));
      continue;
    }
    const std::string number = line.substr(0, line.find(','));
    if (keyword != "*NODE" && keyword != "*ELEMENT") continue;
    EXPECT_TRUE((keyword == "*NODE" ? nodes : elements).insert(number).second) << line;
  }
  EXPECT_GT(elements.size(), die_problem().mesh.bricks.size());
  EXPECT_GT(nodes.size(), die_problem().mesh.nodes.size());
}

/// The file .dat of a solution in which every node moves inward by a fiftieth of its position.
std::string shrunk(const SectorProblem& problem, int instants) {
  std::set<std::size_t> nodes;
  for (const auto& line : problem.mesh.surface) nodes.insert(line.begin(), line.end());
  std::string text;
  for (int i = 1; i <= instants; ++i) {
    text += fmt::format("\n displacements (vx,vy,vz) for set SURFACE and time  0.{}000000E+01\n\n", i);
    for (const std::size_t node : nodes) {
      const Eigen::Vector3d u = -0.02 * 10.0 * problem.mesh.nodes[node];
      text += fmt::format("{:10} {:13.6E} {:13.6E} {:13.6E}\n", node + 1, u.x(), u.y(), u.z());
    }
    for (const int wall : {0, 1}) {
      text += fmt::format("\n total force (fx,fy,fz) for set WALL{} and time  0.{}000000E+01\n\n", wall, i);
      text +=
          fmt::format("{:13.6E} {:13.6E} {:13.6E}\n", wall == 1 ? -50.0 * i : 3.0, 0.0, wall == 0 ? -200.0 * i : 3.0);
    }
  }
  return text;
}

TEST(ReadStates, FindsPositionsAndForcesOfEveryInstant) {
  const SectorProblem problem = die_problem();
  const std::vector<SectorState> states = read_states(shrunk(problem, 2), problem);
  ASSERT_EQ(states.size(), 2U);
  EXPECT_DOUBLE_EQ(states[1].forces[0], 400.0 / 1e5);
  EXPECT_DOUBLE_EQ(states[1].forces[1], 100.0 / 1e5);
  std::size_t i = 0;
  for (const auto& line : problem.mesh.surface) {
    for (const std::size_t node : line) {
      EXPECT_LT((states[1].surface[i] - 0.98 * problem.mesh.nodes[node]).norm(), 1e-6);
      ++i;
    }
  }
}

TEST(ReadStates, LeavesOutAnInstantThatIsNotComplete) {
  const SectorProblem problem = die_problem();
  std::string text = shrunk(problem, 2);
  text.resize(text.rfind(" total force"));
  EXPECT_EQ(read_states(text, problem).size(), 1U);
  EXPECT_EQ(read_states("", problem).size(), 0U);
}

/// A program in the place of CalculiX that writes a solution and prints something.
std::filesystem::path stand_in(const TemporaryFolder& folder, const std::string& dat, const std::string& script) {
  write_text(folder.path() / "solution", dat);
  write_text(folder.path() / "ccx", "#!/bin/sh\ncp solution $1.dat\n" + script);
  std::filesystem::permissions(folder.path() / "ccx", std::filesystem::perms::owner_all);
  return folder.path() / "ccx";
}

TEST(RunCalculix, KeepsWhatIsComputedAndSaysWhyItEnds) {
  const SectorProblem problem = die_problem();
  const TemporaryFolder folder;
  const auto ccx =
      stand_in(folder, shrunk(problem, 1), "echo ' *ERROR: too many cutbacks'; echo ' best solution'; exit 201\n");
  const SectorSolution solution = run_calculix(problem, ccx, folder.path(), "job", {});
  EXPECT_EQ(solution.states.size(), 1U);
  EXPECT_EQ(solution.failure, "CalculiX ended with code 201; its last words: ERROR: too many cutbacks");
}

TEST(RunCalculix, SaysWhichSignalEndedCalculix) {
  const TemporaryFolder folder;
  const auto ccx = stand_in(folder, "", "kill -KILL $$\n");
  EXPECT_EQ(run_calculix(die_problem(), ccx, folder.path(), "job", {}).failure,
            "CalculiX was ended by signal 9 (Killed)");
}

TEST(RunCalculix, CountsTheInstantsWhileCalculixGoesOn) {
  const SectorProblem problem = die_problem();
  const TemporaryFolder folder;
  const auto ccx = stand_in(folder, shrunk(problem, 2), "printf ' STEP INC\\n 1 1\\n 2 1\\n' > $1.sta; sleep 0.6\n");
  std::size_t most = 0;
  const SectorSolution solution =
      run_calculix(problem, ccx, folder.path(), "job", [&](std::size_t done) { most = std::max(most, done); });
  EXPECT_EQ(solution.states.size(), 2U);
  EXPECT_EQ(solution.failure, "");
  EXPECT_EQ(most, 1U);
}

}  // namespace
}  // namespace monograin
