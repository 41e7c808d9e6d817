#include "study/formula/expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <span>
#include <system_error>
#include <utility>

#include "catalogue.hpp"
#include "scenario/words.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

using Values = std::vector<double>;

struct ValueFunction {
  std::string_view name;
  double (*value)(double);
};

constexpr ValueFunction k_value_functions[] = {
    {"sqrt", [](double x) { return std::sqrt(x); }}, {"exp", [](double x) { return std::exp(x); }},
    {"log", [](double x) { return std::log(x); }},   {"abs", [](double x) { return std::abs(x); }},
    {"sin", [](double x) { return std::sin(x); }},   {"cos", [](double x) { return std::cos(x); }},
    {"tan", [](double x) { return std::tan(x); }},   {"atan", [](double x) { return std::atan(x); }},
    {"sinh", [](double x) { return std::sinh(x); }}, {"cosh", [](double x) { return std::cosh(x); }},
    {"tanh", [](double x) { return std::tanh(x); }}};

constexpr std::array<std::string_view, 4> k_row_functions{"min", "max", "end", "last"};
constexpr std::size_t k_longest = 400;  ///< characters of a formula; also bounds the depth of the recursive parser

[[nodiscard]] bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
[[nodiscard]] bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Law of that name among formula_functions(), or null.
[[nodiscard]] const FormulaFunction* find_law(std::string_view name) {
  const auto laws = formula_functions();
  const auto found = std::ranges::find(laws, name, &FormulaFunction::name);
  return found == laws.end() ? nullptr : &*found;
}

/// Number of arguments of a function; 0 if there is no function of that name.
[[nodiscard]] std::size_t argument_count(std::string_view name) {
  if (const FormulaFunction* law = find_law(name)) return law->argument_count;
  const bool is_known =
      std::ranges::find(k_value_functions, name, &ValueFunction::name) != std::end(k_value_functions) ||
      std::ranges::find(k_row_functions, name) != k_row_functions.end();
  return is_known ? 1 : 0;
}

/// Reduces a column to one value by min, max, last or end. All but end skip undefined rows, such as the pressure before
/// first touch; the result is NaN if no row is defined.
[[nodiscard]] double reduced(std::string_view function, const Values& values) {
  if (function == "end") return values.empty() ? k_nan : values.back();
  double result = k_nan;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    const bool is_next =
        std::isnan(result) || function == "last" || (function == "min" ? value < result : value > result);
    if (is_next) result = value;
  }
  return result;
}

[[nodiscard]] Values applied(std::string_view function, Values values) {
  if (std::ranges::find(k_row_functions, function) != k_row_functions.end()) return {reduced(function, values)};
  const auto found = std::ranges::find(k_value_functions, function, &ValueFunction::name);
  for (double& value : values) value = found->value(value);
  return values;
}

}  // namespace

/// Parses a formula by recursive descent into the instructions of a stack machine.
class ExpressionParser {
 public:
  explicit ExpressionParser(std::string_view text) : text_(text) {}

  [[nodiscard]] std::vector<Expression::Instruction> parse() {
    if (text_.size() > k_longest) throw ExpressionError(0, fmt::format("longer than {} characters", k_longest));
    sum();
    skip_blanks();
    if (at_ < text_.size()) fail("expected an operator or the end");
    return std::move(program_);
  }

 private:
  using Operation = Expression::Operation;

  void sum() {
    product();
    for (;;) {
      if (take('+')) {
        product();
        emit(Operation::add);
      } else if (take('-')) {
        product();
        emit(Operation::subtract);
      } else {
        return;
      }
    }
  }

  void product() {
    signed_power();
    for (;;) {
      if (take('*')) {
        signed_power();
        emit(Operation::multiply);
      } else if (take('/')) {
        signed_power();
        emit(Operation::divide);
      } else {
        return;
      }
    }
  }

  void signed_power() {
    if (take('-')) {
      signed_power();
      emit(Operation::negate);
      return;
    }
    atom();
    if (take('^')) {
      signed_power();
      emit(Operation::power);
    }
  }

  void atom() {
    skip_blanks();
    if (at_ == text_.size()) fail("expected a number or a name");
    const char c = text_[at_];
    if (take('(')) {
      sum();
      require(')');
    } else if (c == '`') {
      quoted_name();
    } else if (is_digit(c) || c == '.') {
      number();
    } else if (is_letter(c)) {
      name();
    } else {
      fail("expected a number or a name");
    }
  }

