#include "verify/stress/check/distance.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "history/recorder.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

bool is_energy(const Column& column) { return column.unit == "J"; }

/// True for a strain of a material point or a packing: a direction, an invariant or a part of one tensor.
bool is_strain(const Column& column) {
  return column.name.starts_with("strain") || column.name.starts_with("plastic_strain") || column.name == "phi";
}

bool is_stress(const Column& column) {
  return column.unit == "Pa" && kind_of(column) != "pressure" && column.name != "youngs_modulus";
}

/// True for a column of a free centre: the components of one vector, whose axes are only a choice.
bool is_centre(const Column& column) { return column.name.starts_with("centre_"); }

/// Magnitude to which differences of a column are related: the largest of all related columns, because terms of that
/// magnitude may cancel in one of them.
double scale_of(const Table& table, std::size_t column) {
  const Column& own = table.columns()[column];
  for (const auto is_kin : {is_energy, is_strain, is_stress, is_centre}) {
    if (!is_kin(own)) continue;
    double largest = 0.0;
    for (std::size_t c = 0; c < table.columns().size(); ++c) {
      if (is_kin(table.columns()[c])) largest = std::max(largest, largest_magnitude(table, c));
    }
    return largest;
  }
  return largest_of_kind(table, kind_of(own));
}

/// False for columns that identify a row, and for those with rules of their own.
bool is_compared(const Column& column) {
  return !column.holds_words() && column.name != "time" && column.name != "step" && column.name != "row" &&
         column.name != "yield_function" && column.name != "coordination_number" && kind_of(column) != "pressure";
}

/// True for a position of a free centre, or of a wall relative to it. A centre under no force follows idle contacts.
bool is_place(const Column& column) {
  return is_centre(column) || kind_of(column) == "overlap" || kind_of(column) == "displacement";
}

/// Value of a column beyond an event beside a row, if the column is empty on one side of that event; else nothing.
/// @param step_share  largest distance of the event from the row, over the duration of the step
std::optional<double> beyond_event(const Table& table, std::size_t row, std::size_t column, double step_share) {
  const auto step = *table.find("step");
  const auto is_empty = [&](std::size_t r) { return std::isnan(table.at(r, column)); };
  const auto is_in_step = [&](std::size_t r) { return table.at(r, step) == table.at(row, step); };
  std::size_t first = row;
  std::size_t last = row;
  while (first > 0 && is_in_step(first - 1)) --first;
  while (last + 1 < table.row_count() && is_in_step(last + 1)) ++last;
  const double farthest = step_share * (table.at(last, 0) - table.at(first, 0));
  const auto is_near = [&](std::size_t r) { return std::abs(table.at(r, 0) - table.at(row, 0)) <= farthest; };
  for (std::size_t r = row; r <= last && is_near(r); ++r) {
    if (is_empty(r) != is_empty(row)) return table.at(r, column);
  }
  for (std::size_t r = row; r-- > first && is_near(r);) {
    if (is_empty(r) != is_empty(row)) return table.at(r, column);
  }
  return std::nullopt;
}

double factor_of(const std::string& unit, const Magnification& larger) {
  if (unit == "m") return larger.length;
  if (unit == "m3") return std::pow(larger.length, 3);
  if (unit == "Pa") return larger.stress;
  if (unit == "N") return larger.stress * std::pow(larger.length, 2);
  return unit == "J" ? larger.stress * std::pow(larger.length, 3) : 1.0;
}

/// A column of two tables, and how its values are compared.
struct ColumnPair {
  const Table& first;
  const Table& second;
  std::size_t column = 0;
  double factor = 1.0;   ///< by which values of the second table are larger
  double scale = 0.0;    ///< largest magnitude, in units of the first table
  bool is_root = false;  ///< the square of its distance from the origin is smooth at first touch
  double origin = 0.0;
  double floor = 0.0;  ///< smaller differences do not count

  /// Function of a value that is smooth at first touch.
  [[nodiscard]] double smooth(double value) const { return is_root ? (value - origin) * (value - origin) : value; }
  [[nodiscard]] double unit() const { return is_root ? scale * scale : scale; }
  /// Distance of two values, each from the origin.
  [[nodiscard]] double apart(double x, double y) const {
    return is_root ? std::abs(x * x - y * y) : std::max(0.0, std::abs(x - y) - floor);
  }
};

ColumnPair pair_of(const Table& first, const Table& second, std::size_t c, const Negligible& nothing,
                   const Magnification& larger) {
  const Column& column = first.columns()[c];
  const double factor = factor_of(column.unit, larger);
  const double scale = std::max(scale_of(first, c), scale_of(second, c) / factor);
  // The area of a contact is smooth at first touch. Its radius, a square root, is not, nor is the margin: 1 less such
  // roots.
  const bool is_margin = column.name == "margin";
  return {.first = first,
          .second = second,
          .column = c,
          .factor = factor,
          .scale = scale,
          .is_root = is_margin || kind_of(column).starts_with("contact_radius"),
          .origin = is_margin ? 1.0 : 0.0,
          .floor = nothing.share * factor_of(column.unit, nothing.unit) +
                   (is_energy(column) ? nothing.energy_share * scale : 0.0)};
}

