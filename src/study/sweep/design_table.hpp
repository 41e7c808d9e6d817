/// Designs given as tables in text files: one column per key, one row per run.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenario/faults.hpp"

namespace monograin {

/// Cells of a table, with their positions.
struct DesignTable {
  struct Cell {
    std::string text;
    SourceLocation where;
  };
  std::vector<Cell> headings;
  std::vector<std::vector<Cell>> rows;  ///< each as long as the headings
};

/// Parses a table. The first comma, semicolon or tab among the headings separates all cells; with one of the latter
/// two, decimal commas become points. Blank lines and lines that begin with '#' do not count; quotes have no meaning.
/// Adds a fault for each row of another length than the headings, and for a table without rows.
[[nodiscard]] DesignTable parse_design_table(std::string_view text, const std::string& origin, FaultList& faults);

/// A heading's key and unit: `material.yield_stress[MPa]`. An index at the end, as in `a.normal[2]`, is no unit.
struct DesignHeading {
  std::string key;
  std::string unit;  ///< empty: none given
};
[[nodiscard]] DesignHeading parse_design_heading(std::string_view heading);

}  // namespace monograin
