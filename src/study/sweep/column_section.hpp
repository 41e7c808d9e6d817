/// Keys of a sweep file that name columns of histories and results. For readers of TOML files: includes the library.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenario/scenario.hpp"
#include "scenario/section.hpp"
#include "study/formula/expression.hpp"

namespace monograin::sweep {

/// A column of the histories that the file names, and where.
struct PlacedColumn {
  std::string name;
  SourceLocation where;
  bool may_hold_words = false;
};

/// The columns of the histories that `columns`, a list of columns of the results, needs. A fault for each entry that
/// does not begin with "end.", "max." or "min.".
[[nodiscard]] std::vector<PlacedColumn> columns_of_results(Reading& reading, const Section& root);

/// Reports what is wrong with a formula that stands in quotes at `where`.
void add_formula_fault(FaultList& faults, SourceLocation where, const std::string& formula,
                       const ExpressionError& error, const std::string& advice = {});

/// Checks that the formulas in `results` can be read, name columns of the results, and none that `columns` leaves out.
/// @param keys  of the factors; each is a column of the results
/// @return the columns of the histories that the formulas need
[[nodiscard]] std::vector<PlacedColumn> columns_of_formulas(Reading& reading, const Section& root,
                                                            std::span<const std::string> keys);

/// Checks that histories of a scenario have the columns, so that a sweep of long runs does not end with that fault.
void check_columns(std::span<const PlacedColumn> columns, const CheckedScenario& scenario, FaultList& faults);

}  // namespace monograin::sweep
