#include "nonlocal/rates.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "models/accuracy.hpp"
#include "models/nonlocal/cases.hpp"

namespace monograin::nonlocal::nonlocal_rates_test {
namespace {

TEST(NonlocalRates, AreThoseOfTheSolutions) {
  for (const Scene& scene : scenes()) {
    Contacts contacts({scene.poisson_ratio, Terms::four}, scene.classes, scene.centre);
    std::vector<Ramp> ramps = held(scene.displacements);
    for (std::size_t j = 0; j < ramps.size(); ++j) ramps[j].end += j % 2 == 0 ? 0.02 : -0.01;
    const std::vector<double> start = state_under(contacts, scene.displacements);
    for (const bool has_force : {false, true}) {
      const std::size_t driven = scene.centre == Centre::free ? 0 : 1;
      if (has_force) {
        const double force = states_of(contacts, start)[driven].force;
        ramps[driven] = {.start = force, .end = 1.1 * force + 1e-3, .control = Control::force};
      }
      const auto state_at = [&](double xi) {
        std::vector<double> y = start;
        solve(contacts, ramps, xi, y);
        return y;
      };
      const double xi = 0.5;
      std::vector<double> rates(start.size());
      Rates(contacts).find(contacts, ramps, state_at(xi), rates);
      for (std::size_t i = 0; i < start.size(); ++i) {
        const double derivative = central_difference([&](double x) { return state_at(x)[i]; }, xi, 0.02);
        EXPECT_NEAR(rates[i], derivative, 1e-9) << scene.name << ", unknown " << i << ", force " << has_force;
      }
    }
  }
}

TEST(NonlocalRates, AreRegularWhereNothingIsLoaded) {
  Contacts contacts({k_rubber, Terms::four}, die(), Centre::fixed);
  std::vector<double> rates(2);
  Rates(contacts).find(contacts, compression(2, 0.4), std::vector{0.0, 0.0}, rates);
  EXPECT_EQ(rates[0], 0.4);
  EXPECT_EQ(rates[1], 0.0);
  auto ramps = compression(2, 0.4);
  ramps[0].control = Control::force;
  Rates(contacts).find(contacts, ramps, std::vector{0.0, 0.0}, rates);
  EXPECT_EQ(rates[0], std::numeric_limits<double>::infinity());
  EXPECT_EQ(rates[1], 0.4 * contacts.coupling()(1, 0));
}

TEST(NonlocalRates, LetAFreeCentreFollowFromFirstTouch) {
  Contacts contacts({k_rubber, Terms::four}, single_walls(simple()), Centre::free);
  std::vector<double> rates(3);
  Rates(contacts).find(contacts, std::vector<Ramp>{{0.0, 0.1}, {0.0, 0.0}}, std::vector{0.0, 0.0, 0.0}, rates);
  const double along = contacts.free_directions()(2, 0);
  EXPECT_NEAR(rates[0], 0.05, 1e-16);
  EXPECT_NEAR(rates[1], 0.05, 1e-16);
  EXPECT_NEAR(rates[2] * along, -0.05, 1e-16);
  // A retreating wall does not take the particle with it.
  Rates(contacts).find(contacts, std::vector<Ramp>{{0.0, -0.1}, {0.0, 0.0}}, std::vector{0.0, 0.0, 0.0}, rates);
  EXPECT_EQ(rates, (std::vector{-0.1, 0.0, 0.0}));
}

TEST(NonlocalRates, EndWhereAForceDrivesAFreeCentreThatNothingHolds) {
  Contacts contacts({k_rubber, Terms::four}, single_walls(simple()), Centre::free);
  std::vector<double> rates(3);
  const std::vector<Ramp> ramps{{0.0, 0.1, Control::force}, {-0.01, 0.2, Control::displacement}};
  EXPECT_TRUE(contains(refusal<std::domain_error>([&] {
                         Rates(contacts).find(contacts, ramps, std::vector{0.0, -0.01, 0.0}, rates);
                         return 0;
                       }),
                       "no contact holds the free centre"));
  // The other wall supports the centre once it touches, and a constant force drives nothing.
  EXPECT_NO_THROW(Rates(contacts).find(contacts, ramps, std::vector{0.0, 0.0, 0.0}, rates));
  const std::vector<Ramp> constant{{0.1, 0.1, Control::force}, {-0.01, 0.2, Control::displacement}};
  EXPECT_NO_THROW(Rates(contacts).find(contacts, constant, std::vector{0.01, -0.01, 0.0}, rates));
}

TEST(NonlocalRates, EndAtTheLimit) {
  Contacts contacts({k_rubber, Terms::four}, hydrostatic(), Centre::fixed);
  std::vector<double> rates(1);
  const double limit = 1.0 / (2.0 * contacts.composite_modulus() * contacts.coupling()(0, 0));
  const double below = limit * limit * (1.0 - 1e-9);
  const double above = limit * limit * (1.0 + 1e-9);
  EXPECT_NO_THROW(Rates(contacts).find(contacts, compression(1, 0.1), std::vector{below}, rates));
  EXPECT_THROW(Rates(contacts).find(contacts, compression(1, 0.1), std::vector{above}, rates), std::domain_error);
}

}  // namespace
}  // namespace monograin::nonlocal::nonlocal_rates_test
