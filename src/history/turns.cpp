#include "history/turns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "system/resolution.hpp"

namespace monograin {
namespace {

// Noise.
constexpr std::size_t k_short_path = 2;         // longest path between two turns that may be noise, in rows
constexpr std::size_t k_least_short_paths = 3;  // number of such paths from which on they are noise
// Median of the second differences x[k] - 2 x[k-1] + x[k-2] of normal noise, over its standard deviation: the median of
// |normal| times the root of 1 + 4 + 1.
constexpr double k_noise_of_median = 0.6745 * 2.449489742783178;
constexpr double k_least_median = 0.1;  // of second differences of noise, over the median of its short paths

// Rows at which x turns.
constexpr double k_noise_factor = 9.0;  // least turn over the noise; none of thousands of rows exceeds it
constexpr double k_least_turn = 2e-3;   // least turn of few rows or among noise, over the range of x

/// Lengths of the paths between two turns that may be noise, in units of x.
[[nodiscard]] std::vector<double> short_paths_of(std::span<const double> x) {
  std::vector<double> short_paths;
  std::size_t begin = 0;
  for (std::size_t k = 1; k < x.size(); ++k) {
    const bool ends = k + 1 == x.size() || (x[k + 1] - x[k]) * (x[k] - x[begin]) < 0.0;
    if (!ends) continue;
    if (k - begin <= k_short_path && k + 1 < x.size() && begin > 0) short_paths.push_back(std::abs(x[k] - x[begin]));
    begin = k;
  }
  return short_paths;
}

[[nodiscard]] double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace

double noise_in(std::span<const double> x) {
  const std::vector<double> short_paths = short_paths_of(x);
  if (short_paths.size() < k_least_short_paths) return 0.0;
  std::vector<double> differences;
  for (std::size_t k = 2; k < x.size(); ++k) differences.push_back(std::abs(x[k] - 2.0 * x[k - 1] + x[k - 2]));
  double median = median_of(std::move(differences));
  // Most of the rows of x with few digits are equal to the one before, and have no second difference.
  const double of_short_paths = median_of(short_paths);
  if (median < k_least_median * of_short_paths) median = of_short_paths;
  return std::min(median / k_noise_of_median, std::ranges::max(short_paths));
}

namespace {

/// Least distance by which x has to come back for a turn that is not noise, in units of x. The unloading of a stiff
/// particle may be short: where x has no noise, only its few short paths are left out.
[[nodiscard]] double least_turn(std::span<const double> x) {
  const auto [lowest, highest] = std::ranges::minmax(x);
  const double least = k_least_turn * (highest - lowest);
  const std::vector<double> short_paths = short_paths_of(x);
  if (short_paths.size() >= k_least_short_paths) return std::max(least, k_noise_factor * noise_in(x));
  const double longest = short_paths.empty() ? 0.0 : std::ranges::max(short_paths);
  return std::max(k_same_number * (highest - lowest), std::min(least, longest));
}

}  // namespace

std::vector<std::size_t> turning_points(std::span<const double> x) {
  std::vector<std::size_t> turns;
  if (x.empty()) return turns;
  const double least = least_turn(x);
  std::array<std::size_t, 2> extremes{};  // rows of the lowest and the highest x since the last turn
  int direction = 0;
  turns.push_back(0);
  for (std::size_t k = 1; k < x.size(); ++k) {
    if (x[k] < x[extremes[0]]) extremes[0] = k;
    if (x[k] > x[extremes[1]]) extremes[1] = k;
    const bool has_risen = direction <= 0 && x[k] - x[extremes[0]] > least;
    const bool has_fallen = direction >= 0 && x[extremes[1]] - x[k] > least;
    if (!has_risen && !has_fallen) continue;
    if (direction != 0) turns.push_back(extremes[has_risen ? 0 : 1]);
    direction = has_risen ? 1 : -1;
    extremes = {k, k};
  }
  if (x.size() > 1) turns.push_back(x.size() - 1);
  return turns;
}

namespace {

// Segmented regression: lines through the rows beside a turn.
constexpr std::size_t k_least_line = 3;  // least number of rows beside a turn that show where it is

/// Fit of x over the row by a straight line.
struct Line {
  double row = 0.0;  ///< mean
  double x = 0.0;    ///< mean
  double slope = 0.0;
  double squares = 0.0;    ///< sum of the squared distances from the line
  double variation = 0.0;  ///< sum of the squared distances from the mean

