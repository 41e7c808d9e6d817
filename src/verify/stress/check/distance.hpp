/// Distance between the histories of two runs.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "history/table.hpp"
#include "system/resolution.hpp"

namespace monograin {

/// Factors by which lengths and stresses of one run are larger than those of another. Those of forces and energies
/// follow from them.
struct Magnification {
  double length = 1.0;
  double stress = 1.0;
};

struct Distance {
  double value = 0.0;  ///< largest over all columns, each over the largest magnitude of its kind; nan: not comparable
  std::string column;
  double time = 0.0;
};

/// Kind of a column: the part of its name after the last dot, "force" for "axial.force".
[[nodiscard]] std::string_view kind_of(const Column& column);

/// Largest absolute value in a column.
[[nodiscard]] double largest_magnitude(const Table& table, std::size_t column);

/// Largest absolute value in all columns of a kind.
[[nodiscard]] double largest_of_kind(const Table& table, std::string_view kind);

/// Largest overlap of all contacts [m]; negative, a gap, if no contact is made.
[[nodiscard]] double deepest_overlap(const Table& table);

/// Differences that do not count: shares of a particle's own units, as an absolute tolerance or round-off.
struct Negligible {
  Magnification unit;          ///< the particle's units of length [m] and stress [Pa]
  double share = 0.0;          ///< of those units
  double energy_share = 0.0;   ///< of the largest energy: the tolerance of the direct form's work
  double step_share = 0.0;     ///< of a step: how far an event may be from its exact instant
  double length = 0.0;         ///< round-off of an overlap [m], a difference of lengths of the order of R0
  bool has_any_place = false;  ///< positions of a free centre, and of walls relative to it, do not count
};

/// Distance of two histories at pairs of rows. Not compared are the pressure (a force over an area, which are compared
/// themselves; the quotient has no digits where both vanish) and the coordination number (a square root of the packing
/// fraction). If a column is empty in one regime, a row beside an event may be compared on either side of the event.
/// @param larger  factors by which values of the second table are larger than those of the first
[[nodiscard]] Distance distance_at(const Table& first, const Table& second,
                                   const std::vector<std::pair<std::size_t, std::size_t>>& rows,
                                   const Negligible& nothing = {}, const Magnification& larger = {});

/// Distance of two histories at the output points that both have, up to the time `last` [s].
[[nodiscard]] Distance distance_between(const Table& first, const Table& second, const Negligible& nothing = {},
                                        const Magnification& larger = {}, double last = k_infinity);

}  // namespace monograin
