/// How far the histories of two runs are apart.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "history/table.hpp"

namespace monograin {

/// By which factors lengths and stresses of one run are larger than those of another; forces and energies accordingly.
struct Magnification {
  double length = 1.0;
  double stress = 1.0;
};

struct Distance {
  double value = 0.0;  ///< largest over all columns, each over the largest magnitude of its kind; nan: not comparable
  std::string column;
  double time = 0.0;
};

/// "force" of "axial.force".
[[nodiscard]] std::string_view kind_of(const Column& column);

[[nodiscard]] double largest_magnitude(const Table& table, std::size_t column);

/// Over all columns of that kind.
[[nodiscard]] double largest_of_kind(const Table& table, std::string_view kind);

/// Of all contacts; below zero, a gap, where none closes.
[[nodiscard]] double deepest_overlap(const Table& table);

/// What a column of a contact, or a value that follows from it, changes by where the overlap does by a length, as the
/// rows beside this one show; those of a jump, within that length, do not.
[[nodiscard]] double change_with_overlap(const Table& table, std::size_t row, std::size_t column, double length,
                                         const std::function<double(double)>& value = std::identity());

/// Rows at output points of a history.
[[nodiscard]] std::vector<std::size_t> output_rows(const Table& table);

/// A particle's own measures, and what share of them is nothing: an absolute tolerance, or rounding.
struct Negligible {
  Magnification unit;
  double share = 0.0;
  double energy_share = 0.0;   ///< of the largest energy: the tolerance of the direct form's work
  double step_share = 0.0;     ///< of a step: how far an event may be from where it belongs
  double length = 0.0;         ///< rounding of an overlap, a difference of lengths of the order of R0
  bool has_any_place = false;  ///< where a free centre lies is nothing, nor are walls by it
};

/// At pairs of rows, without the pressure (a force over an area, both of which are compared; where both vanish their
/// quotient has no digits) and the coordination number (a root of the packing fraction). Where a column is empty in one
/// regime, a row beside an event may lie on either side of it.
/// @param larger  the second by the first
[[nodiscard]] Distance distance_at(const Table& first, const Table& second,
                                   const std::vector<std::pair<std::size_t, std::size_t>>& rows,
                                   const Negligible& nothing = {}, const Magnification& larger = {});

/// At the output points that both have, up to a time.
[[nodiscard]] Distance distance_between(const Table& first, const Table& second, const Negligible& nothing = {},
                                        const Magnification& larger = {},
                                        double last = std::numeric_limits<double>::infinity());

}  // namespace monograin
