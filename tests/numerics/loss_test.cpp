#include "numerics/loss.hpp"

#include <gtest/gtest.h>

namespace monograin::loss_test {
namespace {

TEST(LossFunctions, InfluenceAndCurvatureAreDerivativesOfRho) {
  for (const Loss kind : {Loss::linear, Loss::huber, Loss::soft_l1, Loss::cauchy}) {
    const LossFunction loss{kind, 0.7};
    for (const double r : {-3.0, -0.5, 0.2, 1.1}) {
      const double h = 1e-5;
      EXPECT_NEAR((loss.rho(r + h) - loss.rho(r - h)) / (4.0 * h), loss.influence(r), 1e-9);
      EXPECT_NEAR((loss.influence(r + h) - loss.influence(r - h)) / (2.0 * h), loss.curvature(r), 1e-9);
    }
    EXPECT_NEAR(loss.rho(1e-3), 1e-6, 1e-11) << "the square, where residuals are small";
  }
}

}  // namespace
}  // namespace monograin::loss_test
