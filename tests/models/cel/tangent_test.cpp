// The linear equations behind Newton's method and the motion of a coupled elastic-plastic particle.

#include "cel/tangent.hpp"

#include <Eigen/LU>

#include <gtest/gtest.h>

#include "system/limit.hpp"

namespace monograin::cel::tangent_test {
namespace {

TEST(CelElimination, FindsTheSolutionsAndTheSignOfTheDeterminant) {
  RowMatrix equations(3, 5);
  equations << 0, 2, 1, 7, 1,  //
      1e6, 1e6, -1e6, 0, 0,    //
      1, 0, 3, 10, 2;
  const RowMatrix before = equations;
  const double determinant = before.leftCols(3).determinant();
  EXPECT_EQ(eliminate(equations), determinant > 0.0 ? 1.0 : -1.0);
  EXPECT_LE((before.leftCols(3) * equations.rightCols(2) - before.rightCols(2)).cwiseAbs().maxCoeff(), 1e-9);
  RowMatrix swapped = before;
  swapped.row(0).swap(swapped.row(2));
  EXPECT_EQ(eliminate(swapped), determinant > 0.0 ? -1.0 : 1.0);
}

TEST(CelElimination, RefusesSingularEquations) {
  RowMatrix equations(2, 4);
  equations << 1, 2, 0, 0, 2, 4, 0, 0;
  EXPECT_THROW(eliminate(equations), DomainError);
}

}  // namespace
}  // namespace monograin::cel::tangent_test
