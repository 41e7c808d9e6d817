#include "history/sensitivities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "history/run.hpp"
#include "scenario/faults.hpp"
#include "scenario/integrators.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

constexpr double k_direct_round_off = 1e-14;  // relative, of states that `direct` solves for
constexpr double k_finest_atol = 1e-14;  // upper bound of atol of runs for differences; that of rtol is k_finest_rtol

// Step of the neighbours over the value of the key. It balances the error of the difference quotient next to a square
// root, which grows with the square of the step, and the round-off of equations that are evaluated at one state.
constexpr double k_share = 2e-5;
// Error bound of an integrated derivative, over the run's rtol and the largest derivative of the column. The bound for
// ida is larger, because its steps use a larger share of the tolerance.
constexpr double k_forward_error = 30.0;
constexpr double k_forward_error_of_ida = 100.0;

constexpr std::size_t k_time = 0;
constexpr std::size_t k_step = 1;
constexpr std::size_t k_side = 2;

[[nodiscard]] RowSide side_of(const Table& history, std::size_t row) {
  return static_cast<RowSide>(static_cast<int>(history.at(row, k_side)));
}

/// Rows of a history just before and just after all events at one instant; the end of a step is an event, too. Events
/// at one instant may have rows of their own, or share them. Never empty.
using Corner = std::vector<std::size_t>;

/// Segments of a history between its corners.
class Segments {
 public:
  explicit Segments(const Table& history) : history_(history) {
    const double slack = k_same_instant * duration();
    std::size_t segment = 0;
    for (std::size_t row = 0; row < history.row_count(); ++row) {
      if (side(row) != RowSide::output) {
        const bool is_same = !corners_.empty() && time(row) - time(corners_.back().front()) <= slack;
        if (!is_same) corners_.emplace_back();
        corners_.back().push_back(row);
        if (side(row) == RowSide::after) segment = corners_.size();
      }
      of_row_.push_back(segment);
    }
  }

  [[nodiscard]] double time(std::size_t row) const { return history_.at(row, k_time); }
  [[nodiscard]] RowSide side(std::size_t row) const { return side_of(history_, row); }
  [[nodiscard]] std::size_t segment(std::size_t row) const { return of_row_[row]; }
  [[nodiscard]] const std::vector<Corner>& corners() const noexcept { return corners_; }
  [[nodiscard]] double duration() const { return history_.row_count() == 0 ? 0.0 : time(history_.row_count() - 1); }

  /// Output row of a segment at an instant [s]; none if the segment has no such row.
  [[nodiscard]] std::optional<std::size_t> row_at(double instant, std::size_t segment) const {
    const double slack = k_same_instant * duration();
    std::size_t low = 0;
    std::size_t high = of_row_.size();
    while (low < high) {
      const std::size_t middle = low + (high - low) / 2;
      (time(middle) < instant - slack ? low : high) = time(middle) < instant - slack ? middle + 1 : middle;
    }
    for (std::size_t row = low; row < of_row_.size() && time(row) <= instant + slack; ++row) {
      if (side(row) == RowSide::output && of_row_[row] == segment) return row;
    }
    return std::nullopt;
  }

 private:
  const Table& history_;
  std::vector<std::size_t> of_row_;
  std::vector<Corner> corners_;
};

/// Number of leading events that two runs have in common, in the same order.
[[nodiscard]] std::size_t same_events(const Table& one, const Table& other) {
  const std::size_t event = *one.find("event");
  const std::size_t of_class = *one.find("class");
  std::size_t row = 0;
  for (; row < std::min(one.row_count(), other.row_count()); ++row) {
    if (one.word(row, event) != other.word(row, event) || one.word(row, of_class) != other.word(row, of_class)) break;
  }
  return row;
}

/// A run with another value of the key, and its segments.
struct Variant {
  RunRecord record;
  Segments segments;

  explicit Variant(RunRecord made) : record(std::move(made)), segments(record.history) {}
  Variant(const Variant&) = delete;
  Variant& operator=(const Variant&) = delete;
};

