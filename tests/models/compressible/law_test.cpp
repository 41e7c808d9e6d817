// The compressible contact law by itself: limits, joints, derivatives, inverses, work, unloading and its table.

#include "compressible/law.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include "compressible/system.hpp"
#include "models/accuracy.hpp"

namespace monograin::compressible::law_test {
namespace {

const LoadingLaw k_law{2.0, 0.15, 3.0};
constexpr double k_hertz = 22.0;

/// Quadrature of a smooth function by Simpson's rule with many steps.
template <class Function>
double integral(const Function& f, double begin, double end) {
  constexpr int steps = 2000;
  const double h = (end - begin) / steps;
  double sum = f(begin) + f(end);
  for (int i = 1; i < steps; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * f(begin + i * h);
  return sum * h / 3.0;
}

TEST(CompressibleLoading, IsContinuousAtTheTransitionAndItsSlopeJumps) {
  const double t = k_law.transition;
  EXPECT_EQ(force_in(k_law, Part::linear, t), force_in(k_law, Part::exponential, t));
  EXPECT_EQ(work_in(k_law, Part::linear, t), work_in(k_law, Part::exponential, t));
  const double jump = slope_in(k_law, Part::exponential, t) - slope_in(k_law, Part::linear, t);
  EXPECT_NEAR(jump, k_law.stiffness * (k_law.exponent * t - 1.0), 4 * k_epsilon);
  // Once continuously differentiable only where a delta_t = 1.
  const LoadingLaw smooth{2.0, 0.25, 4.0};
  EXPECT_EQ(slope_in(smooth, Part::exponential, 0.25), slope_in(smooth, Part::linear, 0.25));
  EXPECT_EQ(part_at(k_law, std::nextafter(t, 0.0)), Part::linear);
  EXPECT_EQ(part_at(k_law, t), Part::exponential);
}

TEST(CompressibleLoading, HasTheSlopeAndTheForceOfItsDerivatives) {
  for (const Part part : {Part::linear, Part::exponential}) {
    for (const double d : {0.01, 0.1, 0.149, 0.151, 0.3, 0.5}) {
      const auto force = [&](double x) { return force_in(k_law, part, x); };
      const auto work = [&](double x) { return work_in(k_law, part, x); };
      // The truncation error 3^7 h^6/140 with h = 1/128 is 4e-12; round-off over h is smaller.
      EXPECT_NEAR(central_difference(force, d, 0.01), slope_in(k_law, part, d), 1e-11 * slope_in(k_law, part, d)) << d;
      EXPECT_NEAR(central_difference(work, d, 0.01), force(d), 1e-11 * force(0.5)) << d;
    }
  }
}

TEST(CompressibleLoading, WorkIsTheIntegralOfTheForce) {
  for (const double end : {0.05, 0.15, 0.1500001, 0.4, 0.5}) {
    const double first = std::min(end, k_law.transition);
    const auto force = [](double d) { return loading_force(k_law, d); };
    const auto exponential = [](double d) { return force_in(k_law, Part::exponential, d); };
    const double expected =
        integral(force, 0.0, std::nextafter(first, 0.0)) + (end > first ? integral(exponential, first, end) : 0.0);
    EXPECT_LT(relative_error(loading_work(k_law, end), expected), 1e-12) << end;
  }
}

TEST(CompressibleLoading, IsInvertedByTheDisplacementUnderAForce) {
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  double worst = 0.0;
  for (int i = 0; i < 10000; ++i) {
    const LoadingLaw law{std::exp(5.0 * share(generator) - 1.0), 0.02 + 0.4 * share(generator),
                         0.1 + 8.0 * share(generator)};
    const double d = 0.5 * share(generator);
    // A round-off of the force is amplified by f/(d f') in d.
    const double round_off = 1.0 + loading_force(law, d) / (d * slope_in(law, part_at(law, d), d));
    worst = std::max(worst, relative_error(displacement_under(law, loading_force(law, d)), d) / round_off);
  }
  EXPECT_LT(worst, 8 * k_epsilon);
  EXPECT_EQ(displacement_under(k_law, 0.0), 0.0);
  EXPECT_EQ(displacement_under(k_law, k_law.stiffness * k_law.transition), k_law.transition);
  // Just beyond the transition the distance keeps all its digits.
  const double excess = 1e-12;
  EXPECT_NEAR(displacement_under(k_law, 0.3 * (1.0 + excess)) - 0.15, excess / 3.0, 2e-16);
}

TEST(CompressibleLoading, RefusesNumbersThatAreNotAboveZero) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -1.0, nan, infinity}) {
    EXPECT_THROW(static_cast<void>(make_loading_law(bad, 0.1, 1.0)), std::invalid_argument) << bad;
    EXPECT_THROW(static_cast<void>(make_loading_law(1.0, bad, 1.0)), std::invalid_argument) << bad;
    EXPECT_THROW(static_cast<void>(make_loading_law(1.0, 0.1, bad)), std::invalid_argument) << bad;
  }
}

