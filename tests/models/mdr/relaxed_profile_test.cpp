#include "mdr/relaxed_profile.hpp"

#include <algorithm>
#include <boost/math/special_functions/ellint_2.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "history/table.hpp"
#include "models/accuracy.hpp"
#include "support/deviation.hpp"
#include "support/reference_case.hpp"

namespace monograin::mdr::relaxed_profile_test {
namespace {

using std::numbers::pi;

struct Samples {
  std::vector<double> radii, heights;

  [[nodiscard]] RelaxedProfile profile() const { return {radii, heights}; }
};

/// Samples of a height at equal distances of the radius.
template <class Height>
Samples sampled(Height&& height, double largest_radius, std::size_t count) {
  Samples samples;
  for (std::size_t i = 0; i < count; ++i) {
    const double r = largest_radius * static_cast<double>(i) / static_cast<double>(count - 1);
    samples.radii.push_back(r);
    samples.heights.push_back(height(r));
  }
  return samples;
}

/// Concave in the middle, convex outside r = 0.25.
struct Bowl {
  double c2 = -0.05, c4 = 0.4;

  [[nodiscard]] double height(double r) const { return r * r * (c2 + c4 * r * r); }
};

constexpr double k_surface_energy = 1e-4;  // of the reference, E* = 1
constexpr double k_largest_radius = 0.9;

Samples bowl(std::size_t count) {
  return sampled([](double r) { return Bowl{}.height(r); }, k_largest_radius, count);
}

TEST(MdrRelaxedProfile, MeetsTheReferenceOfAConcaveConvexProfile) {
  const Table table = read_csv(test_file("models/mdr/reference/adhesive_concave_profile.csv"));
  const auto radii = table.column("a");
  const auto image = table.column("g1D_of_a");
  const auto displacement = table.column("delta");
  const auto force = table.column("F");
  for (const std::size_t count : {5, 20, 200}) {
    const RelaxedProfile profile = bowl(count).profile();
    for (std::size_t i = 0; i < radii.size(); ++i) {
      // The last radius of the reference is the profile's end up to round-off.
      const double a = std::min(radii[i], profile.largest_radius());
      const PeelState state = peel_state(profile, {1.0, k_surface_energy}, a);
      EXPECT_NEAR(profile.image_height(a), image[i], 1e-14) << "a = " << a << ", samples: " << count;
      EXPECT_NEAR(state.displacement_1d, displacement[i], 1e-14) << "a = " << a << ", samples: " << count;
      EXPECT_NEAR(state.force, force[i], 1e-14) << "a = " << a << ", samples: " << count;
    }
  }
}

struct PullOff {
  Control control;
  double contact_radius, displacement, force;
};

// 17 digits, from the header of the reference file.
constexpr PullOff k_pull_offs[] = {
    {Control::displacement, 0.26220753458303154, -0.014668694991105449, -0.0070194795054721077},
    {Control::force, 0.31211213267490756, -0.013623061273900983, -0.0077406004808598792}};

TEST(MdrRelaxedProfile, PullsOffWhereTheReferenceDoes) {
  for (const std::size_t count : {5, 20, 200}) {
    const RelaxedProfile profile = bowl(count).profile();
    for (const PullOff& expected : k_pull_offs) {
      const PeelState state = pull_off_state(profile, {1.0, k_surface_energy}, expected.control);
      EXPECT_LE(relative_error(state.contact_radius, expected.contact_radius), 1e-13) << "samples: " << count;
      EXPECT_LE(relative_error(state.displacement_1d, expected.displacement), 1e-13) << "samples: " << count;
      EXPECT_LE(relative_error(state.force, expected.force), 1e-13) << "samples: " << count;
    }
  }
}

TEST(MdrRelaxedProfile, PullsOffOutsideTheRing) {
  // g1D = 2 c2 x^2 + (8/3) c4 x^4 has its minimum at x^2 = -3 c2/(8 c4).
  const RelaxedProfile profile = bowl(50).profile();
  const double ring = std::sqrt(3.0 / 64.0);
  EXPECT_NEAR(profile.image_slope(ring), 0.0, 1e-14);
  EXPECT_LE(relative_error(critical_radius(profile, {1.0, 0.0}, Control::displacement), ring), 1e-13);
  double last = ring;
  for (const double surface_energy : {1e-12, 1e-8, 1e-4, 1e-2}) {
    const double a = critical_radius(profile, {1.0, surface_energy}, Control::displacement);
    EXPECT_GT(a, last) << "dg = " << surface_energy;
    last = a;
  }
}

TEST(MdrRelaxedProfile, IsExactForEvenPolynomialsOfDegreeSix) {
  const auto height = [](double r) { return 0.3 * r * r - 0.2 * std::pow(r, 4) + 0.7 * std::pow(r, 6); };
  const auto image = [](double x) { return 0.6 * x * x - 1.6 / 3.0 * std::pow(x, 4) + 2.24 * std::pow(x, 6); };
  const auto slope = [](double x) { return 1.2 * x - 6.4 / 3.0 * x * x * x + 13.44 * std::pow(x, 5); };
  const auto area = [](double x) { return 0.2 * x * x * x - 1.6 / 15.0 * std::pow(x, 5) + 0.32 * std::pow(x, 7); };
  // Not at equal distances, and not counted from zero.
  Samples samples{{0.0, 0.11, 0.17, 0.4, 0.43, 0.8, 1.0}, {}};
  for (const double r : samples.radii) samples.heights.push_back(height(r) - 3.0);
  const RelaxedProfile profile = samples.profile();
  // The round-off of heights of size 3 in a slope in r^2 between the closest samples.
  constexpr double tolerance = 3.0 * k_epsilon / (0.11 * 0.11);
  for (const double x : {0.0, 0.05, 0.11, 0.3, 0.41, 0.9, 1.0}) {
    EXPECT_NEAR(profile.image_height(x), image(x), 2.0 * tolerance) << "x = " << x;
    EXPECT_NEAR(profile.image_slope(x), slope(x), 20.0 * tolerance) << "x = " << x;
    EXPECT_NEAR(profile.image_area(x), area(x), tolerance) << "x = " << x;
  }
}

TEST(MdrRelaxedProfile, ConvergesToTheEllipseWithTheFourthPowerOfTheDistance) {
  // A = 0.3, b = 1; the contact ends before the ellipse, at whose end the slope is unbounded.
  const Indenter ellipse{ElasticProfile::ellipse, 0.3, 1.0};
  const auto height = [](double r) { return 0.15 * (1.0 - 2.0 / pi * boost::math::ellint_2(r)); };
  constexpr double largest_radius = 0.8;
  const auto error = [&](std::size_t count) {
    const RelaxedProfile profile = sampled(height, largest_radius, count).profile();
    double worst = 0.0;
    for (const double a : {0.1, 0.25, 0.4, 0.55, 0.7, 0.8}) {
      const PeelState ours = peel_state(profile, {1.0, 1e-3}, a);
      const PeelState exact = peel_state(ellipse, {1.0, 1e-3}, a);
      worst = std::max(worst, deviation(ours.displacement_1d, exact.displacement_1d));
      worst = std::max(worst, std::abs(ours.force - exact.force));
    }
    return worst;
  };
  const double coarse = error(21);
  const double middle = error(81);
  const double fine = error(321);
  EXPECT_LT(coarse, 1e-5);
  // Each time a quarter of the distance: 256 for fourth order, 64 for third.
  EXPECT_GT(coarse / middle, 150.0) << coarse << ", " << middle;
  EXPECT_GT(middle / fine, 150.0) << middle << ", " << fine;

  const RelaxedProfile profile = sampled(height, largest_radius, 641).profile();
  for (const Control control : {Control::displacement, Control::force}) {
    EXPECT_LE(
        relative_error(critical_radius(profile, {1.0, 1e-3}, control), critical_radius(ellipse, {1.0, 1e-3}, control)),
        1e-8);
  }
}

TEST(MdrRelaxedProfile, PeelsAlongStableStatesDownToPullOff) {
  const RelaxedProfile profile = bowl(100).profile();
  for (const Control control : {Control::displacement, Control::force}) {
    const auto curve = peel_curve(profile, {1.0, k_surface_energy}, control, 60);
    ASSERT_EQ(curve.size(), 60u);
    EXPECT_EQ(curve.front().contact_radius, profile.largest_radius());
    const PeelState end = pull_off_state(profile, {1.0, k_surface_energy}, control);
    EXPECT_EQ(curve.back().contact_radius, end.contact_radius);
    EXPECT_EQ(curve.back().force, end.force);
    for (std::size_t i = 1; i < curve.size(); ++i) {
      EXPECT_LT(curve[i].contact_radius, curve[i - 1].contact_radius);
      // The prescribed quantity falls: the edge is stable under it.
      if (control == Control::displacement)
        EXPECT_LT(curve[i].displacement_1d, curve[i - 1].displacement_1d) << "state " << i;
      else
        EXPECT_LT(curve[i].force, curve[i - 1].force) << "state " << i;
    }
  }
}

TEST(MdrRelaxedProfile, NeverPullsOffWithoutAdhesionWhereItIsConvex) {
  const RelaxedProfile profile = sampled([](double r) { return r * r; }, 1.0, 10).profile();
  EXPECT_EQ(critical_radius(profile, {1.0, 0.0}, Control::force), 0.0);
  EXPECT_EQ(pull_off_state(profile, {1.0, 0.0}, Control::force).force, 0.0);
}

TEST(MdrRelaxedProfile, PullsOffAsJkrForTheParabola) {
  const RelaxedProfile profile = sampled([](double r) { return 0.5 * r * r; }, 1.0, 10).profile();
  const PeelState state = pull_off_state(profile, {1.0, 1e-3}, Control::force);
  EXPECT_LE(relative_error(state.force, -1.5 * pi * 1e-3), 1e-13);
}

TEST(MdrRelaxedProfile, DoesNotDependOnTheUnits) {
  // The units are powers of two, and lengths are so small that their fourth power underflows.
  constexpr double length = 0x1p-200;
  constexpr double stress = 0x1p30;
  Samples small = bowl(30);
  for (double& r : small.radii) r *= length;
  for (double& h : small.heights) h *= length;
  const PeelState ours = pull_off_state(small.profile(), {stress, k_surface_energy * stress * length}, Control::force);
  const PeelState expected = pull_off_state(bowl(30).profile(), {1.0, k_surface_energy}, Control::force);
  EXPECT_LE(relative_error(ours.contact_radius, expected.contact_radius * length), 4 * k_epsilon);
  EXPECT_LE(relative_error(ours.force, expected.force * stress * length * length), 64 * k_epsilon);
}

TEST(MdrRelaxedProfile, RefusesSamplesThatAreNoProfile) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<double> radii{0.0, 1.0, 2.0, 3.0, 4.0};
  const std::vector<double> heights{0.0, 1.0, 4.0, 9.0, 16.0};
  EXPECT_NO_THROW(RelaxedProfile(radii, heights));
  const auto refuses = [](const std::vector<double>& r, const std::vector<double>& h) {
    EXPECT_THROW(RelaxedProfile(r, h), std::invalid_argument) << ::testing::PrintToString(r);
  };
  refuses({0.0, 1.0, 2.0, 3.0}, {0.0, 1.0, 4.0, 9.0});  // too few
  refuses(radii, {0.0, 1.0, 4.0, 9.0});                 // not one height for each
  refuses({0.0, 2.0, 1.0, 3.0, 4.0}, heights);          // not in order
  refuses({0.0, 1.0, 1.0, 3.0, 4.0}, heights);          // twice
  refuses({0.0, -1.0, 2.0, 3.0, 4.0}, heights);         // the wrong side of the axis
  refuses({0.0, 1e-200, 2.0, 3.0, 4.0}, heights);       // its square is that of the axis
  refuses({0.1, 1.0, 2.0, 3.0, 4.0}, heights);          // not from the axis on
  refuses({0.0, 1.0, nan, 3.0, 4.0}, heights);          // not a number
  refuses({0.0, 1.0, 2.0, 3.0, infinity}, heights);     // not finite
  refuses(radii, {0.0, 1.0, nan, 9.0, 16.0});
  refuses(radii, {0.0, 1.0, infinity, 9.0, 16.0});
}

TEST(MdrRelaxedProfile, EndsWithItsSamples) {
  const RelaxedProfile profile = bowl(20).profile();
  const double end = profile.largest_radius();
  EXPECT_NO_THROW(static_cast<void>(profile.image_height(end)));
  for (const double x : {-1e-300, end * (1.0 + k_epsilon), std::nan("")}) {
    EXPECT_THROW(static_cast<void>(profile.image_height(x)), std::domain_error) << x;
    EXPECT_THROW(static_cast<void>(profile.image_slope(x)), std::domain_error) << x;
    EXPECT_THROW(static_cast<void>(profile.image_area(x)), std::domain_error) << x;
    EXPECT_THROW(static_cast<void>(peel_state(profile, {1.0, 0.0}, x)), std::domain_error) << x;
  }
  // The adhesion is so strong that the edge is unstable from the beginning.
  try {
    static_cast<void>(critical_radius(profile, {1.0, 10.0}, Control::displacement));
    ADD_FAILURE() << "no error";
  } catch (const std::domain_error& error) {
    EXPECT_NE(std::string(error.what()).find("unstable at the largest radius"), std::string::npos) << error.what();
  }
  EXPECT_THROW(static_cast<void>(peel_curve(profile, {1.0, k_surface_energy}, Control::force, 1)),
               std::invalid_argument);
}

}  // namespace
}  // namespace monograin::mdr::relaxed_profile_test
