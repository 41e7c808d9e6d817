#include "monograin/prepared.hpp"

#include <fmt/format.h>

#include <atomic>
#include <limits>
#include <stdexcept>

#include "api/checked.hpp"
#include "history/run.hpp"
#include "numerics/parallel.hpp"
#include "scenario/faults.hpp"
#include "scenario/words.hpp"
#include "study/formula/expression.hpp"

namespace monograin {
namespace {

constexpr double k_undefined = std::numeric_limits<double>::quiet_NaN();

/// One value of a run; NaN where the history has no rows or the value is undefined.
/// @throws std::invalid_argument where the formula has a value for each row, or an unknown name
double value_of(const Expression& formula, std::string_view text, const Table& history) {
  if (history.row_count() == 0) return k_undefined;
  try {
    const std::vector<double> values =
        formula.evaluate([&](std::string_view name) -> std::optional<std::vector<double>> {
          if (!history.find(name)) return std::nullopt;
          return history.column(name);
        });
    if (values.size() == 1) return values.front();
  } catch (const ExpressionError& error) {
    throw std::invalid_argument(fmt::format("'{}': {}", text, error.what()));
  }
  throw std::invalid_argument(
      fmt::format("'{}' has a value for each row; expected one for a run, for example max({})", text, text));
}

}  // namespace

struct PreparedScenario::Content {
  std::vector<std::string> keys;
  ScenarioTemplate scenario;

  [[nodiscard]] Run run(std::span<const double> values) const { return run_scenario(scenario.with({}, keys, values)); }
};

PreparedScenario::PreparedScenario(const Scenario& scenario, std::vector<std::string> keys) {
  const CheckedScenario all_right = checked(scenario);
  ScenarioTemplate prepared({.text = all_right.text, .origin = scenario.origin()}, all_right.overrides);
  FaultList faults;
  for (const std::string& key : keys) {
    if (const std::string problem = prepared.problem_of_number(key); !problem.empty()) faults.add({key}, problem);
  }
  faults.throw_if_any();
  content_ = std::make_shared<const Content>(Content{std::move(keys), std::move(prepared)});
}

const std::vector<std::string>& PreparedScenario::keys() const noexcept { return content_->keys; }

RunResult PreparedScenario::run(std::span<const double> values) const {
  if (values.size() != keys().size()) {
    throw std::invalid_argument(
        fmt::format("{} values for {} keys; expected one for each", values.size(), keys().size()));
  }
  return RunResult(std::make_shared<const Run>(content_->run(values)));
}

MapResult PreparedScenario::map(std::span<const double> samples, std::span<const std::string> formulas,
                                const MapOptions& options) const {
  const std::size_t width = keys().size();
  if (width == 0 || samples.size() % width != 0) {
    throw std::invalid_argument(fmt::format("{} values are no rows of {}", samples.size(), width));
  }
  std::vector<Expression> expressions;
  for (const std::string& text : formulas) {
    try {
      expressions.emplace_back(text);
    } catch (const ExpressionError& error) {
      throw std::invalid_argument(fmt::format("'{}': {}", text, error.what()));
    }
  }
  const std::size_t count = samples.size() / width;
  MapResult result{std::vector<double>(count * formulas.size(), k_undefined), std::vector<std::string>(count),
                   std::vector<std::string>(count)};
  std::atomic<bool> ends = false;
  for_each_index(count, thread_count(options.threads), [&](std::size_t i, std::size_t thread) {
    if (options.stop && thread == 0 && options.stop()) ends = true;
    if (ends) return;
    try {
      const Run run = content_->run(samples.subspan(i * width, width));
      for (std::size_t k = 0; k < expressions.size(); ++k) {
        result.values[i * formulas.size() + k] = value_of(expressions[k], formulas[k], run.record.history);
      }
      result.status[i] = to_string(run.record.status);
      result.message[i] = run.record.message;
    } catch (const ScenarioError& error) {
      result.status[i] = "refused";
      result.message[i] = error.faults().front().message;
    }
  });
  return result;
}

}  // namespace monograin
