#include "history/segments.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace monograin::segments_test {
namespace {

/// A history with output rows at 0, 1, 3 s and an event at 2 s.
Table history() {
  Table table({{"time", "s", {}}, {"step", "", {}}, {"row", "", {}}});
  for (const auto& row : std::vector<std::vector<double>>{
           {0.0, 1.0, 0.0}, {1.0, 1.0, 0.0}, {2.0, 1.0, -1.0}, {2.0, 1.0, 1.0}, {3.0, 1.0, 0.0}}) {
    table.append(row);
  }
  return table;
}

TEST(Segments, EndAtEventsAndHoldTheOutputRowsBetween) {
  const Table table = history();
  const Segments segments(table);
  ASSERT_EQ(segments.corners().size(), 1U);
  EXPECT_EQ(segments.corners()[0], (Corner{2, 3}));
  EXPECT_EQ(segments.segment(1), 0U);
  EXPECT_EQ(segments.segment(4), 1U);
  EXPECT_EQ(segments.row_at(1.0, 0), 1U);
  EXPECT_FALSE(segments.row_at(1.0, 1));
  EXPECT_FALSE(segments.row_at(2.0, 0)) << "rows at an event are no output rows";
}

TEST(Segments, GiveTheInstantsOfOutputRowsAfterTheStart) {
  const Table table = history();
  const Segments segments(table);
  EXPECT_EQ(segments.output_instants(), (std::vector<double>{1.0, 3.0}));
  EXPECT_EQ(segments.output_instants([](std::size_t row) { return row == 4; }), std::vector<double>{3.0});
}

TEST(Segments, GiveTheEndIfNoOutputRowIsWanted) {
  const Table table = history();
  EXPECT_EQ(Segments(table).output_instants([](std::size_t) { return false; }), std::vector<double>{3.0});
}

}  // namespace
}  // namespace monograin::segments_test
