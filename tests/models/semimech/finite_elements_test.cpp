// Small contacts of model `semimech` against the finite elements of plots/fe: the errors that warnings and page name.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "history/table.hpp"
#include "models/semimech/steels.hpp"
#include "semimech/lateral.hpp"

namespace monograin::semimech::finite_elements_test {
namespace {

/// Rows of the first loading: displacement over R0 and force over E R0^2.
struct Curve {
  std::vector<double> displacement, force;

  [[nodiscard]] double at(double x) const {
    const auto upper = std::ranges::lower_bound(displacement, x);
    const auto k = static_cast<std::size_t>(upper - displacement.begin());
    const double share = (x - displacement.at(k - 1)) / (displacement.at(k) - displacement.at(k - 1));
    return std::lerp(force.at(k - 1), force.at(k), share);
  }
};

Curve first_loading(const std::string& file, const std::string& force) {
  const Table table = read_csv(std::string(MONOGRAIN_SOURCE_DIR "/plots/fe/") + file + ".csv");
  const std::vector<double> x = table.column("delta_o_over_R0");
  const std::vector<double> f = table.column(force + "_over_E_R0^2");
  Curve curve;
  for (std::size_t row = 0; row < x.size(); ++row) {
    if (row > 0 && x[row] <= curve.displacement.back()) continue;
    curve.displacement.push_back(x[row]);
    curve.force.push_back(f[row]);
  }
  return curve;
}

struct SmallContacts {
  const char *file, *force;
  Configuration configuration;
  double modulus_over_yield, poisson_ratio;
  std::array<long, 3> excess;  ///< at 0.005, 0.01 and 0.02, in percent of the finite elements
};

TEST(SemimechFiniteElements, AreExceededBySmallContactsAsTheWarningSays) {
  const std::array cases{
      SmallContacts{"ep_simple_lambda123.41", "F", Configuration::simple, 102.35604, 0.413, {55, 35, 19}},
      SmallContacts{"die_EY200_nu0.30_unload", "axial_F", Configuration::die, 200.0, 0.3, {66, 37, 27}},
      SmallContacts{"hydrostatic_EY50_nu0.30_unload", "axial_F", Configuration::hydrostatic, 50.0, 0.3, {78, 59, 35}}};
  for (const SmallContacts& small : cases) {
    const Curve elements = first_loading(small.file, small.force);
    const Law law = Steel{small.modulus_over_yield, small.poisson_ratio, 1.0}.law(small.configuration);
    std::array<long, 3> excess{};
    std::ranges::transform(std::array{0.005, 0.01, 0.02}, excess.begin(), [&](double x) {
      return std::lround(100.0 * (state_at(law, x).force / (elements.at(x) * small.modulus_over_yield) - 1.0));
    });
    EXPECT_EQ(excess, small.excess) << small.file;
  }
}

TEST(SemimechFiniteElements, AreExceededByLateralContactsUpToThreefold) {
  const Curve elements = first_loading("die_EY200_nu0.30_unload", "lateral_F");
  const Law law = Steel{200.0, 0.3, 1.0}.law(Configuration::die);
  const LateralLaw lateral = make_lateral(law);
  const double yield = boundaries(law, lateral).front().approach;
  double least = 1e300, greatest = 0.0;
  for (std::size_t row = 0; row < elements.force.size(); ++row) {
    const double x = elements.displacement[row];
    if (x < 0.0299 || x > LateralLaw::small_range_end) continue;
    const Regime regime = x > yield ? Regime::elastic_plastic : Regime::elastic;
    const double ratio = lateral_state_in(law, lateral, regime, x).force / (200.0 * elements.force[row]);
    least = std::min(least, ratio);
    greatest = std::max(greatest, ratio);
  }
  EXPECT_EQ(std::lround(least), 1) << least;
  EXPECT_EQ(std::lround(greatest), 3) << greatest;
}

}  // namespace
}  // namespace monograin::semimech::finite_elements_test
