// The core of an elastic-plastic particle, and the yield of contacts beside it.

#include "cel/core.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "cel/constants.hpp"
#include "models/accuracy.hpp"

namespace monograin::cel::core_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
namespace k = constants;

constexpr double k_yield_stress = 0.02;

Matrix3d dyad(const Vector3d& n) { return n * n.transpose(); }

CoreLoad load_of(const Matrix3d& C, double e, const Matrix3d& pushes) {
  CoreLoad load{.core = {C, e}, .pushes = pushes};
  load.evaluate(k_yield_stress);
  return load;
}

TEST(CelCoreShapes, AreNoneAmongWallsThatPressAlikeOnAllSides) {
  const Matrix3d all_sides = 2.0 * Matrix3d::Identity();
  EXPECT_TRUE(core_shapes(std::vector{all_sides}).empty());
}

TEST(CelCoreShapes, AreOrthonormalAndDeviatorsButForTheFirst) {
  const std::vector<Matrix3d> axes{dyad(Vector3d::UnitX()), dyad(Vector3d::UnitY()), dyad(Vector3d::UnitZ())};
  const std::vector<Matrix3d> oblique{dyad(Vector3d(1, 2, 3)), dyad(Vector3d(-1, 0, 2)), dyad(Vector3d(0.3, 1, 0))};
  const std::vector<Matrix3d> axial{dyad(Vector3d::UnitZ())};
  for (const auto& [spreads, count] : {std::pair(axial, 2u), std::pair(axes, 3u), std::pair(oblique, 6u)}) {
    const std::vector<Matrix3d> shapes = core_shapes(spreads);
    ASSERT_EQ(shapes.size(), count);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < count; ++j) EXPECT_NEAR(contraction(shapes[i], shapes[j]), i == j, 1e-14);
      EXPECT_NEAR(shapes[i].trace(), i == 0 ? std::sqrt(3.0) : 0.0, 1e-14);
    }
  }
}

TEST(CelCoreLoad, IsTheForceTimesTheSupportDistanceBetweenTwoWalls) {
  for (const double l : {0.7, 1.0, 1.1}) {
    const Matrix3d C = Vector3d(1.0 / l, 1.0 / l, l * l).asDiagonal();
    const double force = 0.03;
    // Far from the change of the advance, w = 1/l.
    const CoreLoad load = load_of(C, 0.1, 2.0 * force / l * dyad(Vector3d::UnitZ()));
    EXPECT_LE(relative_error(load.s, force * l), 1e-14);
    EXPECT_NEAR(load.T.trace(), 0.0, 1e-16);
    EXPECT_LE(relative_error(load.use, load.s / (k_yield_stress * (k::s0 + 0.1 * k::s1))), 1e-14);
    EXPECT_LE(relative_error(load.Q, std::pow(load.use, k::n2)), 1e-14);
    // The core flattens, and strains as l shrinks: C_zz = exp(-2 e).
    EXPECT_LE(relative_error(-load.flow.C(2, 2) / C(2, 2), 2.0 * load.flow.e), 1e-14);
  }
}

TEST(CelCoreLoad, HasNoDirectionUnderAPressure) {
  const CoreLoad load = load_of(Matrix3d::Identity(), 0.0, 0.05 * Matrix3d::Identity());
  EXPECT_EQ(load.s, 0.0);
  EXPECT_EQ(load.Q, 0.0);
  EXPECT_EQ(load.flow.C, Matrix3d::Zero());
}

TEST(CelYield, OfAContactThatIsOpenIsFarAway) {
  const Yield yield =
      yield_of(Contact{}, load_of(Matrix3d::Identity(), 0.0, 0.05 * dyad(Vector3d::UnitZ())), dyad(Vector3d::UnitZ()));
  EXPECT_EQ(yield.f, -1.0);
  EXPECT_EQ(yield.X, 0.0);
}

