#include "exchange/lammps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "exchange/motion_of_run.hpp"
#include "history/run.hpp"
#include "history/table.hpp"
#include "support/refusal.hpp"
#include "support/scenario_texts.hpp"
#include "support/test_run.hpp"
#include "support/text_file.hpp"

namespace monograin {
namespace {

std::string input_of(const CheckedScenario& scenario) {
  return lammps_input(scenario, motion_of_run(scenario), lammps_law_of(scenario));
}

/// A particle of mdr with the rule of growth that LAMMPS has.
CheckedScenario mdr(Configuration configuration, std::vector<Step> steps) {
  return with(mdr_scenario(configuration, 50.0, 0.3, std::move(steps)), "radius_rule", "yielded");
}

CheckedScenario die() { return mdr(Configuration::die, path({0.1, 0.08})); }

/// The runs of an input file: their numbers of steps, and where the variables of displacements begin and end.
struct Piece {
  std::map<std::string, double> from{};
  std::map<std::string, double> change{};
  double steps = 0.0;
};

std::vector<Piece> pieces_of(const std::string& input) {
  std::vector<Piece> pieces(1);
  const std::string number = "[0-9.]+(?:e[-+][0-9]+)?";
  const std::regex variable("variable (d_\\w+|centre_\\w) equal (-?" + number + ")(?:([-+]" + number +
                            ")\\*elapsed/\\d+)?");
  std::istringstream lines(input);
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (std::regex_match(line, match, variable)) {
      pieces.back().from[match[1]] = std::stod(match[2]);
      pieces.back().change[match[1]] = match[3].matched ? std::stod(match[3]) : 0.0;
    } else if (line.starts_with("run ")) {
      pieces.back().steps = std::stod(line.substr(4));
      pieces.emplace_back();
    }
  }
  pieces.pop_back();
  return pieces;
}

TEST(LammpsInput, FollowsTheProgramInPiecesOfConstantVelocity) {
  const std::vector<Piece> pieces = pieces_of(input_of(die()));
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_EQ(pieces[0].from.at("d_axial"), 0.0);
  EXPECT_DOUBLE_EQ(pieces[0].change.at("d_axial"), 0.1);
  EXPECT_EQ(pieces[0].steps, 10000.0);
  EXPECT_DOUBLE_EQ(pieces[1].from.at("d_axial"), 0.1);
  EXPECT_DOUBLE_EQ(pieces[1].change.at("d_axial"), -0.02);
  EXPECT_EQ(pieces[1].steps, 2000.0);
  EXPECT_EQ(pieces[1].change.at("d_lateral"), 0.0);
}

TEST(LammpsInput, FollowsAWallUnderAForceAlongItsCurve) {
  const CheckedScenario scenario = mdr(Configuration::simple, {force_ramp(0.01), force_ramp(0.0)});
  const std::vector<Piece> pieces = pieces_of(input_of(scenario));
  EXPECT_GT(pieces.size(), 20U);
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    EXPECT_NEAR(pieces[i].from.at("d_axial"), pieces[i - 1].from.at("d_axial") + pieces[i - 1].change.at("d_axial"),
                1e-15);
    EXPECT_LE(std::abs(pieces[i].change.at("d_axial")), 1e-5 * pieces[i].steps * (1.0 + 1e-8));
    EXPECT_EQ(std::fmod(pieces[i].steps, 100.0), 0.0);
  }
}

TEST(LammpsInput, MovesWallsAsSeenFromAFreeCentre) {
  CheckedScenario scenario =
      between(mdr(Configuration::simple, {}),
              {wall("floor", -Eigen::Vector3d::UnitZ()), wall("punch", Eigen::Vector3d::UnitZ(), path({0.2}))});
  scenario.loading.centre_is_free = true;
  const std::string input = input_of(scenario);
  EXPECT_TRUE(contains(input, "variable m_wall_floor_z equal 1*v_d_floor-v_centre_z\n")) << input;
  EXPECT_TRUE(contains(input, "variable m_wall_punch_z equal -1*v_d_punch-v_centre_z\n")) << input;
  EXPECT_NEAR(pieces_of(input).back().from.at("centre_z") + pieces_of(input).back().change.at("centre_z"), -0.1, 1e-6);
}

