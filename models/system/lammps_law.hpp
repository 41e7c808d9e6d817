/// A contact law of LAMMPS that has the equations of a model.
#pragma once

#include <string>
#include <vector>

namespace monograin {

/// Arguments of LAMMPS (package GRANULAR, units si) for a model's law, without friction and damping.
struct LammpsLaw {
  std::string pair;                        ///< of pair_coeff, after the types: contact of two particles of the material
  std::string wall;                        ///< of fix wall/gran/region, after `granular`: contact with a rigid wall
  std::vector<std::string> differences{};  ///< what LAMMPS computes otherwise, a sentence each
};

}  // namespace monograin
