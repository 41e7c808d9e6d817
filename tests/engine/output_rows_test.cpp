// Rows of a history at output points, and around events.

#include "engine/output_rows.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/fake_integrator.hpp"

namespace monograin::output_rows_test {
namespace {

using Texts = std::vector<std::string>;

/// Keeps rows as text: "side step time state".
class TextSink final : public HistorySink {
 public:
  void observe(double time, int step, double, std::span<const double> y) override {
    row_ = fmt::format("{} {:.4g} {:.4g}", step, time, y[0]);
  }
  void append(RowSide side) override { rows.push_back(fmt::format("{} {}", static_cast<int>(side), row_)); }
  void event(const Event& event) override { rows.emplace_back(event.name); }

  Texts rows;

 private:
  std::string row_;
};

class OutputRowsTest : public ::testing::Test {
 protected:
  /// Takes the rows written so far.
  Texts written() { return std::exchange(sink_.rows, {}); }

  Output output_{.points = 4, .times = {}};
  StepClock clock_{.leg = 1, .start = 10.0, .duration = 2.0, .step_number = 2};
  FakeIntegrator integrator_;
  TextSink sink_;
  OutputRows rows_{output_, clock_, integrator_, sink_, nullptr, 1};
};

TEST_F(OutputRowsTest, DivideAStep) {
  rows_.place({}, 1.0, false);
  rows_.write_before(0.0, 0.6);
  EXPECT_EQ(written(), (Texts{"0 2 10.5 0.25", "0 2 11 0.5"}));
  rows_.write_before(0.6, 1.0);
  EXPECT_EQ(written(), Texts{"0 2 11.5 0.75"});
  rows_.open_instant(1.0, std::vector{1.0});
  EXPECT_EQ(written(), (Texts{"-1 2 12 1", "0 2 12 1"}));
}

TEST_F(OutputRowsTest, DivideAStepOfSeveralLegs) {
  // The clock is that of the leg.
  rows_.place({0.25, 0.75, true}, 1.0, false);
  rows_.write_before(0.0, 1.0);
  EXPECT_EQ(written(), Texts{"0 2 11 0.5"});
  rows_.open_instant(1.0, std::vector{1.0});
  EXPECT_EQ(written(), (Texts{"-1 2 12 1", "0 2 12 1"}));
}

TEST_F(OutputRowsTest, StandOnBothSidesOfAnEvent) {
  rows_.place({}, 1.0, false);
  rows_.write_before(0.0, 0.25);
  rows_.open_instant(0.25, std::vector{0.25});
  rows_.close_instant(0.25, std::vector{7.0}, std::vector<Event>{{"yield"}});
  EXPECT_EQ(written(), (Texts{"-1 2 10.5 0.25", "0 2 10.5 0.25", "1 2 10.5 7", "yield"}));
}

TEST_F(OutputRowsTest, EndWhereAStepEndsThatCouldHaveEndedElsewhere) {
  rows_.place({}, 0.8, true);
  rows_.write_before(0.0, 0.8001);
  EXPECT_EQ(written(), (Texts{"0 2 10.4 0.2", "0 2 10.8 0.4", "0 2 11.2 0.6"}));
  rows_.end_leg(0.8001);
  rows_.open_instant(0.8001, std::vector{0.8001});
  EXPECT_EQ(written(), (Texts{"-1 2 11.6 0.8001", "0 2 11.6 0.8001"}));
}

TEST_F(OutputRowsTest, AreNotWrittenInAPause) {
  rows_.pause();
  rows_.open_instant(0.5, std::vector{0.5});
  rows_.close_instant(0.5, std::vector{0.5}, {});
  EXPECT_EQ(written(), Texts{});
}

TEST_F(OutputRowsTest, InTheBufferComeAgainOrAreWrittenLater) {
  rows_.place({}, 1.0, false);
  rows_.buffer();
  rows_.write_before(0.0, 0.6);
  EXPECT_EQ(written(), Texts{});
  rows_.drop_buffer();
  rows_.buffer();
  rows_.write_before(0.0, 0.6);
  rows_.flush_buffer();
  EXPECT_EQ(written(), (Texts{"0 2 10.5 0.25", "0 2 11 0.5"}));
}

TEST_F(OutputRowsTest, AtAskedInstantsStandInTheirStepOnly) {
  Output output{.times = {9.0, 10.0, 11.0, 12.0, 13.0}};
  OutputRows rows(output, clock_, integrator_, sink_, nullptr, 1);
  rows.place({}, 1.0, false);
  rows.write_before(0.0, 1.0);
  rows.open_instant(1.0, std::vector{1.0});
  EXPECT_EQ(written(), (Texts{"0 2 11 0.5", "-1 2 12 1", "0 2 12 1"}));
  EXPECT_EQ(rows.note_unreached_times(13.0), std::nullopt);
  EXPECT_EQ(rows.note_unreached_times(12.0),
            "1 of 5 output times lies beyond the end of the program, t = 12 s: no rows there");
}

}  // namespace
}  // namespace monograin::output_rows_test
