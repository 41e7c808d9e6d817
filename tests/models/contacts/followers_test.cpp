#include "contacts/followers.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "models/contacts/laws.hpp"

namespace monograin::contacts_test::followers_test {
namespace {

const std::vector<ContactClass> k_die{{.name = "left", .normals = {{-1, 0, 0}}},
                                      {.name = "axial", .normals = {{0, 0, 1}, {0, 0, -1}}},
                                      {.name = "right", .normals = {{1, 0, 0}}}};

TEST(Followers, HaveTheFirstContactAsLeaderThatFollowsNone) {
  const contacts::Followers<Powerful> followers(Powerful{}, k_die);
  EXPECT_EQ(followers.leader(), 1U);
  EXPECT_EQ(followers.of(1), (std::vector{0, 2}));
  EXPECT_TRUE(followers.of(0).empty());
  for (const std::size_t i : {0U, 1U, 2U}) {
    EXPECT_EQ(followers.follows(i), i != 1U);
    EXPECT_EQ(followers.leading(i), 1U);
  }
}

TEST(Followers, DoNotExistUnlessALawNamesThem) {
  const contacts::Followers<Spring> followers(Spring{}, k_die);
  for (const std::size_t i : {0U, 1U, 2U}) {
    EXPECT_FALSE(followers.follows(i));
    EXPECT_EQ(followers.leading(i), i);
    EXPECT_TRUE(followers.of(i).empty());
  }
}

}  // namespace
}  // namespace monograin::contacts_test::followers_test
