/// Laws with every kind of branch, for the tests of the parts of a packing.
#pragma once

#include <string>
#include <vector>

#include "models/packing/cases.hpp"
#include "packing/controlled_branch.hpp"

namespace monograin::packing {

struct NamedBranch {
  std::string name;
  ControlledBranch branch;
};

/// All controls of published, plastic and consistently coupled packings.
inline std::vector<NamedBranch> branches() {
  std::vector<NamedBranch> all;
  for (const Curve& curve : curves()) {
    for (const Control control : {Control::packing_fraction, Control::strain, Control::stress}) {
      all.push_back({curve.file + std::string(" control ") + std::to_string(static_cast<int>(control)),
                     ControlledBranch(make_law(curve.parameters), control)});
    }
  }
  return all;
}

/// A packing with a pole next to jamming.
inline ControlledBranch limited_branch(Control control) {
  Parameters p = published();
  p.poisson_ratio = 0.0;
  p.coupling_factor = 0.05;
  p.has_continuous_jamming = true;
  p.coupling = Coupling::consistent;
  return {make_law(p), control};
}

}  // namespace monograin::packing
