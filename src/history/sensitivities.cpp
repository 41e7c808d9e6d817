#include "history/sensitivities.hpp"

#include <fmt/format.h>

#include <algorithm>
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

// Step of the neighbours over the value of the key. It balances the error of the difference quotient and the round-off
// of equations that are evaluated at one state.
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

/// Derivatives of history and events with respect to one key, as central differences of two runs.
class Differences {
 public:
  Differences(const Table& history, const Segments& base, const Table& events, const Variant& lower,
              const Variant& upper, double width)
      : history_(history), base_(base), lower_(lower), upper_(upper), width_(width) {
    same_events_ = std::min(same_events(events, lower.record.events), same_events(events, upper.record.events));
    const double end = same_events_ < events.row_count() ? events.at(same_events_, k_time) : k_infinity;
    const auto& corners = base.corners();
    const auto is_same = [&](const Segments& other, std::size_t corner) {
      if (corner >= other.corners().size()) return false;
      const Corner& of_other = other.corners()[corner];
      return other.side(of_other.front()) == base.side(corners[corner].front()) &&
             other.side(of_other.back()) == base.side(corners[corner].back());
    };
    while (corners_ < corners.size() && base.time(corners[corners_].front()) < end &&
           is_same(lower.segments, corners_) && is_same(upper.segments, corners_)) {
      ++corners_;
    }
    std::vector<std::size_t> corner_of_row(history.row_count(), corners.size());
    std::size_t begun = 0;  // last segment that begins at a corner of all runs
    for (std::size_t corner = 0; corner < corners.size(); ++corner) {
      for (const std::size_t row : corners[corner]) {
        corner_of_row[row] = corner;
        // An output row at the instant of a corner follows the row just before the event.
        const bool is_shared = base.side(row) == RowSide::before && row + 1 < history.row_count() &&
                               base.side(row + 1) == RowSide::output && base.time(row + 1) == base.time(row);
        if (is_shared) corner_of_row[row + 1] = corner;
      }
      if (corner < corners_ && base.side(corners[corner].back()) == RowSide::after) begun = corner + 1;
    }
    for (std::size_t row = 0; row < history.row_count(); ++row) {
      partners_.push_back(base.segment(row) > begun ? Partners() : partners_of(row, corner_of_row[row]));
    }
  }

  /// Derivative of a column in a row of the history; NaN if it is undefined.
  [[nodiscard]] double at_row(std::size_t row, std::size_t column) const {
    const auto& [below, above] = partners_[row];
    if (!below || !above) return k_nan;
    return (upper_.record.history.at(*above, column) - lower_.record.history.at(*below, column)) / width_;
  }

  /// Derivative of a column of the events at an event, which is compared with the same event of the other runs.
  [[nodiscard]] double at_event(std::size_t row, std::size_t column) const {
    if (row >= same_events_) return k_nan;
    return (upper_.record.events.at(row, column) - lower_.record.events.at(row, column)) / width_;
  }

  /// Absolute difference of the forward and the backward difference quotient in a row; 0 if one of them is undefined.
  [[nodiscard]] double bend(std::size_t row, std::size_t column) const {
    const auto& [below, above] = partners_[row];
    if (!below || !above) return 0.0;
    const double sum = upper_.record.history.at(*above, column) + lower_.record.history.at(*below, column);
    return std::abs(sum - 2.0 * history_.at(row, column)) / (0.5 * width_);
  }

 private:
  /// Rows of the lower and the upper run that belong to a row of the history: at the same corner, or at the same
  /// instant in the same segment.
  using Partners = std::pair<std::optional<std::size_t>, std::optional<std::size_t>>;

