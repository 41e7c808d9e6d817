#include "nonlocal/tangent.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "models/nonlocal/cases.hpp"

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
      net += contacts.weight(j) * stiffness[j] * approaches[j] * contacts.mean_normal(j);
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

/// Classes of one wall and of two that a half turn exchanges, as many as Eigen's blocked method takes.
std::vector<ContactClass> many_classes() {
  std::vector<ContactClass> classes{{"top", {Eigen::Vector3d::UnitZ()}, 0.0},
                                    {"bottom", {-Eigen::Vector3d::UnitZ()}, 0.0}};
  constexpr int k_pairs = 58;
  for (int i = 0; i < k_pairs; ++i) {
    const double z = 0.9 - 1.8 * i / k_pairs;
    const double across = std::sqrt(1.0 - z * z);
    const Eigen::Vector3d normal(across * std::cos(1.2 * i), across * std::sin(1.2 * i), z);
    classes.push_back({"pair", {normal, {-normal.x(), -normal.y(), z}}, 0.0});
  }
  return classes;
}

TEST(NonlocalTangent, SolvesTheEquationsOfManyClasses) {
  const Contacts contacts({k_rubber}, many_classes(), Centre::free);
  const Eigen::Index n = as_index(contacts.class_count());
  Tangent tangent(contacts);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(n, n);
  Eigen::VectorXd right(n);
  std::vector<double> stiffness;
  for (Eigen::Index j = 0; j < n; ++j) {
    stiffness.push_back(j % 5 == 3 ? 0.0 : 0.01 + 1e-4 * static_cast<double>(j));
    matrix.col(j) -= contacts.coupling().col(j) * stiffness.back();
    right[j] = 0.01 * std::sin(static_cast<double>(j));
    tangent.approach(static_cast<std::size_t>(j)) = right[j];
  }
  ASSERT_TRUE(tangent.eliminate(contacts, stiffness));
  const auto factors = matrix.partialPivLu();
  const Eigen::VectorXd expected = factors.solve(right);
  for (Eigen::Index j = 0; j < n; ++j)
    EXPECT_NEAR(tangent.approach(static_cast<std::size_t>(j)), expected[j], 1e-15) << j;

  // The centre is free along the axis of the half turn.
  ASSERT_EQ(contacts.free_count(), 1U);
  Eigen::VectorXd arms(n);
  for (Eigen::Index j = 0; j < n; ++j) arms[j] = contacts.mean_normal(static_cast<std::size_t>(j)).x();
  const Eigen::VectorXd moved = factors.solve(arms);
  double hold = 0.0;
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto i = static_cast<std::size_t>(j);
    hold += contacts.weight(i) * stiffness[i] * arms[j] * moved[j];
  }
  const Eigen::Vector3d step = tangent.step_to_balance(contacts, stiffness, {0.1, 0.0, 0.0});
  EXPECT_NEAR(step.x(), -0.1 / hold, 1e-13 * std::abs(0.1 / hold));
}

TEST(NonlocalTangent, EndsWhereTheMarginOfManyClassesDoes) {
  Contacts contacts({k_rubber}, many_classes(), Centre::fixed);
  Tangent tangent(contacts);
  // M of equal stiffnesses k has the margin 1 - k times the largest eigenvalue of G.
  const double limit = 1.0 / contacts.coupling().eigenvalues().real().maxCoeff();
  const auto equal = [&](double stiffness) { return std::vector(contacts.class_count(), stiffness); };
  EXPECT_TRUE(tangent.eliminate(contacts, equal(limit * (1.0 - 1e-9))));
  EXPECT_FALSE(tangent.eliminate(contacts, equal(limit * (1.0 + 1e-9))));
  EXPECT_FALSE(tangent.eliminate(contacts, equal(k_nan)));
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
