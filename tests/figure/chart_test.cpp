#include "figure/chart.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "support/temporary_folder.hpp"

namespace monograin::figure::chart_test {
namespace {

namespace fs = std::filesystem;

ChartSeries series(const std::string& legend, ChartSeries::Style style = ChartSeries::Style::solid) {
  return {.legend = legend, .style = style, .colour = {}, .x = {0.0, 1.0, 0.5}, .y = {0.0, 2.0, 1.0}};
}

Chart chart_of(std::vector<ChartSeries> all) {
  Chart chart;
  chart.panels.push_back({.x = {.label = "x"}, .y = {.label = "y"}, .note = "it's a note", .series = std::move(all)});
  return chart;
}

std::string script_of(const Chart& chart) { return chart_script(chart, Format::svg, "a.svg", "a.dat"); }

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(Chart, CutsALineIntoThePhasesOfItsWay) {
  const std::string data = chart_data(chart_of({series("a", ChartSeries::Style::phases)}), "here");
  EXPECT_NE(data.find("# panel 1 series 1 loading. a\n0 0\n1 2\n"), std::string::npos) << data;
  EXPECT_NE(data.find("# panel 1 series 1 unloading. a\n1 2\n0.5 1\n"), std::string::npos) << data;
  EXPECT_EQ(data.find("reloading"), std::string::npos);
}

TEST(Chart, ExplainsDashesOnlyWhereALineTurnsBack) {
  EXPECT_NE(script_of(chart_of({series("a", ChartSeries::Style::phases)})).find("'unloading'"), std::string::npos);
  EXPECT_EQ(script_of(chart_of({series("a")})).find("'unloading'"), std::string::npos);
}

TEST(Chart, LeavesAGapWhereAValueIsUndefined) {
  ChartSeries gapped = series("a");
  gapped.y[1] = std::nan("");
  EXPECT_NE(chart_data(chart_of({gapped}), "").find("0 0\n1 NaN\n0.5 1\n"), std::string::npos);
}

TEST(Chart, DrawsABandPieceByPieceWhereXTurnsBack) {
  Chart chart = chart_of({series("a")});
  chart.panels[0].bands = {{.legend = "band",
                            .colour = 0x9FC5E8,
                            .x = {0.0, 1.0, 2.0, 1.0},
                            .lower = {0.0, 1.0, 2.0, 0.5},
                            .upper = {0.0, 2.0, 4.0, std::nan("")}}};
  const std::string data = chart_data(chart, "");
  EXPECT_NE(data.find("lowest and highest y\n0 0 0\n1 1 2\n2 2 4\n\n2 2 4\n\n"), std::string::npos) << data;
  const std::string script = script_of(chart);
  EXPECT_LT(script.find("'panel 1 band 1.' using 1:2:3 with filledcurves"), script.find("'panel 1 series 1.'"));
  EXPECT_EQ(count(script, "title 'band'"), 1U) << script;
  EXPECT_NE(script.find("set yrange [0:4"), std::string::npos) << "the band belongs to what the axis shows: " << script;
}

TEST(Chart, SameLegendsLookTheSameAndStandOnceInTheLegend) {
  Chart chart = chart_of({series("a"), series("b")});
  chart.panels.push_back(chart.panels.front());
  std::swap(chart.panels[1].series[0], chart.panels[1].series[1]);
  const std::string script = script_of(chart);
  EXPECT_EQ(count(script, "title 'a'"), 1U);
  EXPECT_NE(script.find("'panel 1 series 1.' with lines lc rgb '#0072B2'"), std::string::npos) << script;
  EXPECT_NE(script.find("'panel 2 series 2.' with lines lc rgb '#0072B2'"), std::string::npos) << script;
}

TEST(Chart, StylesDifferByTheirDashes) {
  const std::string script =
      script_of(chart_of({series("a"), series("b", ChartSeries::Style::dashed), series("c", ChartSeries::Style::dotted),
                          series("d", ChartSeries::Style::dash_dotted)}));
  for (const char* dash : {"dt 1", "dt (7,4)", "dt (2,4)", "dt (7,3,1.5,3)"}) {
    EXPECT_EQ(count(script, dash), 2U) << dash << ": once in the panel, once in the legend";
  }
}

TEST(Chart, TakesItsAxesFromTheValuesUnlessToldOtherwise) {
  Chart chart = chart_of({series("a")});
  EXPECT_NE(script_of(chart).find("set yrange [0:2.06]"), std::string::npos);
  chart.panels[0].x.highest = 0.5;
  EXPECT_NE(script_of(chart).find("set xrange [0:0.5]"), std::string::npos);
  EXPECT_NE(script_of(chart).find("set yrange [0:1.03]"), std::string::npos)
      << "what is beyond the abscissa does not stretch the ordinate";
}

TEST(Chart, ALogarithmicAxisTakesWholeDecadesOfPositiveValues) {
  Chart chart = chart_of({series("a")});
  chart.panels[0].y.is_logarithmic = true;
  chart.panels[0].series[0].y = {-1.0, 20.0, 3000.0};
  EXPECT_NE(script_of(chart).find("set logscale y; set yrange [10:10000]; set ytics autofreq;"), std::string::npos)
      << script_of(chart);
  chart.panels[0].series[0].y = {2e-12, 20.0, 3000.0};
  EXPECT_NE(script_of(chart).find("set ytics 1e3;"), std::string::npos) << "16 decades with six labels";
}

TEST(Chart, IsDrawnWithPointsLinesAndAreas) {
  const TemporaryFolder folder;
  Chart chart = chart_of({series("a"), series("b", ChartSeries::Style::points)});
  chart.panels.push_back(
      {.x = {.label = "x", .is_logarithmic = true},
       .y = {.label = "y", .is_logarithmic = true},
       .areas = {{.legend = "inside", .colour = 0xE69F00, .boxes = {{1, 10, 1, 10}, {10, 100, 1, 5}}}}});
  chart.panels.push_back({.x = {.label = "x"}, .y = {.label = "y"}, .note = "nothing"});
  for (const char* name : {"a.svg", "a.pdf", "a.png"}) {
    const FigureFiles files(folder.path() / name);
    files.write(chart_data(chart, "test"), chart_script(chart, files.format(), files.figure_name(), files.data_name()));
    EXPECT_GT(fs::file_size(folder.path() / name), 1000U) << name;
  }
}

}  // namespace
}  // namespace monograin::figure::chart_test
