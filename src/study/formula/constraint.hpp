/// Inequalities between formulas of named quantities, such as `100 <= E / Y <= 5000`.
#pragma once

#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "study/formula/expression.hpp"

namespace monograin {

/// A chain of formulas with `<`, `<=`, `>` or `>=` between neighbours. The constraint holds if all inequalities hold.
class Constraint {
 public:
  /// Gives the value of a named quantity, or nothing for an unknown name.
  using Lookup = std::function<std::optional<double>(std::string_view name)>;

  /// Parses a constraint.
  /// @throws ExpressionError with the fault and its position in the text
  explicit Constraint(std::string_view text);

  /// True if all inequalities hold. An inequality with an undefined side (NaN) does not hold.
  /// @throws ExpressionError for an unknown name
  [[nodiscard]] bool holds(const Lookup& lookup) const;

 private:
  struct Side {
    Expression formula;
    std::size_t offset = 0;  ///< position of the formula in the text, counted from 0
  };

  std::vector<Side> sides_;
  std::vector<std::string_view> relations_;  ///< relation k stands between sides k and k + 1
};

}  // namespace monograin
