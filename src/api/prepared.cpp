#include "monograin/prepared.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <optional>
#include <stdexcept>

#include "api/checked.hpp"
#include "api/untrapped.hpp"
#include "history/recorder.hpp"
#include "history/run.hpp"
#include "numerics/parallel.hpp"
#include "scenario/faults.hpp"
#include "scenario/file_keys.hpp"
#include "scenario/words.hpp"
#include "scene/scene.hpp"
#include "study/formula/expression.hpp"
#include "system/resolution.hpp"

namespace monograin {

void check_threads(int threads) {
  if (threads >= 0) return;
  throw std::invalid_argument(fmt::format("threads = {}: expected 0 for one for each core, or more", threads));
}
namespace {

/// True for the name of a derivative, which only a run with its sensitivities has.
bool is_derivative(std::string_view name) { return name.starts_with("d("); }

/// Advice on an unknown name: a column with a similar name, or one whose name needs backquotes.
std::string advice_on(std::string_view name, const std::vector<std::string_view>& columns) {
  const auto is_of_names = [](char c) { return c == '_' || c == '.' || std::isalnum(static_cast<unsigned char>(c)); };
  for (const std::string_view column : columns) {
    if (!column.starts_with(name) || column.size() == name.size() || is_of_names(column[name.size()])) continue;
    return fmt::format("; names with other characters than letters, digits, '_' and '.' stand in backquotes: `{}`",
                       column);
  }
  return did_you_mean(name, columns);
}

/// Names of the columns that runs of a scenario may have.
struct ColumnNames {
  std::vector<std::string> numbers;
  std::vector<std::string> units;  ///< of the columns of numbers; derivatives have none here
  std::vector<std::string> words;
};

/// A column's name, and the unit that a formula gives it; none if it gives none.
struct NameInFormula {
  std::string_view name;
  std::optional<std::string_view> unit{};
};

NameInFormula parts_of(std::string_view name) {
  const std::size_t bracket = name.rfind('[');
  if (bracket == std::string_view::npos || !name.ends_with(']')) return {name};
  return {name.substr(0, bracket), name.substr(bracket + 1, name.size() - bracket - 2)};
}

/// Names of the columns of a scene, of each wall alone, which other numbers may take out of its class, and of the
/// derivatives.
ColumnNames names_of_columns(const CheckedScenario& scenario) {
  const Scene scene = make_scene(scenario);
  const Table columns = Recorder(*scene.system, {}).take_history();
  ColumnNames found;
  for (const Column& column : columns.columns()) {
    const auto add = [&](std::string name) {
      (column.labels.empty() ? found.numbers : found.words).push_back(std::move(name));
      if (column.labels.empty()) found.units.push_back(column.unit);
    };
    add(column.name);
    const std::size_t point = column.name.find('.');
    if (point == std::string::npos) continue;
    for (const WallSpec& wall : scenario.loading.walls) add(wall.name + column.name.substr(point));
  }
  const std::size_t count = found.numbers.size();
  for (const SensitivityKey& key : scenario.sensitivities) {
    for (std::size_t k = 0; k < count; ++k) {
      found.numbers.push_back(fmt::format("d({})/d({})", found.numbers[k], key.key));
    }
  }
  return found;
}

/// Checks the names in a formula by the columns that runs may have.
/// @throws std::invalid_argument for an unknown name, another unit than that of the column, or a column of words
void check_names(const Expression& formula, std::string_view text, const ColumnNames& columns) {
  const std::vector<std::string_view> known(columns.numbers.begin(), columns.numbers.end());
  for (const std::string_view name : formula.names()) {
    if (std::ranges::find(known, name) != known.end()) continue;
    const auto [without_unit, unit] = parts_of(name);
    const auto found = static_cast<std::size_t>(std::ranges::find(known, without_unit) - known.begin());
    const bool is_derivative = found >= columns.units.size() && found < known.size();
    if (is_derivative || (found < known.size() && unit == columns.units[found])) continue;
    if (found < known.size()) {
      const std::string heading = Column{.name = columns.numbers[found], .unit = columns.units[found]}.heading();
      throw std::invalid_argument(
          fmt::format("'{}': there is no '{}'; expected {}, or the name without a unit", text, shown(name), heading));
    }
    if (std::ranges::find(columns.words, without_unit) != columns.words.end()) {
      throw std::invalid_argument(
          fmt::format("'{}': column '{}' holds words, and a formula takes numbers; the history of a single run has the "
                      "words",
                      text, without_unit));
    }
    throw std::invalid_argument(fmt::format("'{}': unknown name '{}'{}", text, shown(name), advice_on(name, known)));
  }
}

/// Value of a formula over a history; NaN if the history has no rows, or the value is undefined.
/// @param missing  receives the name of a column that the history lacks; the value is NaN then
/// @throws std::invalid_argument if the formula has a value for each row
double value_of(const Expression& formula, std::string_view text, const Table& history, std::string& missing) {
  if (history.row_count() == 0) return k_nan;
  try {
    const std::vector<double> values =
        formula.evaluate([&](std::string_view name) -> std::optional<std::vector<double>> {
          if (!history.find(name)) return std::nullopt;
          return history.column(name);
        });
    if (values.size() == 1) return values.front();
  } catch (const ExpressionError& error) {
    if (error.unknown_name().empty()) throw std::invalid_argument(fmt::format("'{}': {}", text, error.what()));
    missing = error.unknown_name();
    return k_nan;
  }
  throw std::invalid_argument(
      fmt::format("'{}' has a value for each row; expected one for a run, for example max({})", text, text));
}

/// Parts of a history that the formulas do not need, and that a run may leave out.
LeftOut not_needed_by(std::span<const Expression> formulas) {
  const auto names_energy = [](const Expression& formula) {
    return std::ranges::any_of(formula.names(), [](std::string_view name) { return is_energy(parts_of(name).name); });
  };
  return {.energies = std::ranges::none_of(formulas, names_energy),
          .rows = std::ranges::all_of(formulas, &Expression::needs_last_row_only)};
}

}  // namespace

struct PreparedScenario::Content {
  std::vector<std::string> keys;
  ScenarioTemplate scenario;

