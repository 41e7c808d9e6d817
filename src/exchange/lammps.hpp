/// A scenario's test as an input file of LAMMPS.
#pragma once

#include <string>

#include "exchange/motion.hpp"
#include "scenario/scenario.hpp"
#include "system/lammps_law.hpp"

namespace monograin {

/// Contact law of LAMMPS with the equations of a scenario's model.
/// @throws std::invalid_argument if LAMMPS has none for the model or its options; the message says why
[[nodiscard]] LammpsLaw lammps_law_of(const CheckedScenario& scenario);

/// Input file of LAMMPS (package GRANULAR, units si) for the test of a scenario: one particle at rest and a moving
/// plane for each wall, without friction and damping.
///
/// Walls follow the motion of the recorded run, in pieces of constant velocity that deviate from it by at most
/// 1e-7 R0. With a free centre they move as seen from the centre. A step of LAMMPS moves no wall by more than 1e-5 R0.
/// LAMMPS writes displacement and force of one wall of each contact class to the file NAME.lammps.csv, with the
/// headings of a history and a row at each end of a piece.
/// @param motion  of the scenario's run
[[nodiscard]] std::string lammps_input(const CheckedScenario& scenario, const Motion& motion, const LammpsLaw& law);

}  // namespace monograin
