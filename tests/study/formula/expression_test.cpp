#include "study/formula/expression.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "nonlocal/coupling.hpp"

namespace monograin::expression_test {
namespace {

using Values = std::vector<double>;

/// x has three rows, c is a number, `a name` is a column that needs backquotes.
Values value_of(const std::string& text) {
  return Expression(text).evaluate([](std::string_view name) -> std::optional<Values> {
    if (name == "axial.x") return Values{1.0, 4.0, 2.0};
    if (name == "c") return Values{2.0};
    if (name == "F_over_R^2") return Values{3.0, 6.0, 9.0};
    if (name == "gap") return Values{std::nan(""), 5.0, std::nan("")};
    if (name == "two") return Values{1.0, 2.0};
    return std::nullopt;
  });
}

std::string fault_of(const std::string& text) {
  try {
    static_cast<void>(value_of(text));
  } catch (const ExpressionError& error) {
    return std::to_string(error.offset()) + ": " + error.what();
  }
  return "no fault";
}

struct NumberCase {
  const char* text;
  double value;
};

TEST(Expression, BindsAsInAFormula) {
  for (const auto& [text, value] :
       {NumberCase{"2 + 3 * 4", 14}, NumberCase{"12 / 2 * 3", 18}, NumberCase{"12 / (2 * 3)", 2},
        NumberCase{"-2^2", -4}, NumberCase{"2^3^2", 512}, NumberCase{"2^-1", 0.5}, NumberCase{"8 - 2 - 1", 5},
        NumberCase{"sin(1)^2 + cos(1)^2", 1}, NumberCase{"tan(atan(3))", 3}, NumberCase{"log(sinh(2) + cosh(2))", 2},
        NumberCase{"tanh(1) * cosh(1) / sinh(1)", 1}, NumberCase{"1e3 * .5", 500},
        NumberCase{"sqrt(16) + abs(-1) + log(exp(2))", 7}, NumberCase{"c * c", 4}}) {
    const Values values = value_of(text);
    ASSERT_EQ(values.size(), 1U) << text;
    EXPECT_DOUBLE_EQ(values[0], value) << text;
  }
}

TEST(Expression, GoesThroughColumnsRowByRow) {
  EXPECT_EQ(value_of("axial.x / c"), (Values{0.5, 2.0, 1.0}));
  EXPECT_EQ(value_of("c * axial.x - axial.x"), (Values{1.0, 4.0, 2.0}));
  EXPECT_EQ(value_of("`F_over_R^2` / 3"), (Values{1.0, 2.0, 3.0}));
}

TEST(Expression, MakesOneNumberOfAColumn) {
  EXPECT_EQ(value_of("max(axial.x) - min(axial.x)"), (Values{3.0}));
  EXPECT_EQ(value_of("last(axial.x / c)"), (Values{1.0}));
  EXPECT_EQ(value_of("max(gap) + min(gap) + last(gap)"), (Values{15.0})) << "undefined rows do not count";
  EXPECT_EQ(value_of("end(axial.x)"), (Values{2.0}));
  EXPECT_TRUE(std::isnan(value_of("end(gap)").front())) << "the last row counts, defined or not";
}

TEST(Expression, NamesTheColumnsThatItReads) {
  const Expression formula("max(axial.force) / end(`contact radius`) + 2 * axial.force");
  EXPECT_EQ(formula.names(), (std::vector<std::string_view>{"axial.force", "contact radius", "axial.force"}));
  const Expression heading("max(axial.force[N])*2");
  EXPECT_EQ(heading.names(), (std::vector<std::string_view>{"axial.force[N]"}));
  const Expression number("sqrt(2) + 1");
  EXPECT_TRUE(number.names().empty());
}

TEST(Expression, KnowsWhetherRowsBeforeTheLastMatter) {
  for (const char* formula : {"end(work)", "end(a) / end(b) - 3", "1 + 1", "sqrt(end(a))"}) {
    EXPECT_TRUE(Expression(formula).needs_last_row_only()) << formula;
  }
  for (const char* formula : {"work", "max(work)", "last(work)", "end(a + b)", "end(a) + max(b)", "end(2 * a)"}) {
    EXPECT_FALSE(Expression(formula).needs_last_row_only()) << formula;
  }
}

TEST(Expression, KnowsLawsThatAreNoFormula) {
  using nonlocal::radius_influence;
  using nonlocal::RadiusRule;
  EXPECT_EQ(value_of("radius_influence_closed(0.3, 2, 0.5)"),
            (Values{radius_influence(RadiusRule::closed, 0.3, 2, 0.5)}));
  EXPECT_EQ(value_of("2 * radius_influence_integral(0.3, axial.x / c + 0.8, 0.25)"),
            (Values{2 * radius_influence(RadiusRule::integral, 0.3, 1.3, 0.25),
                    2 * radius_influence(RadiusRule::integral, 0.3, 2.8, 0.25),
                    2 * radius_influence(RadiusRule::integral, 0.3, 1.8, 0.25)}));
  const Values values = value_of("radius_influence_projected(0.3, 2, two - 0.5)");
  EXPECT_EQ(values[0], radius_influence(RadiusRule::projected, 0.3, 2, 0.5));
  EXPECT_TRUE(std::isnan(values[1])) << "wider than the particle";
}

TEST(Expression, SaysWhatIsWrongAndWhere) {
  EXPECT_EQ(fault_of("radius_influence_closed(c, c)"), "28: expected ','");
  EXPECT_EQ(fault_of("radius_influence_closed(c, axial.x, two)"), "0: 2 values do not go with 3");
  EXPECT_EQ(fault_of("2 * (c"), "6: expected ')'");
  EXPECT_EQ(fault_of("2 *"), "3: expected a number or a name");
  EXPECT_EQ(fault_of(""), "0: expected a number or a name");
  EXPECT_EQ(fault_of("2 c"), "2: expected an operator or the end");
  EXPECT_EQ(fault_of("c + sine(c)"), "4: there is no function 'sine'");
  EXPECT_EQ(fault_of("`c"), "1: the backquote is not closed");
  EXPECT_EQ(fault_of("c[N"), "1: the bracket of the unit is not closed");
  EXPECT_EQ(fault_of("c * d"), "4: unknown name 'd'");
  EXPECT_EQ(fault_of("axial.x + two"), "13: 3 values do not go with 2");
  EXPECT_EQ(fault_of(std::string(1000, '(')), "0: longer than 400 characters");
}

}  // namespace
}  // namespace monograin::expression_test
