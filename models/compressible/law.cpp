#include "compressible/law.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>

namespace monograin::compressible {
namespace {

UnloadingShape between(const UnloadingShape& first, const UnloadingShape& second, double share) noexcept {
  return {std::lerp(first.exponent, second.exponent, share),
          std::lerp(first.stiffness_ratio, second.stiffness_ratio, share)};
}

/// (d - d0)/(dm - d0), from the difference d - dm, which has all its digits near dm.
double share_of(const UnloadingCurve& curve, double displacement) noexcept {
  return 1.0 + (displacement - curve.largest) / curve.length;
}

/// share|^power, with all digits of the distance from dm.
double power_of_share(const UnloadingCurve& curve, double displacement, double power) noexcept {
  const double share = share_of(curve, displacement);
  if (share <= 0.0) return std::pow(-share, power);
  return std::exp(power * std::log1p((displacement - curve.largest) / curve.length));
}

// Share to either side beyond which an unloading curve continues along its tangent. A curve may be much shorter than
// the error of a wall's position while an event is located, and a power of so many lengths has no bound.
constexpr double k_farthest_share = 2.0;

}  // namespace

LoadingLaw make_loading_law(double stiffness, double transition, double exponent) {
  const auto check = [](const char* name, double value) {
    if (value > 0.0 && std::isfinite(value)) return;
    throw std::invalid_argument(std::string(name) + " = " + std::to_string(value) + "; expected a number above 0");
  };
  check("k", stiffness);
  check("delta_t", transition);
  check("a", exponent);
  return {stiffness, transition, exponent};
}

double force_in(const LoadingLaw& law, Part part, double displacement) noexcept {
  const auto [k, transition, a] = law;
  return part == Part::linear ? k * displacement : k * transition * std::exp(a * (displacement - transition));
}

double slope_in(const LoadingLaw& law, Part part, double displacement) noexcept {
  return part == Part::linear ? law.stiffness : law.exponent * force_in(law, part, displacement);
}

double work_in(const LoadingLaw& law, Part part, double displacement) noexcept {
  const auto [k, transition, a] = law;
  if (part == Part::linear) return 0.5 * k * displacement * displacement;
  return 0.5 * k * transition * transition + k * transition / a * std::expm1(a * (displacement - transition));
}

Part part_at(const LoadingLaw& law, double displacement) noexcept {
  return displacement < law.transition ? Part::linear : Part::exponential;
}

double loading_force(const LoadingLaw& law, double displacement) noexcept {
  return force_in(law, part_at(law, displacement), displacement);
}

double loading_work(const LoadingLaw& law, double displacement) noexcept {
  return work_in(law, part_at(law, displacement), displacement);
}

double displacement_under(const LoadingLaw& law, double force) noexcept {
  const auto [k, transition, a] = law;
  const double before = k * transition;
  if (force <= before) return force / k;
  return transition + std::log1p((force - before) / before) / a;
}

double hertz_stiffness(double stiffness_ratio, double poisson_ratio) noexcept {
  return 4.0 / (3.0 * std::numbers::pi) * stiffness_ratio / ((1.0 - poisson_ratio) * (1.0 + poisson_ratio));
}

UnloadingShape UnloadingRule::at(double largest) const noexcept {
  const auto above = std::ranges::upper_bound(nodes_, largest, {}, &UnloadingNode::largest);
  if (above == nodes_.begin()) return nodes_.front().shape;
  if (above == nodes_.end()) return nodes_.back().shape;
  const UnloadingNode& below = *(above - 1);
  return between(below.shape, above->shape, (largest - below.largest) / (above->largest - below.largest));
}

UnloadingRule interpolated_rule(std::span<const UnloadingRow> rows, double stiffness_over_shear) {
  if (rows.empty()) throw std::invalid_argument("a table of unloadings without rows");
  std::map<double, std::vector<UnloadingNode>> materials;
  for (const UnloadingRow& row : rows) materials[row.stiffness_over_shear].push_back(row.node);
  for (auto& [ratio, nodes] : materials) std::ranges::sort(nodes, {}, &UnloadingNode::largest);

  const auto above = materials.upper_bound(stiffness_over_shear);
  if (above == materials.begin()) return UnloadingRule(above->second);
  const auto below = std::prev(above);
  if (above == materials.end()) return UnloadingRule(below->second);
  // Between two materials the rule has a node where either of them has one.
  const UnloadingRule first(below->second);
  const UnloadingRule second(above->second);
  std::vector<double> places;
  for (const auto& rule : {first, second}) {
    for (const UnloadingNode& node : rule.nodes()) places.push_back(node.largest);
  }
  std::ranges::sort(places);
  places.erase(std::unique(places.begin(), places.end()), places.end());
  const double share = std::log(stiffness_over_shear / below->first) / std::log(above->first / below->first);
  std::vector<UnloadingNode> nodes;
  for (const double place : places) nodes.push_back({place, between(first.at(place), second.at(place), share)});
  return UnloadingRule(std::move(nodes));
}

UnloadingCurve unloading_from(const LoadingLaw& law, double hertz_stiffness, const UnloadingRule& rule,
                              double largest) noexcept {
  const UnloadingShape shape = rule.at(largest);
  const double force = loading_force(law, largest);
  const double recovery = std::cbrt(force / hertz_stiffness);
  const double length = recovery * recovery / shape.stiffness_ratio;  // Edmans and Sinka (n.d.), eqs. 11 and 12
  return {.largest = largest,
          .force = force,
          .length = std::min(length, largest),
          .exponent = shape.exponent,
          .is_clipped = length > largest};
}

double unloading_force(const UnloadingCurve& curve, double displacement) noexcept {
  const double share = share_of(curve, displacement);
  const double beyond = std::abs(share) - k_farthest_share;
  if (beyond > 0.0) {
    const double at_farthest = curve.force * std::pow(k_farthest_share, curve.exponent);
    return std::copysign(at_farthest * (1.0 + curve.exponent * beyond / k_farthest_share), share);
  }
  return std::copysign(curve.force * power_of_share(curve, displacement, curve.exponent), share);
}

double unloading_slope(const UnloadingCurve& curve, double displacement) noexcept {
  if (std::abs(share_of(curve, displacement)) > k_farthest_share) {
    return curve.force * curve.exponent / curve.length * std::pow(k_farthest_share, curve.exponent - 1.0);
  }
  return curve.force * curve.exponent / curve.length * power_of_share(curve, displacement, curve.exponent - 1.0);
}

double recoverable_work(const UnloadingCurve& curve, double displacement) noexcept {
  const double beyond = std::abs(share_of(curve, displacement)) - k_farthest_share;
  if (beyond > 0.0) {
    const double at_farthest = curve.force * std::pow(k_farthest_share, curve.exponent);
    const double mean = 1.0 + 0.5 * curve.exponent * beyond / k_farthest_share;
    return at_farthest * curve.length * (k_farthest_share / (curve.exponent + 1.0) + beyond * mean);
  }
  return curve.force * curve.length / (curve.exponent + 1.0) *
         power_of_share(curve, displacement, curve.exponent + 1.0);
}

double unloading_displacement(const UnloadingCurve& curve, double force) noexcept {
  // expm1 keeps the digits of the distance from dm.
  return curve.largest + curve.length * std::expm1(std::log(force / curve.force) / curve.exponent);
}

double slope_ratio(const LoadingLaw& law, const UnloadingCurve& curve) noexcept {
  return unloading_slope(curve, curve.largest) / slope_in(law, part_at(law, curve.largest), curve.largest);
}

}  // namespace monograin::compressible