[[nodiscard]] std::string quotient_unit(const std::string& unit, const std::string& by) {
  if (by == "-") return unit.empty() ? "-" : unit;
  const bool has_unit = !unit.empty() && unit != "-";
  if (unit == by) return "-";
  const std::string own = has_unit ? unit : "1";
  return by.find('/') == std::string::npos ? fmt::format("{}/{}", own, by) : fmt::format("{}/({})", own, by);
}

[[nodiscard]] Column derivative_column(const std::string& name, const std::string& unit, const SensitivityKey& key) {
  return {fmt::format("d({})/d({})", name, key.key), quotient_unit(unit, key.unit), {}};
}

/// Values of a column in the run with the lower value of the key, with the key's own value, and with the upper value.
struct Triple {
  double lower = k_nan;
  double centre = k_nan;
  double upper = k_nan;

  [[nodiscard]] double largest() const { return std::max({std::abs(lower), std::abs(centre), std::abs(upper)}); }
  [[nodiscard]] double second_difference() const { return std::abs(upper + lower - 2.0 * centre); }
};

/// Runs with a smaller and a larger value of the key.
struct Pair {
  Variant lower;
  Variant upper;
  double step = 0.0;  ///< distance of their values from the key's own [SI]
};

/// Rows of the runs beside a run that belong to the rows of its history and of its events.
class Partnership {
 public:
  /// @param centre  run that the pair is compared with; null: the run of the history itself
  Partnership(const Table& history, const Segments& base, const Table& events, const Pair& pair, const Variant* centre)
      : history_(history), events_(events), base_(base), pair_(pair), centre_(centre) {
    std::vector<const Variant*> others{&pair.lower, &pair.upper};
    if (centre != nullptr) others.push_back(centre);
    same_events_ = events.row_count();
    for (const Variant* other : others)
      same_events_ = std::min(same_events_, same_events(events, other->record.events));
    const double end = same_events_ < events.row_count() ? events.at(same_events_, k_time) : k_infinity;
    const auto& corners = base.corners();
    const auto has_corner = [&](const Variant* other) {
      if (corners_ >= other->segments.corners().size()) return false;
      const Corner& of_other = other->segments.corners()[corners_];
      return other->segments.side(of_other.front()) == base.side(corners[corners_].front()) &&
             other->segments.side(of_other.back()) == base.side(corners[corners_].back());
    };
    while (corners_ < corners.size() && base.time(corners[corners_].front()) < end &&
           std::ranges::all_of(others, has_corner)) {
      ++corners_;
    }
    find_partners(history);
  }

  /// Values of a column that belong to a row of the history; none if the runs have no such row in common.
  [[nodiscard]] std::optional<Triple> at_row(std::size_t row, std::size_t column) const {
    const auto& [lower, centre, upper] = partners_[row];
    if (!lower || !centre || !upper) return std::nullopt;
    const Table& of_centre = centre_ != nullptr ? centre_->record.history : history_;
    return Triple{pair_.lower.record.history.at(*lower, column), of_centre.at(*centre, column),
                  pair_.upper.record.history.at(*upper, column)};
  }

  /// Values of a column of the events at an event, which is compared with the same event of the other runs.
  [[nodiscard]] std::optional<Triple> at_event(std::size_t row, std::size_t column) const {
    if (row >= same_events_) return std::nullopt;
    const Table& of_centre = centre_ != nullptr ? centre_->record.events : events_;
    return Triple{pair_.lower.record.events.at(row, column), of_centre.at(row, column),
                  pair_.upper.record.events.at(row, column)};
  }

 private:
  /// Rows of the runs that belong to a row of the history: at the same corner, or at the same instant in the same
  /// segment.
  struct Partners {
    std::optional<std::size_t> lower, centre, upper;
  };

