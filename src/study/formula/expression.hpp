/// Formulas over the columns of a table, as on the axes of a figure.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace monograin {

/// Fault of a formula: its text cannot be parsed, or it cannot be evaluated.
class ExpressionError : public std::runtime_error {
 public:
  ExpressionError(std::size_t offset, const std::string& message, std::string unknown_name = {})
      : std::runtime_error(message), offset_(offset), unknown_name_(std::move(unknown_name)) {}
  /// Position of the fault in the text of the formula, counted from 0.
  [[nodiscard]] std::size_t offset() const noexcept { return offset_; }
  /// The unknown name, if the fault is one; otherwise empty.
  [[nodiscard]] const std::string& unknown_name() const noexcept { return unknown_name_; }

 private:
  std::size_t offset_;
  std::string unknown_name_;
};

/// A parsed formula of numbers, names, `+ - * / ^`, brackets and functions.
///
/// Functions of each value: sqrt, exp, log, abs, sin, cos, tan, atan, sinh, cosh, tanh. Functions of a column: min,
/// max, last (of its defined values), end (value in the last row, even if undefined). Laws: radius_influence_closed,
/// radius_influence_integral, radius_influence_projected, with the arguments Poisson's ratio, angle, contact radius/R.
/// A name consists of letters, digits, `_` and `.`, with or without a unit in brackets (axial.force, axial.force[N]),
/// or is any text between backquotes.
///
/// `a / b * c` is (a / b) * c; `^` binds before them, and from the right.
class Expression {
 public:
  /// Gives the value of a name, or its values in all rows; nothing for an unknown name.
  using Lookup = std::function<std::optional<std::vector<double>>(std::string_view name)>;

  /// Parses a formula of at most 400 characters.
  /// @throws ExpressionError with the fault and its position
  explicit Expression(std::string_view text);

  /// Values of the formula: one for each row of the columns in it, or a single value if columns stand only inside min,
  /// max, last and end.
  /// @throws ExpressionError for an unknown name, or if columns differ in length
  [[nodiscard]] std::vector<double> evaluate(const Lookup& lookup) const;

  /// Names in the formula, in order, repeated as often as they occur.
  [[nodiscard]] std::vector<std::string_view> names() const&;
  void names() const&& = delete;  ///< the names would end with the expression
  /// True if every name stands alone inside end(), so that the value depends on the last row only.
  [[nodiscard]] bool needs_last_row_only() const noexcept;

 private:
  friend class ExpressionParser;

  enum class Operation { number, name, add, subtract, multiply, divide, power, negate, function };
  /// Instruction of a stack machine: operands come before their operation.
  struct Instruction {
    Operation operation = Operation::number;
    double number = 0.0;
    std::string name{};
    std::size_t offset = 0;  ///< position in the text of the formula
  };

  std::vector<Instruction> program_;
};

}  // namespace monograin
