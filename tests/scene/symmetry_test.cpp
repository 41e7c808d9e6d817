// Which walls of a set share one history.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>

#include "support/test_run.hpp"

namespace monograin::symmetry_test {
namespace {

using Classes = std::vector<std::size_t>;

Wall driven(const Eigen::Vector3d& normal, double displacement = 0.1) {
  return {"", "", normal.normalized(), 0.0, path({displacement})};
}
Wall fixed(const Eigen::Vector3d& normal) { return {"", "", normal.normalized(), 0.0, {}}; }

std::vector<Wall> walls_of(Configuration configuration, double angle = 0.0, int oblique_walls = 2) {
  CheckedScenario scenario = hertz_scenario(configuration, path({0.1}));
  scenario.loading.oblique_angle = angle;
  scenario.loading.oblique_walls = oblique_walls;
  return make_walls(scenario);
}

constexpr double k_degree = std::numbers::pi / 180.0;

std::vector<Wall> oblique_die(int oblique_walls) {
  return walls_of(Configuration::oblique_die, 37.5 * k_degree, oblique_walls);
}

TEST(SymmetryClasses, OfThePresets) {
  EXPECT_EQ(symmetry_classes(walls_of(Configuration::simple)), (Classes{0, 0}));
  EXPECT_EQ(symmetry_classes(walls_of(Configuration::die)), (Classes{0, 0, 1, 1, 1, 1}));
  EXPECT_EQ(symmetry_classes(walls_of(Configuration::hydrostatic)), (Classes{0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(symmetry_classes(oblique_die(2)), (Classes{0, 0, 1, 1, 2, 2, 3, 3}));
  EXPECT_EQ(symmetry_classes(oblique_die(4)), (Classes{0, 0, 1, 1, 2, 2, 3, 3, 3, 3}));
}

TEST(SymmetryClasses, DoNotDependOnTheOrientationOfTheSet) {
  const Eigen::Quaterniond rotation = Eigen::Quaterniond(0.1, 0.9, -0.4, 0.3).normalized();
  for (std::vector<Wall> walls :
       {walls_of(Configuration::die), walls_of(Configuration::hydrostatic), oblique_die(2), oblique_die(4)}) {
    const Classes expected = symmetry_classes(walls);
    for (Wall& w : walls) w.normal = rotation * w.normal;
    EXPECT_EQ(symmetry_classes(walls), expected) << walls.size() << " walls";
  }
}

TEST(SymmetryClasses, DoNotDependOnTheOrderOfTheWalls) {
  std::vector<Wall> walls = oblique_die(4);
  const Classes expected = symmetry_classes(walls);
  std::vector<std::size_t> order{7, 2, 9, 0, 4, 1, 8, 3, 6, 5};
  std::vector<Wall> shuffled;
  for (const std::size_t i : order) shuffled.push_back(walls[i]);
  const Classes actual = symmetry_classes(shuffled);
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t j = 0; j < order.size(); ++j) {
      EXPECT_EQ(actual[i] == actual[j], expected[order[i]] == expected[order[j]]) << order[i] << " and " << order[j];
    }
  }
}

TEST(SymmetryClasses, KeepWallsApartThatMoveOrStartDifferently) {
  EXPECT_EQ(symmetry_classes({driven({0, 0, 1}, 0.1), driven({0, 0, -1}, 0.2)}), (Classes{0, 1}));
  std::vector<Wall> walls{driven({0, 0, 1}), driven({0, 0, -1})};
  walls[1].gap = 0.01;
  EXPECT_EQ(symmetry_classes(walls), (Classes{0, 1}));
  walls[1] = fixed({0, 0, -1});
  EXPECT_EQ(symmetry_classes(walls), (Classes{0, 1}));
  walls[1] = driven({0, 0, -1});
  walls[1].steps[0] = until(walls[1].steps[0], Quantity::force, 1.0);
  EXPECT_EQ(symmetry_classes(walls), (Classes{0, 1}));
}

TEST(SymmetryClasses, SeeTheWholeSetNotOnlyThePair) {
  // Two driven walls alike, but a third one stands nearer to the first.
  EXPECT_EQ(symmetry_classes({driven({0, 0, 1}), driven({0, 0, -1}), fixed({1, 0, 0.3})}), (Classes{0, 1, 2}));
  EXPECT_EQ(symmetry_classes({driven({0, 0, 1}), driven({0, 0, -1}), fixed({1, 0, 0})}), (Classes{0, 0, 1}));
}

TEST(SymmetryClasses, AreSingleWallsWithoutSymmetry) {
  EXPECT_EQ(symmetry_classes({driven({0.1, -0.05, 1}), driven({0.9, 0.1, -0.5}), driven({-0.5, 0.7, -0.4}),
                              driven({-0.4, -0.8, -0.6})}),
            (Classes{0, 1, 2, 3}));
}

TEST(SymmetryClasses, FindReflections) {
  // A kite in a plane: its one mirror exchanges the two walls aside.
  EXPECT_EQ(symmetry_classes({driven({0, 1, 0}), driven({0.8, -0.3, 0}), driven({-0.8, -0.3, 0})}), (Classes{0, 1, 1}));
}

TEST(SymmetryClasses, FindTheSymmetryOfATetrahedron) {
  const std::vector<Wall> walls{driven({1, 1, 1}), driven({1, -1, -1}), driven({-1, 1, -1}), driven({-1, -1, 1})};
  EXPECT_EQ(symmetry_classes(walls), (Classes{0, 0, 0, 0}));
}

TEST(SymmetryClasses, OfFiftyWallsTakeNoTime) {
  std::vector<Wall> walls;
  for (int k = 0; k < 50; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / 50.0;
    walls.push_back(driven({std::cos(angle), std::sin(angle), 0.0}));
  }
  const std::clock_t begin = std::clock();
  EXPECT_EQ(symmetry_classes(walls), Classes(50, 0));
  // One wall with a program of its own leaves the mirror through it: 24 pairs, the wall itself and the one opposite.
  walls[0].steps[0].target = 0.2;
  const Classes classes = symmetry_classes(walls);
  EXPECT_EQ(*std::ranges::max_element(classes), 25u);
  EXPECT_LT(std::clock() - begin, CLOCKS_PER_SEC);
}

}  // namespace
}  // namespace monograin::symmetry_test
