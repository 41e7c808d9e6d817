/// The inequalities that the runs of a sweep obey. For readers of TOML files: includes the library.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenario/section.hpp"
#include "study/formula/constraint.hpp"
#include "study/sweep/factor.hpp"
#include "study/sweep/sweep_runs.hpp"

namespace monograin::sweep {

struct PlacedConstraint {
  Constraint constraint;
  std::string text;
  SourceLocation where;
};

/// Reads the list `constraints`.
[[nodiscard]] std::vector<PlacedConstraint> constraints_in(Reading& reading, const Section& root);

/// Reports names in the constraints that are not keys with a number.
/// @param takes_lists  false: keys with listed values have no number
void check_names(std::span<const PlacedConstraint> constraints, std::span<const Factor> factors, bool takes_lists,
                 FaultList& faults);

/// First constraint that a run breaks, or nullptr. @param run  a value for each factor
[[nodiscard]] const PlacedConstraint* broken_constraint(std::span<const PlacedConstraint> constraints,
                                                        std::span<const Factor> factors,
                                                        std::span<const SweepValue> run);

}  // namespace monograin::sweep
