#include "figure/legend.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace monograin::figure::legend_test {
namespace {

std::vector<RunCurves> runs_of(std::size_t count, const std::vector<std::string>& contacts) {
  std::vector<RunCurves> runs(count);
  for (RunCurves& run : runs) {
    for (const std::string& contact : contacts) run.contacts.push_back({.name = contact});
  }
  return runs;
}

/// gnuplot's type of the points on a line.
std::string point_type(const Stroke& stroke) {
  const std::string line = phase_line(stroke, Phase::loading);
  const std::size_t place = line.find(" pt ");
  return place == std::string::npos ? "" : line.substr(place + 4, line.find(' ', place + 4) - place - 4);
}

TEST(Palette, GivesManyRunsOfOneContactLinesThatAllDiffer) {
  const Palette palette(runs_of(36, {"axial"}));
  std::set<std::pair<unsigned, std::string>> lines;
  for (std::size_t run = 0; run < 36; ++run) {
    const Stroke stroke = palette.contact_line(run, "axial");
    EXPECT_TRUE(lines.emplace(stroke.colour, point_type(stroke)).second) << "run " << run;
    EXPECT_EQ(point_type(palette.particle_line(run)), point_type(stroke)) << "run " << run;
  }
}

TEST(Palette, TellsRunsOfSeveralContactsApartWithoutColour) {
  const Palette palette(runs_of(6, {"axial", "lateral"}));
  std::set<std::string> points;
  for (std::size_t run = 0; run < 6; ++run) {
    for (const char* contact : {"axial", "lateral"}) points.insert(point_type(palette.contact_line(run, contact)));
    EXPECT_EQ(point_type(palette.particle_line(run)), point_type(palette.contact_line(run, "axial"))) << "run " << run;
  }
  EXPECT_EQ(points.size(), 12U);
  EXPECT_FALSE(points.contains(""));
}

TEST(Palette, LeavesTheFirstContactOfOneRunWithoutMarks) {
  const Palette palette(runs_of(1, {"axial", "lateral"}));
  EXPECT_EQ(point_type(palette.contact_line(0, "axial")), "");
  EXPECT_NE(point_type(palette.contact_line(0, "lateral")), "");
  EXPECT_EQ(point_type(palette.particle_line(0)), "");
}

}  // namespace
}  // namespace monograin::figure::legend_test
