#include "exchange/vtk.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include "exchange/motion_of_run.hpp"
#include "support/temporary_folder.hpp"
#include "support/test_run.hpp"
#include "support/text_file.hpp"

namespace monograin {
namespace {

/// A .vtp file as a reader of VTK's XML format with raw appended data sees it.
class VtkFile {
 public:
  explicit VtkFile(const std::filesystem::path& file) : text_(read_text(file)) {
    data_ = text_.find("<AppendedData encoding=\"raw\">\n_") + std::strlen("<AppendedData encoding=\"raw\">\n_");
  }
  [[nodiscard]] std::size_t count(const std::string& attribute) const {
    std::smatch match;
    return std::regex_search(text_, match, std::regex(attribute + "=\"(\\d+)\"")) ? std::stoul(match[1]) : 0;
  }
  /// Values of an array; that of the points has no name.
  template <class Value>
  [[nodiscard]] std::vector<Value> array(const std::string& name) const {
    std::smatch match;
    const std::string head = text_.substr(0, data_);
    if (!std::regex_search(head, match, std::regex("Name=\"" + name + "\"[^>]*offset=\"(\\d+)\""))) return {};
    const std::size_t place = data_ + std::stoul(match[1]);
    std::uint64_t size = 0;
    std::memcpy(&size, text_.data() + place, sizeof(size));
    std::vector<Value> values(size / sizeof(Value));
    std::memcpy(values.data(), text_.data() + place + sizeof(size), size);
    return values;
  }
  [[nodiscard]] std::vector<float> points() const { return array<float>(""); }

 private:
  std::string text_;
  std::size_t data_;
};

class Vtk : public ::testing::Test {
 protected:
  void write(const CheckedScenario& scenario) {
    motion_ = motion_of_run(scenario);
    write_vtk(motion_, folder_.path());
  }
  [[nodiscard]] std::filesystem::path file(const std::string& name) const { return folder_.path() / name; }

  /// File of a part at the end of the run.
  [[nodiscard]] VtkFile last(const std::string& part) const {
    return VtkFile(file(fmt::format("{}-{:04}.vtp", part, std::min<std::size_t>(motion_.instants.size(), 200) - 1)));
  }

