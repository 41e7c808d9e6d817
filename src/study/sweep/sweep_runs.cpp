#include "study/sweep/sweep_runs.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scenario/overrides.hpp"

namespace monograin {

void SweepRuns::add(const std::vector<SweepValue>& values) {
  words_.resize(values.size());
  for (std::size_t f = 0; f < values.size(); ++f) {
    if (const auto* number = std::get_if<double>(&values[f])) {
      cells_.push_back(*number);
      continue;
    }
    const std::string& word = std::get<std::string>(values[f]);
    auto known = std::ranges::find(words_[f], word);
    if (known == words_[f].end()) known = words_[f].insert(known, word);
    cells_.push_back(static_cast<double>(known - words_[f].begin()));
  }
  ++size_;
}

std::vector<SweepValue> SweepRuns::operator[](std::size_t run) const {
  const std::size_t factors = words_.size();
  std::vector<SweepValue> values;
  values.reserve(factors);
  for (std::size_t f = 0; f < factors; ++f) {
    const double cell = cells_[run * factors + f];
    if (words_[f].empty()) {
      values.emplace_back(cell);
    } else {
      values.emplace_back(words_[f][static_cast<std::size_t>(cell)]);
    }
  }
  return values;
}

std::string cell_of(const SweepValue& value) {
  const auto* number = std::get_if<double>(&value);
  return number == nullptr ? std::get<std::string>(value) : csv_number(*number);
}

CheckedScenario scenario_with(const ScenarioTemplate& scenario, std::span<const SweepFactor> factors,
                              std::span<const SweepValue> values) {
  std::vector<std::string> words;
  std::vector<std::string> keys;
  std::vector<double> numbers;
  for (std::size_t f = 0; f < values.size(); ++f) {
    const auto& [key, unit, is_toggle] = factors[f];
    if (const auto* number = std::get_if<double>(&values[f])) {
      keys.push_back(key);
      numbers.push_back(*number);
    } else {
      const std::string& word = std::get<std::string>(values[f]);
      words.push_back(fmt::format("{}={}", key, is_toggle ? word : in_quotes(word)));
    }
  }
  return scenario.with(words, keys, numbers);
}

}  // namespace monograin
