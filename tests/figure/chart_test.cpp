#include "figure/chart.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <set>
#include <string_view>

#include "catalogue.hpp"
#include "figure/legend.hpp"
#include "figure/run_curves.hpp"
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

TEST(Chart, TakesAStepOfRoundOffForNoPhaseOfItsOwn) {
  ChartSeries held = series("a", ChartSeries::Style::phases);
  held.x = {0.0, 1.0, 1.0 + 1e-15, 1.0, 0.5};
  held.y = {0.0, 2.0, 2.0, 2.0, 1.0};
  const std::string data = chart_data(chart_of({held}), "here");
  EXPECT_NE(data.find("# panel 1 series 1 loading. a\n0 0\n1 2\n1 2\n1 2\n\n"), std::string::npos) << data;
  EXPECT_NE(data.find("# panel 1 series 1 unloading. a\n1 2\n0.5 1\n"), std::string::npos) << data;
  EXPECT_EQ(data.find("reloading"), std::string::npos) << data;
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

TEST(Chart, DrawsCrowdsOfPointsBelowTheLines) {
  ChartSeries points = series("data");
  points.style = ChartSeries::Style::points;
  const std::string few = script_of(chart_of({series("fit"), points}));
  EXPECT_NE(few.find("'panel 1 series 2.'"), std::string::npos);
  EXPECT_LT(few.find("'panel 1 series 1.'"), few.find("'panel 1 series 2.'"));
  points.x.assign(1001, 0.5);
  points.y.assign(1001, 0.5);
  const std::string many = script_of(chart_of({series("fit"), points}));
  EXPECT_NE(many.find("'panel 1 series 1."), std::string::npos);
  EXPECT_GT(many.find("'panel 1 series 1."), many.find("'panel 1 series 2."));
}

TEST(Chart, NamesWhatItFillsInItsLegend) {
  Chart chart = chart_of({series("a")});
  chart.panels[0].bands = {
      {.legend = "spread", .colour = 1, .x = {0.0, 1.0}, .lower = {0.0, 0.0}, .upper = {1.0, 1.0}}};
  EXPECT_EQ(count(script_of(chart), "'Band'"), 1U) << script_of(chart);
  EXPECT_EQ(count(script_of(chart), "'Area'"), 0U);
  chart.panels[0].areas = {{.legend = "planned", .colour = 2, .boxes = {{0.0, 1.0, 0.0, 1.0}}}};
  EXPECT_EQ(count(script_of(chart), "'Area'"), 1U);
  chart.area_heading = "Program";
  EXPECT_EQ(count(script_of(chart), "'Area'"), 0U);
  EXPECT_EQ(count(script_of(chart), "'Program'"), 1U);
}

TEST(Chart, HasAPageOfA4ForItsText) {
  Chart chart = chart_of({series("a")});
  EXPECT_EQ(count(script_of(chart), "Monospace"), 0U);
  chart.head = {"title_1"};
  chart.foot = {"a  1.5", "it's b"};
  const std::string script = chart_script(chart, Format::pdf, "a.pdf", "a.dat");
  EXPECT_NE(script.find("size 17cm,24.04cm"), std::string::npos) << script;
  EXPECT_EQ(count(script, "noenhanced font 'Monospace,9.00'"), 3U) << script;
  EXPECT_NE(script.find("font 'Helvetica,10' fontscale 0.75 "), std::string::npos) << "else gnuplot draws 6.7 points";
  EXPECT_LT(script.find("'title_1'"), script.find("'a  1.5'"));
  chart.foot.resize(100, "more");
  EXPECT_EQ(chart_script(chart, Format::pdf, "a.pdf", "a.dat").find("size 17cm,24.04cm"), std::string::npos)
      << "many lines make the page taller";
  chart.foot = {std::string(164, 'x')};
  EXPECT_EQ(count(script_of(chart), "noenhanced font 'Monospace,4.53'"), 2U) << "all lines fit the page";
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
  chart.panels[0].x.lowest = 0.25;
  EXPECT_NE(script_of(chart).find("set xrange [0.25:1.0225]"), std::string::npos) << script_of(chart);
  chart.panels[0].x.lowest = {};
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
  chart.panels[0].series[0].y = {10.0, 10.0, 10.0};
  EXPECT_NE(script_of(chart).find("set yrange [10:100]"), std::string::npos) << "no empty axis: " << script_of(chart);
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

TEST(Chart, DrawsReloadingWiderThanTheUnloadingThatItCovers) {
  ChartSeries cycle = series("a", ChartSeries::Style::phases);
  cycle.x = {0.0, 1.0, 0.5, 0.9};
  cycle.y = {0.0, 2.0, 1.0, 1.8};
  const std::string script = script_of(chart_of({cycle}));
  EXPECT_NE(script.find("unloading.' with lines lc rgb '#0072B2' lw 1.8 dt (7,4)"), std::string::npos) << script;
  EXPECT_NE(script.find("reloading.' with lines lc rgb '#0072B2' lw 3.96 dt (0.8,2.6)"), std::string::npos) << script;
  EXPECT_NE(script.find("lw 3.96 dt (0.8,2.6) title 'reloading'"), std::string::npos)
      << "the legend says so: " << script;
}

TEST(Chart, GivesEachOfManyLegendsAStyleOfItsOwn) {
  std::vector<ChartSeries> many;
  for (char name = 'a'; name < 'a' + 18; ++name) many.push_back(series({name}));
  const std::string script = script_of(chart_of(many));
  std::set<std::string> styles;
  constexpr std::string_view k_entry = "keyentry ";
  for (std::size_t at = script.find(k_entry); at != std::string::npos; at = script.find(k_entry, at + 1)) {
    styles.insert(script.substr(at, script.find(" title ", at) - at));
  }
  EXPECT_EQ(styles.size(), 18U);
}

TEST(Chart, LeavesColoursThatOthersAskFor) {
  ChartSeries first = series("first");
  ChartSeries second = series("second");
  second.colour = 0;
  const std::string script = script_of(chart_of({first, second}));
  EXPECT_NE(script.find("'panel 1 series 1.' with lines lc rgb '#D55E00'"), std::string::npos) << script;
  EXPECT_NE(script.find("'panel 1 series 2.' with linespoints lc rgb '#0072B2'"), std::string::npos) << script;
}

TEST(Chart, MarksLinesThatDifferByTheirColourAlone) {
  Chart chart = chart_of({series("a"), series("b"), series("c", ChartSeries::Style::dashed), series("d")});
  const std::string script = script_of(chart);
  EXPECT_NE(script.find("'panel 1 series 1.' with lines "), std::string::npos) << script;
  EXPECT_NE(script.find("'panel 1 series 2.' with linespoints "), std::string::npos) << script;
  EXPECT_NE(script.find("'panel 1 series 3.' with lines "), std::string::npos) << "its dashes tell it: " << script;
  EXPECT_EQ(count(script, "pt 7 ps 0.45"), 2U) << "in the panel and in the legend: " << script;
  EXPECT_EQ(count(script, "pt 9 ps 0.45"), 2U) << script;
  chart.panels.push_back({.x = {.label = "x"}, .y = {.label = "y"}, .series = {chart.panels[0].series[1]}});
  chart.panels[0].series.resize(1);
  EXPECT_EQ(count(script_of(chart), "linespoints"), 0U) << "alone in its panel";
}

TEST(Chart, DrawsEventsWithTheSymbolsOfTheirNames) {
  ChartSeries yield = series("yield", ChartSeries::Style::events);
  ChartSeries made = series("contact-made", ChartSeries::Style::events);
  for (const auto& order : {std::vector{yield, made}, std::vector{made, yield}}) {
    const std::string script = script_of(chart_of(order));
    EXPECT_EQ(count(script, event_points("yield")), 2U) << script;
    EXPECT_EQ(count(script, event_points("contact-made")), 2U) << script;
    EXPECT_EQ(count(script, "'Events'"), 1U) << script;
    EXPECT_EQ(count(script, "'Points'"), 0U) << script;
  }
}

TEST(Chart, HasASymbolForEachEventOfAModel) {
  std::set<std::string_view> names;
  std::set<std::string> symbols{event_points("no event of a model")};
  for (const Model& model : model_catalogue()) {
    for (const Term& event : model.events) {
      if (!is_of_program(event.name)) names.insert(event.name);
    }
  }
  for (const std::string_view name : names) EXPECT_TRUE(symbols.insert(event_points(name)).second) << name;
}

TEST(Chart, MarksErrorsThatALogarithmicAxisCannotShow) {
  ChartSeries errors = series("a");
  errors.y = {1e-3, 0.0, 1e-9};
  errors.is_error = true;
  Chart chart = chart_of({errors});
  chart.panels[0].y = {.label = "y", .lowest = 1e-6, .is_logarithmic = true};
  const std::string data = chart_data(chart, "");
  EXPECT_NE(data.find("# panel 1 series 1. a\n0 0.001\n1 1e-06\n0.5 1e-06\n"), std::string::npos) << data;
  EXPECT_NE(data.find("# panel 1 series 1 at the floor. a\n1 1e-06\n0.5 1e-06\n"), std::string::npos) << data;
  const std::string script = script_of(chart);
  EXPECT_EQ(count(script, "title 'at the lower end of the axis, or below'"), 1U) << script;
  EXPECT_EQ(count(script, "series 1 at the floor.'"), 1U) << script;
  errors.style = ChartSeries::Style::points;
  chart = chart_of({errors});
  chart.panels[0].y.is_logarithmic = true;
  EXPECT_EQ(count(script_of(chart), "series 1 at the floor.'"), 1U) << "points, too: " << script_of(chart);
}

TEST(Chart, MarksNothingOnAnAxisThatShowsZero) {
  ChartSeries errors = series("a");
  errors.is_error = true;
  EXPECT_EQ(script_of(chart_of({errors})).find("floor"), std::string::npos);
  errors.is_error = false;
  Chart chart = chart_of({errors});
  chart.panels[0].y.is_logarithmic = true;
  EXPECT_EQ(script_of(chart).find("floor"), std::string::npos) << "a curve that is no error may begin at zero";
}

TEST(Chart, ShadesWhatLiesOutsideARange) {
  Chart chart = chart_of({series("a")});
  chart.panels[0].range = {.from = 0.25, .to = 0.75, .legend = "beyond"};
  const std::string script = script_of(chart);
  EXPECT_EQ(count(script, "set object rectangle"), 2U) << script;
  EXPECT_NE(script.find("from first 0, graph 0 to first 0.25, graph 1 behind"), std::string::npos) << script;
  EXPECT_NE(script.find("from first 0.75, graph 0 to first 1.03, graph 1 behind"), std::string::npos) << script;
  EXPECT_EQ(count(script, "title 'beyond'"), 1U) << script;
  chart.panels[0].range = {.from = {}, .to = -1.0, .legend = "beyond"};
  EXPECT_NE(script_of(chart).find("from first 0, graph 0 to first 1.03, graph 1 behind"), std::string::npos)
      << "the whole panel, and nothing beside it: " << script_of(chart);
  chart.panels[0].range = {.from = -1.0, .to = 2.0, .legend = "beyond"};
  EXPECT_EQ(count(script_of(chart), "set object rectangle"), 0U) << "all that is shown lies inside";
}

TEST(Chart, HasLettersOnlyForSeveralPanels) {
  Chart chart = chart_of({series("a")});
  EXPECT_EQ(script_of(chart).find("'(a)'"), std::string::npos);
  chart.panels.push_back(chart.panels.front());
  EXPECT_NE(script_of(chart).find("'(a)'"), std::string::npos);
  EXPECT_NE(script_of(chart).find("'(b)'"), std::string::npos);
}

TEST(Chart, KeepsItsNoteBesideThePowerOfTenOfItsAbscissa) {
  Chart chart = chart_of({series("a")});
  chart.panels[0].series[0].x = {0.0, 1e-7, 0.5e-7};
  const std::string script = script_of(chart);
  EXPECT_NE(script.find("\"it's a note\""), std::string::npos) << script;
  EXPECT_NE(script.find("'x [10^{−7}]"), std::string::npos) << script;
}

TEST(Chart, PutsThePowerOfTenOfItsAbscissaIntoTheUnit) {
  Chart chart = chart_of({series("a")});
  chart.panels[0].x.label = "Displacement [m]";
  chart.panels[0].series[0].x = {0.0, 1e-7, 0.5e-7};
  const std::string script = script_of(chart);
  EXPECT_NE(script.find("'Displacement [nm]'"), std::string::npos) << script;
  EXPECT_NE(script.find("'100' 1e-07"), std::string::npos) << script;
  chart.panels[0].x.label = "Area [m^2]";
  EXPECT_NE(script_of(chart).find("Area [10^{−7} m^2]"), std::string::npos) << "a prefix belongs to the metre";
  EXPECT_EQ(script_of(chart).find("×10"), std::string::npos);
}

TEST(Chart, DividesNumbersThatNeedFourDecimals) {
  Chart chart = chart_of({series("a")});
  chart.panels[0].series[0].y = {0.0, 1e-3, 0.5e-3};
  EXPECT_NE(script_of(chart).find("'×10^{−3}'"), std::string::npos) << script_of(chart);
  chart.panels[0].series[0].y = {0.0, 5e-3, 2.5e-3};
  EXPECT_EQ(script_of(chart).find("×10"), std::string::npos) << script_of(chart);
}

TEST(Label, HasMinusSignsAndKeepsItsHyphens) {
  EXPECT_EQ(label_string("a - b"), "'a − b'");
  EXPECT_EQ(label_string("-1"), "'−1'");
  EXPECT_EQ(label_string("10^{-3}"), "'10^{−3}'");
  EXPECT_EQ(label_string("elastic-plastic"), "'elastic-plastic'");
}

TEST(Label, ShowsANameAsItIs) {
  EXPECT_EQ(verbatim_text("radius_rule"), "radius\\_rule");
  EXPECT_EQ(verbatim_text("a{b}^c"), "a\\{b\\}\\^c");
}

/// rsvg-convert drops blanks beside a change of font where they are not to be kept.
TEST(Label, KeepsItsBlanksInEveryRenderer) {
  const TemporaryFolder folder;
  Chart chart = chart_of({series("{/:Italic ν} = 0.3")});
  chart.panels[0].x.label = "Force {/:Italic F} / ({/:Italic E R}_0^2)";
  const FigureFiles files(folder.path() / "a.svg");
  files.write(chart_data(chart, ""), chart_script(chart, files.format(), files.figure_name(), files.data_name()));
  std::ifstream in(files.figure());
  const std::string svg{std::istreambuf_iterator<char>(in), {}};
  for (const char* part : {">Force </tspan>", "> = 0.3</tspan>"}) {
    const std::size_t at = svg.find(part);
    ASSERT_NE(at, std::string::npos) << part;
    const std::size_t text = svg.rfind("<text", at);
    EXPECT_EQ(svg.compare(text, 27, "<text xml:space=\"preserve\">"), 0) << svg.substr(text, 100);
  }
}

TEST(Chart, MakesANoteThatIsTooWideSmaller) {
  Chart chart = chart_of({series("a")});
  EXPECT_EQ(script_of(chart).find("{/*"), std::string::npos);
  chart.panels[0].note = std::string(50, 'm');
  EXPECT_NE(script_of(chart).find("{/*0.79 m"), std::string::npos) << script_of(chart);
  chart.panels[0].note = std::string(100, 'm');
  EXPECT_NE(script_of(chart).find("{/*0.72 mmm"), std::string::npos) << script_of(chart);
  EXPECT_NE(script_of(chart).find("mmm...mmm"), std::string::npos) << script_of(chart);
}

TEST(Chart, PutsALegendThatIsWiderThanACellBelowThePanels) {
  Chart chart = chart_of({series("a")});
  chart.panels.resize(3, chart.panels.front());
  const std::string beside = script_of(chart);
  chart.panels[0].series[0].legend = "an entry that is wider than a cell";
  const std::string below = script_of(chart);
  EXPECT_NE(beside.find("size 643,465"), std::string::npos) << beside;
  EXPECT_EQ(below.find("size 643,465"), std::string::npos) << below;
}

}  // namespace
}  // namespace monograin::figure::chart_test