  void find_partners(const Table& history) {
    const auto& corners = base_.corners();
    std::vector<std::size_t> corner_of_row(history.row_count(), corners.size());
    std::size_t begun = 0;  // last segment that begins at a corner of all runs
    for (std::size_t corner = 0; corner < corners.size(); ++corner) {
      for (const std::size_t row : corners[corner]) {
        corner_of_row[row] = corner;
        // An output row at the instant of a corner follows the row just before the event.
        const bool is_shared = base_.side(row) == RowSide::before && row + 1 < history.row_count() &&
                               base_.side(row + 1) == RowSide::output && base_.time(row + 1) == base_.time(row);
        if (is_shared) corner_of_row[row + 1] = corner;
      }
      if (corner < corners_ && base_.side(corners[corner].back()) == RowSide::after) begun = corner + 1;
    }
    for (std::size_t row = 0; row < history.row_count(); ++row) {
      partners_.push_back(base_.segment(row) > begun ? Partners() : partners_of(row, corner_of_row[row]));
    }
  }

  /// @param corner  index of the corner at which the row is; the number of corners if it is at none
  [[nodiscard]] Partners partners_of(std::size_t row, std::size_t corner) const {
    if (corner < corners_) {
      const auto count = [corner](const Segments& run) { return run.corners()[corner].size(); };
      const auto is_alike = [&](const Variant& other) { return count(other.segments) == count(base_); };
      const bool are_alike =
          is_alike(pair_.lower) && is_alike(pair_.upper) && (centre_ == nullptr || is_alike(*centre_));
      return {partner_in(pair_.lower, row, corner, are_alike),
              centre_ != nullptr ? partner_in(*centre_, row, corner, are_alike) : row,
              partner_in(pair_.upper, row, corner, are_alike)};
    }
    if (corner < base_.corners().size()) return {};
    const auto row_in = [&](const Variant& other) {
      return other.segments.row_at(base_.time(row), base_.segment(row));
    };
    return {row_in(pair_.lower), centre_ != nullptr ? row_in(*centre_) : row, row_in(pair_.upper)};
  }

  /// Row of another run at a corner.
  /// @param are_alike  all runs have as many rows there; if not, the first or the last row of the corner counts
  [[nodiscard]] std::size_t partner_in(const Variant& other, std::size_t row, std::size_t corner,
                                       bool are_alike) const {
    const Corner& here = base_.corners()[corner];
    const Corner& there = other.segments.corners()[corner];
    if (!are_alike) return base_.side(row) == RowSide::after ? there.back() : there.front();
    const auto place = std::ranges::upper_bound(here, row) - here.begin();
    return there[static_cast<std::size_t>(place) - 1];
  }

  const Table& history_;
  const Table& events_;
  const Segments& base_;
  const Pair& pair_;
  const Variant* centre_;
  std::size_t same_events_ = 0;     ///< number of leading events that all runs have in common
  std::size_t corners_ = 0;         ///< number of leading corners that all runs have in common
  std::vector<Partners> partners_;  ///< one for each row of the history
};

/// Instants of the output rows [s], ascending, without t = 0.
[[nodiscard]] std::vector<double> instants_of(const Segments& base, std::size_t rows) {
  std::vector<double> instants;
  for (std::size_t row = 0; row < rows; ++row) {
    const bool is_new = base.time(row) > (instants.empty() ? 0.0 : instants.back());
    if (base.side(row) == RowSide::output && is_new) instants.push_back(base.time(row));
  }
  return instants;
}

/// Largest magnitude of a value that rows have. @param value  row -> value
template <class Value>
[[nodiscard]] double largest_of(std::size_t rows, Value&& value) {
  double largest = 0.0;
  for (std::size_t row = 0; row < rows; ++row) largest = std::fmax(largest, std::abs(value(row)));
  return largest;
}

/// Columns of derivatives for a history and its events, key by key.
[[nodiscard]] std::vector<Column> forward_columns(const CheckedScenario& scenario, const HybridSystem& system) {
  std::vector<Column> columns;
  for (const SensitivityKey& key : scenario.sensitivities) {
    columns.push_back(derivative_column("time", "s", key));
    for (const Observable& observable : system.observables()) {
      if (observable.words.empty()) columns.push_back(derivative_column(observable.name, observable.unit, key));
    }
  }
  return columns;
}

