#include "history/compare.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "scenario/words.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

/// Largest distance of equal jumps, or of equal ends, over the range of x. Events are located about as accurately as
/// the solution that crosses them.
constexpr double k_same_event = 1e-6;

/// Value of the reference at one x and the difference of the other curve; NaN if they cannot be compared there.
struct Sample {
  double x;
  double reference;
  double difference;
  bool is_defined;      ///< true if at least one of the curves is defined here
  double beyond = 0.0;  ///< distance of x from the nearest end of the other curve, if it lies beyond that
};

/// One value of x in a monotone piece, with both limits of the curve.
struct Knot {
  double along;  ///< x, or -x if x decreases in the piece: strictly ascending from knot to knot
  double left;   ///< y as x is reached
  double right;  ///< y as x is left
  bool is_jump;  ///< true if several rows have this x
};

/// A part of a curve with monotone x.
struct Piece {
  double direction = 1.0;  ///< +1 where x increases, -1 where it decreases
  std::vector<Knot> knots{};
};

struct Curve {
  std::span<const double> x;
  std::span<const double> y;
};

[[nodiscard]] double range_of(std::span<const double> x) {
  double lowest = k_infinity;
  double highest = -lowest;
  for (const double value : x) {  // comparisons with nan are false: rows without x do not count
    if (value < lowest) lowest = value;
    if (value > highest) highest = value;
  }
  return highest > lowest ? highest - lowest : 0.0;
}

// --- pieces

/// Rows at which x turns back, with the first and the last row, in computed curves, whose x has no noise: every turn by
/// more than the tolerance counts. For measured curves see turning_points(). If several rows are at a turn, the last
/// one counts: it ends one piece and starts the next.
[[nodiscard]] std::vector<std::size_t> turning_rows(std::span<const double> x, double tolerance) {
  std::vector<std::size_t> turns;
  double direction = 0.0;
  std::size_t extreme = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (std::isnan(x[k])) continue;
    if (turns.empty()) {
      turns.push_back(k);
      extreme = k;
    }
    const double step = x[k] - x[extreme];
    if (direction == 0.0 && std::abs(step) > tolerance) direction = std::copysign(1.0, step);
    if (step * direction >= 0.0) {
      extreme = k;
    } else if (std::abs(step) > tolerance) {
      turns.push_back(extreme);
      direction = -direction;
      extreme = k;
    }
  }
  if (!turns.empty()) turns.push_back(extreme);
  return turns;
}

[[nodiscard]] Piece piece_between(const Curve& curve, std::size_t first, std::size_t last) {
  Piece piece{.direction = curve.x[last] < curve.x[first] ? -1.0 : 1.0};
  for (std::size_t k = first; k <= last; ++k) {
    const double along = piece.direction * curve.x[k];
    if (std::isnan(along)) continue;
    if (!piece.knots.empty() && along <= piece.knots.back().along) {
      piece.knots.back().right = curve.y[k];
      piece.knots.back().is_jump = true;
    } else {
      piece.knots.push_back({along, curve.y[k], curve.y[k], false});
    }
  }
  return piece;
}

[[nodiscard]] std::vector<Piece> monotone_pieces(const Curve& curve) {
  const auto turns = turning_rows(curve.x, k_same_value * range_of(curve.x));
  std::vector<Piece> pieces;
  for (std::size_t k = 1; k < turns.size(); ++k) pieces.push_back(piece_between(curve, turns[k - 1], turns[k]));
  return pieces;
}

// --- interpolation

[[nodiscard]] double interpolated(const Knot& from, const Knot& to, double along) noexcept {
  return std::lerp(from.right, to.left, (along - from.along) / (to.along - from.along));
}

/// Evaluates a piece of the other curve at any x, given as Knot::along.
class PieceReader {
 public:
  PieceReader(const std::vector<Knot>& knots, double range) : knots_(knots), tolerance_(k_same_event * range) {}

  [[nodiscard]] double left_limit(double along) const noexcept { return read(along, &Knot::left); }
  [[nodiscard]] double right_limit(double along) const noexcept { return read(along, &Knot::right); }
  /// True if the curve has a row exactly there, so that nothing is interpolated.
  [[nodiscard]] bool has_row(double along) const noexcept {
    const auto knot = first_not_before(along);
    return knot != knots_.end() && knot->along == along;
  }

  /// Distance from the nearest end of the curve; 0 between its ends.
  [[nodiscard]] double beyond(double along) const noexcept {
    return std::max({0.0, along - knots_.back().along, knots_.front().along - along});
  }

