#include "nonlocal/modes.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "models/nonlocal/cases.hpp"

namespace monograin::nonlocal::nonlocal_modes_test {
namespace {

/// Influence of the walls on each other, and the classes that they form.
struct Set {
  explicit Set(const std::vector<ContactClass>& classes)
      : influence(influence_of(Influence::half_space, k_rubber, walls_of(classes), classes)) {
    for (const Wall& wall : walls_of(classes)) class_of.push_back(wall.contact_class);
  }
  /// Least eigenvalue of 1 - k^(1/2) G k^(1/2) over all walls.
  [[nodiscard]] double least_eigenvalue(const std::vector<double>& stiffness) const {
    Eigen::VectorXd roots(influence.rows());
    for (std::size_t i = 0; i < class_of.size(); ++i) roots[as_index(i)] = std::sqrt(stiffness[class_of[i]]);
    const Eigen::MatrixXd matrix = -(roots.asDiagonal() * influence * roots.asDiagonal());
    return 1.0 + Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix, Eigen::EigenvaluesOnly).eigenvalues()[0];
  }

  Eigen::MatrixXd influence;
  std::vector<std::size_t> class_of;
};

TEST(NonlocalModes, HaveTheLeastEigenvalueOverAllWallsAsMargin) {
  const Set set(oblique_die(20.0, 4));
  Modes modes(set.influence, set.class_of, false);
  for (const std::vector<double>& stiffness :
       {std::vector{0.5, 0.4, 0.3, 0.2}, std::vector{0.0, 0.0, 0.1, 1.5}, std::vector{2.0, 0.0, 0.0, 0.3}}) {
    EXPECT_NEAR(modes.margin(stiffness), set.least_eigenvalue(stiffness), 1e-14);
  }
  EXPECT_NEAR(modes.margin(std::vector(4, 0.0)), 1.0, 1e-15);
}

TEST(NonlocalModes, NeedThoseOfTheClassesOnlyWhereEveryCouplingIsPositive) {
  const Set set(die());
  ASSERT_FALSE(has_negative_coupling(set.influence));
  const std::vector<double> stiffness{1.2, 0.7};
  Modes of_classes(set.influence, set.class_of, true);
  EXPECT_NEAR(of_classes.margin(stiffness), set.least_eigenvalue(stiffness), 1e-14);
}

TEST(NonlocalModes, HavePivotsWithTheSignOfTheMargin) {
  const Set set(oblique_die());
  Modes modes(set.influence, set.class_of, false);
  for (const double factor : {0.1, 0.5, 1.0, 2.0, 4.0}) {
    const std::vector<double> stiffness{0.5 * factor, 0.4 * factor, 0.3 * factor, 0.2 * factor};
    const double margin = modes.margin(stiffness);
    EXPECT_EQ(modes.least_pivot(stiffness, 0.0) > 0.0, margin > 0.0);
    EXPECT_GT(modes.least_pivot(stiffness, margin - 1e-9), 0.0);
    EXPECT_LT(modes.least_pivot(stiffness, margin + 1e-9), 0.0);
  }
}

}  // namespace
}  // namespace monograin::nonlocal::nonlocal_modes_test