  [[nodiscard]] double at(double other) const noexcept { return x + slope * (other - row); }
};

/// Line through rows `first` to `last`.
[[nodiscard]] Line line_through(std::span<const double> x, std::size_t first, std::size_t last) {
  Line line;
  const auto count = static_cast<double>(last + 1 - first);
  for (std::size_t k = first; k <= last; ++k) {
    line.row += static_cast<double>(k) / count;
    line.x += x[k] / count;
  }
  double products = 0.0;
  double squares = 0.0;
  for (std::size_t k = first; k <= last; ++k) {
    const double away = static_cast<double>(k) - line.row;
    products += away * (x[k] - line.x);
    squares += away * away;
    line.variation += (x[k] - line.x) * (x[k] - line.x);
  }
  if (squares > 0.0) line.slope = products / squares;
  for (std::size_t k = first; k <= last; ++k) {
    const double off = x[k] - line.at(static_cast<double>(k));
    line.squares += off * off;
  }
  return line;
}

/// Straight lines through any of the rows of a window, in a time that does not depend on their number.
class WindowOfRows {
 public:
  WindowOfRows(std::span<const double> x, std::size_t first, std::size_t last)
      : first_(first), last_(last), origin_(x[first]), sums_(last + 2 - first), products_(sums_), squares_(sums_) {
    for (std::size_t k = first; k <= last; ++k) {
      const std::size_t i = k - first;
      const double value = x[k] - origin_;
      sums_[i + 1] = sums_[i] + value;
      products_[i + 1] = products_[i] + static_cast<double>(i) * value;
      squares_[i + 1] = squares_[i] + value * value;
    }
  }

  [[nodiscard]] std::size_t first() const noexcept { return first_; }
  [[nodiscard]] std::size_t last() const noexcept { return last_; }

  /// Line through rows `begin` to before `end`, at least one.
  [[nodiscard]] Line line(std::size_t begin, std::size_t end) const {
    const std::size_t i = begin - first_;
    const std::size_t j = end - first_;
    const auto count = static_cast<double>(end - begin);
    const double middle = 0.5 * static_cast<double>(i + j - 1);
    const double mean = (sums_[j] - sums_[i]) / count;
    const double products = products_[j] - products_[i] - middle * mean * count;
    const double distances = count * (count * count - 1.0) / 12.0;
    Line line{.row = static_cast<double>(first_) + middle, .x = origin_ + mean};
    line.variation = std::max(squares_[j] - squares_[i] - mean * mean * count, 0.0);
    if (distances > 0.0) line.slope = products / distances;
    line.squares = std::max(line.variation - line.slope * products, 0.0);
    return line;
  }

 private:
  std::size_t first_;
  std::size_t last_;
  double origin_;
  std::vector<double> sums_, products_, squares_;
};

// Lines beside a turn in noise.
constexpr double k_turn_reach = 30.0;  // path beside a turn that shows where it is, over the noise
constexpr int k_reaches = 3;           // number of windows, each of half the reach of the one before
constexpr double k_bad_lines = 2.0;    // mean squared distance from lines beside a turn that are not straight

// Holds.
constexpr std::size_t k_least_hold = 5;  // rows
constexpr double k_better_hold = 20.0;   // least F of the fit with a hold against that by two lines
constexpr double k_below_extreme = 2.0;  // distance of a hold from the extreme x beyond its rows' own, over the noise
constexpr double k_level = 2.5;          // largest slope of a hold, over its standard error

// Turns without noise.
constexpr double k_equal_steps = 0.05;  // largest difference of equal steps of x, over the step
constexpr double k_doubt_of_row = 4.0;  // error of the row where lines meet, over the difference of their steps

/// Row next to a turn from which a line to the turn is drawn.
/// @param step  -1: before the turn; 1: after it
/// @param end   the farthest row
[[nodiscard]] std::size_t row_beside(std::span<const double> x, std::size_t turn, int step, std::size_t end,
                                     double reach) {
  std::size_t row = turn;
  for (std::size_t count = 0; row != end; ++count) {
    if (count >= k_least_line && std::abs(x[row] - x[turn]) > reach) break;
    row = step < 0 ? row - 1 : row + 1;
  }
  return row;
}

/// A turn in noise without a hold.
struct MeetingLines {
  double x = 0.0;
  double squares = k_infinity;  ///< sum of the squared distances of all rows of the window
};

/// Intersection of the two straight lines that fit the rows of a window best. Every row is tried as the last one of the
/// first line.
[[nodiscard]] MeetingLines meeting_lines(const WindowOfRows& window) {
  const std::size_t first = window.first();
  const std::size_t last = window.last();
  MeetingLines best;
  for (std::size_t middle = first + 1; middle + 1 < last; ++middle) {
    const Line before = window.line(first, middle + 1);
    const Line after = window.line(middle + 1, last + 1);
    if (!(before.squares + after.squares < best.squares)) continue;
    best.squares = before.squares + after.squares;
    const double row = (after.at(0.0) - before.at(0.0)) / (before.slope - after.slope);
    const bool meet = row >= static_cast<double>(first) && row <= static_cast<double>(last);
    const double at = meet ? row : static_cast<double>(middle);
    best.x = 0.5 * (before.at(at) + after.at(at));
  }
  return best;
}

/// Rows of a hold.
struct Hold {
  std::size_t begin = 0;
  std::size_t end = 0;
  double squares = k_infinity;  ///< sum of the squared distances of all rows of the window

