#include "engine/program_notes.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace monograin::program_notes_test {
namespace {

using Texts = std::vector<std::string>;

TEST(ProgramNotes, NameTheStepAndItsNumbers) {
  ProgramNotes notes;
  notes.add(2, "until axial.force = 1 N was never met", " (3 N at its end)");
  EXPECT_EQ(notes.texts(), Texts{"step 2: until axial.force = 1 N was never met (3 N at its end)"});
}

TEST(ProgramNotes, ShareTheNumbersOfTheFirstStepWhereTheirWordsAreEqual) {
  ProgramNotes notes;
  notes.add(2, "never met", " (first)");
  notes.add(3, "holds at once");
  notes.add(5, "never met", " (second)");
  EXPECT_EQ(notes.texts(), (Texts{"steps 2, 5: never met (first)", "step 3: holds at once"}));
}

TEST(ProgramNotes, NameThreeStepsAndCountTheRest) {
  ProgramNotes notes;
  for (std::size_t step = 3; step <= 42; step += 3) notes.add(step, "never met");
  EXPECT_EQ(notes.texts(), Texts{"steps 3, 6, 9, ... (14 times): never met"});
}

TEST(ProgramNotes, CountAStepOnce) {
  ProgramNotes notes;
  notes.add(1, "never met");
  notes.add(1, "never met");
  EXPECT_EQ(notes.texts(), Texts{"step 1: never met"});
}

TEST(ProgramNotes, AreNoneWhereNothingWasAdded) { EXPECT_TRUE(ProgramNotes{}.texts().empty()); }

}  // namespace
}  // namespace monograin::program_notes_test
