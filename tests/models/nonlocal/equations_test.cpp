#include "nonlocal/equations.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "models/accuracy.hpp"
#include "models/nonlocal/cases.hpp"

namespace monograin::nonlocal::nonlocal_equations_test {
namespace {

TEST(NonlocalEquations, HaveTheJacobianOfTheirResidual) {
  for (const Scene& scene : scenes()) {
    for (const Terms terms : k_all_terms) {
      Contacts contacts({scene.poisson_ratio, terms}, scene.classes, scene.centre);
      std::vector<double> y = state_under(contacts, scene.displacements);
      auto ramps = held(scene.displacements);
      ramps[1] = {.start = 0.001, .end = 0.002, .control = Control::force};
      Eigen::MatrixXd jacobian;
      nonlocal::jacobian(contacts, ramps, y, jacobian);
      std::vector<double> residual(y.size());
      for (std::size_t i = 0; i < y.size(); ++i) {
        for (std::size_t k = 0; k < y.size(); ++k) {
          const double derivative = central_difference(
              [&](double value) {
                std::vector<double> moved = y;
                moved[k] = value;
                nonlocal::residual(contacts, ramps, 0.3, moved, residual);
                return residual[i];
              },
              y[k], std::max(1e-2 * std::abs(y[k]), 1e-6));
          // Round-off of numbers up to 1, over the step.
          EXPECT_NEAR(jacobian(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)), derivative, 1e-9)
              << scene.name << ", " << i << ", " << k;
        }
      }
    }
  }
}

TEST(NonlocalEquations, HaveNoResidualInASolution) {
  for (const Scene& scene : scenes()) {
    Contacts contacts({scene.poisson_ratio, Terms::four}, scene.classes, scene.centre);
    const std::vector<double> y = state_under(contacts, scene.displacements);
    std::vector<double> residual(y.size());
    nonlocal::residual(contacts, held(scene.displacements), 0.0, y, residual);
    for (const double value : residual) EXPECT_NEAR(value, 0.0, 1e-15) << scene.name;
    const auto states = states_of(contacts, y);
    for (std::size_t j = 0; j < states.size(); ++j) {
      EXPECT_NEAR(states[j].displacement, scene.displacements[j], 1e-15) << scene.name;
      EXPECT_EQ(states[j].force > 0.0, y[j] > 0.0);
    }
  }
}

}  // namespace
}  // namespace monograin::nonlocal::nonlocal_equations_test
