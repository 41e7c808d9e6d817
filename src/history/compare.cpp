#include "history/compare.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "undefined.hpp"

namespace monograin {
namespace {

/// Share of the range of x within which two jumps, or two ends, are the same one: events are located about as exactly
/// as the solution that crosses them.
constexpr double k_same_event = 1e-6;
/// Share of the range of x that is rounding: too little to be a turn of the curve.
constexpr double k_rounding = 1e-12;

/// The reference at one place and what the other curve differs by; nan where they cannot be compared.
struct Sample {
  double x;
  double reference;
  double difference;
};

/// One value of x in a monotone piece, with what the curve comes from and goes on to.
struct Knot {
  double along;  ///< x, or -x in a piece in which x decreases: increases strictly from knot to knot
  double left;
  double right;
  bool is_jump;  ///< more than one row at this x
};

struct Piece {
  double direction = 1.0;  ///< +1 where x increases, -1 where it decreases
  std::vector<Knot> knots;
};

struct Curve {
  std::span<const double> x;
  std::span<const double> y;
};

[[nodiscard]] double range_of(std::span<const double> x) {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (const double value : x) {  // comparisons with nan are false: rows without x do not count
    if (value < lowest) lowest = value;
    if (value > highest) highest = value;
  }
  return highest > lowest ? highest - lowest : 0.0;
}

// --- pieces

/// Row indices at which x turns back, with the first and the last row around them. Of several rows at a turn the last
/// is taken: it ends one piece and starts the next.
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
  Piece piece{.direction = curve.x[last] < curve.x[first] ? -1.0 : 1.0, .knots = {}};
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
  const auto turns = turning_rows(curve.x, k_rounding * range_of(curve.x));
  std::vector<Piece> pieces;
  for (std::size_t k = 1; k < turns.size(); ++k) pieces.push_back(piece_between(curve, turns[k - 1], turns[k]));
  return pieces;
}

// --- interpolation

[[nodiscard]] double interpolated(const Knot& from, const Knot& to, double along) noexcept {
  return std::lerp(from.right, to.left, (along - from.along) / (to.along - from.along));
}

/// Reads a piece of the other curve at any place.
class PieceReader {
 public:
  PieceReader(const std::vector<Knot>& knots, double range) : knots_(knots), reach_(k_same_event * range) {}

  [[nodiscard]] double left_limit(double along) const noexcept { return read(along, &Knot::left); }
  [[nodiscard]] double right_limit(double along) const noexcept { return read(along, &Knot::right); }

  /// The jump that is taken for one at this place, or nullptr.
  [[nodiscard]] const Knot* jump_near(double along) const noexcept {
    const Knot* nearest = nullptr;
    double reach = reach_;
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
    if (next == knots_.end()) return along - knots_.back().along <= reach_ ? knots_.back().*side : k_nan;
    if (next->along == along) return (*next).*side;
    if (next == knots_.begin()) return next->along - along <= reach_ ? (*next).*side : k_nan;
    return interpolated(*std::prev(next), *next, along);
  }

