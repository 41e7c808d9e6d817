#include "study/sweep/constraint_section.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <variant>

#include "scenario/words.hpp"
#include "study/sweep/column_section.hpp"

namespace monograin::sweep {

std::vector<PlacedConstraint> constraints_in(Reading& reading, const Section& root) {
  std::vector<PlacedConstraint> constraints;
  const std::vector<std::string> texts = root.texts("constraints");
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const SourceLocation where = root.value_place("constraints", i);
    try {
      constraints.push_back({Constraint(texts[i]), texts[i], where});
    } catch (const ExpressionError& error) {
      add_formula_fault(reading.faults, where, texts[i], error);
    }
  }
  return constraints;
}

void check_names(std::span<const PlacedConstraint> constraints, std::span<const Factor> factors, bool takes_lists,
                 FaultList& faults) {
  std::vector<std::string_view> names;
  for (const Factor& factor : factors) {
    if (factor.is_number() && (takes_lists || factor.values.empty())) names.push_back(factor.key);
  }
  for (const PlacedConstraint& entry : constraints) {
    try {
      static_cast<void>(entry.constraint.holds([&](std::string_view name) {
        return std::ranges::find(names, name) == names.end() ? std::nullopt : std::optional(1.0);
      }));
    } catch (const ExpressionError& error) {
      const std::string suggestion = did_you_mean(error.unknown_name(), names);
      add_formula_fault(faults, entry.where, entry.text, error,
                        suggestion.empty() ? "; expected one of " + listed(names) : suggestion);
    }
  }
}

const PlacedConstraint* broken_constraint(std::span<const PlacedConstraint> constraints,
                                          std::span<const Factor> factors, std::span<const SweepValue> run) {
  const Constraint::Lookup lookup = [&](std::string_view name) -> std::optional<double> {
    const auto factor = std::ranges::find(factors, name, &Factor::key);
    if (factor == factors.end()) return std::nullopt;
    const auto* number = std::get_if<double>(&run[static_cast<std::size_t>(factor - factors.begin())]);
    return number == nullptr ? std::nullopt : std::optional(*number);
  };
  for (const PlacedConstraint& entry : constraints) {
    if (!entry.constraint.holds(lookup)) return &entry;
  }
  return nullptr;
}

}  // namespace monograin::sweep