  /// The scenario with these values of the keys [SI]. @throws ScenarioError if a value is not admissible
  [[nodiscard]] CheckedScenario with(std::span<const double> values) const { return scenario.with({}, keys, values); }
  /// The scenario with its own values.
  [[nodiscard]] CheckedScenario as_it_is() const { return scenario.with({}); }

  /// Runs the scenario with these values and leaves out parts of the history. Only a whole run has the columns of
  /// derivatives.
  [[nodiscard]] RunRecord record(std::span<const double> values, const LeftOut& left_out, bool has_derivatives) const {
    const CheckedScenario changed = with(values);
    return has_derivatives ? run_scenario(changed).record : record_run(changed, left_out);
  }
};

PreparedScenario::PreparedScenario(const Scenario& scenario, std::vector<std::string> keys) {
  const Untrapped untrapped;
  if (keys.empty()) throw std::invalid_argument("keys: expected at least one");
  const CheckedScenario all_right = checked(scenario);
  FileTexts files;  // later runs do not depend on what becomes of them
  for (FileKey& key : file_keys(all_right)) files.emplace(std::move(key.name), std::move(key.text));
  ScenarioTemplate prepared({.text = all_right.text, .origin = scenario.origin(), .files = std::move(files)},
                            all_right.overrides);
  FaultList faults;
  for (auto key = keys.begin(); key != keys.end(); ++key) {
    if (std::find(keys.begin(), key, *key) != key) {
      faults.add({*key}, "the key is listed twice; expected it once");
    } else if (const std::string problem = prepared.problem_of_number(*key); !problem.empty()) {
      faults.add({*key}, problem);
    }
  }
  faults.throw_if_any();
  content_ = std::make_shared<const Content>(Content{std::move(keys), std::move(prepared)});
}

const std::vector<std::string>& PreparedScenario::keys() const noexcept { return content_->keys; }

RunResult PreparedScenario::run(std::span<const double> values, const RunOptions& options) const {
  const Untrapped untrapped;
  if (values.size() != keys().size()) {
    throw std::invalid_argument(
        fmt::format("{} values for {} keys; expected one for each", values.size(), keys().size()));
  }
  return RunResult(std::make_shared<const Run>(run_scenario(content_->with(values), interruptible(options.stop))));
}

MapResult PreparedScenario::map(std::span<const double> samples, std::span<const std::string> formulas,
                                const MapOptions& options) const {
  const Untrapped untrapped;
  const std::size_t width = keys().size();
  if (samples.size() % width != 0) {
    throw std::invalid_argument(fmt::format("{} values are no rows of {}", samples.size(), width));
  }
  check_threads(options.threads);
  std::vector<Expression> expressions;
  for (const std::string& text : formulas) {
    try {
      expressions.emplace_back(text);
    } catch (const ExpressionError& error) {
      throw std::invalid_argument(fmt::format("'{}': {}", text, error.what()));
    }
  }
  const ColumnNames columns = names_of_columns(content_->as_it_is());
  for (std::size_t k = 0; k < expressions.size(); ++k) check_names(expressions[k], formulas[k], columns);
  const LeftOut left_out = not_needed_by(expressions);
  const bool has_derivatives = std::ranges::any_of(
      expressions, [](const Expression& formula) { return std::ranges::any_of(formula.names(), is_derivative); });
  const std::size_t count = samples.size() / width;
  MapResult result{std::vector<double>(count * formulas.size(), k_nan), std::vector<std::string>(count),
                   std::vector<std::string>(count)};
  std::atomic<bool> ends = false;
  for_each_index(count, thread_count(options.threads), [&](std::size_t i, std::size_t thread) {
    if (options.stop && thread == 0 && options.stop()) ends = true;
    if (ends) return;
    try {
      const RunRecord record = content_->record(samples.subspan(i * width, width), left_out, has_derivatives);
      result.status[i] = to_string(record.status);
      result.message[i] = record.message;
      for (std::size_t k = 0; k < expressions.size(); ++k) {
        std::string missing;
        result.values[i * formulas.size() + k] = value_of(expressions[k], formulas[k], record.history, missing);
        // Walls that move alike may be one class in this run alone.
        if (missing.empty() || !result.message[i].empty()) continue;
        result.message[i] = fmt::format("the run has no column '{}'", shown(missing));
      }
    } catch (const ScenarioError& error) {
      result.status[i] = "refused";
      result.message[i] = error.faults().front().message;
    }
  });
  return result;
}

}  // namespace monograin