  /// The nearest jump within k_same_event of the range of x, or nullptr.
  [[nodiscard]] const Knot* jump_near(double along) const noexcept {
    const Knot* nearest = nullptr;
    double reach = tolerance_;
    for (auto knot = first_not_before(along - reach); knot != knots_.end() && knot->along <= along + reach; ++knot) {
      const double distance = std::abs(knot->along - along);
      if (!knot->is_jump || distance > reach) continue;
      nearest = &*knot;
      reach = distance;
    }
    return nearest;
  }

 private:
  [[nodiscard]] std::vector<Knot>::const_iterator first_not_before(double along) const noexcept {
    return std::ranges::lower_bound(knots_, along, {}, &Knot::along);
  }

  [[nodiscard]] double read(double along, double Knot::*side) const noexcept {
    const auto next = first_not_before(along);
    if (next == knots_.end()) return along - knots_.back().along <= tolerance_ ? knots_.back().*side : k_nan;
    if (next->along == along) return (*next).*side;
    if (next == knots_.begin()) return next->along - along <= tolerance_ ? (*next).*side : k_nan;
    return interpolated(*std::prev(next), *next, along);
  }

  const std::vector<Knot>& knots_;
  double tolerance_;
};

/// Difference of two recorded values; infinite if only one of them is defined, NaN if none is.
[[nodiscard]] double recorded_difference(double reference, double other) noexcept {
  if (std::isnan(reference) != std::isnan(other)) return k_infinity;
  return reference == other ? 0.0 : other - reference;  // equal infinities do not differ
}

/// The smaller of the differences to the two limits of b, for an x at which a has a single value.
[[nodiscard]] double nearer_difference(double from_left, double from_right) noexcept {
  return std::abs(from_right) < std::abs(from_left) ? from_right : from_left;
}

/// Sample at a row of a where it has a single value.
[[nodiscard]] Sample sample_row(const Knot& knot, double x, const PieceReader& b) {
  const double left = b.left_limit(knot.along);
  const double right = b.right_limit(knot.along);
  const double difference = b.has_row(knot.along) ? nearer_difference(recorded_difference(knot.left, left),
                                                                      recorded_difference(knot.left, right))
                                                  : nearer_difference(left - knot.left, right - knot.left);
  return {x, knot.left, difference, !std::isnan(knot.left) || !std::isnan(left), b.beyond(knot.along)};
}

/// Samples before and after a jump of a. The jump of b may be a little earlier or later: left limits are read before
/// both jumps, right limits after both.
[[nodiscard]] std::array<Sample, 2> sample_jump(const Knot& knot, double x, const PieceReader& b) {
  const Knot* const jump = b.jump_near(knot.along);
  const double before = jump ? std::min(knot.along, jump->along) : knot.along;
  const double after = jump ? std::max(knot.along, jump->along) : knot.along;
  const double left = b.left_limit(before);
  const double right = b.right_limit(after);
  const double beyond = b.beyond(knot.along);
  const auto sample = [&](double own, double other) {
    const double difference = jump ? recorded_difference(own, other) : other - own;
    return Sample{x, own, difference, !std::isnan(own) || !std::isnan(other), beyond};
  };
  return {sample(knot.left, left), sample(knot.right, right)};
}

void sample_piece(const Piece& a, const Piece& b, double range, std::vector<Sample>& samples) {
  const PieceReader reader(b.knots, range);
  for (const Knot& knot : a.knots) {
    const double x = a.direction * knot.along;
    if (knot.is_jump) {
      for (const Sample& sample : sample_jump(knot, x, reader)) samples.push_back(sample);
    } else {
      samples.push_back(sample_row(knot, x, reader));
    }
  }
}

[[nodiscard]] bool all_undefined(std::span<const double> y) noexcept {
  return std::ranges::all_of(y, [](double value) { return std::isnan(value); });
}

