#include "elastic/nonlocal_tangent.hpp"

#include <Eigen/LU>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "models/elastic/nonlocal_cases.hpp"

namespace monograin::nonlocal::nonlocal_tangent_test {
namespace {

/// The trigonal walls in contact, with a free centre.
struct Loaded {
  Contacts contacts{{0.4, Terms::three}, trigonal_walls().classes(), Centre::free};
  std::vector<double> y = state_under(contacts, std::vector{0.15, 0.13, 0.0, 0.04, -0.01});
  std::vector<double> stiffness = contacts.evaluate(y).stiffness;
  Tangent tangent{contacts};

  [[nodiscard]] std::vector<double> approaches() {
    std::vector<double> values;
    for (std::size_t j = 0; j < contacts.class_count(); ++j) values.push_back(tangent.approach(j));
    return values;
  }
  /// Net force of contacts that approach by so much.
  [[nodiscard]] Eigen::Vector3d net_force_of(const std::vector<double>& approaches) const {
    Eigen::Vector3d net = Eigen::Vector3d::Zero();
    for (std::size_t j = 0; j < approaches.size(); ++j)
      net += contacts.weight(j) * stiffness[j] * approaches[j] * contacts.arm(j);
    return net;
  }
};

TEST(NonlocalTangent, SolvesTheLinearizedEquations) {
  Loaded loaded;
  const Eigen::Index n = 5;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(n, n);
  Eigen::VectorXd right(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    matrix.col(j) -= loaded.contacts.coupling().col(j) * loaded.stiffness[static_cast<std::size_t>(j)];
    right[j] = 0.01 * static_cast<double>(j - 2);
    loaded.tangent.approach(static_cast<std::size_t>(j)) = right[j];
  }
  ASSERT_TRUE(loaded.tangent.eliminate(loaded.contacts, loaded.stiffness));
  const Eigen::VectorXd expected = matrix.partialPivLu().solve(right);
  for (std::size_t j = 0; j < 5; ++j) EXPECT_NEAR(loaded.tangent.approach(j), expected[as_index(j)], 1e-16);
}

TEST(NonlocalTangent, EndsWhereTheMarginDoes) {
  Contacts contacts({k_rubber, Terms::four}, hydrostatic(), Centre::fixed);
  Tangent tangent(contacts);
  const double limit = 1.0 / contacts.coupling()(0, 0);
  EXPECT_TRUE(tangent.eliminate(contacts, std::vector{limit * (1.0 - 1e-9)}));
  EXPECT_FALSE(tangent.eliminate(contacts, std::vector{limit * (1.0 + 1e-9)}));
}

TEST(NonlocalTangent, MovesAFreeCentreIntoBalance) {
  Loaded loaded;
  for (std::size_t j = 0; j < 5; ++j) loaded.tangent.approach(j) = j == 0 ? 0.02 : 0.0;
  ASSERT_TRUE(loaded.tangent.eliminate(loaded.contacts, loaded.stiffness));
  const Eigen::Vector3d net = loaded.net_force_of(loaded.approaches());
  EXPECT_GT(net.norm(), 1e-3);
  std::vector<double> centre(3, 0.0);
  loaded.tangent.move_centre(loaded.contacts, loaded.stiffness, net, centre);
  EXPECT_LE(loaded.net_force_of(loaded.approaches()).norm(), 1e-16);
  EXPECT_GT(Eigen::Vector3d(centre[0], centre[1], centre[2]).norm(), 1e-3);
}

TEST(NonlocalTangent, LeavesTheCentreInPlaceAlongDirectionsThatNothingSupports) {
  Contacts contacts({k_rubber}, single_walls(die()), Centre::free);
  Tangent tangent(contacts);
  // The two axial walls bear.
  const std::vector<double> stiffness{0.2, 0.2, 0.0, 0.0, 0.0, 0.0};
  for (std::size_t j = 0; j < 6; ++j) tangent.approach(j) = 0.0;
  ASSERT_TRUE(tangent.eliminate(contacts, stiffness));
  const Eigen::Vector3d step = tangent.step_to_balance(contacts, stiffness, {0.1, 0.2, 0.3});
  EXPECT_EQ(step.head(2).norm(), 0.0);
  EXPECT_LT(step.z(), 0.0);
  const Eigen::Matrix3d unsupported = directions_of_nothing(contacts, [&](std::size_t j) { return stiffness[j]; });
  EXPECT_EQ(unsupported, Eigen::Matrix3d(Eigen::Vector3d(1.0, 1.0, 0.0).asDiagonal()));
}

TEST(NonlocalTangent, CountsAContactThatHasJustBegunAmongThoseThatSupport) {
  Contacts contacts({k_rubber}, single_walls(die()), Centre::free);
  const std::vector<double> stiffness{0.2, 0.2, 1e-10, 0.0, 0.0, 0.0};
  EXPECT_FALSE(carries_no_load(stiffness));
  EXPECT_TRUE(carries_no_load(std::vector(6, 0.0)));
  EXPECT_NEAR(directions_of_nothing(contacts, [&](std::size_t j) { return stiffness[j]; }).trace(), 1.0, 1e-15);
}

}  // namespace
}  // namespace monograin::nonlocal::nonlocal_tangent_test
