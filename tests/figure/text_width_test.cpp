#include "figure/text_width.hpp"

#include <gtest/gtest.h>

#include "figure/page.hpp"

namespace monograin::figure::text_width_test {
namespace {

constexpr double k_em = 0.353;  // [cm]

TEST(TextWidth, IsThatOfWhatATextShows) {
  EXPECT_NEAR(text_width("Mm"), (0.87 + 0.98) * k_em, 1e-12);
  EXPECT_DOUBLE_EQ(text_width("{/:Italic Mm}"), text_width("Mm"));
  EXPECT_DOUBLE_EQ(text_width(verbatim_text("a_b")), text_width("a") + text_width("b") + 0.5 * k_em);
  EXPECT_DOUBLE_EQ(text_width("ν"), 0.84 * k_em) << "one letter of two bytes";
}

TEST(TextWidth, TakesSubscriptsForSmaller) {
  EXPECT_DOUBLE_EQ(text_width("R_0"), text_width("R") + 0.8 * text_width("0"));
  EXPECT_DOUBLE_EQ(text_width("σ_{y0}z"), text_width("σz") + 0.8 * text_width("y0"));
}

TEST(FittedText, IsSmallerOnlyWhereItIsTooWide) {
  EXPECT_EQ(fitted_text("Mm", 1.0), "Mm");
  EXPECT_EQ(fitted_text("Mm", 0.5 * text_width("Mm")), "{/*0.50 Mm}");
}

}  // namespace
}  // namespace monograin::figure::text_width_test