/// Removes the last columns of a table, which hold the round-off of the derivatives in the columns before them. A
/// derivative becomes NaN if its round-off exceeds 1e-6 of the largest derivative in its column.
/// @param largest  largest derivative between events, one for each column of derivatives
[[nodiscard]] Table without_round_off(const Table& wide, const std::vector<double>& largest) {
  constexpr double k_counts = 1e-6;
  const std::size_t count = largest.size();
  const std::size_t width = wide.columns().size() - count;
  Table table({wide.columns().begin(), wide.columns().end() - static_cast<std::ptrdiff_t>(count)});
  for (std::size_t row = 0; row < wide.row_count(); ++row) {
    std::vector<double> values(wide.row(row).begin(), wide.row(row).end());
    for (std::size_t k = 0; k < count; ++k) {
      if (values[width + k] > k_counts * largest[k]) values[width - count + k] = k_nan;
    }
    values.resize(width);
    table.append(values);
  }
  return table;
}

/// Largest absolute derivative between events, for each of the `count` columns before the `count` columns of round-off.
[[nodiscard]] std::vector<double> largest_between_events(const Table& wide, std::size_t count) {
  std::vector<double> largest;
  const std::size_t first = wide.columns().size() - 2 * count;
  for (std::size_t column = first; column < first + count; ++column) {
    largest.push_back(largest_of(wide.row_count(), [&](std::size_t row) {
      return side_of(wide, row) == RowSide::output ? wide.at(row, column) : 0.0;
    }));
  }
  return largest;
}

/// Relative round-off of the derivatives with respect to a key: the worst column counts, each over its largest
/// derivative.
[[nodiscard]] double round_off_of(const Table& history, const SensitivityKey& key, double step) {
  double result = 0.0;
  for (std::size_t column = 0; column < history.columns().size(); ++column) {
    const Column& of = history.columns()[column];
    const auto derivative = history.find(derivative_column(of.name, of.unit, key).name);
    if (!derivative) continue;
    const auto largest = [&](std::size_t c) {
      return largest_of(history.row_count(), [&](std::size_t row) { return history.at(row, c); });
    };
    const double size = largest(*derivative);
    const double round_off = k_direct_round_off * largest(column) / step;
    if (size > 10.0 * round_off) result = std::max(result, round_off / size);
  }
  return result;
}

/// How many times larger the relative error of d(dissipation) is than that of d(work). The dissipation is the work less
/// the stored energy: its absolute error is that of the work, and its derivative may be small.
/// @param error  relative error of d(work); it hides derivatives that are not much larger
[[nodiscard]] double magnification_of(const Table& history, const SensitivityKey& key, double error) {
  const auto largest = [&](const char* energy) {
    const auto column = history.find(derivative_column(energy, "J", key).name);
    return column ? largest_of(history.row_count(), [&](std::size_t row) { return history.at(row, *column); }) : 0.0;
  };
  const double of_work = largest("work");
  const double of_dissipation = largest("dissipation");
  return of_dissipation > 10.0 * error * of_work ? std::max(1.0, of_work / of_dissipation) : 1.0;
}

/// Makes the scenes for a slightly smaller and a slightly larger value of each key.
/// @throws ScenarioError if such a value is not admissible
[[nodiscard]] std::vector<Neighbours> neighbours_of(const CheckedScenario& scenario) {
  std::vector<Neighbours> neighbours;
  for (const SensitivityKey& key : scenario.sensitivities) {
    const double step = k_share * std::abs(key.value);
    const auto scene_with = [&](double number) {
      return make_scene(scenario.variants->with({}, std::span(&key.key, 1), std::span(&number, 1)));
    };
    neighbours.push_back({scene_with(key.value - step), scene_with(key.value + step), key.value, step});
  }
  return neighbours;
}

/// Columns of numbers that a predicate takes. @param is_wanted  (index, column) -> bool
template <class Predicate>
[[nodiscard]] std::vector<std::size_t> numbers_of(const Table& table, Predicate&& is_wanted) {
  std::vector<std::size_t> wanted;
  for (std::size_t column = 0; column < table.columns().size(); ++column) {
    const Column& of = table.columns()[column];
    if (!of.holds_words() && is_wanted(column, of)) wanted.push_back(column);
  }
  return wanted;
}

