#include "figure/fonts.hpp"

#include <gtest/gtest.h>

namespace monograin::figure::fonts_test {
namespace {

TEST(Letters, AreThoseThatNoFontHas) {
  EXPECT_EQ(letters_without_font("set label 'δ_o 压缩 µ'", "20-7e a0-17f\n391-3c9\n"), "压缩");
  EXPECT_EQ(letters_without_font("'压缩, 缩压'", "20-7e\n538b\n"), "缩") << "each once";
  EXPECT_EQ(letters_without_font("'压缩'", "4e00-9fff"), "");
  EXPECT_EQ(letters_without_font("'🪨'", "4e00-9fff 1faa7"), "🪨") << "a letter of four bytes, U+1FAA8";
  EXPECT_EQ(letters_without_font("'🪨'", "1faa8"), "");
}

TEST(Letters, MayBeGivenByTheNumbersOfTheirBytes) {
  EXPECT_EQ(letters_without_font("\"it's \\345\\216\\213\"", "20-7e"), "压");
  EXPECT_EQ(letters_without_font("\"it's \\345\\216\\213\"", "20-7e 538b"), "");
}

}  // namespace
}  // namespace monograin::figure::fonts_test