TEST(LammpsInput, StaysWithinItsDeviationFromTheRun) {
  const CheckedScenario scenario = mdr(Configuration::simple, {force_ramp(0.01), force_ramp(0.0)});
  const Motion motion = motion_of_run(scenario);
  const std::vector<Piece> pieces = pieces_of(input_of(scenario));
  // Pieces begin and end at instants of the run; between them the walls move in proportion to the time.
  std::size_t i = 0;
  for (const Piece& piece : pieces) {
    const double from = piece.from.at("d_axial");
    const double to = from + piece.change.at("d_axial");
    std::size_t end = i + 1;
    while (std::abs(motion.instants[end].contacts[0].displacement - to) > 1e-15) ++end;
    for (std::size_t k = i; k <= end; ++k) {
      const double share =
          (motion.instants[k].time - motion.instants[i].time) / (motion.instants[end].time - motion.instants[i].time);
      EXPECT_NEAR(motion.instants[k].contacts[0].displacement, std::lerp(from, to, share), 1.0001e-7);
    }
    i = end;
  }
  EXPECT_EQ(i + 1, motion.instants.size());
}

TEST(LammpsInput, RunsOnceWhereNoWallMoves) {
  EXPECT_TRUE(input_of(hertz_scenario(Configuration::simple, {hold()})).ends_with("\nrun 0\n"));
}

TEST(LammpsInput, KeepsTitleAndNameFromBeingCommands) {
  CheckedScenario scenario = die();
  scenario.title = "one\nshell touch file &";
  scenario.name = "my $new# test";
  const auto run = run_scenario(scenario);
  const std::string input = lammps_input(scenario, motion_of(scenario, run.record.history), lammps_law_of(scenario));
  EXPECT_FALSE(contains(input, "\nshell"));
  EXPECT_FALSE(contains(input, "&"));
  EXPECT_TRUE(contains(input, " file my__new__test.lammps.csv ")) << input;
  EXPECT_TRUE(contains(input, "# status: complete\n"));
}

TEST(LammpsInput, PutsAWallWithAGapAway) {
  const std::string input = input_of(parse_scenario(k_late_wall_text, "late.toml"));
  EXPECT_EQ(pieces_of(input).front().from.at("d_late"), -2e-5);
  EXPECT_TRUE(contains(input, "region wall_late plane 0.01 0 0 -1 0 0 side in move"));
}

TEST(LammpsInput, NamesWallsInLettersDigitsAndUnderscoresThatDiffer) {
  CheckedScenario scenario = between(
      hertz_scenario(Configuration::simple, {}),
      {wall("a-b", Eigen::Vector3d::UnitX(), path({0.01})), wall("a_b", -Eigen::Vector3d::UnitX(), path({0.02})),
       wall("c+", Eigen::Vector3d::UnitY()), wall("c-", -Eigen::Vector3d::UnitY())});
  const std::string input = input_of(scenario);
  std::set<std::string> names;
  const std::regex region("region (\\S+) plane");
  for (std::sregex_iterator i(input.begin(), input.end(), region); i != std::sregex_iterator(); ++i) {
    EXPECT_TRUE(std::regex_match((*i)[1].str(), std::regex("\\w+")));
    EXPECT_TRUE(names.insert((*i)[1]).second) << (*i)[1];
  }
  EXPECT_EQ(names, (std::set<std::string>{"wall_a_b", "wall_a_b_", "wall_cp", "wall_cm"}));
}

TEST(LammpsInput, NamesTheLawWithTheMaterial) {
  EXPECT_TRUE(
      contains(input_of(die()), "pair_coeff * * mdr 1 0.3 0.02 0 0 0 tangential linear_nohistory 0 0 damping mdr 1\n"));
  EXPECT_TRUE(
      contains(input_of(parse_scenario(k_hertz_text, "hertz.toml")),
               "pair_coeff * * hertz/material 5e+10 0 0.22 tangential linear_nohistory 0 0 damping velocity\n"));
}