TEST(CompressibleUnloading, IsHertzsWithHertzsNumbers) {
  const UnloadingCurve curve = unloading_from(k_law, k_hertz, UnloadingRule(), 0.4);
  for (const double d : {curve.separation() + 1e-6, 0.36, 0.38, 0.4}) {
    const double hertz = k_hertz * std::pow(d - curve.separation(), 1.5);
    EXPECT_NEAR(unloading_force(curve, d), hertz, 1e-14 * curve.force) << d;
  }
}

TEST(CompressibleUnloading, BeginsAtTheLoadingLawAndEndsAtItsSeparation) {
  const UnloadingCurve curve = unloading_from(k_law, k_hertz, UnloadingRule(UnloadingShape{1.3, 1.6}), 0.4);
  EXPECT_EQ(unloading_force(curve, 0.4), loading_force(k_law, 0.4));
  EXPECT_NEAR(unloading_force(curve, curve.separation()), 0.0, 1e-15);
  EXPECT_NEAR(unloading_slope(curve, 0.4), 1.3 * curve.force / curve.length, 1e-14 * curve.force / curve.length);
  const double hertz_separation = 0.4 - std::pow(curve.force / k_hertz, 2.0 / 3.0);
  EXPECT_NEAR((0.4 - hertz_separation) / (0.4 - curve.separation()), 1.6, 1e-14);
  // The curve continues as an odd function: a trial step beyond is as smooth as one before.
  const double distance = 1e-3;
  EXPECT_NEAR(unloading_force(curve, curve.separation() - distance),
              -unloading_force(curve, curve.separation() + distance), 1e-13 * curve.force);
}

TEST(CompressibleUnloading, HasTheSlopeAndTheForceOfItsDerivatives) {
  const UnloadingCurve curve = unloading_from(k_law, k_hertz, UnloadingRule(UnloadingShape{1.3, 1.6}), 0.4);
  for (const double share : {0.05, 0.3, 0.7, 0.99}) {
    const double d = curve.separation() + share * curve.length;
    const auto force = [&](double x) { return unloading_force(curve, x); };
    const auto work = [&](double x) { return recoverable_work(curve, x); };
    const double step = 0.02 * share * curve.length;
    EXPECT_NEAR(central_difference(force, d, step), unloading_slope(curve, d), 1e-10 * unloading_slope(curve, 0.4))
        << share;
    EXPECT_NEAR(central_difference(work, d, step), force(d), 1e-10 * curve.force) << share;
    EXPECT_NEAR(unloading_displacement(curve, force(d)), d, 1e-15) << share;
  }
  EXPECT_NEAR(recoverable_work(curve, 0.4), curve.force * curve.length / 2.3, 1e-16);
  for (const double share : {-3.0, 2.5, 100.0}) {  // where only a guess comes
    const double d = curve.separation() + share * curve.length;
    const double step = 0.1 * curve.length;
    const double growth = (unloading_force(curve, d + step) - unloading_force(curve, d - step)) / (2.0 * step);
    EXPECT_NEAR(unloading_slope(curve, d), growth, 1e-12 * growth) << share;
    const double power = (recoverable_work(curve, d + step) - recoverable_work(curve, d - step)) / (2.0 * step);
    EXPECT_NEAR(unloading_force(curve, d), power, 1e-11 * std::abs(power)) << share;
  }
}

TEST(CompressibleUnloading, OpensNoEarlierThanAtFirstTouch) {
  // The linear part is stiffer than Hertz for d < (k/k_H)^2.
  const double end = std::pow(k_law.stiffness / k_hertz, 2.0);
  const UnloadingCurve inside = unloading_from(k_law, k_hertz, UnloadingRule(), 0.999 * end);
  const UnloadingCurve outside = unloading_from(k_law, k_hertz, UnloadingRule(), 1.001 * end);
  EXPECT_TRUE(inside.is_clipped);
  EXPECT_EQ(inside.separation(), 0.0);
  EXPECT_FALSE(outside.is_clipped);
  EXPECT_GT(outside.separation(), 0.0);
}

