/// Formulas over the columns of a table: what a figure has on its axes.
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

/// A text that is no formula, or a formula that has no value where it is asked for one.
class ExpressionError : public std::runtime_error {
 public:
  ExpressionError(std::size_t offset, const std::string& message, std::string unknown_name = {})
      : std::runtime_error(message), offset_(offset), unknown_name_(std::move(unknown_name)) {}
  /// Place in the formula's text, counted from 0.
  [[nodiscard]] std::size_t offset() const noexcept { return offset_; }
  /// The name that is not known, where that is what is wrong.
  [[nodiscard]] const std::string& unknown_name() const noexcept { return unknown_name_; }

 private:
  std::size_t offset_;
  std::string unknown_name_;
};

/// A formula of numbers, names, `+ - * / ^`, brackets and the functions sqrt, exp, log, abs, sin, cos, tan, atan, sinh,
/// cosh, tanh (value by value), min, max, last (one value of all that are defined), end (that of the last row, defined
/// or not), and laws that are no formula: radius_influence_closed, _integral, _projected of Poisson's ratio, angle,
/// contact radius over R. A name is letters, digits, `_` and `.` (axial.force), or any text between backquotes.
///
/// `a / b * c` is (a / b) * c; `^` binds first and from the right.
class Expression {
 public:
  /// One value, or one for each row; nothing for a name that is not known.
  using Lookup = std::function<std::optional<std::vector<double>>(std::string_view name)>;

  /// @throws ExpressionError saying what is wrong, and where
  explicit Expression(std::string_view text);

  /// All values: as many as the columns in it have rows; one if there is no column in it, or only below min, max,
  /// last, end.
  /// @throws ExpressionError naming an unknown name, or where the lengths of columns differ
  [[nodiscard]] std::vector<double> evaluate(const Lookup& lookup) const;

  /// Every name in it, as often as it stands there.
  [[nodiscard]] std::vector<std::string_view> names() const;
  /// True if all names stand alone in end(): earlier rows make no difference.
  [[nodiscard]] bool needs_last_row_only() const noexcept;

 private:
  friend class ExpressionParser;

  enum class Operation { number, name, add, subtract, multiply, divide, power, negate, function };
  /// Operands come before their operation, as on a stack machine.
  struct Instruction {
    Operation operation = Operation::number;
    double number = 0.0;
    std::string name{};
    std::size_t offset = 0;
  };

  std::vector<Instruction> program_;
};

}  // namespace monograin
