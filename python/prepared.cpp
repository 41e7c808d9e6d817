#include "prepared.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "scenario/document.hpp"
#include "scenario/faults.hpp"
#include "scenario/key_path.hpp"
#include "scenario/overrides.hpp"
#include "scenario/words.hpp"

namespace monograin::python {
namespace {

[[nodiscard]] bool takes_number(KeySpec::Kind kind) noexcept {
  return kind == KeySpec::Kind::integer || kind == KeySpec::Kind::quantity || kind == KeySpec::Kind::pair;
}

void require_number_keys(const Scenario& scenario, const std::string& origin, const std::vector<std::string>& keys) {
  toml::table root = parse_document(scenario.text, origin);
  FaultList faults;
  for (const std::string& override_text : scenario.overrides) apply_override(root, override_text, faults);
  for (const std::string& key : keys) {
    const KeyAnswer answer = key_at(key, root, scenario.model);
    if (answer.spec && takes_number(answer.spec->kind)) continue;
    faults.add({origin}, answer.spec ? fmt::format("'{}' takes no number; expected keys of numbers", shown(key))
                                     : answer.problem);
  }
  faults.throw_if_any();
}

[[nodiscard]] double value_of(const Expression& formula, const Table& history) {
  const std::vector<double> values = formula.evaluate([&](std::string_view name) {
    const auto column = history.find(name);
    std::optional<std::vector<double>> found;
    if (!column || history.columns()[*column].holds_words()) return found;
    found.emplace(history.row_count());
    for (std::size_t row = 0; row < found->size(); ++row) (*found)[row] = history.at(row, *column);
    return found;
  });
  if (values.size() == 1) return values.front();
  throw ExpressionError(0, fmt::format("a formula gives {} numbers, one for each row of the history; expected one, for "
                                       "example by max(...) or end(...)",
                                       values.size()));
}

[[nodiscard]] RowStatus row_status(RunStatus status) noexcept {
  switch (status) {
    case RunStatus::complete:
      return RowStatus::complete;
    case RunStatus::stopped:
      return RowStatus::stopped;
    case RunStatus::failed:
      break;
  }
  return RowStatus::failed;
}

}  // namespace

Prepared::Prepared(const Scenario& scenario, const std::string& origin, std::vector<std::string> keys)
    : template_(scenario.text, origin), overrides_(scenario.overrides), keys_(std::move(keys)) {
  require_number_keys(scenario, origin, keys_);
}

Scenario Prepared::with(std::span<const double> values) const {
  if (values.size() != keys_.size()) {
    throw std::invalid_argument(fmt::format("{} values for {} keys", values.size(), keys_.size()));
  }
  std::vector<std::string> overrides = overrides_;
  for (std::size_t k = 0; k < keys_.size(); ++k) overrides.push_back(keys_[k] + '=' + csv_number(values[k]));
  return template_.with(overrides);
}

RowStatus Prepared::run_row(std::span<const double> values, const std::vector<Expression>& formulas,
                            std::span<double> results) const {
  std::ranges::fill(results, std::numeric_limits<double>::quiet_NaN());
  try {
    const Run run = run_scenario(with(values));
    const RowStatus status = row_status(run.record.status);
    if (status == RowStatus::failed) return status;
    for (std::size_t k = 0; k < formulas.size(); ++k) results[k] = value_of(formulas[k], run.record.history);
    return status;
  } catch (const ScenarioError&) {
    return RowStatus::refused;
  }
}

void Prepared::map(const Batch& batch, const std::atomic<bool>& stop) const {
  const int threads = batch.threads > 0 ? batch.threads : oneapi::tbb::info::default_concurrency();
  const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism,
                                          static_cast<std::size_t>(threads));
  oneapi::tbb::task_arena(threads).execute([&] {
    oneapi::tbb::parallel_for(std::size_t{0}, batch.statuses.size(), [&](std::size_t row) {
      if (stop || batch.statuses[row] != RowStatus::pending) return;
      batch.statuses[row] = run_row(batch.samples.subspan(row * keys_.size(), keys_.size()), batch.formulas,
                                    batch.results.subspan(row * batch.formulas.size(), batch.formulas.size()));
    });
  });
}

}  // namespace monograin::python