TEST(CompressibleUnloading, DissipatesWhereItIsSteeperThanTheLoading) {
  std::mt19937_64 generator(2);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  int steep = 0;
  for (int i = 0; i < 20000; ++i) {
    const LoadingLaw law{std::exp(3.0 * share(generator) - 1.0), 0.02 + 0.4 * share(generator),
                         0.1 + 8.0 * share(generator)};
    const UnloadingRule rule(UnloadingShape{1.0 + 2.0 * share(generator), 0.3 + 5.0 * share(generator)});
    const UnloadingCurve curve = unloading_from(law, 1.0 + 100.0 * share(generator), rule, 0.5 * share(generator));
    if (slope_ratio(law, curve) < 1.0) continue;
    ++steep;
    const double work = loading_work(law, curve.largest);
    EXPECT_GE(work - recoverable_work(curve, curve.largest), -8 * k_epsilon * work);
  }
  EXPECT_GT(steep, 15000);
}

TEST(CompressibleUnloading, WarnsOfWhatHappenedInOneRun) {
  WallLaw clipped({.law = {1.53, 0.36, 3.48},
                   .hertz_stiffness = hertz_stiffness(4.5, 0.3),
                   .unloading = UnloadingRule(UnloadingShape{1.7, 1.2})});
  WallLaw::Branch branch;
  clipped.turn(branch, 0.1);
  EXPECT_EQ(clipped.warnings(1.0).size(), 1u);
  clipped.start();
  EXPECT_TRUE(clipped.warnings(1.0).empty());
  WallLaw flat({.law = {2.0, 0.1, 12.0},
                .hertz_stiffness = hertz_stiffness(4.0, 0.3),
                .unloading = UnloadingRule(UnloadingShape{1.0, 0.2})});
  static_cast<void>(flat.stored({.part = Part::exponential}, 0.4));
  EXPECT_EQ(flat.warnings(1.0).size(), 1u);
  flat.start();
  EXPECT_TRUE(flat.warnings(1.0).empty());
}

TEST(CompressibleUnloadingTable, IsBilinearAndConstantOutside) {
  // alpha = 1 + ln(ratio) dm and beta = 2 + ln(ratio) + dm are bilinear, so that the interpolation is exact.
  std::vector<UnloadingRow> rows;
  const auto shape = [](double ratio, double dm) {
    return UnloadingShape{1.0 + std::log(ratio) * dm, 2.0 + std::log(ratio) + dm};
  };
  for (const double ratio : {3.0, 30.0, 100.0}) {
    for (const double dm : {0.4, 0.1, 0.2}) rows.push_back({ratio, {dm, shape(ratio, dm)}});
  }
  const auto expect = [&](double ratio, double dm, const UnloadingShape& expected) {
    const UnloadingShape found = interpolated_rule(rows, ratio).at(dm);
    EXPECT_NEAR(found.exponent, expected.exponent, 1e-14) << ratio << " " << dm;
    EXPECT_NEAR(found.stiffness_ratio, expected.stiffness_ratio, 1e-14) << ratio << " " << dm;
  };
  for (const double ratio : {3.0, 5.0, 29.0, 30.0, 77.0, 100.0}) {
    for (const double dm : {0.1, 0.15, 0.2, 0.39, 0.4}) expect(ratio, dm, shape(ratio, dm));
  }
  expect(1.0, 0.05, shape(3.0, 0.1));
  expect(1e4, 0.5, shape(100.0, 0.4));
  expect(10.0, 0.5, shape(10.0, 0.4));
}

TEST(CompressibleUnloadingTable, NeedsNoCommonDisplacements) {
  const std::vector<UnloadingRow> rows{
      {10.0, {0.1, {1.0, 1.0}}}, {10.0, {0.5, {2.0, 5.0}}}, {1000.0, {0.3, {3.0, 7.0}}}};
  const UnloadingRule rule = interpolated_rule(rows, 100.0);  // half way in the logarithm
  EXPECT_NEAR(rule.at(0.1).exponent, 2.0, 1e-14);
  EXPECT_NEAR(rule.at(0.2).exponent, 2.125, 1e-14);
  EXPECT_NEAR(rule.at(0.5).stiffness_ratio, 6.0, 1e-14);
  EXPECT_THROW(static_cast<void>(interpolated_rule({}, 1.0)), std::invalid_argument);
}

}  // namespace
}  // namespace monograin::compressible::law_test
