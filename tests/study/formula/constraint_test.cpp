#include "study/formula/constraint.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace monograin::constraint_test {
namespace {

bool holds(std::string_view text, double a, double b = 0.0) {
  return Constraint(text).holds([=](std::string_view name) -> std::optional<double> {
    if (name == "a") return a;
    if (name == "key.b") return b;
    return std::nullopt;
  });
}

TEST(Constraints, HoldWhereEveryInequalityDoes) {
  for (const double a : {0.5, 1.0, 2.0, 3.0, 3.5}) EXPECT_EQ(holds("1 <= a < 3", a), a >= 1.0 && a < 3.0) << a;
  EXPECT_TRUE(holds("a > key.b >= 2", 3.0, 2.0));
  EXPECT_FALSE(holds("a > key.b >= 2", 2.0, 2.0));
  EXPECT_TRUE(holds("2*(a + key.b) <= 12 - 2", 2.0, 3.0));
}

TEST(Constraints, DoNotHoldWhereAFormulaHasNoValue) {
  EXPECT_FALSE(holds("a < 1", std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(holds("0 <= sqrt(a)", -1.0));
}

TEST(Constraints, TellWhereTheyAreWrong) {
  const auto offset_of = [](std::string_view text) {
    try {
      static_cast<void>(holds(text, 1.0));
    } catch (const ExpressionError& error) {
      return static_cast<int>(error.offset());
    }
    return -1;
  };
  EXPECT_EQ(offset_of("a"), 0) << "no inequality";
  EXPECT_EQ(offset_of("1 <="), 4);
  EXPECT_EQ(offset_of("1 <= a <= c"), 10) << "unknown name";
  EXPECT_EQ(offset_of("1 = a < 2"), 2);
}

}  // namespace
}  // namespace monograin::constraint_test
