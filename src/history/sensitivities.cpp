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

#include "history/differences.hpp"
#include "history/run.hpp"
#include "scenario/faults.hpp"
#include "scenario/integrators.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

constexpr double k_direct_round_off = 1e-14;  // relative, of states that `direct` solves for
// Step of differences of such states, over the step that balances round-off and truncation of smooth curves: next to a
// square root, truncation is much larger.
constexpr double k_shorter = 0.25;
constexpr double k_finest_atol = 1e-14;  // upper bound of atol of runs for differences; that of rtol is k_finest_rtol

// Step of the neighbours over the value of the key. It balances the error of the difference quotient next to a square
// root, which grows with the square of the step, and the round-off of equations that are evaluated at one state.
constexpr double k_share = 1e-5;
// Error bound of an integrated derivative, over the run's rtol and the largest derivative of the column.
constexpr double k_forward_error = 90.0;
constexpr double k_counts = 1e-6;  // error of a derivative that counts, over the largest one of its column

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

/// Distance of the neighbours of an integrated run from the key's own value [SI].
[[nodiscard]] double step_of(const SensitivityKey& key) { return k_share * std::abs(key.value); }

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

/// Removes the last columns of a table, which hold the errors of the derivatives in the columns before them. A
/// derivative becomes NaN if its error exceeds 1e-6 of the largest derivative in its column.
/// @param largest  one for each column of derivatives
[[nodiscard]] Table without_errors(const Table& wide, const std::vector<double>& largest) {
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

/// Largest absolute derivative, for each of the `count` columns before the `count` columns of errors. A derivative
/// counts if its error does not.
[[nodiscard]] std::vector<double> largest_derivatives(const Table& wide, std::size_t count) {
  std::vector<double> largest;
  const std::size_t first = wide.columns().size() - 2 * count;
  for (std::size_t column = first; column < first + count; ++column) {
    largest.push_back(largest_of(wide.row_count(), [&](std::size_t row) {
      const double derivative = wide.at(row, column);
      return wide.at(row, column + count) <= k_counts * std::abs(derivative) ? derivative : 0.0;
    }));
  }
  return largest;
}

/// Errors that without_errors() leaves in the derivatives, each over the largest derivative of its column: the largest
/// one for each of the keys, which have equally many columns.
[[nodiscard]] std::vector<double> errors_left(const Table& wide, const std::vector<double>& largest, std::size_t keys) {
  const std::size_t first = wide.columns().size() - largest.size();
  std::vector<double> left(keys, 0.0);
  for (std::size_t row = 0; row < wide.row_count(); ++row) {
    for (std::size_t k = 0; k < largest.size(); ++k) {
      const double error = wide.at(row, first + k);
      double& of_key = left[k * keys / largest.size()];
      if (error <= k_counts * largest[k] && error > 0.0) of_key = std::max(of_key, error / largest[k]);
    }
  }
  return left;
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
    const double step = step_of(key);
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
[[nodiscard]] std::unique_ptr<NeighbourPair> runs_beside(const SensitivityKey& key, double step,
                                                         const std::function<RunRecord(double number)>& run_with,
                                                         std::vector<std::string>& warnings) {
  try {
    return std::unique_ptr<NeighbourPair>(
        new NeighbourPair{Variant(run_with(key.value - step)), Variant(run_with(key.value + step)), step});
  } catch (const ScenarioError& error) {
    warnings.push_back(
        fmt::format("no derivatives by {}: they are differences over {:.3g} to either side of {:.6g}, which the "
                    "scenario does not take: {}",
                    key.key, step, key.value, error.faults().front().message));
    return nullptr;
  }
}

/// True if two runs have the same events, and the same rows at output points and corners.
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
/// @return empty if they are added; otherwise why that is not possible
[[nodiscard]] std::optional<std::string> add_integrated(Run& run, const Segments& base,
                                                        const std::function<Scene()>& new_scene) {
  Run other;
  other.scenario = run.scenario;
  Output& output = other.scenario.output;
  const bool writes_every_step = output.points == 0 && output.times.empty();  // of its own integrator
  if (writes_every_step) output.times = base.output_instants();
  other.integrator.used = integrators::k_cvode_bdf;
  Scene scene = new_scene();
  const std::size_t columns = run.record.history.columns().size();
  auto problem = record_with_sensitivities(other, scene, new_scene);
  run.record.statistics.rhs_evaluations += other.record.statistics.rhs_evaluations;
  if (problem) return problem;
  if (!have_same_rows(run.record, other.record)) {
    return fmt::format("a run by '{}' has other events", other.integrator.used);
  }
  const std::size_t count = other.record.history.columns().size() - columns;
  append_last_columns(other.record.history, count, run.record.history);
  append_last_columns(other.record.events, count, run.record.events);
  for (Sensitivity& by : other.sensitivities) {
    by.why = fmt::format("integrated with another run, by '{}'", other.integrator.used);
    run.sensitivities.push_back(std::move(by));
  }
  return std::nullopt;
}

/// Columns of derivatives of a table, key by key, with their values.
class DerivativeColumns {
 public:
  /// @param columns  of the table, that have derivatives
  /// @param value    (index of the key, row, column of the table) -> derivative
  template <class Value>
  DerivativeColumns(const Table& table, std::span<const std::size_t> columns, const std::vector<SensitivityKey>& keys,
                    Value&& value) {
    for (const SensitivityKey& key : keys) {
      for (const std::size_t column : columns) {
        const Column& of = table.columns()[column];
        columns_.push_back(derivative_column(of.name, of.unit, key));
      }
    }
    for (std::size_t row = 0; row < table.row_count(); ++row) {
      for (std::size_t key = 0; key < keys.size(); ++key) {
        for (const std::size_t column : columns) values_.push_back(value(key, row, column));
      }
    }
  }

  void append_to(Table& table) const {
    table.append_columns(columns_, [&](std::size_t row, std::size_t c) { return values_[row * columns_.size() + c]; });
  }

 private:
  std::vector<Column> columns_;
  std::vector<double> values_;  ///< row by row
};

/// Adds derivatives as central differences of two more runs for each key.
/// @param is_solved  the runs solve for their states directly
void add_differences(Run& run, const Segments& base, bool is_solved, const std::string& why,
                     const std::function<Scene(const CheckedScenario&)>& scene_of) {
  const CheckedScenario& scenario = run.scenario;
  Table& history = run.record.history;
  Table& events = run.record.events;
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
    centre = std::make_unique<Variant>(record(scene_of(scenario), base.output_instants()));
    is_solved = centre->record.status == run.record.status;
    if (!is_solved) centre.reset();
  }
  const double noise = is_solved ? k_direct_round_off : std::min(scenario.numerics.rtol, k_finest_rtol);
  const double share = (is_solved ? k_shorter : 1.0) * std::cbrt(noise);
  const std::vector<std::size_t> of_history = numbers_of(
      history, [](std::size_t column, const Column&) { return column != k_step_column && column != k_side_column; });
  const std::vector<std::size_t> of_events =
      numbers_of(events, [](std::size_t, const Column& column) { return column.name != "step"; });
  std::vector<std::unique_ptr<Differences>> differences;
  for (const SensitivityKey& key : scenario.sensitivities) {
    Differences& of_key = *differences.emplace_back(
        std::make_unique<Differences>(history, base, events, of_history, noise, share, key.value, centre.get()));
    const auto run_pair = [&](double step, const std::vector<double>& instants) {
      const auto run_with = [&](double number) {
        return record(scene_of(scenario.variants->with({}, std::span(&key.key, 1), std::span(&number, 1))), instants);
      };
      return runs_beside(key, step, run_with, run.record.warnings);
    };
    const double error = of_key.make_pairs(run_pair, is_solved) ? of_key.error() : k_nan;
    run.sensitivities.push_back({key.key, key.value, of_key.step(), error, false, why});
    if (of_key.kink() > 0.0) {
      run.record.warnings.push_back(
          fmt::format("derivatives by {}: the curves have a kink at {:.6g}, so that the derivatives on its two sides "
                      "differ by up to {:.2g} of the largest one; the columns hold their means",
                      key.key, key.value, of_key.kink()));
    }
  }
  const auto at_row = [&](std::size_t key, std::size_t row, std::size_t c) { return differences[key]->at_row(row, c); };
  const auto at_event = [&](std::size_t key, std::size_t row, std::size_t c) {
    return differences[key]->at_event(row, c);
  };
  // The derivatives need the tables without them.
  const DerivativeColumns of_rows(history, of_history, scenario.sensitivities, at_row);
  const DerivativeColumns at_events(events, of_events, scenario.sensitivities, at_event);
  of_rows.append_to(history);
  at_events.append_to(events);
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
    const std::vector<Column> of_errors = columns;
    columns.insert(columns.end(), of_errors.begin(), of_errors.end());
    RunRecord record = record_run(scene, run.integrator.used, {scenario.numerics.rtol, scenario.numerics.atol},
                                  scenario.output, carried, columns);
    if (record.status == RunStatus::complete) {
      const std::vector<double> largest = largest_derivatives(record.history, columns.size() / 2);
      const std::vector<double> left = errors_left(record.history, largest, scenario.sensitivities.size());
      record.history = without_errors(record.history, largest);
      record.events = without_errors(record.events, largest);
      run.record = std::move(record);
      for (std::size_t k = 0; k < left.size(); ++k) {
        const SensitivityKey& key = scenario.sensitivities[k];
        const double step = step_of(key);
        const double error =
            k_forward_error * scenario.numerics.rtol + round_off_of(run.record.history, key, step) + left[k];
        run.sensitivities.push_back({key.key, key.value, step, error, true, "integrated with the run"});
      }
      return std::nullopt;
    }
    run.record.statistics.rhs_evaluations = record.statistics.rhs_evaluations;
    why = fmt::format("the run is not complete: {}", record.message);
  } catch (const LostSensitivities& lost) {
    run.record.statistics.rhs_evaluations = lost.evaluations;
    why = lost.what();
  } catch (const ScenarioError& error) {
    why = error.faults().front().message;
  }
  scene = new_scene();
  return why;
}

void add_sensitivities(Run& run, std::string why, const std::function<Scene(const CheckedScenario&)>& scene_of) {
  const Segments base(run.record.history);
  const auto new_scene = [&] { return scene_of(run.scenario); };
  const bool is_solvable = new_scene().system->is_solvable();
  bool expects_integration = has_forward_sensitivities(run.integrator.used);
  if (!expects_integration && !is_solvable) {
    const auto problem = add_integrated(run, base, new_scene);
    if (!problem) return;
    why = *problem;
    expects_integration = true;
  }
  if (expects_integration) {
    run.record.warnings.push_back(fmt::format("derivatives are differences of more runs: {}", why));
  }
  add_differences(run, base, is_solvable, why, scene_of);
}

}  // namespace monograin