  void number() {
    Expression::Instruction instruction{.operation = Operation::number, .offset = at_};
    const char* const begin = text_.data() + at_;
    const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), instruction.number);
    if (error != std::errc{}) fail("not a number");
    at_ += static_cast<std::size_t>(end - begin);
    program_.push_back(std::move(instruction));
  }

  void quoted_name() {
    const std::size_t begin = ++at_;
    const std::size_t end = text_.find('`', begin);
    if (end == std::string_view::npos) fail("the backquote is not closed");
    at_ = end + 1;
    program_.push_back(
        {.operation = Operation::name, .name = std::string(text_.substr(begin, end - begin)), .offset = begin});
  }

  void name() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]) || text_[at_] == '.')) ++at_;
    if (at_ < text_.size() && text_[at_] == '[') {
      const std::size_t end = text_.find(']', at_);
      if (end == std::string_view::npos) fail("the bracket of the unit is not closed");
      at_ = end + 1;
    }
    const std::string_view word = text_.substr(begin, at_ - begin);
    if (!take('(')) {
      program_.push_back({.operation = Operation::name, .name = std::string(word), .offset = begin});
      return;
    }
    const std::size_t count = argument_count(word);
    if (count == 0) throw ExpressionError(begin, fmt::format("there is no function '{}'", word));
    sum();
    for (std::size_t k = 1; k < count; ++k) {
      require(',');
      sum();
    }
    require(')');
    program_.push_back({.operation = Operation::function, .name = std::string(word), .offset = begin});
  }

  void emit(Operation operation) { program_.push_back({.operation = operation, .offset = at_}); }

  void skip_blanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  }

  bool take(char c) {
    skip_blanks();
    if (at_ == text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  void require(char c) {
    if (!take(c)) fail(fmt::format("expected '{}'", c));
  }

  [[noreturn]] void fail(const std::string& message) const { throw ExpressionError(at_, message); }

  std::string_view text_;
  std::size_t at_ = 0;
  std::vector<Expression::Instruction> program_;
};

namespace {

template <class Combine>
[[nodiscard]] Values combined(Values left, const Values& right, std::size_t offset, Combine combine) {
  if (left.size() == 1 && right.size() != 1) left.assign(right.size(), left.front());
  if (right.size() != 1 && right.size() != left.size()) {
    throw ExpressionError(offset, fmt::format("{} values do not go with {}", left.size(), right.size()));
  }
  for (std::size_t k = 0; k < left.size(); ++k) left[k] = combine(left[k], right[right.size() == 1 ? 0 : k]);
  return left;
}

[[nodiscard]] Values evaluated(const FormulaFunction& law, std::span<const Values> arguments, std::size_t offset) {
  const std::size_t count = std::ranges::max(arguments, {}, &Values::size).size();
  for (const Values& values : arguments) {
    if (values.size() != 1 && values.size() != count) {
      throw ExpressionError(offset, fmt::format("{} values do not go with {}", values.size(), count));
    }
  }
  Values result(count);
  Values of_row(arguments.size());
  for (std::size_t row = 0; row < count; ++row) {
    for (std::size_t i = 0; i < arguments.size(); ++i) of_row[i] = arguments[i][arguments[i].size() == 1 ? 0 : row];
    result[row] = law.value(of_row);
  }
  return result;
}

}  // namespace

Expression::Expression(std::string_view text) : program_(ExpressionParser(text).parse()) {}

std::vector<double> Expression::evaluate(const Lookup& lookup) const {
  std::vector<Values> stack;
  const auto combine_last_two = [&](const Instruction& step, auto combine) {
    const Values right = std::move(stack.back());
    stack.pop_back();
    stack.back() = combined(std::move(stack.back()), right, step.offset, combine);
  };
  for (const Instruction& step : program_) {
    switch (step.operation) {
      case Operation::number:
        stack.push_back({step.number});
        break;
      case Operation::name: {
        auto values = lookup(step.name);
        if (!values) throw ExpressionError(step.offset, fmt::format("unknown name '{}'", shown(step.name)), step.name);
        stack.push_back(std::move(*values));
        break;
      }
      case Operation::add:
        combine_last_two(step, [](double a, double b) { return a + b; });
        break;
      case Operation::subtract:
        combine_last_two(step, [](double a, double b) { return a - b; });
        break;
      case Operation::multiply:
        combine_last_two(step, [](double a, double b) { return a * b; });
        break;
      case Operation::divide:
        combine_last_two(step, [](double a, double b) { return a / b; });
        break;
      case Operation::power:
        combine_last_two(step, [](double a, double b) { return std::pow(a, b); });
        break;
      case Operation::negate:
        for (double& value : stack.back()) value = -value;
        break;
      case Operation::function: {
        const FormulaFunction* law = find_law(step.name);
        if (law == nullptr) {
          stack.back() = applied(step.name, std::move(stack.back()));
        } else {
          const std::size_t count = law->argument_count;
          Values result = evaluated(*law, std::span<const Values>(stack).last(count), step.offset);
          stack.resize(stack.size() - count + 1);
          stack.back() = std::move(result);
        }
        break;
      }
    }
  }
  return std::move(stack.back());
}

std::vector<std::string_view> Expression::names() const& {
  std::vector<std::string_view> result;
  for (const Instruction& step : program_) {
    if (step.operation == Operation::name) result.emplace_back(step.name);
  }
  return result;
}

bool Expression::needs_last_row_only() const noexcept {
  for (std::size_t k = 0; k < program_.size(); ++k) {
    if (program_[k].operation != Operation::name) continue;
    const bool is_end =
        k + 1 < program_.size() && program_[k + 1].operation == Operation::function && program_[k + 1].name == "end";
    if (!is_end) return false;
  }
  return true;
}

}  // namespace monograin