/// Runs the scenario with a smaller and a larger value of the key; null, with a warning, if one is not admissible.
[[nodiscard]] std::unique_ptr<Pair> runs_beside(const SensitivityKey& key, double step,
                                                const std::function<RunRecord(double number)>& run_with,
                                                std::vector<std::string>& warnings) {
  try {
    return std::unique_ptr<Pair>(
        new Pair{Variant(run_with(key.value - step)), Variant(run_with(key.value + step)), step});
  } catch (const ScenarioError& error) {
    warnings.push_back(
        fmt::format("no derivatives by {}: they are differences over {:.3g} to either side of {:.6g}, which the "
                    "scenario does not take: {}",
                    key.key, step, key.value, error.faults().front().message));
    return nullptr;
  }
}

/// Magnitudes of a column of the history.
struct Magnitudes {
  double value = 0.0;
  double derivative = 0.0;
};

/// A derivative and its absolute errors.
struct Quotient {
  double value = k_nan;
  double truncation = 0.0;
  double round_off = 0.0;

  [[nodiscard]] double error() const noexcept { return truncation + round_off; }
};

/// Derivatives of history and events with respect to one key, as central differences. Rows where the runs show that
/// truncation exceeds what round-off allows get them from a second pair of runs, which writes no other rows.
class Differences {
 public:
  using RunPair = std::function<std::unique_ptr<Pair>(double step, const std::vector<double>& instants)>;

  /// @param noise   relative error of the computed values, over the largest one of the column
  /// @param value   of the key
  /// @param centre  run that the pairs are compared with; null: the run of the history itself
  Differences(const Table& history, const Segments& base, const Table& events, double noise, double value,
              const Variant* centre)
      : history_(history),
        base_(base),
        events_(events),
        noise_(noise),
        value_(std::abs(value)),
        centre_(centre),
        columns_(numbers_of(history, [](std::size_t c, const Column&) { return c != k_step && c != k_side; })),
        magnitudes_(history.columns().size()) {}

  /// Makes the pairs of runs. @return false if one of the key's values is not admissible
  bool make_pairs(const RunPair& run_pair, bool may_refine) {
    if (!add_pair(run_pair, std::cbrt(noise_) * value_, instants_of(base_, history_.row_count()))) return false;
    for (const std::size_t column : columns_) {
      magnitudes_[column].value =
          largest_of(history_.row_count(), [&](std::size_t r) { return history_.at(r, column); });
      magnitudes_[column].derivative = largest_derivative(column);
    }
    if (may_refine) refine(run_pair);
    return true;
  }

  [[nodiscard]] double step() const noexcept { return std::cbrt(noise_) * value_; }
  [[nodiscard]] std::span<const std::size_t> columns() const noexcept { return columns_; }

  [[nodiscard]] double at_row(std::size_t row, std::size_t column) const {
    return best([&](const Partnership& of) { return of.at_row(row, column); }, magnitudes_[column],
                base_.side(row) != RowSide::output)
        .value;
  }

  /// @param column  of the events
  [[nodiscard]] double at_event(std::size_t row, std::size_t column) const {
    const auto in_history = history_.find(events_.columns()[column].name);
    if (!in_history) return k_nan;
    return best([&](const Partnership& of) { return of.at_event(row, column); }, magnitudes_[*in_history], true).value;
  }

  /// Largest estimated error of a column over its largest derivative.
  [[nodiscard]] double error() const {
    double error = 0.0;
    for (const std::size_t column : columns_) {
      if (!depends(column)) continue;
      const double of_column = largest_of(history_.row_count(), [&](std::size_t row) {
        const auto values = [&](const Partnership& of) { return of.at_row(row, column); };
        return best(values, magnitudes_[column], base_.side(row) != RowSide::output).error();
      });
      error = std::max(error, of_column / largest_derivative(column));
    }
    return error;
  }

 private:
  bool add_pair(const RunPair& run_pair, double step, const std::vector<double>& instants) {
    std::unique_ptr<Pair> pair = run_pair(step, instants);
    if (!pair) return false;
    partnerships_.emplace_back(history_, base_, events_, *pair, centre_);
    pairs_.push_back(std::move(pair));
    return true;
  }