TEST(LammpsInput, LetsRadiiChange) { EXPECT_TRUE(contains(input_of(die()), "\natom_style sphere 1\n")); }

TEST(LammpsInput, SaysWhatLammpsComputesOtherwise) {
  EXPECT_TRUE(contains(input_of(die()), "# LAMMPS multiplies the force of a wall by 1 + exp(10.7 d/R0 - 10)"));
}

TEST(LammpsLaw, RefusesModelsAndOptionsWithoutACounterpart) {
  const auto reason = [](const CheckedScenario& scenario) {
    return refusal<std::invalid_argument>([&] { return lammps_law_of(scenario); });
  };
  EXPECT_EQ(reason(read_scenario(MONOGRAIN_SOURCE_DIR "/scenarios/semimech.toml")),
            "LAMMPS has no contact law with the equations of model semimech, only of hertz and mdr");
  EXPECT_EQ(reason(with(die(), "radius_rule", "gated")), "LAMMPS computes mdr with radius_rule = 'yielded' only");
  EXPECT_EQ(reason(with(die(), "elastic_profile", "parabola")),
            "LAMMPS computes mdr with elastic_profile = 'ellipse' only");
  CheckedScenario auxetic = die();
  auxetic.material["poisson_ratio"] = -0.2;
  EXPECT_EQ(reason(auxetic), "LAMMPS takes no negative Poisson's ratio for mdr");
}

/// Lines of an input file that do not move walls, without comments.
std::vector<std::string> fixed_lines_of(const std::string& input) {
  std::vector<std::string> fixed;
  std::istringstream lines(input);
  for (std::string line; std::getline(lines, line);) {
    const bool moves = line.starts_with("variable d_") || line.starts_with("variable centre_");
    if (!line.starts_with('#') && !moves) fixed.push_back(line);
  }
  return fixed;
}

/// The folder holds an input file, and what LAMMPS has computed with it.
const std::string k_lammps = MONOGRAIN_SOURCE_DIR "/tests/exchange/lammps/";

TEST(LammpsInput, IsTheOneThatLammpsHasRun) {
  const std::string input = input_of(read_scenario(k_lammps + "free-centre.toml"));
  const std::string run = read_text(k_lammps + "free-centre.in");
  EXPECT_EQ(fixed_lines_of(input), fixed_lines_of(run));
  const std::vector<Piece> pieces = pieces_of(input);
  const std::vector<Piece> run_pieces = pieces_of(run);
  ASSERT_EQ(pieces.size(), run_pieces.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    EXPECT_EQ(pieces[i].steps, run_pieces[i].steps);
    for (const auto& [name, from] : run_pieces[i].from) {
      EXPECT_NEAR(pieces[i].from.at(name), from, 1e-14) << name;
      EXPECT_NEAR(pieces[i].change.at(name), run_pieces[i].change.at(name), 1e-14) << name;
    }
  }
}

TEST(LammpsInput, GivesTheForcesOfHertzInLammps) {
  const CheckedScenario scenario = read_scenario(k_lammps + "free-centre.toml");
  const Table forces = read_csv(k_lammps + "free-centre.csv");
  const std::vector<double> displacement = forces.column("punch.displacement[m]");
  const std::vector<double> punch = forces.column("punch.force[N]");
  const std::vector<double> floor = forces.column("floor.force[N]");
  const double stiffness = 4.0 / 3.0 * 1e9 / (1.0 - 0.3 * 0.3) * std::sqrt(scenario.radius);
  for (std::size_t i = 0; i < displacement.size(); ++i) {
    // Half of the displacement is the centre's.
    const double force = stiffness * std::pow(0.5 * displacement[i], 1.5);
    EXPECT_NEAR(punch[i], force, 1e-9 * force);
    EXPECT_NEAR(floor[i], force, 1e-9 * force);
  }
  // The run ends where LAMMPS does.
  const Motion motion = motion_of_run(scenario);
  EXPECT_DOUBLE_EQ(displacement.back(), motion.instants.back().contacts[0].displacement);
  EXPECT_NEAR(punch.back(), motion.instants.back().contacts[0].force, 1e-9 * punch.back());
}

}  // namespace
}  // namespace monograin
