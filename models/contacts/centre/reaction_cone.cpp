#include "contacts/centre/reaction_cone.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <boost/container/static_vector.hpp>

namespace monograin {
namespace {

// Three directions suffice for any push; more may be active while some depend on each other to within round-off.
constexpr int k_most_bearing = 8;

}  // namespace

bool in_reaction_cone(const Eigen::Vector3d& push, std::span<const Eigen::Vector3d> directions, double nothing) {
  const Eigen::Vector3d unit = push.normalized();
  Eigen::Vector3d left_over = unit;
  boost::container::static_vector<Eigen::Vector3d, k_most_bearing> bearing;
  boost::container::static_vector<double, k_most_bearing> shares;
  for (std::size_t round = 0; round <= 4 * directions.size(); ++round) {
    // Only directions that have no component against the push would need a larger multiple of it.
    const auto is_possible = [](double share) { return share * k_no_direction <= 1.0; };
    if (left_over.norm() < nothing) return std::ranges::all_of(shares, is_possible);
    const auto help = [&](const Eigen::Vector3d& direction) { return -direction.dot(left_over); };
    const auto best = std::ranges::max_element(directions, {}, help);
    if (best == directions.end() || help(*best) <= k_same_value || bearing.size() == k_most_bearing) return false;
    bearing.push_back(*best);
    shares.push_back(0.0);
    for (double share_of_step = 0.0; share_of_step < 1.0 && !bearing.empty();) {
      Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, k_most_bearing> together(
          3, static_cast<Eigen::Index>(bearing.size()));
      for (std::size_t k = 0; k < bearing.size(); ++k) together.col(static_cast<Eigen::Index>(k)) = bearing[k];
      const Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, k_most_bearing, 1> wanted =
          together.colPivHouseholderQr().solve(-unit);
      // Moves the shares towards the least-squares solution until one becomes zero, whose direction is dropped.
      share_of_step = 1.0;
      std::size_t first = bearing.size();
      for (std::size_t k = 0; k < bearing.size(); ++k) {
        const double to = wanted[static_cast<Eigen::Index>(k)];
        if (to >= 0.0 || shares[k] / (shares[k] - to) >= share_of_step) continue;
        share_of_step = shares[k] / (shares[k] - to);
        first = k;
      }
      for (std::size_t k = 0; k < bearing.size(); ++k) {
        shares[k] += share_of_step * (wanted[static_cast<Eigen::Index>(k)] - shares[k]);
      }
      if (first == bearing.size()) break;
      bearing.erase(bearing.nth(first));
      shares.erase(shares.nth(first));
    }
    left_over = unit;
    for (std::size_t k = 0; k < bearing.size(); ++k) left_over += shares[k] * bearing[k];
  }
  return false;
}

}  // namespace monograin