  [[nodiscard]] double largest_derivative(std::size_t column) const {
    return largest_of(history_.row_count(), [&](std::size_t row) { return at_row(row, column); });
  }

  /// False if a column does not depend on the number.
  [[nodiscard]] bool depends(std::size_t column) const {
    return magnitudes_[column].derivative > 10.0 * noise_ * magnitudes_[column].value / step();
  }

  /// Makes a second pair of runs if truncation is too large in some rows. Its step balances the two errors in the worst
  /// of them.
  void refine(const RunPair& run_pair) {
    constexpr double k_too_large = 1e-7;  // over the largest derivative of the column
    constexpr double k_finest_share = 1e-2;
    double share = 1.0;
    std::vector<bool> is_coarse(history_.row_count(), false);
    for (const std::size_t column : columns_) {
      if (!depends(column)) continue;
      for (std::size_t row = 0; row < history_.row_count(); ++row) {
        const auto values = partnerships_[0].at_row(row, column);
        if (!values) continue;
        const Quotient of = quotient(*values, magnitudes_[column], step(), false);
        const double size = magnitudes_[column].derivative;
        if (of.truncation <= std::max(k_too_large * size, of.round_off)) continue;
        is_coarse[row] = true;
        share = std::min(share, std::cbrt(of.round_off / of.truncation));
      }
    }
    if (share == 1.0) return;
    std::vector<double> instants;
    for (std::size_t row = 0; row < history_.row_count(); ++row) {
      const bool is_new = base_.time(row) > (instants.empty() ? 0.0 : instants.back());
      if (is_coarse[row] && base_.side(row) == RowSide::output && is_new) instants.push_back(base_.time(row));
    }
    if (instants.empty()) instants.push_back(base_.duration());
    add_pair(run_pair, std::max(share, k_finest_share) * step(), instants);
  }

  /// Truncation of a central difference from its bend f'' h, which is f''' h^2/6: with f''' = f''/p, as in a smooth
  /// curve; or with f''' = 3 f''^2/f', as next to a square root, where derivatives are large. In a row at an event, a
  /// column may be nothing but round-off; its values then differ as much as they are large, and it has no derivative.
  [[nodiscard]] Quotient quotient(const Triple& of, const Magnitudes& magnitudes, double step, bool is_at_event) const {
    constexpr double k_as_large = 1e-3;
    constexpr double k_counts = 1e-6;
    Quotient result{(of.upper - of.lower) / (2.0 * step), 0.0, noise_ * magnitudes.value / step};
    const double size = magnitudes.derivative;
    const double slope = std::abs(result.value);
    const double bend = of.second_difference() / step;
    const bool is_round_off = is_at_event && of.second_difference() > k_as_large * of.largest();
    if (is_round_off && size > 0.0 && 0.5 * bend > k_counts * size) return {k_nan, 0.0, 0.0};
    const bool may_be_singular = slope > 0.1 * size && bend > result.round_off;
    result.truncation = std::max(step / value_ * bend / 6.0, may_be_singular ? 0.5 * bend * bend / slope : 0.0);
    return result;
  }

  /// The more accurate quotient of the two pairs. Where they differ by more than round-off, their difference is the
  /// truncation of the first one. @param values  Partnership -> optional Triple
  template <class Values>
  [[nodiscard]] Quotient best(Values&& values, const Magnitudes& magnitudes, bool is_at_event) const {
    std::array<Quotient, 2> of_pairs;
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      if (const std::optional<Triple> of = values(partnerships_[k])) {
        of_pairs[k] = quotient(*of, magnitudes, pairs_[k]->step, is_at_event);
      }
    }
    auto& [coarse, fine] = of_pairs;
    if (std::isnan(coarse.value) || std::isnan(fine.value)) return coarse;
    const double difference = std::abs(fine.value - coarse.value);
    if (difference > coarse.round_off + fine.round_off) {
      coarse.truncation = difference;
      fine.truncation = difference * std::pow(pairs_[1]->step / pairs_[0]->step, 2);
    }
    return fine.error() < coarse.error() ? fine : coarse;
  }

  const Table& history_;
  const Segments& base_;
  const Table& events_;
  double noise_;
  double value_;
  const Variant* centre_;
  std::vector<std::size_t> columns_;
  std::vector<Magnitudes> magnitudes_;  ///< of all columns of the history
  std::vector<std::unique_ptr<Pair>> pairs_;
  std::vector<Partnership> partnerships_;  ///< one for each pair
};