[[nodiscard]] std::vector<Sample> interpolated_samples(const Curve& a, const Curve& b) {
  const auto pieces_a = monotone_pieces(a);
  const auto pieces_b = monotone_pieces(b);
  if (pieces_a.size() != pieces_b.size()) {
    throw std::runtime_error(fmt::format(
        "the curves cannot be compared: x runs through {} monotone pieces in the first and {} in the second",
        pieces_a.size(), pieces_b.size()));
  }
  std::vector<Sample> samples;
  const double range = range_of(a.x);
  for (std::size_t k = 0; k < pieces_a.size(); ++k) {
    if (pieces_a[k].direction != pieces_b[k].direction) {
      throw std::runtime_error(fmt::format("the curves cannot be compared: x runs the other way in piece {}", k + 1));
    }
    sample_piece(pieces_a[k], pieces_b[k], range, samples);
  }
  const bool nothing_compared =
      std::ranges::all_of(samples, [](const Sample& sample) { return std::isnan(sample.difference); });
  if (nothing_compared && !(all_undefined(a.y) && all_undefined(b.y))) {
    throw std::runtime_error("the curves cannot be compared: there is no x at which both are defined");
  }
  return samples;
}

// --- row by row

[[nodiscard]] bool share_places(const Curve& a, const Curve& b) noexcept {
  return std::ranges::equal(a.x, b.x, [](double p, double q) { return p == q || (std::isnan(p) && std::isnan(q)); });
}

[[nodiscard]] std::vector<Sample> row_samples(const Curve& a, const Curve& b) {
  std::vector<Sample> samples;
  samples.reserve(a.x.size());
  for (std::size_t k = 0; k < a.x.size(); ++k) {
    samples.push_back(
        {a.x[k], a.y[k], recorded_difference(a.y[k], b.y[k]), !std::isnan(a.y[k]) || !std::isnan(b.y[k])});
  }
  return samples;
}

// --- measures

[[nodiscard]] double over(double measure, double scale) noexcept { return scale > 0.0 ? measure / scale : measure; }

/// Integrals over |dx| along the path of the reference.
struct PathIntegrals {
  double length = 0.0;
  double compared_length = 0.0;
  double difference_squared = 0.0;
  double reference_squared = 0.0;
  double reference = 0.0;
};

/// Length over which two curves can be compared between samples one of which has no difference: the other curve may end
/// between them.
[[nodiscard]] double compared_part(const Sample& from, const Sample& to) noexcept {
  if (std::isnan(from.difference) && std::isnan(to.difference)) return 0.0;
  const double beyond = std::isnan(to.difference) ? to.beyond : from.beyond;
  return beyond > 0.0 ? std::max(0.0, std::abs(to.x - from.x) - beyond) : 0.0;
}

[[nodiscard]] PathIntegrals integrate(const std::vector<Sample>& samples) noexcept {
  PathIntegrals sums;
  for (std::size_t k = 1; k < samples.size(); ++k) {
    const Sample& from = samples[k - 1];
    const Sample& to = samples[k];
    const double dx = std::abs(to.x - from.x);
    if (!(dx > 0.0) || !from.is_defined || !to.is_defined) continue;
    sums.length += dx;
    if (std::isnan(from.difference) || std::isnan(to.difference)) {
      sums.compared_length += compared_part(from, to);
      continue;
    }
    sums.compared_length += dx;
    sums.difference_squared += 0.5 * dx * (from.difference * from.difference + to.difference * to.difference);
    // An undefined reference already has an infinite difference.
    if (std::isnan(from.reference) || std::isnan(to.reference)) continue;
    sums.reference_squared += 0.5 * dx * (from.reference * from.reference + to.reference * to.reference);
    sums.reference += 0.5 * dx * (std::abs(from.reference) + std::abs(to.reference));
  }
  return sums;
}

[[nodiscard]] CurveDifference measures(const std::vector<Sample>& samples) noexcept {
  CurveDifference result;
  double largest = 0.0;
  double largest_reference = 0.0;
  double peak_place = -k_infinity;
  double reference_at_peak = 0.0;
  for (const auto& [x, reference, difference, is_defined, beyond] : samples) {
    if (std::abs(difference) > largest) {
      largest = std::abs(difference);
      result.linf_at = x;
    }
    if (std::isnan(reference) || std::isnan(difference)) continue;
    largest_reference = std::max(largest_reference, std::abs(reference));
    if (x > peak_place) {
      peak_place = x;
      reference_at_peak = std::abs(reference);
    }
  }
  const PathIntegrals sums = integrate(samples);
  result.linf = over(largest, largest_reference);
  result.peak_error = over(largest, reference_at_peak > 0.0 ? reference_at_peak : largest_reference);
  result.l2 = std::sqrt(over(sums.difference_squared, sums.reference_squared));
  result.area_error = over(std::sqrt(sums.difference_squared), sums.reference);
  if (sums.length > 0.0) result.coverage = sums.compared_length / sums.length;
  return result;
}

