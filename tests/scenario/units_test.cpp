#include "scenario/units.hpp"

#include <gtest/gtest.h>

#include <locale>
#include <numbers>

namespace monograin::units_test {
namespace {

struct UnitRow {
  const char* name;
  const char* text;
  Dimension dimension;
  double si;
};

class UnitTable : public ::testing::TestWithParam<UnitRow> {};

TEST_P(UnitTable, ReadsTextInSi) {
  const UnitRow& row = GetParam();
  const ParsedQuantity quantity = parse_quantity(row.text, row.dimension, 0.01);
  ASSERT_TRUE(quantity.value) << row.text << ": " << quantity.problem;
  // One rounding in the factor, one in the product.
  EXPECT_NEAR(*quantity.value, row.si, 4e-16 * std::abs(row.si)) << row.text;
}

INSTANTIATE_TEST_SUITE_P(
    Units, UnitTable,
    ::testing::Values(
        UnitRow{"metre", "2 m", Dimension::length, 2.0}, UnitRow{"centimetre", "2 cm", Dimension::length, 0.02},
        UnitRow{"millimetre", "10 mm", Dimension::length, 0.01}, UnitRow{"micrometre", "5 um", Dimension::length, 5e-6},
        UnitRow{"micro_sign", "5 \u00b5m", Dimension::length, 5e-6},
        UnitRow{"greek_mu", "5 \u03bcm", Dimension::length, 5e-6},
        UnitRow{"nanometre", "7 nm", Dimension::length, 7e-9},
        UnitRow{"kilometre", "1.5 km", Dimension::length, 1500.0},
        UnitRow{"initial_radii", "0.4 R0", Dimension::length, 0.004},
        UnitRow{"one_initial_radius", "R0", Dimension::length, 0.01},
        UnitRow{"negative_initial_radii", "-0.1 R0", Dimension::length, -0.001},
        UnitRow{"scientific", "1e-3 m", Dimension::length, 1e-3}, UnitRow{"plus_sign", "+1 m", Dimension::length, 1.0},
        UnitRow{"no_space", "10mm", Dimension::length, 0.01},
        UnitRow{"outer_spaces", " 10 mm ", Dimension::length, 0.01},
        UnitRow{"leading_point", ".5 m", Dimension::length, 0.5}, UnitRow{"pascal", "3 Pa", Dimension::stress, 3.0},
        UnitRow{"kilopascal", "3 kPa", Dimension::stress, 3e3}, UnitRow{"megapascal", "50 MPa", Dimension::stress, 5e7},
        UnitRow{"gigapascal", "1 GPa", Dimension::stress, 1e9},
        UnitRow{"newton_per_square_millimetre", "50 N/mm^2", Dimension::stress, 5e7},
        UnitRow{"psi", "1 psi", Dimension::stress, 6894.757293168361},
        UnitRow{"inch", "2 in", Dimension::length, 0.0508},
        UnitRow{"pound_force", "1 lbf", Dimension::force, 4.4482216152605},
        UnitRow{"gram_force", "1 gf", Dimension::force, 9.80665e-3},
        UnitRow{"kilogram_force", "1 kgf", Dimension::force, 9.80665},
        UnitRow{"superscript", "0.2 J/m²", Dimension::surface_energy, 0.2},
        UnitRow{"crosshead_speed", "3 mm/min", Dimension::velocity, 5e-5},
        UnitRow{"surface_energy", "2 mJ/m^2", Dimension::surface_energy, 2e-3},
        UnitRow{"surface_tension", "2 mN/m", Dimension::surface_energy, 2e-3},
        UnitRow{"newton", "1 N", Dimension::force, 1.0}, UnitRow{"kilonewton", "1 kN", Dimension::force, 1e3},
        UnitRow{"meganewton", "1 MN", Dimension::force, 1e6}, UnitRow{"millinewton", "1 mN", Dimension::force, 1e-3},
        UnitRow{"micronewton", "1 uN", Dimension::force, 1e-6}, UnitRow{"nanonewton", "1 nN", Dimension::force, 1e-9},
        UnitRow{"second", "1 s", Dimension::time, 1.0}, UnitRow{"millisecond", "1 ms", Dimension::time, 1e-3},
        UnitRow{"microsecond", "1 us", Dimension::time, 1e-6}, UnitRow{"nanosecond", "1 ns", Dimension::time, 1e-9},
        UnitRow{"minute", "2 min", Dimension::time, 120.0}, UnitRow{"hour", "2 h", Dimension::time, 7200.0},
        UnitRow{"velocity", "3 mm/s", Dimension::velocity, 3e-3},
        UnitRow{"radii_per_second", "0.1 R0/s", Dimension::velocity, 1e-3},
        UnitRow{"force_rate", "3 kN/s", Dimension::force_rate, 3e3},
        UnitRow{"degree", "180 deg", Dimension::angle, std::numbers::pi},
        UnitRow{"radian", "1 rad", Dimension::angle, 1.0}),
    [](const auto& row) { return std::string(row.param.name); });

class NoQuantity : public ::testing::TestWithParam<const char*> {};

TEST_P(NoQuantity, IsRefusedAsLength) {
  const ParsedQuantity quantity = parse_quantity(GetParam(), Dimension::length, 0.01);
  EXPECT_FALSE(quantity.value) << GetParam();
  EXPECT_NE(quantity.problem.find("expected a length, for example \"10 mm\""), std::string::npos) << quantity.problem;
}

INSTANTIATE_TEST_SUITE_P(Units, NoQuantity,
                         ::testing::Values("", " ", "10", "mm", "10 MM", "10 furlong", "10 Pa", "inf m", "nan m",
                                           "-inf m", "1e400 m", "0x10 m", "1,5 mm", "1_000 mm", "1 000 mm", "--1 m",
                                           "+-1 m", "e5 m", "-R0", "10 mm mm", "10 R1", ". m"));

TEST(Units, InitialRadiusIsRefusedWhereItIsBeingDefined) {
  const ParsedQuantity quantity = parse_quantity("1 R0", Dimension::length, std::nullopt);
  EXPECT_FALSE(quantity.value);
  EXPECT_NE(quantity.problem.find("cannot be given in itself"), std::string::npos) << quantity.problem;
}

TEST(Units, NameADecimalComma) {
  const ParsedQuantity quantity = parse_quantity("1,2 GPa", Dimension::stress, std::nullopt);
  EXPECT_FALSE(quantity.value);
  EXPECT_EQ(quantity.problem, "a decimal comma; expected a stress, for example \"50 MPa\", with a decimal point");
}

struct DecimalComma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
};

TEST(Units, DoNotDependOnTheLocale) {
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
  const ParsedQuantity quantity = parse_quantity("1.5 m", Dimension::length, std::nullopt);
  std::locale::global(before);
  ASSERT_TRUE(quantity.value);
  EXPECT_EQ(*quantity.value, 1.5);
}

TEST(PlausibleRange, IsFiniteAndKeepsZeroOutWhereItIsOut) {
  const Range range = plausible_range(Dimension::length, {.lower = 0.0, .lower_is_open = true});
  EXPECT_FALSE(range.contains(0.0));
  EXPECT_TRUE(range.contains(1e-12));
  EXPECT_TRUE(range.contains(1e6));
  EXPECT_FALSE(range.contains(1.1e6));
}

}  // namespace
}  // namespace monograin::units_test