/// True if two runs have the same events, and rows at the same instants.
[[nodiscard]] bool have_same_rows(const RunRecord& one, const RunRecord& other) {
  const std::size_t rows = one.history.row_count();
  if (other.history.row_count() != rows || other.events.row_count() != one.events.row_count()) return false;
  if (same_events(one.events, other.events) != one.events.row_count()) return false;
  for (std::size_t row = 0; row < rows; ++row) {
    if (side_of(one.history, row) != side_of(other.history, row)) return false;
  }
  return true;
}

/// Appends the last columns of a table to another one with the same rows.
void append_last_columns(const Table& from, std::size_t count, Table& to) {
  const std::size_t first = from.columns().size() - count;
  const std::vector<Column> columns(from.columns().begin() + static_cast<std::ptrdiff_t>(first), from.columns().end());
  to.append_columns(columns, [&](std::size_t row, std::size_t column) { return from.at(row, first + column); });
}

/// Integrates the derivatives with another run, by CVODES.
/// @return false if that is not possible
[[nodiscard]] bool add_integrated(Run& run, const Segments& base, const std::function<Scene()>& new_scene) {
  Run other;
  other.scenario = run.scenario;
  other.scenario.output = {.points = 0, .times = instants_of(base, run.record.history.row_count())};
  other.integrator.used = integrators::k_cvode_bdf;
  Scene scene = new_scene();
  const std::size_t columns = run.record.history.columns().size();
  if (record_with_sensitivities(other, scene, new_scene) || !have_same_rows(run.record, other.record)) return false;
  const std::size_t count = other.record.history.columns().size() - columns;
  append_last_columns(other.record.history, count, run.record.history);
  append_last_columns(other.record.events, count, run.record.events);
  run.record.statistics.rhs_evaluations += other.record.statistics.rhs_evaluations;
  for (Sensitivity& by : other.sensitivities) {
    by.why = fmt::format("integrated with another run, by '{}'", other.integrator.used);
    run.sensitivities.push_back(std::move(by));
  }
  return true;
}

}  // namespace

std::optional<std::string> record_with_sensitivities(Run& run, Scene& scene, const std::function<Scene()>& new_scene) {
  const CheckedScenario& scenario = run.scenario;
  if (!has_forward_sensitivities(run.integrator.used)) {
    return fmt::format("integrator '{}' carries no derivatives along", run.integrator.used);
  }
  std::string why;
  try {
    ForwardSensitivities carried(*scene.system, neighbours_of(scenario));
    std::vector<Column> columns = forward_columns(scenario, *scene.system);
    const std::vector<Column> of_round_off = columns;
    columns.insert(columns.end(), of_round_off.begin(), of_round_off.end());
    RunRecord record = record_run(scene, run.integrator.used, {scenario.numerics.rtol, scenario.numerics.atol},
                                  scenario.output, carried, columns);
    if (record.status == RunStatus::complete) {
      const std::vector<double> largest = largest_between_events(record.history, columns.size() / 2);
      record.history = without_round_off(record.history, largest);
      record.events = without_round_off(record.events, largest);
      run.record = std::move(record);
      const double over_rtol = run.integrator.used == integrators::k_ida ? k_forward_error_of_ida : k_forward_error;
      for (const SensitivityKey& key : scenario.sensitivities) {
        const double step = k_share * std::abs(key.value);
        const double of_one = over_rtol * scenario.numerics.rtol;
        const double error =
            of_one * magnification_of(run.record.history, key, of_one) + round_off_of(run.record.history, key, step);
        run.sensitivities.push_back({key.key, key.value, step, error, true, "integrated with the run"});
      }
      return std::nullopt;
    }
    why = fmt::format("the run is not complete: {}", record.message);
  } catch (const LostSensitivities& lost) {
    why = lost.what();
  } catch (const ScenarioError& error) {
    why = error.faults().front().message;
  }
  scene = new_scene();
  return why;
}