// --- tables

/// Heading of the column of that name in the reference. @throws std::runtime_error if there is none
[[nodiscard]] std::string heading_of(const Table& a, const std::string& name) {
  const auto index = a.find(name);
  if (!index) {
    std::vector<std::string_view> names;
    for (const Column& column : a.columns()) names.push_back(column.name);
    throw std::runtime_error(
        fmt::format("the first table has no column '{}'{}", shown(name), did_you_mean(name, names)));
  }
  return a.columns()[*index].heading();
}

[[nodiscard]] std::vector<std::string> result_headings(const Table& a, const std::string& x) {
  std::vector<std::string> headings;
  for (const Column& column : a.columns()) {
    if (!is_counter(column) && column.heading() != x) headings.push_back(column.heading());
  }
  if (headings.empty()) throw std::runtime_error(fmt::format("the first table has no column besides '{}'", x));
  return headings;
}

/// Describes how a column of a is missing in b; empty if b has it with the same unit and kind.
[[nodiscard]] std::string missing_column(const Table& a, const Table& b, const std::string& heading) {
  const Column& in_a = a.columns()[*a.find(heading)];
  const auto index = b.find(in_a.name);
  if (!index) return "is missing";
  const Column& in_b = b.columns()[*index];
  const auto named = [](const std::string& unit) { return unit.empty() ? "without unit" : fmt::format("in {}", unit); };
  if (in_a.unit != in_b.unit) return fmt::format("is {} instead of {}", named(in_b.unit), named(in_a.unit));
  const auto kind = [](const Column& column) { return column.holds_words() ? "words" : "numbers"; };
  if (in_a.holds_words() != in_b.holds_words()) {
    return fmt::format("holds {} instead of {}", kind(in_b), kind(in_a));
  }
  return {};
}

/// Describes rows without an abscissa, which are not compared, if one of the curves has more of them.
[[nodiscard]] std::string undefined_rows(std::span<const double> x_a, std::span<const double> x_b) {
  const auto undefined = [](std::span<const double> x) {
    return std::ranges::count_if(x, [](double value) { return std::isnan(value); });
  };
  const auto in_a = undefined(x_a);
  const auto in_b = undefined(x_b);
  if (in_a == in_b) return {};
  return fmt::format("is undefined in {} of {} rows, and in {} of {} of the reference", in_b, x_b.size(), in_a,
                     x_a.size());
}

/// Length of the abscissa that makes it a pure number: R0 for a length of a particle, and the range of any other
/// quantity with a unit. The area error depends on it.
[[nodiscard]] double unit_of_path(const Table& a, const std::string& x) {
  const Column& column = a.columns()[*a.find(x)];
  if (column.unit.empty()) return 1.0;
  const auto radius = std::ranges::find(a.header, "R0", [](const auto& entry) { return entry.first; });
  double value = 0.0;
  if (column.unit == "m" && radius != a.header.end()) {
    std::from_chars(radius->second.data(), radius->second.data() + radius->second.size(), value);
  }
  return value > 0.0 ? value : range_of(a.column(x));
}

/// Rows of a column of words: all rows, or only those at which the word changes.
[[nodiscard]] std::vector<std::size_t> word_rows(const Table& table, std::size_t column, bool only_changes) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const bool is_new = rows.empty() || table.word(row, column) != table.word(rows.back(), column);
    if (is_new || !only_changes) rows.push_back(row);
  }
  return rows;
}

/// Describes the first difference of two columns of words; empty if they agree. Tables with the same x in every row are
/// compared row by row, others by the order of their words.
[[nodiscard]] std::string word_difference(const Table& a, const Table& b, const std::string& heading,
                                          const std::string& x) {
  const std::size_t x_a = *a.find(x);
  const std::size_t column_a = *a.find(heading);
  const std::size_t column_b = *b.find(heading);
  const bool only_changes = !share_places({a.column(x), {}}, {b.column(x), {}});
  const auto rows_a = word_rows(a, column_a, only_changes);
  const auto rows_b = word_rows(b, column_b, only_changes);
  const auto word = [](const Table& table, const auto& rows, std::size_t k, std::size_t column) {
    return k < rows.size() ? fmt::format("'{}'", table.word(rows[k], column)) : std::string("nothing");
  };
  for (std::size_t k = 0; k < std::max(rows_a.size(), rows_b.size()); ++k) {
    const std::string expected = word(a, rows_a, k, column_a);
    const std::string found = word(b, rows_b, k, column_b);
    if (expected == found) continue;
    const double place = k < rows_a.size() ? a.at(rows_a[k], x_a) : b.at(rows_b[k], *b.find(x));
    return fmt::format("has {} instead of {} at {} = {:.6g}", found, expected, x, place);
  }
  return {};
}

}  // namespace

