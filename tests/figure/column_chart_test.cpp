#include "figure/column_chart.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "figure/figure.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"

namespace monograin::figure::column_chart_test {
namespace {

namespace fs = std::filesystem;
using Style = ChartSeries::Style;

class ColumnCharts : public ::testing::Test {
 protected:
  void SetUp() override {
    write("run/history.csv",
          "# R0: 0.01\ntime[s],axial.displacement[m],axial.force[N],lateral.displacement[m],lateral.force[N]\n"
          "0,0,0,0,0\n1,0.001,2000,0,500\n");
    write("run/events.csv",
          "time[s],class,event,axial.displacement[m],axial.force[N],lateral.force[N]\n"
          "0.5,axial,yield,0.0005,900,200\n0.6,axial/lateral,impingement,0.0006,1100,250\n"
          "0.7,lateral,contact-made,0.0007,1300,300\n1,,step-end,0.001,2000,500\n");
    write("sweep/results.csv",
          "run,particle.radius[m],loading.configuration,status,reason,end.work[J],max.axial.force[N]\n"
          "1,0.01,die,complete,,1,1000\n2,0.02,simple,complete,,2,4000\n");
  }

  [[nodiscard]] fs::path path(const std::string& name) const { return folder_.path() / name; }
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories(path(name).parent_path());
    write_text(path(name), text);
  }
  [[nodiscard]] std::string fault_of(const std::string& name, const ColumnChoice& choice) const {
    try {
      (void)column_chart({path(name)}, choice);
    } catch (const FigureError& fault) {
      return fault.what();
    }
    return "no fault";
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(ColumnCharts, ShowTheForceOfTheDrivenWallsWithoutAChoice) {
  const ColumnChart figure = column_chart({path("run")}, {});
  ASSERT_EQ(figure.chart.panels.size(), 1U);
  const ChartPanel& panel = figure.chart.panels[0];
  EXPECT_EQ(panel.x.label, "axial.displacement [m]");
  EXPECT_EQ(panel.y.label, "axial.force [N]");
  EXPECT_EQ(panel.series[0].y, (std::vector{0.0, 2000.0}));
}

TEST_F(ColumnCharts, FindColumnsWithAndWithoutTheirUnits) {
  for (const char* name : {"lateral.force", "lateral.force[N]"}) {
    const ColumnChart figure = column_chart({path("run/history.csv")}, {.x = "time", .y = name});
    EXPECT_EQ(figure.chart.panels[0].x.label, "time [s]");
    EXPECT_EQ(figure.chart.panels[0].series[0].y, (std::vector{0.0, 500.0})) << name;
  }
  EXPECT_NE(fault_of("run", {.y = "axial.fore"}).find("has no column 'axial.fore'; did you mean 'axial.force'?"),
            std::string::npos);
}

TEST_F(ColumnCharts, ListTheColumnsWhereNoneIsNear) {
  EXPECT_NE(fault_of("run", {.y = "force"}).find("has no column 'force'; expected one of time, "), std::string::npos)
      << fault_of("run", {.y = "force"});
}

TEST_F(ColumnCharts, ShowNoWords) {
  EXPECT_NE(fault_of("sweep", {.y = "status"}).find("column 'status' holds words; expected numbers"),
            std::string::npos);
}

TEST_F(ColumnCharts, MarkTheEventsOfTheContactThatTheyShow) {
  const ColumnChart figure = column_chart({path("run")}, {.y = "axial.force"});
  const std::vector<ChartSeries>& series = figure.chart.panels[0].series;
  ASSERT_EQ(series.size(), 3U) << "a curve, yield and impingement";
  EXPECT_EQ(series[1].legend, "yield");
  EXPECT_EQ(series[1].style, Style::events);
  EXPECT_EQ(series[1].y, std::vector{900.0});
  EXPECT_EQ(series[2].legend, "impingement");
}

TEST_F(ColumnCharts, TakeTheUnitThatIsAskedFor) {
  const ColumnChart figure = column_chart({path("run")}, {.unit = "kN"});
  EXPECT_EQ(figure.chart.panels[0].y.label, "axial.force [kN]");
  EXPECT_EQ(figure.chart.panels[0].series[0].y, (std::vector{0.0, 2.0}));
  EXPECT_EQ(figure.chart.panels[0].series[1].y, std::vector{0.9}) << "events, too";
  const ColumnChart relative = column_chart({path("run")}, {.x = "time", .y = "axial.displacement", .unit = "R0"});
  EXPECT_EQ(relative.chart.panels[0].series[0].y, (std::vector{0.0, 0.1}));
  EXPECT_EQ(fault_of("run", {.unit = "mm"}),
            "unit 'mm' for 'axial.force[N]': 'mm' is a unit of length; expected a force, for example \"10 N\"");
  EXPECT_TRUE(fault_of("run", {.unit = "kn"}).ends_with("did you mean 'kN'?"));
}

TEST_F(ColumnCharts, ShowASweepOverEachOfItsKeys) {
  const ColumnChart figure = column_chart({path("sweep")}, {});
  ASSERT_EQ(figure.chart.panels.size(), 2U);
  EXPECT_EQ(figure.chart.panels[0].x.label, "particle.radius [m]");
  EXPECT_EQ(figure.chart.panels[0].y.label, "max.axial.force [N]");
  EXPECT_EQ(figure.chart.panels[0].series[0].style, Style::points);
  EXPECT_EQ(figure.chart.panels[1].x.names, (std::vector<std::string>{"die", "simple"}));
  EXPECT_EQ(figure.chart.panels[1].series[0].x, (std::vector{1.0, 2.0}));
  const ColumnChart chosen = column_chart({path("sweep")}, {.x = "particle.radius", .y = "end.work"});
  ASSERT_EQ(chosen.chart.panels.size(), 1U);
  EXPECT_EQ(chosen.chart.panels[0].series[0].y, (std::vector{1.0, 2.0}));
}

TEST_F(ColumnCharts, TellTheFewValuesOfAFurtherKeyApart) {
  std::string grid =
      "run,material.poisson_ratio[-],material.yield_stress[Pa],loading.configuration,status,reason,"
      "max.axial.force[N]\n";
  int run = 0;
  for (const char* ratio : {"0.2", "0.25", "0.3", "0.35", "0.4", "0.45", "0.48"}) {
    for (const char* stress : {"5e7", "2e7"}) {
      for (const char* walls : {"die", "simple"}) {
        ++run;
        grid +=
            std::to_string(run) + ',' + ratio + ',' + stress + ',' + walls + ",complete,," + std::to_string(run) + '\n';
      }
    }
  }
  write("grid/results.csv", grid);
  const auto legends = [](const ChartPanel& panel) {
    std::vector<std::string> found;
    for (const ChartSeries& series : panel.series) found.push_back(series.legend);
    return found;
  };
  const ColumnChart figure = column_chart({path("grid")}, {});
  ASSERT_EQ(figure.chart.panels.size(), 3U);
  const std::vector<std::string> stresses{"yield\\_stress = 20 MPa", "yield\\_stress = 50 MPa"};
  EXPECT_EQ(legends(figure.chart.panels[0]), stresses) << "the next key";
  EXPECT_EQ(figure.chart.panels[0].series[0].y,
            (std::vector<double>{3, 4, 7, 8, 11, 12, 15, 16, 19, 20, 23, 24, 27, 28}));
  EXPECT_EQ(legends(figure.chart.panels[1]),
            (std::vector<std::string>{"configuration = die", "configuration = simple"}));
  EXPECT_EQ(legends(figure.chart.panels[2]), stresses) << "the ratio has too many values";
  EXPECT_EQ(legends(column_chart({path("grid"), path("sweep")}, {.x = "loading.configuration"}).chart.panels.at(0)),
            (std::vector<std::string>{"grid", "sweep"}));
}

TEST_F(ColumnCharts, WantBothColumnsOfARunWithoutContacts) {
  write("packing/history.csv", "time[s],packing_fraction[-],stress[Pa]\n0,0.8,0\n1,0.9,1e5\n");
  EXPECT_NE(fault_of("packing", {.y = "stress"}).find("has no contacts; give both columns"), std::string::npos);
  EXPECT_EQ(fault_of("packing", {.x = "packing_fraction", .y = "stress"}), "no fault");
}

TEST_F(ColumnCharts, DrawMeasuredPointsInTheUnitsOfTheirAxes) {
  ColumnChart figure = column_chart({path("run")}, {.unit = "kN"});
  add_points(figure, {.legend = "data", .x = {"d", "mm", {0.5}}, .y = {"f", "N", {800.0}}});
  const ChartSeries& points = figure.chart.panels[0].series.back();
  EXPECT_EQ(points.style, Style::points);
  EXPECT_DOUBLE_EQ(points.x.at(0), 0.0005);
  EXPECT_DOUBLE_EQ(points.y.at(0), 0.8);
  EXPECT_THROW(add_points(figure, {.legend = "data", .x = {"d", "mm", {0.5}}, .y = {"f", "MPa", {800.0}}}),
               FigureError);
}

}  // namespace
}  // namespace monograin::figure::column_chart_test