/// Both values at a pair of rows, from the origin. If only one is empty, a value beyond an event beside its row is
/// used.
std::pair<double, double> values_at(const ColumnPair& pair, std::size_t a, std::size_t b, double step_share) {
  double x = pair.first.at(a, pair.column) - pair.origin;
  double y = pair.second.at(b, pair.column) / pair.factor - pair.origin;
  if (std::isnan(x) != std::isnan(y)) {
    if (const auto of_first = beyond_event(pair.first, a, pair.column, step_share))
      x = *of_first - pair.origin;
    else if (const auto of_second = beyond_event(pair.second, b, pair.column, step_share))
      y = *of_second / pair.factor - pair.origin;
  }
  return {x, y};
}

/// Change of a value that follows from a contact's column when the overlap changes by a length [m]. The slope comes
/// from the nearest rows whose overlap differs by more than that length, so that a jump does not count.
/// @return 0 if the column belongs to no contact with an overlap
double change_with_overlap(const ColumnPair& pair, std::size_t row, double length) {
  const Table& table = pair.first;
  const std::string& name = table.columns()[pair.column].name;
  const std::size_t dot = name.rfind('.');
  if (dot == std::string::npos || !(length > 0.0)) return 0.0;
  const auto overlap = table.find(name.substr(0, dot) + ".overlap");
  if (!overlap) return 0.0;
  double steepest = 0.0;
  const auto has_sampled = [&](std::size_t beside) {
    const double way = std::abs(table.at(beside, *overlap) - table.at(row, *overlap));
    if (!(way > length)) return false;
    steepest = std::max(
        steepest, std::abs(pair.smooth(table.at(beside, pair.column)) - pair.smooth(table.at(row, pair.column))) / way);
    return true;
  };
  for (std::size_t beside = row; beside-- > 0 && !has_sampled(beside);) continue;
  for (std::size_t beside = row + 1; beside < table.row_count() && !has_sampled(beside); ++beside) continue;
  return steepest * length;
}

}  // namespace

std::string_view kind_of(const Column& column) {
  const std::size_t dot = column.name.rfind('.');
  return dot == std::string::npos ? std::string_view(column.name) : std::string_view(column.name).substr(dot + 1);
}

double largest_magnitude(const Table& table, std::size_t column) {
  double largest = 0.0;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const double value = std::abs(table.at(row, column));
    if (value > largest) largest = value;
  }
  return largest;
}

double largest_of_kind(const Table& table, std::string_view kind) {
  double largest = 0.0;
  for (std::size_t c = 0; c < table.columns().size(); ++c) {
    if (kind_of(table.columns()[c]) == kind) largest = std::max(largest, largest_magnitude(table, c));
  }
  return largest;
}

double deepest_overlap(const Table& table) {
  double deepest = -k_infinity;
  for (std::size_t c = 0; c < table.columns().size(); ++c) {
    if (kind_of(table.columns()[c]) != "overlap") continue;
    for (std::size_t row = 0; row < table.row_count(); ++row) deepest = std::max(deepest, table.at(row, c));
  }
  return deepest;
}

Distance distance_at(const Table& first, const Table& second,
                     const std::vector<std::pair<std::size_t, std::size_t>>& rows, const Negligible& nothing,
                     const Magnification& larger) {
  Distance worst;
  for (std::size_t c = 0; c < first.columns().size(); ++c) {
    if (!is_compared(first.columns()[c]) || (nothing.has_any_place && is_place(first.columns()[c]))) continue;
    const ColumnPair pair = pair_of(first, second, c, nothing, larger);
    if (pair.scale == 0.0) continue;
    for (const auto& [a, b] : rows) {
      const auto [x, y] = values_at(pair, a, b, nothing.step_share);
      if (std::isnan(x) && std::isnan(y)) continue;
      if (std::isnan(x - y)) return {x - y, first.columns()[c].name, first.at(a, 0)};
      const double apart = pair.apart(x, y);
      if (!(apart > worst.value * pair.unit())) continue;
      // A quantity that is steep over the overlap is known only as well as the overlap.
      const double value = (apart - change_with_overlap(pair, a, nothing.length)) / pair.unit();
      if (value > worst.value) worst = {value, first.columns()[c].name, first.at(a, 0)};
    }
  }
  return worst;
}

Distance distance_between(const Table& first, const Table& second, const Negligible& nothing,
                          const Magnification& larger, double last) {
  const std::vector<std::size_t> a = output_rows(first);
  const std::vector<std::size_t> b = output_rows(second);
  const auto step = *first.find("step");
  std::vector<std::pair<std::size_t, std::size_t>> rows;
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size() && first.at(a[i], 0) <= last;) {
    // A step that a condition ends may have a row more or less.
    const double of_a = first.at(a[i], step);
    const double of_b = second.at(b[j], step);
    if (of_a == of_b) rows.emplace_back(a[i], b[j]);
    if (of_a <= of_b) ++i;
    if (of_b <= of_a) ++j;
  }
  return distance_at(first, second, rows, nothing, larger);
}

}  // namespace monograin