void add_sensitivities(Run& run, const std::string& why, const std::function<Scene(const CheckedScenario&)>& scene_of) {
  const CheckedScenario& scenario = run.scenario;
  Table& history = run.record.history;
  Table& events = run.record.events;
  const Segments base(history);
  const auto new_scene = [&] { return scene_of(scenario); };
  const bool has_forward = has_forward_sensitivities(run.integrator.used);
  bool is_solved = new_scene().system->is_solvable();
  if (!has_forward && !is_solved && add_integrated(run, base, new_scene)) return;
  if (has_forward) run.record.warnings.push_back(fmt::format("derivatives are differences of more runs: {}", why));
  const Tolerances tolerances{std::min(scenario.numerics.rtol, k_finest_rtol),
                              std::min(scenario.numerics.atol, k_finest_atol)};
  const auto record = [&](Scene scene, const std::vector<double>& instants) {
    RunRecord made = record_run(scene, is_solved ? std::string(integrators::k_direct) : run.integrator.used, tolerances,
                                {.points = 0, .times = instants});
    run.record.statistics.rhs_evaluations += made.statistics.rhs_evaluations;
    return made;
  };
  // Values of a run that is integrated at a coarser tolerance do not belong between those of the other runs.
  std::unique_ptr<Variant> centre;
  if (is_solved && !run.integrator.is_direct()) {
    centre = std::make_unique<Variant>(record(new_scene(), instants_of(base, history.row_count())));
    is_solved = centre->record.status == run.record.status;
    if (!is_solved) centre.reset();
  }
  const double noise = is_solved ? k_direct_round_off : std::min(scenario.numerics.rtol, k_finest_rtol);
  const std::vector<std::size_t> of_events =
      numbers_of(events, [](std::size_t, const Column& column) { return column.name != "step"; });
  std::vector<std::unique_ptr<Differences>> differences;
  std::vector<Column> row_columns;
  std::vector<Column> event_columns;
  for (const SensitivityKey& key : scenario.sensitivities) {
    Differences& of_key =
        *differences.emplace_back(std::make_unique<Differences>(history, base, events, noise, key.value, centre.get()));
    const auto run_pair = [&](double step, const std::vector<double>& instants) {
      const auto run_with = [&](double number) {
        return record(scene_of(scenario.variants->with({}, std::span(&key.key, 1), std::span(&number, 1))), instants);
      };
      return runs_beside(key, step, run_with, run.record.warnings);
    };
    const double error = of_key.make_pairs(run_pair, is_solved) ? of_key.error() : k_nan;
    run.sensitivities.push_back({key.key, key.value, of_key.step(), error, false, why});
    for (const std::size_t column : of_key.columns()) {
      row_columns.push_back(derivative_column(history.columns()[column].name, history.columns()[column].unit, key));
    }
    for (const std::size_t column : of_events) {
      event_columns.push_back(derivative_column(events.columns()[column].name, events.columns()[column].unit, key));
    }
  }
  // The derivatives need the tables without them.
  std::vector<double> of_rows;
  std::vector<double> at_events;
  for (std::size_t row = 0; row < history.row_count(); ++row) {
    for (const auto& of_key : differences) {
      for (const std::size_t column : of_key->columns()) of_rows.push_back(of_key->at_row(row, column));
    }
  }
  for (std::size_t row = 0; row < events.row_count(); ++row) {
    for (const auto& of_key : differences) {
      for (const std::size_t column : of_events) at_events.push_back(of_key->at_event(row, column));
    }
  }
  history.append_columns(row_columns,
                         [&](std::size_t row, std::size_t c) { return of_rows[row * row_columns.size() + c]; });
  events.append_columns(event_columns,
                        [&](std::size_t row, std::size_t c) { return at_events[row * event_columns.size() + c]; });
}

}  // namespace monograin
