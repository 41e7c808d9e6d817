#include "system/limit.hpp"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>
#include <string>

#include "system/difficulty.hpp"

namespace {

using monograin::advice;
using monograin::as_domain_error;
using monograin::code;
using monograin::Difficulty;
using monograin::DomainError;
using monograin::Limit;
using monograin::sentence;
using monograin::text_of;

// The last enumerator; those before it are counted from 0.
constexpr auto k_last = Limit::unequal_durations;

TEST(Limits, HaveACodeEachThatIsAWordOfLowerCaseLettersAndHyphens) {
  std::set<std::string> codes;
  for (int k = 0; k <= static_cast<int>(k_last); ++k) {
    const std::string name(code(static_cast<Limit>(k)));
    EXPECT_FALSE(name.empty());
    EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz-"), std::string::npos) << name;
    EXPECT_TRUE(codes.insert(name).second) << name;
  }
}

TEST(Limits, HaveASentenceEachWithoutAFullStop) {
  std::set<std::string> sentences;
  for (int k = 0; k <= static_cast<int>(k_last); ++k) {
    const std::string text(sentence(static_cast<Limit>(k)));
    ASSERT_FALSE(text.empty()) << k;
    EXPECT_NE(text.back(), '.') << text;
    EXPECT_TRUE(sentences.insert(text).second) << text;
  }
}

TEST(Limits, ShowTheNumberThatMeetsThem) {
  EXPECT_EQ(text_of({Limit::walls_meet, 2, "displacement/R0", 0.999999999123}),
            "the walls meet (displacement/R0 = 0.999999999)");
  EXPECT_EQ(text_of({.limit = Limit::walls_meet}), "the walls meet");
}

TEST(DomainErrors, CarryTheirLimitThroughWhoeverCatchesThem) {
  try {
    throw DomainError({Limit::greatest_force, 1, "stiffness left", 0.01});
  } catch (const std::domain_error& error) {
    const DomainError known = as_domain_error(error);
    EXPECT_EQ(known.point().limit, Limit::greatest_force);
    EXPECT_EQ(known.point().contact_class, 1);
    EXPECT_EQ(known.point().value, 0.01);
    EXPECT_STREQ(known.what(), error.what());
  }
}

TEST(DomainErrors, OfOthersNameNoLimitAndKeepTheirWords) {
  const DomainError unknown = as_domain_error(std::domain_error("the exponent of a profile is negative"));
  EXPECT_EQ(unknown.point().limit, Limit::no_solution);
  EXPECT_STREQ(unknown.what(), "the exponent of a profile is negative");
}

TEST(Difficulties, SayWhatIsExpectedInstead) {
  for (const auto difficulty :
       {Difficulty::below_resolution, Difficulty::stiff_material, Difficulty::hardly_unique,
        Difficulty::singular_balance, Difficulty::near_applicability_limit, Difficulty::soft_centre}) {
    EXPECT_NE(std::string(advice(difficulty)).find("expected"), std::string::npos) << advice(difficulty);
  }
}

}  // namespace
