// `monograin data` shows how a file is written, its columns, and its ways of loading and unloading.

#include "study/calibrate/data_report.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <string>

#include "scenario/faults.hpp"
#include "support/refusal.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"

namespace monograin::data_report_test {
namespace {

namespace fs = std::filesystem;

class DataReportTest : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path write(const std::string& name, const std::string& text) const {
    write_text(folder_.path() / name, text);
    return folder_.path() / name;
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(DataReportTest, ShowsColumnsWithTheirUnitsAndRanges) {
  const DataReport report =
      report_of_file(write("d.txt",
                           "Specimen\t12\nTime\tPhase\tLoad\tDepth\n(s)\t\t(mN)\t(nm)\n0\tup\t0\t-1\n1\tup\t2.5\t10\n"
                           "2\thold\t\t11\n3\tdown\t1\t8\n"));
  ASSERT_EQ(report.columns.size(), 4U);
  EXPECT_EQ(report.columns[2].heading, "Load");
  EXPECT_EQ(report.columns[2].unit, "mN");
  EXPECT_EQ(report.columns[2].values, 3U);
  EXPECT_EQ(report.columns[2].missing, 1U);
  EXPECT_EQ(report.columns[2].highest, 2.5);
  EXPECT_EQ(report.columns[3].lowest, -1.0);
  EXPECT_FALSE(report.columns[1].is_numeric);
  // x is the first length and y the first force, wherever they stand.
  EXPECT_EQ(report.x.number, 4U);
  EXPECT_EQ(report.y.number, 3U);
  EXPECT_EQ(report.left_out, 1U);
  EXPECT_EQ(report.lines, (std::vector<std::size_t>{4, 5, 7}));
  const std::string text = data_text(report);
  EXPECT_NE(text.find("separator  tab"), std::string::npos) << text;
  EXPECT_NE(text.find("Phase        2     -    text"), std::string::npos) << text;
}

TEST_F(DataReportTest, SaysWhatIsLeftOutAboveAndBelowTheTable) {
  const std::string text =
      data_text(report_of_file(write("d.csv", "t,displacement,force,remark\n0,1,2\n1,2,3\n2,3,4\nEND\n")));
  EXPECT_NE(text.find("left out   0 without x or y; 1 line from line 5 below the table"), std::string::npos) << text;
  EXPECT_NE(text.find("line 1 has no text for each of the 3 columns, and was not taken for headings"),
            std::string::npos)
      << text;
}

TEST_F(DataReportTest, WithoutUnitsTakesTheFirstTwoColumnsOfNumbers) {
  const DataReport report = report_of_file(write("d.csv", "name,a,b,c\nx,1,2,3\ny,2,3,4\n"));
  EXPECT_EQ(report.x.name, "a");
  EXPECT_EQ(report.y.name, "b");
}

TEST_F(DataReportTest, SaysWhyACalibrationWouldRefuseTheFile) {
  const DataReport report = report_of_file(write("d.csv", "d [furlong],F [N]\n1,2\n2,\n3,4\n"));
  ASSERT_EQ(report.remarks.size(), 2U);
  EXPECT_NE(report.remarks[0].find("1 of 3 rows have no number in x or y, more than 10 %"), std::string::npos);
  EXPECT_NE(report.remarks[1].find("'furlong' is no unit that monograin knows"), std::string::npos);
  EXPECT_TRUE(report_of_file(write("e.csv", "d [mm],F [N]\n1,2\n2,3\n3,4\n")).remarks.empty());
}

TEST_F(DataReportTest, FindsTheWaysOfNoisyCycles) {
  std::mt19937 generator(3);
  std::normal_distribution<double> noise(0.0, 0.002);
  std::string text = "h[um],F[mN]\n";
  for (int row = 0; row <= 4000; ++row) {
    const double x = std::abs(std::remainder(row / 1000.0 - 0.5, 2.0)) < 0.5 ? 1.0 : 0.0;
    const double h = 10.0 * std::abs(std::remainder(row / 1000.0, 2.0)) + noise(generator);
    text += fmt::format("{:.6f},{:.6f}\n", h, h * h + x);
  }
  const DataReport report = report_of_file(write("d.csv", text));
  ASSERT_EQ(report.branches.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(report.branches[k].is_loading, k % 2 == 0) << k;
    EXPECT_NEAR(report.x.values[report.branches[k].end], k % 2 == 0 ? 10.0 : 0.0, 0.01) << k;
  }
  const figure::Chart chart = data_chart({report});
  ASSERT_EQ(chart.panels.front().series.size(), 3U);
  EXPECT_EQ(chart.panels.front().series[2].legend, "turning points");
  EXPECT_EQ(chart.panels.front().series[2].x.size(), 3U);
  EXPECT_EQ(chart.panels.front().x.label, "h [um]");
}

TEST_F(DataReportTest, ShowsAHoldWithItsMeanDisplacement) {
  std::mt19937 generator(5);
  std::normal_distribution<double> noise(0.0, 0.2);
  std::string text = "h[um],F[mN]\n";
  for (int row = 0; row <= 200; ++row) {
    const double h = row <= 70 ? row : (row <= 130 ? 70.0 : 70.0 - 0.2 * (row - 130));
    text += fmt::format("{:.6f},{:.6f}\n", h + noise(generator), 2.0 * h);
  }
  const DataReport report = report_of_file(write("d.csv", text));
  ASSERT_EQ(report.branches.size(), 2U);
  EXPECT_NEAR(report.branches[0].x_end, 70.0, 0.1);
  EXPECT_EQ(report.branches[1].x_begin, report.branches[0].x_end);
  EXPECT_NEAR(static_cast<double>(report.branches[0].held_end - report.branches[0].held_begin), 61.0, 3.0);
  EXPECT_NE(data_text(report).find("\nhold 1 "), std::string::npos) << data_text(report);
}

TEST_F(DataReportTest, ThatIsNoTableIsRefused) {
  for (const char* text : {"", "hello\n", "a\n1\n2\n", "a,b\nx,y\n"}) {
    EXPECT_THROW(static_cast<void>(report_of_file(write("d.csv", text))), ScenarioError) << text;
  }
}

TEST_F(DataReportTest, OfACalibrationHasItsOwnColumns) {
  const Calibration calibration = read_calibration(MONOGRAIN_SOURCE_DIR "/scenarios/calibrate/packing.toml");
  const std::vector<DataReport> reports = reports_of(calibration);
  ASSERT_EQ(reports.size(), calibration.curves.size());
  for (std::size_t c = 0; c < reports.size(); ++c) {
    const MeasuredCurve& curve = calibration.curves[c];
    EXPECT_EQ(reports[c].lines.size(), curve.end - curve.begin);
    EXPECT_EQ(reports[c].columns.size(), 2U);
    EXPECT_EQ(reports[c].y.unit, "MPa");
    EXPECT_DOUBLE_EQ(reports[c].y.values.back() * 1e6, calibration.y.values[curve.end - 1]);
    EXPECT_EQ(reports[c].columns[1].values, reports[c].lines.size());
  }
}

TEST_F(DataReportTest, RefusesTheColumnZeroForColumnsCountFromOne) {
  const fs::path file = write("d.csv", "a,b\n1,2\n2,3\n3,4\n");
  EXPECT_EQ(report_of_file(file, {.x = "2", .y = "1"}).x.number, 2U);
  const std::string message = refusal<ScenarioError>([&] { return report_of_file(file, {.x = "0", .y = "1"}); });
  EXPECT_TRUE(contains(message, "--x 0: expected a whole number from 1, or a heading")) << message;
}

}  // namespace
}  // namespace monograin::data_report_test
