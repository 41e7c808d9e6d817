#include "figure/text_width.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "figure/gnuplot.hpp"
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
  EXPECT_EQ(fitted_text("Mm", 0.8 * text_width("Mm")), "{/*0.80 Mm}");
}

/// Text of `{/*0.72 ...}`; the whole text if it has no size of its own.
std::string without_size(const std::string& fitted) {
  const std::size_t begin = std::string("{/*0.72 ").size();
  return fitted.starts_with("{/*") ? fitted.substr(begin, fitted.size() - begin - 1) : fitted;
}

TEST(FittedText, LosesItsMiddleBeforeItsLettersAreBelowSevenPoints) {
  const std::string name = verbatim_text("upper_punch_of_the_rotary_press_in_the_second_building");
  const double width = 0.4 * text_width(name);
  const std::string fitted = fitted_text(name, width);
  EXPECT_LE(text_width(without_size(fitted)), width / 0.72);
  EXPECT_GE(text_width(without_size(fitted)), 0.9 * width / 0.72) << "no room is wasted";
  EXPECT_TRUE(without_size(fitted).starts_with("upper\\_punch")) << fitted;
  EXPECT_TRUE(fitted.ends_with("building}")) << fitted;
}

TEST(FittedText, KeepsLettersAndGroupsWhole) {
  for (const char* text : {"{/:Italic σ}_{y0}{/:Italic σ}_{y1}{/:Italic σ}_{y2}{/:Italic σ}_{y3}{/:Italic σ}_{y4}",
                           "压缩压缩压缩压缩压缩压缩压缩压缩压缩", "a\\_b\\_c\\_d\\_e\\_f\\_g\\_h\\_i"}) {
    const std::string fitted = without_size(fitted_text(text, 0.5 * text_width(text)));
    const std::size_t gap = fitted.find("...");
    ASSERT_NE(gap, std::string::npos) << fitted;
    EXPECT_EQ(plain_text(fitted), fitted) << "no letter is cut";
    EXPECT_TRUE(std::string(text).starts_with(fitted.substr(0, gap))) << fitted;
    EXPECT_TRUE(std::string(text).ends_with(fitted.substr(gap + 3))) << fitted;
    EXPECT_EQ(std::ranges::count(fitted.substr(0, gap), '{'), std::ranges::count(fitted.substr(0, gap), '}')) << fitted;
    EXPECT_FALSE(fitted.substr(0, gap).ends_with('\\')) << fitted;
  }
}

TEST(FittedText, ShowsWhereLongNamesDiffer) {
  const std::string begin = "side wall of the die that was made of hardened steel and is ";
  const std::string end = " to the window in the laboratory on the second floor";
  const std::vector<std::string> names{begin + "closest" + end, begin + "furthest" + end, "axial",
                                       begin + "close" + end + end};
  const std::vector<std::string> fitted = fitted_texts(names, 0.35 * text_width(names[0]));
  EXPECT_EQ(std::set<std::string>(fitted.begin(), fitted.end()).size(), names.size()) << fitted[0];
  EXPECT_NE(fitted[0].find("...closest"), std::string::npos) << fitted[0];
  EXPECT_NE(fitted[1].find("...furthest"), std::string::npos) << fitted[1];
  EXPECT_EQ(fitted[2], "axial");
}

}  // namespace
}  // namespace monograin::figure::text_width_test
