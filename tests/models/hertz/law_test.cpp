#include "hertz/law.hpp"

#include <gtest/gtest.h>

#include "contacts/law_check.hpp"

namespace monograin::hertz::law_test {
namespace {

TEST(HertzLaw, HasFunctionsThatBelongTogether) {
  for (const double reach : {1e-9, 1e-3, 0.5, 0.99}) {
    EXPECT_EQ(contacts::contradiction_in(WallLaw{5e9}, reach), "") << reach;
  }
}

}  // namespace
}  // namespace monograin::hertz::law_test
