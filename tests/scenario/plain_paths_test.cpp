#include "scenario/plain_paths.hpp"

#include <gtest/gtest.h>

namespace monograin::plain_paths_test {
namespace {

using Paths = std::vector<std::string>;

TEST(PlainPaths, OfAPathWithoutARangeIsItself) {
  for (const char* path : {"", "material.yield_stress", "loading.wall[2].gap", "a[0][1].b"}) {
    EXPECT_EQ(plain_paths(path), Paths{path});
  }
}

TEST(PlainPaths, NameEachEntryOfARange) {
  EXPECT_EQ(plain_paths("loading.wall[2-4].gap"),
            (Paths{"loading.wall[2].gap", "loading.wall[3].gap", "loading.wall[4].gap"}));
  EXPECT_EQ(plain_paths("a[7].b[0-1]"), (Paths{"a[7].b[0]", "a[7].b[1]"}));
}

TEST(PlainPaths, CombineRanges) {
  EXPECT_EQ(plain_paths("a[0-1].b[3-4]"), (Paths{"a[0].b[3]", "a[0].b[4]", "a[1].b[3]", "a[1].b[4]"}));
}

TEST(PlainPaths, LeaveWhatIsNoRange) {
  for (const char* path : {"a[2-2]", "a[3-2]", "a[-2]", "a[2-]", "a[2-3", "a[2-3-4]", "a[x-y]", "a[0-1000]",
                           "a[0-99].b[0-99]", "a[0-1].b[0-99].c[0-99]", "a[0-99999999999999999999]"}) {
    EXPECT_EQ(plain_paths(path), Paths{path});
  }
}

}  // namespace
}  // namespace monograin::plain_paths_test
