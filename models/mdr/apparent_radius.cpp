#include "mdr/apparent_radius.hpp"

#include <algorithm>
#include <cmath>

#include "system/resolution.hpp"

namespace monograin::mdr {

bool opens_gate(RadiusRule rule, const ContactMotion& drive) noexcept {
  // A contact whose wall keeps its distance from the centre displaces no volume.
  const bool is_idle = !drive.is_force_controlled && std::abs(drive.inward_rate) <= drive.least_rate;
  if (rule == RadiusRule::seed && !is_idle) return true;
  const bool is_driven = drive.is_force_controlled ? drive.rises : drive.inward_rate > drive.least_rate;
  return drive.is_on_primary_branch && is_driven;
}

double VolumeBalance::volume_ratio() const noexcept {
  // The volume is smallest at w = 1/4; fixed steps may end beyond that.
  const double w = std::min(compression_of_all, 0.25);
  return 1.0 - 2.0 * w / (1.0 + std::sqrt(1.0 - 4.0 * w));
}

double growth_drive(double demand, double time_scale, bool withdraws, bool is_compressible) noexcept {
  if (time_scale > 0.0) return demand / time_scale;
  if (demand != 0.0) return std::copysign(1.0, demand);
  // At first and last touch both elastic volume and caps are zero. The elastic volume is larger just beside it.
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
      // Between opposite walls the squared sine is 1.
      if (half_sine * half_sine < 1.0 - k_same_value) {
        pairs.push_back({static_cast<int>(i), static_cast<int>(j), half_sine});
      }
    }
  }
  return pairs;
}

CapAngle cap_angle(double overlap, double growth) noexcept {
  // A cap of overlap d covers an angle a on either side of its normal with sin(a/2)^2 = d/(2 R).
  const double square = std::clamp(overlap * 0.5 / (1.0 + growth), 0.0, 1.0);
  return {std::sqrt(square), std::sqrt(1.0 - square)};
}

}  // namespace monograin::mdr