  const std::vector<Knot>& knots_;
  double reach_;
};

/// Of the two sides of b at a place where a has only one value, the one that is nearer.
[[nodiscard]] double nearer_difference(double reference, double left, double right) noexcept {
  const double from_left = left - reference;
  const double from_right = right - reference;
  return std::abs(from_right) < std::abs(from_left) ? from_right : from_left;
}

void sample_piece(const Piece& a, const Piece& b, double range, std::vector<Sample>& samples) {
  const PieceReader reader(b.knots, range);
  for (const Knot& knot : a.knots) {
    const double x = a.direction * knot.along;
    if (!knot.is_jump) {
      const double left = reader.left_limit(knot.along);
      const double right = reader.right_limit(knot.along);
      samples.push_back({x, knot.left, nearer_difference(knot.left, left, right)});
      continue;
    }
    // A jump a little earlier or later in b is read on the same side of it as in a.
    const Knot* const jump = reader.jump_near(knot.along);
    const double before = jump ? std::min(knot.along, jump->along) : knot.along;
    const double after = jump ? std::max(knot.along, jump->along) : knot.along;
    samples.push_back({x, knot.left, reader.left_limit(before) - knot.left});
    samples.push_back({x, knot.right, reader.right_limit(after) - knot.right});
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
    const bool in_one_only = std::isnan(a.y[k]) != std::isnan(b.y[k]);
    const double same = a.y[k] == b.y[k] ? 0.0 : b.y[k] - a.y[k];  // equal infinities do not differ
    samples.push_back({a.x[k], a.y[k], in_one_only ? std::numeric_limits<double>::infinity() : same});
  }
  return samples;
}

// --- measures

[[nodiscard]] double over(double measure, double scale) noexcept { return scale > 0.0 ? measure / scale : measure; }

/// Sums along the path of the reference.
struct PathIntegrals {
  double length = 0.0;
  double compared_length = 0.0;
  double difference_squared = 0.0;
  double reference_squared = 0.0;
  double reference = 0.0;
};

[[nodiscard]] PathIntegrals integrate(const std::vector<Sample>& samples) noexcept {
  PathIntegrals sums;
  for (std::size_t k = 1; k < samples.size(); ++k) {
    const Sample& from = samples[k - 1];
    const Sample& to = samples[k];
    const double dx = std::abs(to.x - from.x);
    if (!(dx > 0.0)) continue;
    sums.length += dx;
    if (std::isnan(from.difference) || std::isnan(to.difference)) continue;
    sums.compared_length += dx;
    sums.difference_squared += 0.5 * dx * (from.difference * from.difference + to.difference * to.difference);
    // A reference that is undefined has an infinite difference, which says enough.
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
  double peak_place = -std::numeric_limits<double>::infinity();
  double reference_at_peak = 0.0;
  for (const auto& [x, reference, difference] : samples) {
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

[[nodiscard]] std::size_t numeric_column(const Table& table, const std::string& name, const char* which) {
  const auto index = table.find(name);
  if (!index) throw std::runtime_error(fmt::format("the {} table has no column '{}'", which, name));
  if (table.columns()[*index].holds_words()) {
    throw std::runtime_error(fmt::format("column '{}' of the {} table holds words, not numbers", name, which));
  }
  return *index;
}

/// The column's heading, after making sure that both tables have it, with numbers in the same unit.
[[nodiscard]] std::string shared_heading(const Table& a, const Table& b, const std::string& name) {
  std::string heading = a.columns()[numeric_column(a, name, "first")].heading();
  const std::string other = b.columns()[numeric_column(b, name, "second")].heading();
  if (heading != other) {
    throw std::runtime_error(
        fmt::format("'{}' is '{}' in the first table and '{}' in the second", name, heading, other));
  }
  return heading;
}

/// step and row number the rows; they are not results.
[[nodiscard]] bool is_counter(const Column& column) { return column.name == "step" || column.name == "row"; }

[[nodiscard]] std::vector<std::string> shared_results(const Table& a, const Table& b, const std::string& x) {
  std::vector<std::string> headings;
  for (const Column& column : a.columns()) {
    const std::string heading = column.heading();
    const auto in_b = b.find(heading);
    const bool is_shared = in_b && b.columns()[*in_b].heading() == heading && !b.columns()[*in_b].holds_words();
    if (is_shared && !column.holds_words() && !is_counter(column) && heading != x) headings.push_back(heading);
  }
  if (headings.empty()) throw std::runtime_error(fmt::format("the tables share no numeric column besides '{}'", x));
  return headings;
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

std::vector<CurveDifference> compare_tables(const Table& a, const Table& b, const std::string& x,
                                            const std::string& y) {
  if (a.columns().empty() || b.columns().empty()) throw std::runtime_error("one of the tables has no columns");
  const std::string place = shared_heading(a, b, x.empty() ? a.columns().front().heading() : x);
  const auto headings = y.empty() ? shared_results(a, b, place) : std::vector{shared_heading(a, b, y)};
  const auto x_a = a.column(place);
  const auto x_b = b.column(place);
  std::vector<CurveDifference> differences;
  for (const std::string& heading : headings) {
    try {
      differences.push_back(compare_curves(x_a, a.column(heading), x_b, b.column(heading)));
    } catch (const std::runtime_error& fault) {
      throw std::runtime_error(fmt::format("{}: {}", heading, fault.what()));
    }
    differences.back().y = heading;
  }
  return differences;
}

}  // namespace monograin
