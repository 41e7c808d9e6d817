// The pressure curve by itself, in the contact laws, and in runs.

#include "mdr/pressure_curve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "mdr/contact.hpp"
#include "models/accuracy.hpp"
#include "support/test_run.hpp"

namespace monograin::mdr::pressure_curve_test {
namespace {

using std::numbers::pi;

struct Samples {
  std::vector<double> x;
  std::vector<double> p;

  [[nodiscard]] PressureCurve curve() const { return {x, p}; }
};

/// Rises, rests, falls steeply, falls gently; unequal intervals.
const Samples k_bumpy{{0.0, 1e-4, 0.01, 0.1, 0.12, 0.2, 0.5}, {1.0, 1.4, 2.2, 2.6, 2.6, 1.3, 1.2}};

/// The exponential, sampled in a number of equal intervals up to x = 0.8.
Samples dense_exponential(int intervals) {
  Samples samples;
  for (int i = 0; i <= intervals; ++i) {
    samples.x.push_back(0.8 * i / intervals);
    samples.p.push_back(exponential_pressure(samples.x.back()).value);
  }
  return samples;
}

std::shared_ptr<const PressureCurve> shared(const Samples& samples) {
  return std::make_shared<const PressureCurve>(samples.x, samples.p);
}

/// Positions inside all intervals of a curve.
std::vector<double> inner_places(const PressureCurve& curve) {
  std::vector<double> places;
  const auto knots = curve.knots();
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    for (const double share : {0.1, 0.5, 0.85}) places.push_back(std::lerp(knots[i], knots[i + 1], share));
  }
  return places;
}

// --- the curve

TEST(MdrPressureCurve, PassesThroughItsSamples) {
  const PressureCurve curve = k_bumpy.curve();
  for (std::size_t i = 0; i < k_bumpy.x.size(); ++i) {
    EXPECT_LE(relative_error(curve.at(k_bumpy.x[i]).value, k_bumpy.p[i]), 4 * k_epsilon) << "x = " << k_bumpy.x[i];
  }
  EXPECT_EQ(curve.end(), 0.5);
}

TEST(MdrPressureCurve, IsMonotoneBetweenSamples) {
  const PressureCurve curve = k_bumpy.curve();
  for (std::size_t i = 0; i + 1 < k_bumpy.x.size(); ++i) {
    const double sign = std::copysign(1.0, k_bumpy.p[i + 1] - k_bumpy.p[i]);
    double last = curve.at(k_bumpy.x[i]).value;
    for (int k = 1; k <= 200; ++k) {
      const PressureRatio now = curve.at(std::lerp(k_bumpy.x[i], k_bumpy.x[i + 1], k / 200.0));
      EXPECT_GE(sign * (now.value - last), -4 * k_epsilon * last) << "after sample " << i;
      last = now.value;
    }
  }
}

TEST(MdrPressureCurve, HasTheSlopeOfItsValues) {
  const PressureCurve curve = k_bumpy.curve();
  const auto value = [&](double x) { return curve.at(x).value; };
  for (const double x : inner_places(curve)) {
    const auto knots = curve.knots();
    const auto next = std::ranges::upper_bound(knots, x);
    const double room = std::min(x - *(next - 1), *next - x);  // the stencil must stay in one cubic
    const double slope = central_difference(value, x, room / 4.0);
    const double round_off = 1e3 * k_epsilon * value(x) / room;
    EXPECT_NEAR(curve.at(x).slope, slope, 1e-11 * std::abs(slope) + round_off) << "x = " << x;
  }
}

TEST(MdrPressureCurve, HasNoKinks) {
  const PressureCurve curve = k_bumpy.curve();
  for (std::size_t i = 1; i + 1 < k_bumpy.x.size(); ++i) {
    const double x = k_bumpy.x[i];
    const double before = std::nextafter(x, 0.0);
    // Slopes of a cubic change by no more than 6 secants over its interval.
    const double width = std::min(x - k_bumpy.x[i - 1], k_bumpy.x[i + 1] - x);
    EXPECT_NEAR(curve.at(before).slope, curve.at(x).slope, 1e3 * k_epsilon * 2.6 / width) << "x = " << x;
  }
}

TEST(MdrPressureCurve, HasTheMomentsOfItsValues) {
  using Quadrature = boost::math::quadrature::gauss_kronrod<double, 15>;
  const auto expect_moments = [](const std::function<double(double)>& value, const PressureMoments& moments, double x,
                                 std::span<const double> knots) {
    double sums[3]{};
    for (std::size_t i = 0; i + 1 < knots.size() && knots[i] < x; ++i) {
      for (int n = 0; n < 3; ++n) {
        sums[n] += Quadrature::integrate([&](double t) { return value(t) * std::pow(t, n); }, knots[i],
                                         std::min(x, knots[i + 1]), 5, 1e-14);
      }
    }
    constexpr double k_quadrature = 1e-13;
    EXPECT_LE(relative_error(moments.zeroth, sums[0]), k_quadrature) << "x = " << x;
    EXPECT_LE(relative_error(moments.first, sums[1]), k_quadrature) << "x = " << x;
    EXPECT_LE(relative_error(moments.second, sums[2]), k_quadrature) << "x = " << x;
  };
  const PressureCurve curve = k_bumpy.curve();
  for (const double x : inner_places(curve)) {
    expect_moments([&](double t) { return curve.at(t).value; }, curve.moments(x), x, curve.knots());
    const double whole[]{0.0, 1.0};
    expect_moments([](double t) { return exponential_pressure(t).value; }, exponential_moments(x), x, whole);
  }
}

TEST(MdrPressureCurve, OfTheSourceHasTheSlopeOfItsValues) {
  const auto value = [](double x) { return exponential_pressure(x).value; };
  for (const double x : {0.0, 0.01, 0.3, 1.0}) {
    EXPECT_NEAR(exponential_pressure(x).slope, central_difference(value, x, 4e-3), 1e-11) << "x = " << x;
  }
  EXPECT_EQ(value(0.0), 2.75);
}

TEST(MdrPressureCurve, RefusesBadSamples) {
  constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double k_infinity = std::numeric_limits<double>::infinity();
  const auto refuses = [](const std::vector<double>& x, const std::vector<double>& p) {
    EXPECT_THROW(PressureCurve(x, p), std::invalid_argument)
        << ::testing::PrintToString(x) << ::testing::PrintToString(p);
  };
  refuses({}, {});
  refuses({0.0, 0.1, 0.2}, {3.0, 2.0, 1.0});
  refuses({0.0, 0.1, 0.2, 0.3}, {3.0, 2.0, 1.0});
  refuses({0.01, 0.1, 0.2, 0.3}, {3.0, 2.0, 2.0, 1.0});
  refuses({0.0, 0.2, 0.1, 0.3}, {3.0, 2.0, 2.0, 1.0});
  refuses({0.0, 0.1, 0.1, 0.3}, {3.0, 2.0, 2.0, 1.0});
  refuses({0.0, 0.1, 0.2, 0.3}, {3.0, 2.0, 0.0, 1.0});
  refuses({0.0, 0.1, 0.2, 0.3}, {3.0, 2.0, -1.0, 1.0});
  refuses({0.0, 0.1, 0.2, 0.3}, {3.0, 2.0, k_nan, 1.0});
  refuses({0.0, 0.1, 0.2, 0.3}, {k_infinity, 2.0, 2.0, 1.0});
  refuses({0.0, 0.1, k_nan, 0.3}, {3.0, 2.0, 2.0, 1.0});
  refuses({0.0, 0.1, 0.2, k_infinity}, {3.0, 2.0, 2.0, 1.0});
  refuses({0.0, 1e-320, 0.2, 0.3}, {3.0, 2.0, 2.0, 1.0});
}

TEST(MdrPressureCurve, SaysWhereItEnds) {
  const PressureCurve curve = k_bumpy.curve();
  EXPECT_NO_THROW(static_cast<void>(curve.at(0.5)));
  for (const double x : {std::nextafter(0.5, 1.0), 0.7, -1e-9, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(static_cast<void>(curve.moments(x)), std::domain_error);
    try {
      static_cast<void>(curve.at(x));
      ADD_FAILURE() << "x = " << x;
    } catch (const std::domain_error& error) {
      EXPECT_NE(std::string(error.what()).find("ends at 0.5"), std::string::npos) << error.what();
    }
  }
}

TEST(MdrPressureCurve, FindsTheNextKnotInEitherDirection) {
  const PressureCurve curve = k_bumpy.curve();
  EXPECT_EQ(curve.knot_beyond(0.05, 1.0), 0.1);
  EXPECT_EQ(curve.knot_beyond(0.1, 2.0), 0.12);
  EXPECT_EQ(curve.knot_beyond(0.05, -1.0), 0.01);
  EXPECT_EQ(curve.knot_beyond(0.1, -1.0), 0.01);
  EXPECT_EQ(curve.knot_beyond(-1.0, 1.0), 0.0);
  EXPECT_EQ(curve.knot_beyond(0.5, 1.0), k_infinity);
  EXPECT_EQ(curve.knot_beyond(0.0, -1.0), -k_infinity);
}

// --- in the contact laws

TEST(MdrYieldWithTable, IsWhereTheElasticPressureMeetsTheCurve) {
  for (const double modulus_over_yield : {10.0, 30.0, 100.0, 1e4}) {
    const double d = yield_overlap_ratio(modulus_over_yield, k_bumpy.curve());
    ASSERT_TRUE(std::isfinite(d)) << modulus_over_yield;
    const double elastic = 4.0 * modulus_over_yield / (3.0 * pi) * std::sqrt(d);
    EXPECT_LE(relative_error(elastic, k_bumpy.curve().at(d).value), 1e-14) << modulus_over_yield;
  }
}

TEST(MdrYieldWithTable, IsThatOfTheClosedFormForAConstantPressure) {
  const PressureCurve constant = Samples{{0.0, 0.1, 0.2, 1.0}, {2.0, 2.0, 2.0, 2.0}}.curve();
  for (const double modulus_over_yield : {6.0, 100.0, 1e5}) {
    const double s = 1.5 * pi / modulus_over_yield;
    EXPECT_LE(relative_error(yield_overlap_ratio(modulus_over_yield, constant), s * s), 8 * k_epsilon);
  }
}

TEST(MdrYieldWithTable, IsTheFirstOfSeveral) {
  // The elastic pressure is 2.12 at 0.01 and 6.7 at 0.1: above the curve in between, below it later.
  const PressureCurve curve = Samples{{0.0, 0.01, 0.1, 0.12, 0.5}, {1.0, 1.0, 1.0, 50.0, 1.0}}.curve();
  const double d = yield_overlap_ratio(50.0, curve);
  EXPECT_LT(d, 0.01);
}

TEST(MdrYieldWithTable, IsNowhereWhereTheTableEndsBefore) {
  const PressureCurve curve = Samples{{0.0, 0.01, 0.02, 0.03}, {2.0, 2.0, 2.0, 2.0}}.curve();
  EXPECT_EQ(yield_overlap_ratio(10.0, curve), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isfinite(yield_overlap_ratio(100.0, curve)));
}

TEST(MdrYieldWithTable, ApproachesThatOfTheExponential) {
  for (const double modulus_over_yield : {6.25, 20.0, 200.0, 1e4}) {
    // 8.5e-8 measured at most
    EXPECT_LE(relative_error(yield_overlap_ratio(modulus_over_yield, dense_exponential(800).curve()),
                             yield_overlap_ratio(modulus_over_yield)),
              1e-6);
  }
}

/// A yielded contact of a material with the bumpy curve, at overlaps in all of its intervals above yield.
struct TableContact {
  Material material = make_material(1.0, 0.3, 0.02, shared(k_bumpy));
  double radius = 1.1;
  double area_constant = yield_area_constant(material.yield_overlap_ratio, radius);

  [[nodiscard]] std::vector<double> overlaps() const {
    std::vector<double> result;
    for (const double x : inner_places(*material.pressure_curve)) {
      if (x > 1.2 * material.yield_overlap_ratio) result.push_back(radius * x);
    }
    return result;
  }
};

TEST(MdrContactWithTable, HasExactDerivatives) {
  const TableContact c;
  ASSERT_GE(c.overlaps().size(), 10U);
  for (const double overlap : c.overlaps()) {
    constexpr double k_step = 2e-4;  // stays within the intervals
    const Contact contact = plastic_contact(c.material, c.radius, overlap, c.area_constant);
    const auto force = [&](double R, double delta) {
      return plastic_contact(c.material, R, delta, c.area_constant).force;
    };
    const double tolerance = 1e-9;  // rounding of the force over the step
    EXPECT_NEAR(contact.by_overlap, central_difference([&](double d) { return force(c.radius, d); }, overlap, k_step),
                tolerance);
    EXPECT_NEAR(contact.by_radius, central_difference([&](double R) { return force(R, overlap); }, c.radius, k_step),
                tolerance);

    const double below = overlap - 0.4 * unloading_shape(c.material, c.radius, overlap, c.area_constant).recovery;
    const auto unloading = [&](double R, double m) {
      return unloading_contact(unloading_shape(c.material, R, m, c.area_constant), c.material.composite_modulus, below);
    };
    const Contact unloaded = unloading(c.radius, overlap);
    EXPECT_NEAR(unloaded.by_overlap_max,
                central_difference([&](double m) { return unloading(c.radius, m).force; }, overlap, k_step), tolerance)
        << "delta = " << overlap;
    EXPECT_NEAR(unloaded.by_radius,
                central_difference([&](double R) { return unloading(R, overlap).force; }, c.radius, k_step), tolerance)
        << "delta = " << overlap;
  }
}

TEST(MdrContactWithTable, HasAWorkInClosedForm) {
  const TableContact c;
  for (const double overlap : c.overlaps()) {
    const auto work = [&](double delta) {
      return plastic_work_primitive(c.material, c.radius, delta, c.area_constant);
    };
    const double force = plastic_contact(c.material, c.radius, overlap, c.area_constant).force;
    EXPECT_NEAR(central_difference(work, overlap, 2e-4), force, 1e-10) << "delta = " << overlap;
  }
}

TEST(MdrContactWithTable, EndsWithIt) {
  const TableContact c;
  const double beyond = 0.51 * c.radius;
  EXPECT_THROW(static_cast<void>(plastic_contact(c.material, c.radius, beyond, c.area_constant)), std::domain_error);
  EXPECT_THROW(static_cast<void>(unloading_shape(c.material, c.radius, beyond, c.area_constant)), std::domain_error);
  EXPECT_THROW(static_cast<void>(plastic_work_primitive(c.material, c.radius, beyond, c.area_constant)),
               std::domain_error);
}

// --- in runs

CheckedScenario with_curve(CheckedScenario scenario, const Samples& samples) {
  scenario.curves["pressure_table"] = {"", samples.x, samples.p};
  return scenario;
}

CheckedScenario pressed_and_let_go(Configuration configuration, double displacement) {
  return mdr_scenario(configuration, 50.0, 0.3, path({displacement, 0.9 * displacement, displacement, 0.0}));
}

TEST(MdrRunWithTable, ApproachesThatWithTheExponential) {
  for (const auto configuration : {Configuration::simple, Configuration::die}) {
    const CheckedScenario scenario = pressed_and_let_go(configuration, 0.3);
    const TestRun exponential = run(scenario);
    // Cubics through samples with slopes that are good to second order: the third order overall.
    const double coarse = difference(run(with_curve(scenario, dense_exponential(100))), exponential);
    const double fine = difference(run(with_curve(scenario, dense_exponential(800))), exponential);
    EXPECT_LE(coarse, 1e-4);
    EXPECT_LE(fine, 1e-6);
    EXPECT_LE(fine, coarse / 64.0);
    EXPECT_GT(fine, 0.0);  // the table was used
  }
}

TEST(MdrRunWithTable, IsTheSameByAllIntegrators) {
  for (const auto configuration : {Configuration::simple, Configuration::die}) {
    const CheckedScenario scenario = with_curve(pressed_and_let_go(configuration, 0.3), k_bumpy);
    const TestRun direct = run(scenario);
    ASSERT_EQ(direct.record.status, RunStatus::complete) << direct.record.message;
    for (const char* integrator : k_integrators) {
      const TestRun other = run(scenario, integrator);
      EXPECT_EQ(other.events(), direct.events()) << integrator;
      EXPECT_LE(difference(other, direct), 5e-7) << integrator;  // fifty rtol
    }
  }
}

TEST(MdrRunWithTable, StopsAtItsEnd) {
  Samples ending = dense_exponential(80);
  ending.x.resize(21);  // up to 0.2
  ending.p.resize(21);
  for (const char* integrator : k_integrators) {
    const TestRun result = run(with_curve(pressed_and_let_go(Configuration::simple, 0.3), ending), integrator);
    EXPECT_EQ(result.record.status, RunStatus::stopped) << integrator;
    EXPECT_NE(result.record.message.find("pressure table, which ends at 0.2"), std::string::npos)
        << result.record.message;
    EXPECT_NEAR(result.last("axial.overlap") / result.last("apparent_radius"), 0.2, 1e-6) << integrator;
  }
}

}  // namespace
}  // namespace monograin::mdr::pressure_curve_test
