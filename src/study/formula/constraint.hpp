/// Inequalities between named quantities, such as `100 <= E / Y <= 5000`.
#pragma once

#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "study/formula/expression.hpp"

namespace monograin {

/// Formulas with `<`, `<=`, `>` or `>=` between them; all of the inequalities have to hold.
class Constraint {
 public:
  /// A quantity's value, or nothing for a name that is not known.
  using Lookup = std::function<std::optional<double>(std::string_view name)>;

  /// @throws ExpressionError saying what is wrong, and where in the text
  explicit Constraint(std::string_view text);

  /// False too where a formula has no value (nan).
  /// @throws ExpressionError naming an unknown name
  [[nodiscard]] bool holds(const Lookup& lookup) const;

 private:
  struct Side {
    Expression formula;
    std::size_t offset = 0;  ///< of the formula in the text
  };

  std::vector<Side> sides_;
  std::vector<std::string_view> relations_;  ///< between a side and the next
};

}  // namespace monograin