  /// @param corner  index of the corner at which the row is; the number of corners if it is at none
  [[nodiscard]] Partners partners_of(std::size_t row, std::size_t corner) const {
    if (corner < corners_) {
      const auto count = [corner](const Segments& run) { return run.corners()[corner].size(); };
      const bool are_alike = count(lower_.segments) == count(base_) && count(upper_.segments) == count(base_);
      return {partner_in(lower_, row, corner, are_alike), partner_in(upper_, row, corner, are_alike)};
    }
    if (corner < base_.corners().size()) return {};
    return {lower_.segments.row_at(base_.time(row), base_.segment(row)),
            upper_.segments.row_at(base_.time(row), base_.segment(row))};
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
  const Segments& base_;
  const Variant& lower_;
  const Variant& upper_;
  double width_;
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

/// Estimated error of the differences in a column over the largest derivative: truncation and noise of the runs. The
/// bend f'' h of a row gives the truncation f''' h^2/6: with f''' = f''/p, as in a smooth curve; or with
/// f''' = 3 f''^2/f', as next to a square root, where derivatives are large.
/// @param derivatives  those of the column, one for each row
/// @param share        step over the value of the key
/// @param step         distance of the values of the two runs from that of the key [SI]
/// @param noise        relative error of the computed values, over the largest one of the column
[[nodiscard]] double error_of(const Differences& differences, const Table& history, std::size_t column,
                              std::span<const double> derivatives, double share, double step, double noise) {
  const std::size_t rows = history.row_count();
  const double size = largest_of(rows, [&](std::size_t row) { return derivatives[row]; });
  const double round_off = noise * largest_of(rows, [&](std::size_t row) { return history.at(row, column); }) / step;
  if (size <= 10.0 * round_off) return 0.0;  // the column does not depend on the number
  const double truncation = largest_of(rows, [&](std::size_t row) {
    const double bend = differences.bend(row, column);
    const double slope = std::abs(derivatives[row]);
    const bool may_be_singular = slope > 0.1 * size && bend > round_off;
    return std::max(share * bend / 6.0, may_be_singular ? 0.5 * bend * bend / slope : 0.0);
  });
  return (truncation + round_off) / size;
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

/// Runs with a smaller and a larger value of the key.
struct Pair {
  Variant lower;
  Variant upper;
};

/// Runs the scenario with a smaller and a larger value of the key; null, with a warning, if one is not admissible.
[[nodiscard]] std::unique_ptr<Pair> runs_beside(const SensitivityKey& key, double step,
                                                const std::function<RunRecord(double number)>& run_with,
                                                std::vector<std::string>& warnings) {
  try {
    return std::unique_ptr<Pair>(new Pair{Variant(run_with(key.value - step)), Variant(run_with(key.value + step))});
  } catch (const ScenarioError& error) {
    warnings.push_back(
        fmt::format("no derivatives by {}: they are differences over {:.3g} to either side of {:.6g}, which the "
                    "scenario does not take: {}",
                    key.key, step, key.value, error.faults().front().message));
    return nullptr;
  }
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
        const double error = over_rtol * scenario.numerics.rtol + round_off_of(run.record.history, key, step);
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
  if (has_forward_sensitivities(run.integrator.used)) {
    run.record.warnings.push_back(fmt::format("derivatives are differences of more runs: {}", why));
  }
  const CheckedScenario& scenario = run.scenario;
  Table& history = run.record.history;
  Table& events = run.record.events;
  const Segments base(history);
  const bool is_direct = run.integrator.is_direct();
  const double noise = is_direct ? k_direct_round_off : std::min(scenario.numerics.rtol, k_finest_rtol);
  const double share = std::cbrt(noise);
  const Tolerances tolerances{std::min(scenario.numerics.rtol, k_finest_rtol),
                              std::min(scenario.numerics.atol, k_finest_atol)};
  const Output output{.points = 0, .times = instants_of(base, history.row_count())};
  const std::vector<std::size_t> of_history =
      numbers_of(history, [](std::size_t column, const Column&) { return column != k_step && column != k_side; });
  const std::vector<std::size_t> of_events =
      numbers_of(events, [](std::size_t, const Column& column) { return column.name != "step"; });
  std::vector<std::unique_ptr<Pair>> pairs;
  std::vector<std::optional<Differences>> differences;
  std::vector<Column> row_columns;
  std::vector<std::vector<double>> derivatives;  // of the rows, one list for each of those columns
  std::vector<Column> event_columns;
  for (const SensitivityKey& key : scenario.sensitivities) {
    const double step = share * std::abs(key.value);
    const auto run_with = [&](double number) {
      Scene scene = scene_of(scenario.variants->with({}, std::span(&key.key, 1), std::span(&number, 1)));
      return record_run(scene, run.integrator.used, tolerances, output);
    };
    const Pair* const pair = pairs.emplace_back(runs_beside(key, step, run_with, run.record.warnings)).get();
    auto& of_key = differences.emplace_back();
    if (pair != nullptr) of_key.emplace(history, base, events, pair->lower, pair->upper, 2.0 * step);
    double error = pair != nullptr ? 0.0 : k_nan;
    for (const std::size_t column : of_history) {
      row_columns.push_back(derivative_column(history.columns()[column].name, history.columns()[column].unit, key));
      auto& values = derivatives.emplace_back(history.row_count(), k_nan);
      if (!of_key) continue;
      for (std::size_t row = 0; row < values.size(); ++row) values[row] = of_key->at_row(row, column);
      error = std::max(error, error_of(*of_key, history, column, values, share, step, noise));
    }
    for (const std::size_t column : of_events) {
      event_columns.push_back(derivative_column(events.columns()[column].name, events.columns()[column].unit, key));
    }
    run.sensitivities.push_back({key.key, key.value, step, error, false, why});
  }
  history.append_columns(row_columns, [&](std::size_t row, std::size_t c) { return derivatives[c][row]; });
  events.append_columns(event_columns, [&](std::size_t row, std::size_t c) {
    const auto& of_key = differences[c / of_events.size()];
    return of_key ? of_key->at_event(row, of_events[c % of_events.size()]) : k_nan;
  });
}

}  // namespace monograin
