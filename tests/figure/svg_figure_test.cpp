#include "support/svg_figure.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <tuple>

#include "figure/chart.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"

namespace monograin::svg_figure_test {
namespace {

using figure::ChartSeries;

class DrawnSvg : public ::testing::Test {
 protected:
  [[nodiscard]] SvgFigure drawn(const ChartSeries& series, const std::string& label = "{/:Italic x} / {/:Italic y}") {
    figure::Chart chart;
    // What the second series shows is far from the edges, so that the axes stay as they are.
    const ChartSeries frame{
        .legend = "frame", .style = ChartSeries::Style::points, .colour = {}, .x = {0.0, 1.0}, .y = {0.0, 1.0}};
    chart.panels.push_back({.x = {.label = label}, .y = {.label = "y"}, .series = {frame, series}});
    const figure::FigureFiles files(folder_.path() / "a.svg");
    files.write(figure::chart_data(chart, ""),
                figure::chart_script(chart, files.format(), files.figure_name(), files.data_name()));
    return read_svg(files.figure());
  }

  [[nodiscard]] static ChartSeries line(std::vector<double> x, std::vector<double> y) {
    return {.legend = "line", .style = ChartSeries::Style::solid, .colour = {}, .x = std::move(x), .y = std::move(y)};
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(DrawnSvg, ShowsTheSameWithMoreVerticesOnTheSameLine) {
  EXPECT_TRUE(differences(drawn(line({0.2, 0.8}, {0.2, 0.8})), drawn(line({0.2, 0.5, 0.8}, {0.2, 0.5, 0.8}))).empty());
}

TEST_F(DrawnSvg, TellsALineThatIsTwoHundredthsOfTheAxisOff) {
  const auto found = differences(drawn(line({0.2, 0.8}, {0.2, 0.8})), drawn(line({0.2, 0.8}, {0.2, 0.82})));
  EXPECT_FALSE(found.empty());
}

TEST_F(DrawnSvg, TellsALineThatEndsEarlier) {
  EXPECT_FALSE(differences(drawn(line({0.2, 0.8}, {0.2, 0.8})), drawn(line({0.2, 0.7}, {0.2, 0.7}))).empty());
}

TEST_F(DrawnSvg, TellsAnotherColourDashAndLabel) {
  const ChartSeries solid = line({0.2, 0.8}, {0.2, 0.8});
  ChartSeries dashed = solid;
  dashed.style = ChartSeries::Style::dashed;
  ChartSeries other = solid;
  other.colour = 3;
  EXPECT_FALSE(differences(drawn(solid), drawn(dashed)).empty());
  EXPECT_FALSE(differences(drawn(solid), drawn(other)).empty());
  EXPECT_FALSE(differences(drawn(solid), drawn(solid, "z")).empty());
}

TEST(Svg, ThatIsMissingOrEmptyIsAFault) {
  const TemporaryFolder folder;
  EXPECT_THROW(std::ignore = read_svg(folder.path() / "none.svg"), std::runtime_error);
  write_text(folder.path() / "empty.svg", "");
  EXPECT_THROW(std::ignore = read_svg(folder.path() / "empty.svg"), std::runtime_error);
}

}  // namespace
}  // namespace monograin::svg_figure_test