  Motion motion_;
  TemporaryFolder folder_;
};

TEST_F(Vtk, ListsTheFilesOfEveryInstantInTheOrderOfTime) {
  write(with_points(mdr_scenario(Configuration::die, 50.0, 0.3, path({0.1, 0.09})), 10));
  const std::string list = read_text(file("run.pvd"));
  const std::regex entry("timestep=\"([^\"]+)\" part=\"([01])\" file=\"([^\"]+)\"");
  std::size_t count = 0;
  double last_time = -1.0;
  for (std::sregex_iterator i(list.begin(), list.end(), entry); i != std::sregex_iterator(); ++i, ++count) {
    EXPECT_EQ((*i)[2], count % 2 == 0 ? "0" : "1");
    EXPECT_TRUE(std::filesystem::exists(file((*i)[3]))) << (*i)[3];
    const double time = std::stod((*i)[1]);
    if (count % 2 == 0) {
      EXPECT_GT(time, last_time);
    }
    last_time = time;
  }
  EXPECT_EQ(count, 2 * motion_.instants.size());
  EXPECT_EQ(last_time, 2.0);
}

TEST_F(Vtk, WritesAtMostTwoHundredInstantsAndTheLast) {
  write(with_points(hertz_scenario(Configuration::simple, path({0.01})), 999));
  const std::string list = read_text(file("run.pvd"));
  const std::regex entry("timestep=\"([^\"]+)\" part=\"0\"");
  std::vector<double> times;
  for (std::sregex_iterator i(list.begin(), list.end(), entry); i != std::sregex_iterator(); ++i) {
    times.push_back(std::stod((*i)[1]));
  }
  EXPECT_EQ(times.size(), 200U);
  EXPECT_EQ(times.front(), 0.0);
  EXPECT_EQ(times.back(), 1.0);
}

TEST_F(Vtk, ShowsAParticleThatEndsAtItsWalls) {
  write(with_points(mdr_scenario(Configuration::die, 50.0, 0.3, path({0.3})), 4));
  const VtkFile particle = last("particle");
  const std::vector<float> points = particle.points();
  ASSERT_EQ(points.size(), 3 * particle.count("NumberOfPoints"));
  EXPECT_EQ(particle.array<std::int32_t>("connectivity").size(), 3 * particle.count("NumberOfPolys"));
  EXPECT_EQ(particle.array<std::int32_t>("offsets").size(), particle.count("NumberOfPolys"));
  float highest = 0.0F;
  float widest = 0.0F;
  for (std::size_t i = 0; i < points.size(); i += 3) {
    widest = std::max({widest, std::abs(points[i]), std::abs(points[i + 1])});
    highest = std::max(highest, std::abs(points[i + 2]));
  }
  EXPECT_FLOAT_EQ(highest, 0.7F);
  EXPECT_FLOAT_EQ(widest, 1.0F);
}

TEST_F(Vtk, GivesThePressureOfAContactWithinItsRadiusAndNoneElsewhere) {
  write(with_points(mdr_scenario(Configuration::die, 50.0, 0.3, path({0.3})), 1));
  const ContactInstant& axial = motion_.instants.back().contacts[0];
  const std::vector<float> points = last("particle").points();
  const std::vector<float> pressures = last("particle").array<float>("pressure");
  const std::vector<float> walls = last("particle").array<float>("wall");
  ASSERT_EQ(3 * pressures.size(), points.size());
  int pressed = 0;
  for (std::size_t i = 0; i < pressures.size(); ++i) {
    if (walls[i] != 1.0F) continue;
    const double from_axis = std::hypot(points[3 * i], points[3 * i + 1]);
    EXPECT_FLOAT_EQ(pressures[i], from_axis > axial.radius ? 0.0F : static_cast<float>(axial.pressure));
    pressed += pressures[i] > 0.0F ? 1 : 0;
  }
  EXPECT_GT(pressed, 50);
  for (std::size_t i = 0; i < pressures.size(); ++i) {
    if (walls[i] == 0.0F) {
      EXPECT_EQ(pressures[i], 0.0F);
    }
  }
}

TEST_F(Vtk, KeepsTheDentOfAContactThatIsLost) {
  write(with_points(mdr_scenario(Configuration::simple, 25.0, 0.3, path({0.3, 0.0})), 20));
  double lost = 0.0;
  for (const MotionInstant& instant : motion_.instants) {
    if (instant.contacts[0].force > 0.0) lost = instant.contacts[0].displacement;
  }
  ASSERT_GT(lost, 0.2);
  float highest = 0.0F;
  const std::vector<float> points = last("particle").points();
  for (std::size_t i = 2; i < points.size(); i += 3) highest = std::max(highest, points[i]);
  EXPECT_FLOAT_EQ(highest, static_cast<float>(1.0 - lost));
}

TEST_F(Vtk, HasThePressureInEveryFileOrInNone) {
  write(read_scenario(MONOGRAIN_SOURCE_DIR "/scenarios/semimech.toml"));
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
    const bool is_particle = entry.path().filename().string().starts_with("particle");
    if (is_particle) {
      EXPECT_FALSE(VtkFile(entry.path()).array<float>("pressure").empty()) << entry.path();
    }
  }
  write(read_scenario(MONOGRAIN_SOURCE_DIR "/scenarios/compressible.toml"));
  EXPECT_TRUE(last("particle").array<float>("pressure").empty());
}

TEST_F(Vtk, MovesPointsFromTheUndeformedSphere) {
  write(with_points(hertz_scenario(Configuration::simple, path({0.2})), 1));
  const VtkFile start(file("particle-0000.vtp"));
  const VtkFile end = last("particle");
  for (const float value : start.array<float>("displacement")) EXPECT_NEAR(value, 0.0F, 1e-6F);
  const std::vector<float> from = start.points();
  const std::vector<float> to = end.points();
  const std::vector<float> displacement = end.array<float>("displacement");
  for (std::size_t i = 0; i < to.size(); ++i) EXPECT_NEAR(to[i] - from[i], displacement[i], 1e-6F);
}

TEST_F(Vtk, ShowsTheForceOfEveryWall) {
  write(with_points(mdr_scenario(Configuration::die, 50.0, 0.3, path({0.3})), 1));
  const VtkFile walls = last("walls");
  EXPECT_EQ(walls.count("NumberOfPolys"), 6U);
  const std::vector<float> forces = walls.array<float>("force");
  ASSERT_EQ(forces.size(), 6U);
  EXPECT_FLOAT_EQ(forces[0], static_cast<float>(motion_.instants.back().contacts[0].force));
  EXPECT_FLOAT_EQ(forces[5], static_cast<float>(motion_.instants.back().contacts[1].force));
  EXPECT_FLOAT_EQ(walls.array<float>("displacement")[0], 0.3F);
}

}  // namespace
}  // namespace monograin
