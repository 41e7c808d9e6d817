#include "packing/equations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <stdexcept>

#include "models/packing/branches.hpp"

namespace monograin::packing::equations_test {
namespace {

constexpr double k_scale = 0.02;  // of the particles' strain

/// A state of the law, half way along a branch.
IntegratedState exact_state(const ControlledBranch& branch) {
  const double phi = std::midpoint(branch.range().begin, branch.range().end);
  return {state(branch.law(), phi).particle_strain, phi};
}

IntegratedEquations equations_at(const ControlledBranch& branch, const IntegratedState& y) {
  return {branch, Piece::either, k_scale, branch.value_at(y.packing_fraction)};
}

TEST(PackingEquations, HoldInAStateOfTheLaw) {
  for (const auto& [name, branch] : branches()) {
    SCOPED_TRACE(name);
    const IntegratedState y = exact_state(branch);
    const IntegratedEquations equations = equations_at(branch, y);
    EXPECT_NEAR(equations.strain(y), state(branch.law(), y.packing_fraction).strain, 1e-14);
    EXPECT_NEAR(equations.excess(y), 0.0, 1e-14);
    EXPECT_EQ(equations.within_branch(y).packing_fraction, y.packing_fraction);
  }
}

TEST(PackingEquations, SlopesAreDifferenceQuotients) {
  constexpr double h = 1e-6;
  for (const auto& [name, branch] : branches()) {
    SCOPED_TRACE(name);
    const IntegratedState y = exact_state(branch);
    const IntegratedEquations equations = equations_at(branch, y);
    const auto [by_particles, by_fraction] = equations.excess_slopes(y);
    const auto excess = [&](double particles, double fraction) {
      return equations.excess({y.particle_strain + k_scale * particles, y.packing_fraction + fraction});
    };
    EXPECT_NEAR(by_particles, (excess(h, 0.0) - excess(-h, 0.0)) / (2.0 * h), 1e-8);
    EXPECT_NEAR(by_fraction, (excess(0.0, h) - excess(0.0, -h)) / (2.0 * h), 1e-6);
  }
}

TEST(PackingEquations, RatesFollowTheLaw) {
  constexpr double h = 1e-6;
  for (const auto& [name, branch] : branches()) {
    SCOPED_TRACE(name);
    const IntegratedState y = exact_state(branch);
    const IntegratedState rates = equations_at(branch, y).rates(y, 1.0);
    const double value = branch.value_at(y.packing_fraction);
    const double step = h * value;
    const double low = branch.packing_fraction_at(value - step);
    const double high = branch.packing_fraction_at(value + step);
    const double particles = state(branch.law(), high).particle_strain - state(branch.law(), low).particle_strain;
    EXPECT_NEAR(rates.packing_fraction * 2.0 * step / (high - low), 1.0, 1e-6);
    EXPECT_NEAR(rates.particle_strain * 2.0 * step, particles, 1e-5 * std::abs(particles));
  }
}

TEST(PackingEquations, AStateOffByAnIntegratorsErrorComesBackToThePrescribedValue) {
  for (const auto& [name, branch] : branches()) {
    SCOPED_TRACE(name);
    const IntegratedState y = exact_state(branch);
    const IntegratedEquations equations = equations_at(branch, y);
    const IntegratedState found = equations.completed({y.particle_strain + 1e-5, y.packing_fraction - 2e-5});
    EXPECT_NEAR(equations.excess(found), 0.0, 1e-13);
    EXPECT_NEAR(found.packing_fraction, y.packing_fraction, 1e-3);
  }
}

TEST(PackingEquations, HaveNoStateBeyondTheEndOfTheBranch) {
  const ControlledBranch branch = limited_branch(Control::strain);
  const IntegratedEquations equations(branch, Piece::growing, k_scale, 1.01 * branch.range().greatest);
  EXPECT_THROW(static_cast<void>(equations.completed({0.0, branch.range().end})), std::domain_error);
}

}  // namespace
}  // namespace monograin::packing::equations_test
