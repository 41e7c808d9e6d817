#include "study/formula/constraint.hpp"

#include <algorithm>
#include <array>

namespace monograin {
namespace {

// Longer relations come first, so that `<=` is not read as `<`.
constexpr std::array<std::string_view, 4> k_relations{"<=", ">=", "<", ">"};

[[nodiscard]] bool is_met(double left, std::string_view relation, double right) {
  if (relation == "<=") return left <= right;
  if (relation == ">=") return left >= right;
  return relation == "<" ? left < right : left > right;
}

/// Calls `action` for a formula that begins at `offset` of a constraint, and shifts the position of an ExpressionError
/// from the formula to the constraint.
template <class Action>
auto shifted(std::size_t offset, Action action) {
  try {
    return action();
  } catch (const ExpressionError& error) {
    throw ExpressionError(offset + error.offset(), error.what(), error.unknown_name());
  }
}

}  // namespace

Constraint::Constraint(std::string_view text) {
  std::size_t begin = 0;
  for (;;) {
    const std::size_t end = std::min(text.find_first_of("<>", begin), text.size());
    sides_.push_back({shifted(begin, [&] { return Expression(text.substr(begin, end - begin)); }), begin});
    if (end == text.size()) break;
    const std::string_view rest = text.substr(end);
    relations_.push_back(
        *std::ranges::find_if(k_relations, [&](std::string_view relation) { return rest.starts_with(relation); }));
    begin = end + relations_.back().size();
  }
  if (relations_.empty()) throw ExpressionError(0, "expected an inequality, for example 100 <= a / b");
}

bool Constraint::holds(const Lookup& lookup) const {
  const auto value_of = [&](const Side& side) {
    const Expression::Lookup one = [&](std::string_view name) -> std::optional<std::vector<double>> {
      const std::optional<double> value = lookup(name);
      return value ? std::optional(std::vector<double>{*value}) : std::nullopt;
    };
    return shifted(side.offset, [&] { return side.formula.evaluate(one).front(); });
  };
  double left = value_of(sides_.front());
  bool holds = true;
  for (std::size_t i = 0; i < relations_.size(); ++i) {
    const double right = value_of(sides_[i + 1]);
    holds = holds && is_met(left, relations_[i], right);
    left = right;
  }
  return holds;
}

}  // namespace monograin
