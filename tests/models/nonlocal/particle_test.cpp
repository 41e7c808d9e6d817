#include "nonlocal/particle.hpp"

#include <cmath>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "models/accuracy.hpp"
#include "models/nonlocal/cases.hpp"

namespace monograin::nonlocal::nonlocal_particle_test {
namespace {

/// A particle in a die, pressed by a displacement or a force along the axis.
struct Pressed {
  explicit Pressed(const Ramp& axial, Settings settings = unit_settings()) : particle(settings, die()) {
    const double lateral = 0.0;
    particle.set_ramps(std::vector<Ramp>{axial, {lateral, lateral}}, y);
    particle.mode.is_closed = {1, 1};
  }

  [[nodiscard]] std::vector<double> at(double xi) {
    std::vector<double> state = y;
    particle.solve(xi, state);
    return state;
  }

  Particle particle;
  std::vector<double> y = std::vector<double>(3, 0.0);
};

TEST(NonlocalParticle, HasTheRatesOfItsSolutions) {
  for (const Ramp& axial : {Ramp{0.0, 0.3}, Ramp{0.0, 0.1, Control::force}}) {
    Pressed pressed(axial);
    const double xi = 0.5;
    std::vector<double> rates(3);
    pressed.particle.rates(xi, pressed.at(xi), rates);
    for (std::size_t i = 0; i < 2; ++i) {
      const double derivative = central_difference([&](double x) { return pressed.at(x)[i]; }, xi, 0.02);
      EXPECT_NEAR(rates[i], derivative, 1e-8) << i;
    }
    const double power = central_difference(
        [&](double x) { return pressed.particle.contacts().energy(pressed.particle.evaluate(x, pressed.at(x))); }, xi,
        0.02);
    EXPECT_NEAR(rates[pressed.particle.work_slot()], power, 1e-8);
    std::vector<double> residual(3);
    pressed.particle.residual(xi, pressed.at(xi), rates, residual);
    for (const double value : residual) EXPECT_NEAR(value, 0.0, 1e-14);
  }
}

TEST(NonlocalParticle, KeepsItsStateWhenAWallChangesItsControl) {
  Pressed pressed({0.0, 0.2});
  std::vector<double> y = pressed.at(1.0);
  const double square = y[0];
  pressed.particle.evaluate_contacts(1.0, y);
  const double force = pressed.particle.contact(0).force;
  pressed.particle.set_ramps(std::vector<Ramp>{{force, 2.0 * force, Control::force}, {0.0, 0.0}}, y);
  EXPECT_NEAR(y[0], std::pow(square, 1.5), 1e-16);
  EXPECT_NEAR(pressed.particle.evaluate(0.0, y)[0], square, 1e-15);
  pressed.particle.set_ramps(std::vector<Ramp>{{0.2, 0.1}, {0.0, 0.0}}, y);
  EXPECT_NEAR(y[0], square, 1e-16);
}

TEST(NonlocalParticle, WorksInUnitsOfItsRadiusAndModulus) {
  Settings settings = unit_settings();
  settings.initial_radius = 0.01;
  settings.youngs_modulus = 2e6;
  Pressed pressed({0.0, 0.002}, settings);
  EXPECT_DOUBLE_EQ(pressed.particle.ramp(0).end, 0.2);
  Pressed under_force({0.0, 20.0, Control::force}, settings);
  EXPECT_DOUBLE_EQ(under_force.particle.ramp(0).end, 0.1);
}

TEST(NonlocalParticle, RefusesAForceThatPulls) {
  Pressed pressed({0.01, -0.01, Control::force});
  EXPECT_DOUBLE_EQ(pressed.particle.end_of_force(0), 0.5);
  EXPECT_NO_THROW(pressed.particle.require_pressing_walls(0.4));
  EXPECT_THROW(pressed.particle.require_pressing_walls(0.6), std::domain_error);
  EXPECT_THROW(pressed.particle.evaluate(0.6, pressed.y), std::domain_error);
  EXPECT_EQ(pressed.particle.end_of_force(1), k_infinity);
}

TEST(NonlocalParticle, SeesTheSideToWhichATouchingContactGoes) {
  for (const double target : {0.1, -0.1}) {
    Pressed pressed({0.0, target});
    pressed.particle.evaluate(0.0, pressed.y);
    EXPECT_EQ(std::signbit(pressed.particle.square_ahead(0, 0.0).value()), std::signbit(target));
    EXPECT_FALSE(pressed.particle.comes_to_rest(0, 0.0));
  }
  Pressed resting({0.0, 0.0});
  resting.particle.evaluate(0.0, resting.y);
  EXPECT_TRUE(resting.particle.comes_to_rest(0, 0.0));
}

TEST(NonlocalParticle, PassesTheBeginningOfAForceThatContactsAloneBear) {
  Particle particle(unit_settings(Centre::free), single_walls(simple()));
  std::vector<double> y(particle.work_slot() + 1, 0.0);
  particle.set_ramps(std::vector<Ramp>{{0.0, 0.1, Control::force}, {0.0, 0.0}}, y);
  const double later = particle.leave_singularity(0.0, y);
  EXPECT_EQ(later, k_ahead);
  EXPECT_GT(y[0], 0.0);
  EXPECT_GT(y[1], 0.0);
  EXPECT_EQ(particle.leave_singularity(0.5, y), 0.5);
}

TEST(NonlocalSetup, TakesItsScalesFromTheProgram) {
  Settings settings = unit_settings();
  const auto scales = [&] {
    const Contacts contacts(settings.model, die(), settings.centre);
    return scales_of(settings, die(), contacts);
  };
  EXPECT_EQ(scales().depth, 0.3);
  EXPECT_FALSE(scales().is_below_resolution);
  settings.reach.displacement = 1e-13;
  EXPECT_TRUE(scales().is_below_resolution);
  settings.reach.displacement = 2.0;
  EXPECT_EQ(scales().depth, 1.0);
  settings.model.terms = Terms::all;
  EXPECT_LT(scales().widest, 1.0);
}

}  // namespace
}  // namespace monograin::nonlocal::nonlocal_particle_test