CurveDifference compare_curves(std::span<const double> x_a, std::span<const double> y_a, std::span<const double> x_b,
                               std::span<const double> y_b) {
  if (x_a.size() != y_a.size() || x_b.size() != y_b.size()) {
    throw std::invalid_argument("a curve needs as many y as x");
  }
  if (x_a.empty() || x_b.empty()) throw std::runtime_error("the curves cannot be compared: one of them has no points");
  const Curve a{x_a, y_a};
  const Curve b{x_b, y_b};
  return measures(share_places(a, b) ? row_samples(a, b) : interpolated_samples(a, b));
}

Comparison compare_tables(const Table& a, const Table& b, const std::string& x, const std::string& y) {
  if (a.columns().empty()) throw std::runtime_error("the first table has no columns");
  const std::string place = heading_of(a, x.empty() ? a.columns().front().heading() : x);
  if (a.columns()[*a.find(place)].holds_words()) {
    throw std::runtime_error(fmt::format("column '{}' of the first table holds words, not numbers", place));
  }
  const auto headings = y.empty() ? result_headings(a, place) : std::vector{heading_of(a, y)};
  Comparison result;
  if (std::string problem = missing_column(a, b, place); !problem.empty()) {
    result.gaps.push_back({place, std::move(problem)});
    return result;
  }
  const auto x_a = a.column(place);
  const auto x_b = b.column(place);
  if (std::string problem = undefined_rows(x_a, x_b); !problem.empty()) {
    result.gaps.push_back({place, std::move(problem)});
  }
  const double unit = unit_of_path(a, place);
  for (const std::string& heading : headings) {
    std::string problem = missing_column(a, b, heading);
    if (problem.empty() && a.columns()[*a.find(heading)].holds_words()) {
      problem = word_difference(a, b, heading, place);
    } else if (problem.empty()) {
      try {
        result.curves.push_back(compare_curves(x_a, a.column(heading), x_b, b.column(heading)));
        result.curves.back().y = heading;
        result.curves.back().area_error *= std::sqrt(unit);
        const double coverage = result.curves.back().coverage;
        if (coverage < k_least_coverage) problem = fmt::format("covers only {:.4g} % of the curve", 100.0 * coverage);
      } catch (const std::runtime_error& fault) {
        problem = fault.what();
      }
    }
    if (!problem.empty()) result.gaps.push_back({heading, std::move(problem)});
  }
  return result;
}

Comparison compare_events(const Table& a, const Table& b) {
  Comparison result;
  for (const char* column : {"time", "class", "event"}) {
    if (!a.find(column)) throw std::runtime_error(fmt::format("the first events have no column '{}'", column));
    if (!b.find(column)) result.gaps.push_back({column, "is missing"});
  }
  if (!result.gaps.empty() || (a.row_count() == 0 && b.row_count() == 0)) return result;
  const auto name = [](const Table& events, std::size_t row) -> std::string {
    if (row >= events.row_count()) return "nothing";
    const std::string_view of_class = events.word(row, *events.find("class"));
    return fmt::format("'{}'{}{}", events.word(row, *events.find("event")), of_class.empty() ? "" : " of ", of_class);
  };
  for (std::size_t k = 0; k < std::max(a.row_count(), b.row_count()); ++k) {
    const std::string expected = name(a, k);
    const std::string found = name(b, k);
    if (expected == found) continue;
    const Table& longer = k < a.row_count() ? a : b;
    result.gaps.push_back({"event", fmt::format("number {} is {} instead of {} at {:.6g} s", k + 1, found, expected,
                                                longer.at(k, *longer.find("time")))});
    return result;
  }
  std::vector<double> number(a.row_count());
  for (std::size_t k = 0; k < number.size(); ++k) number[k] = static_cast<double>(k);
  const auto times = a.column("time");
  result.curves.push_back(compare_curves(number, times, number, b.column("time")));
  result.curves.back().y = "event time[s]";
  result.curves.back().linf_at = times[static_cast<std::size_t>(result.curves.back().linf_at)];
  return result;
}

}  // namespace monograin
