// Runs of which a study reads a part only.

#include "history/run.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/test_run.hpp"

namespace monograin::run_test {
namespace {

CheckedScenario die() { return mdr_scenario(Configuration::die, 20.0, 0.3, path({0.3, 0.2, 0.35})); }

TEST(RunOfAScenario, HasNoEnergiesWhereTheyAreLeftOut) {
  const RunRecord whole = record_run(die());
  const RunRecord part = record_run(die(), {.energies = true});
  ASSERT_EQ(part.history.row_count(), whole.history.row_count());
  EXPECT_LT(part.statistics.rhs_evaluations, whole.statistics.rhs_evaluations);
  for (const Column& column : whole.history.columns()) {
    const bool is_energy = column.unit == "J";
    const auto expected = whole.history.column(column.name);
    const auto actual = part.history.column(column.name);
    for (std::size_t row = 0; row < expected.size(); ++row) {
      if (is_energy) {
        EXPECT_TRUE(std::isnan(actual[row])) << column.name;
      } else if (std::isfinite(expected[row])) {
        EXPECT_NEAR(actual[row], expected[row], 1e-13) << column.name << ", row " << row;
      }
    }
  }
}

TEST(RunOfAScenario, HasTheEndsOfItsStepsAndItsEventsWhereRowsAreLeftOut) {
  const RunRecord whole = record_run(die());
  const RunRecord part = record_run(die(), {.rows = true});
  EXPECT_LT(part.history.row_count(), whole.history.row_count() / 3);
  ASSERT_EQ(part.events.row_count(), whole.events.row_count());
  for (std::size_t row = 0; row < whole.events.row_count(); ++row) {
    EXPECT_NEAR(part.events.column("time")[row], whole.events.column("time")[row], 1e-13);
  }
  EXPECT_NEAR(part.history.column("work").back(), whole.history.column("work").back(), 1e-13);
}

TEST(RunOfAScenario, KeepsRowsAtOutputTimesThatAreListed) {
  CheckedScenario scenario = die();
  scenario.output.times = {0.25, 0.5, 2.5};
  EXPECT_EQ(record_run(scenario, {.rows = true}).history.row_count(), record_run(scenario).history.row_count());
}

}  // namespace
}  // namespace monograin::run_test