TEST(CelYield, IsCarriedAcrossTheLoadAndDrivesAlongIt) {
  const CoreLoad load = load_of(Matrix3d::Identity(), 0.0, 0.05 * dyad(Vector3d::UnitZ()));
  const Contact contact{.F = 0.01, .alpha = 0.1, .F_over_H = 0.5};
  const Yield along = yield_of(contact, load, dyad(Vector3d::UnitZ()));
  EXPECT_NEAR(along.tau, 1.0, 1e-15);
  EXPECT_EQ(along.b, 0.0);
  EXPECT_EQ(along.weak, 1.0);
  const Yield across = yield_of(contact, load, dyad(Vector3d::UnitX()));
  EXPECT_NEAR(across.tau, -0.5, 1e-15);
  EXPECT_NEAR(across.b, 1.0, 1e-15);
  EXPECT_LT(across.weak, 1.0);
  EXPECT_GT(across.f, along.f);
  // By itself a contact flows at its limit force.
  EXPECT_LE(std::abs(yield_of({.F = 0.01, .F_over_H = 1.0}, CoreLoad{}, dyad(Vector3d::UnitX())).f), 1e-15);
}

TEST(CelYield, HasTheDerivativesOfItsFunction) {
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<> share(0.2, 1.0);
  const auto random = [&] {
    const Matrix3d a = Matrix3d::NullaryExpr([&](Eigen::Index, Eigen::Index) { return share(generator) - 0.6; });
    return Matrix3d(a + a.transpose());
  };
  int carried = 0;
  for (int n = 0; n < 60; ++n) {
    const Matrix3d C = Matrix3d::Identity() + 0.2 * random();
    const Matrix3d pushes = 0.06 * random();
    const Matrix3d pushes_by_flow = 0.01 * random();
    const Matrix3d wall = dyad(Vector3d(share(generator), share(generator) - 0.6, 0.3).normalized());
    const double H = 0.02 * share(generator);
    const Contact contact{.F = 0.8 * H, .alpha = 0.2 * share(generator), .H = H, .F_over_H = 0.8};
    const CoreLoad load = load_of(C, 0.2, pushes);
    const Yield at = yield_of(contact, load, wall);
    if (at.b > 0.0 && at.b < 1.0) ++carried;
    const YieldSlopes slopes = slopes_of(at, contact, load, wall, pushes_by_flow);
    const auto f = [&](double F, double limit, double alpha, double push, double flow) {
      const Contact moved{.F = F, .alpha = alpha, .H = limit, .F_over_H = F / limit};
      const Matrix3d moved_pushes = pushes + push * wall + flow * pushes_by_flow;
      return yield_of(moved, load_of(C + flow * load.flow.C, 0.2 + flow * load.flow.e, moved_pushes), wall).f;
    };
    const auto expect = [&](double slope, auto&& function, double x, double step) {
      EXPECT_NEAR(slope, central_difference(function, x, step), 1e-8 * (1.0 + std::abs(slope))) << "case " << n;
    };
    const double F = contact.F, alpha = contact.alpha;
    expect(
        slopes.by_F, [&](double x) { return f(x, H, alpha, 0, 0); }, F, 1e-4 * F);
    expect(
        slopes.by_H, [&](double x) { return f(F, x, alpha, 0, 0); }, H, 1e-4 * H);
    expect(
        slopes.by_alpha, [&](double x) { return f(F, H, x, 0, 0); }, alpha, 1e-4 * alpha);
    expect(
        contraction(slopes.by_pushes, wall), [&](double x) { return f(F, H, alpha, x, 0); }, 0.0, 1e-6);
    const double pace = std::max(1.0, load.flow.C.norm());
    expect(
        slopes.by_flow, [&](double x) { return f(F, H, alpha, 0, x); }, 0.0, 1e-5 / pace);
  }
  EXPECT_GE(carried, 5);
}

}  // namespace
}  // namespace monograin::cel::core_test
