#include "mdr/apparent_radius.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace monograin::mdr {
namespace {

// Divisions by these would be a good part of what summing up takes.
constexpr double k_per_solid_angle = 0.25 * std::numbers::inv_pi;
constexpr double k_third = 1.0 / 3.0;
constexpr double k_twelfth = 1.0 / 12.0;

// By how much the squared sine of half the angle between opposite walls falls short of 1 for round-off.
constexpr double k_opposite = 5e-13;

}  // namespace

bool takes_part(RadiusRule rule, Regime regime) noexcept {
  switch (rule) {
    case RadiusRule::gated:
    case RadiusRule::seed:
      return touches(regime);
    case RadiusRule::yielded:
      return regime == Regime::fully_plastic;
    case RadiusRule::fixed:
      return false;
  }
  return false;
}

bool opens_gate(RadiusRule rule, const GrowthDrive& drive) noexcept {
  // What keeps up with its wall displaces nothing.
  const bool is_idle = !drive.is_force_controlled && std::abs(drive.inward_rate) <= drive.least_rate;
  if (rule == RadiusRule::seed && !is_idle) return true;
  const bool is_driven = drive.is_force_controlled ? drive.rises : drive.inward_rate > drive.least_rate;
  return drive.is_on_primary_branch && is_driven;
}

double VolumeBalance::volume_ratio() const noexcept {
  // There is no smaller volume; fixed steps end beyond it.
  const double w = std::min(relative_compression, 0.25);
  return 1.0 - 2.0 * w / (1.0 + std::sqrt(1.0 - 4.0 * w));
}

VolumeSum::VolumeSum(double bulk_compliance, double virial_of_all, double virial) noexcept {
  const double scale = 3.0 * k_per_solid_angle * bulk_compliance;
  w_ = scale * virial;
  sum_.under_root = 1.0 - 4.0 * w_;
  root_ = std::sqrt(sum_.under_root);
  weight_ = k_per_solid_angle * bulk_compliance / root_;
  sum_.relative_compression = scale * virial_of_all;
}

VolumeBalance VolumeSum::balance(double r) const noexcept {
  const double radius = 1.0 + r;
  VolumeBalance result = sum_;
  result.value = r * (1.0 + r * (1.0 + k_third * r)) - k_twelfth * caps_ + 2.0 * k_third * w_ / (1.0 + root_);
  result.by_radius_at_rest = sum_.by_radius + (radius * radius - 0.5 * radius * overlaps_);
  result.by_radius = result.by_radius_at_rest + of_walls_;
  return result;
}

double growth_drive(double demand, double time_scale, bool withdraws, bool is_compressible) noexcept {
  if (time_scale > 0.0) return demand / time_scale;
  if (demand != 0.0) return std::copysign(1.0, demand);
  // First touch, or the last one: of two things that vanish, the elastic volume vanishes last.
  return is_compressible == withdraws ? 1.0 : -1.0;
}

std::vector<CapPair> cap_pairs_of(std::span<const ContactClass> classes) {
  std::vector<CapPair> pairs;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    for (std::size_t j = i; j < classes.size(); ++j) {
      double half_sine = 1.0;
      for (std::size_t m = 0; m < classes[i].normals.size(); ++m) {
        for (std::size_t n = (i == j ? m + 1 : 0); n < classes[j].normals.size(); ++n) {
          half_sine = std::min(half_sine, 0.5 * (classes[i].normals[m] - classes[j].normals[n]).norm());
        }
      }
      if (half_sine * half_sine < 1.0 - k_opposite) {
        pairs.push_back({static_cast<int>(i), static_cast<int>(j), half_sine});
      }
    }
  }
  return pairs;
}

double cap_guard(const CapPair& pair, double first_overlap, double second_overlap, double r) noexcept {
  // A cap of overlap d covers an angle a on either side of its normal with sin(a/2)^2 = d/(2 R). Caps meet where their
  // angles add up to that between the normals; half of each, because the cosines of small angles have no digits left.
  const double scale = 0.5 / (1.0 + r);
  const double first = std::clamp(first_overlap * scale, 0.0, 1.0);
  const double second = std::clamp(second_overlap * scale, 0.0, 1.0);
  return std::sqrt(first * (1.0 - second)) + std::sqrt(second * (1.0 - first)) - pair.half_sine;
}

}  // namespace monograin::mdr