  [[nodiscard]] std::size_t rows() const noexcept { return end - begin; }
};

/// Hold between two lines of at least three rows that fits the rows of a window best. Its two ends are moved in turns.
[[nodiscard]] Hold best_hold(const WindowOfRows& window) {
  Hold hold{window.first() + k_least_line, window.last() + 1 - k_least_line};
  if (hold.end < hold.begin + k_least_hold) return {};
  const auto squares = [&window](std::size_t from, std::size_t to) {
    return window.line(window.first(), from).squares + window.line(from, to).variation +
           window.line(to, window.last() + 1).squares;
  };
  bool is_better = true;
  while (is_better) {
    const double before = hold.squares;
    for (std::size_t from = window.first() + k_least_line; from + k_least_hold <= hold.end; ++from) {
      if (const double sum = squares(from, hold.end); sum < hold.squares) hold = {from, hold.end, sum};
    }
    for (std::size_t to = hold.begin + k_least_hold; to + k_least_line <= window.last() + 1; ++to) {
      if (const double sum = squares(hold.begin, to); sum < hold.squares) hold = {hold.begin, to, sum};
    }
    is_better = hold.squares < before;
  }
  return hold;
}

/// True if a hold is level and lies at the extreme x, within the noise of its rows.
[[nodiscard]] bool is_at_turn(std::span<const double> x, const WindowOfRows& window, const Hold& hold, std::size_t turn,
                              double noise) {
  const Line line = window.line(hold.begin, hold.end);
  const auto rows = static_cast<double>(hold.rows());
  // The largest of n normal values is expected below this.
  const double largest = std::sqrt(2.0 * std::log(rows));
  if (std::abs(x[turn] - line.x) > (largest + k_below_extreme) * noise) return false;
  return std::abs(line.slope) <= k_level * noise / std::sqrt(rows * (rows * rows - 1.0) / 12.0);
}

/// Hold at a turn in noise; without rows if x is not held there. @param by_lines  squares of the fit without a hold
[[nodiscard]] Hold hold_at(std::span<const double> x, const WindowOfRows& window, std::size_t turn, double noise,
                           double by_lines) {
  const Hold hold = best_hold(window);
  if (hold.rows() == 0 || !is_at_turn(x, window, hold, turn, noise)) return {};
  const auto rows = static_cast<double>(window.last() + 1 - window.first());
  const double variance = std::max(hold.squares / rows, noise * noise);
  return by_lines - hold.squares > k_better_hold * variance ? hold : Hold{};
}

/// A turn of x with noise. Where the rows beside it are not on straight lines, as those of a hold below the peak are
/// not, fewer of them show where it is.
[[nodiscard]] Turn turn_in_noise(std::span<const double> x, std::size_t begin, std::size_t extreme, std::size_t end,
                                 double noise) {
  Turn turn{.last_row = extreme, .x = x[extreme]};
  double reach = k_turn_reach * noise;
  for (int k = 0; k < k_reaches; ++k, reach *= 0.5) {
    const std::size_t first = row_beside(x, extreme, -1, begin, reach);
    const std::size_t last = row_beside(x, extreme, 1, end, reach);
    if (last - first < 2 * k_least_line) break;
    const WindowOfRows window(x, first, last);
    const MeetingLines lines = meeting_lines(window);
    if (const Hold hold = hold_at(x, window, extreme, noise, lines.squares); hold.rows() > 0) {
      return {.last_row = hold.end - 1,
              .x = window.line(hold.begin, hold.end).x,
              .is_known = true,
              .held_begin = hold.begin,
              .held_end = hold.end};
    }
    turn.x = lines.x;
    if (lines.squares <= k_bad_lines * noise * noise * static_cast<double>(last + 1 - first)) break;
  }
  return turn;
}

/// Largest difference of consecutive steps of x from row `first` to row `last`, over the largest step.
[[nodiscard]] double unevenness(std::span<const double> x, std::size_t first, std::size_t last) {
  double largest = 0.0;
  double difference = 0.0;
  for (std::size_t row = first + 1; row <= last; ++row) {
    const double step = x[row] - x[row - 1];
    largest = std::max(largest, std::abs(step));
    if (row > first + 1) difference = std::max(difference, std::abs(step - (x[row - 1] - x[row - 2])));
  }
  return largest > 0.0 ? difference / largest : 0.0;
}

/// Turn of a curve without noise, in numbers of rows.
struct PlaceOfTurn {
  std::size_t last_row = 0;  ///< of the branch that ends there
  double row = 0.0;
};

/// Place where lines through the rows of both sides meet: the extreme row, if they meet there as nearly as the steps of
/// these rows are equal. None if the steps are not equal.
/// @param begin, end  first row of the branch before the turn, last row of the branch after it
[[nodiscard]] std::optional<PlaceOfTurn> place_between_rows(std::span<const double> x, std::size_t begin,
                                                            std::size_t extreme, std::size_t end) {
  std::optional<PlaceOfTurn> place;
  double least = k_equal_steps;
  for (const std::size_t before : {extreme, extreme - 1}) {
    const std::size_t after = before + 1;
    if (before < begin + k_least_line - 1 || after + k_least_line - 1 > end) continue;
    const std::size_t first = before + 1 - k_least_line;
    const std::size_t last = after + k_least_line - 1;
    const double uneven = std::max(unevenness(x, first, before), unevenness(x, after, last));
    if (!(uneven < least)) continue;
    const Line rising = line_through(x, first, before);
    const Line falling = line_through(x, after, last);
    const double row = (falling.at(0.0) - rising.at(0.0)) / (rising.slope - falling.slope);
    const double doubt = k_doubt_of_row * uneven + k_same_value * static_cast<double>(after);
    // Lines of equal slope, as during a hold, meet nowhere.
    if (!(row >= static_cast<double>(before) - doubt && row <= static_cast<double>(after) + doubt)) continue;
    least = uneven;
    const bool is_extreme = std::abs(row - static_cast<double>(extreme)) <= doubt;
    place = is_extreme ? PlaceOfTurn{extreme, static_cast<double>(extreme)} : PlaceOfTurn{before, row};
  }
  return place;
}

/// A turn of x without noise, in the extreme row or beside it.
[[nodiscard]] Turn turn_beside(std::span<const double> x, std::size_t begin, std::size_t extreme, std::size_t end) {
  Turn turn{.last_row = extreme, .x = x[extreme]};
  std::size_t after = extreme + 1;
  while (after <= end && x[after] == x[extreme]) ++after;
  if (after - extreme >= k_least_hold) {
    turn.held_begin = extreme;
    turn.held_end = after;
  }
  const auto place = place_between_rows(x, begin, extreme, end);
  turn.is_known = place.has_value();
  if (!place || place->row == static_cast<double>(extreme)) return turn;
  const Line before = line_through(x, place->last_row + 1 - k_least_line, place->last_row);
  return {.last_row = place->last_row, .x = before.at(place->row)};
}

}  // namespace

std::vector<Turn> turns_of(std::span<const double> x, std::span<const std::size_t> points) {
  const double noise = noise_in(x);
  std::vector<Turn> turns;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::size_t row = points[k];
    if (k == 0 || k + 1 == points.size()) {
      turns.push_back({.last_row = row, .x = x[row]});
    } else if (noise > 0.0) {
      turns.push_back(turn_in_noise(x, points[k - 1], row, points[k + 1], noise));
    } else {
      turns.push_back(turn_beside(x, points[k - 1], row, points[k + 1]));
    }
  }
  return turns;
}

}  // namespace monograin
