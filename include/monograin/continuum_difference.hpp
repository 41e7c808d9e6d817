/// Difference between a law and finite elements.
#pragma once

#include <string>

namespace monograin {

/// Largest differences between the law and finite elements in a quantity of a contact class, over the quantity's
/// largest value by finite elements. NaN: there are none.
struct ContinuumDifference {
  std::string column;       ///< without the unit, e.g. "axial.force"
  double loading = 0.0;     ///< where the first class that moves is as deep as ever before, or deeper
  double unloading = 0.0;   ///< where it is not
  double mesh_error = 0.0;  ///< estimate of the finite elements' own error
};

}  // namespace monograin
