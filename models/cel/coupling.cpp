#include "cel/coupling.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "cel/contact_law.hpp"
#include "elastic/nonlocal_coupling.hpp"

namespace monograin::cel {
namespace {

/// Sine of half the angle, and last term of the series, of the self influence: part of the law's definition.
constexpr double k_self_half_sine = 0.2;
constexpr int k_last_term = 4000;
constexpr double k_same_angle = 1e-12;

}  // namespace

std::vector<Coupling> couplings_of(double poisson_ratio, std::span<const ContactClass> classes) {
  std::map<double, double> influences;  // of neighbours, each angle computed once
  const auto influence_at = [&](double angle) {
    const auto [at, is_new] = influences.try_emplace(std::round(angle / k_same_angle));
    if (is_new) at->second = nonlocal::sphere_influence(poisson_ratio, angle);
    return at->second;
  };
  const double self = nonlocal::sphere_self_influence(poisson_ratio, k_self_half_sine, k_last_term);
  std::vector<Coupling> couplings;
  for (const ContactClass& c : classes) {
    const Eigen::Vector3d& normal = c.normals.front();
    for (const ContactClass& neighbour : classes) {
      Coupling& sum = couplings.emplace_back();
      for (const Eigen::Vector3d& other : neighbour.normals) {
        const double g = &other == &normal ? self : influence_at(nonlocal::angle_between(normal, other));
        const double c2 = std::min(1.0, raised<2>(normal.dot(other)));
        sum.same += g * c2 * c2;
        sum.mixed += g * c2 * (1.0 - c2);
        sum.across += g * (1.0 - c2) * (1.0 - c2);
      }
    }
  }
  return couplings;
}

}  // namespace monograin::cel
