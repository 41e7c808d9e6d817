#include "mdr/walls.hpp"

#include <algorithm>
#include <cmath>

namespace monograin::mdr {

void Walls::set_drives(const Setup& setup, std::span<const Ramp> ramps) {
  double largest = 0.0;
  for (std::size_t i = 0; i < walls_.size(); ++i) {
    const bool is_force = ramps[i].control == Control::force;
    walls_[i].drive = {ramps[i], is_force ? setup.force_unit() : setup.length_unit()};
    if (is_force) largest = std::max(largest, setup.counts[i] * walls_[i].drive.size());
  }
  for (std::size_t i = 0; i < walls_.size(); ++i) {
    const double force = is_force_controlled(i) ? setup.counts[i] * walls_[i].drive.size() : 0.0;
    walls_[i].may_be_negligible = setup.centre.acts(i) && force > 0.0 && force <= k_no_net_force * largest;
  }
}

double Walls::speed_scale() const noexcept {
  double scale = 0.0;
  for (const Wall& wall : walls_) {
    if (!wall.drive.is_force_controlled()) scale = std::max(scale, std::abs(wall.drive.rate()));
  }
  return scale > 0.0 ? scale : 1.0;
}

}  // namespace monograin::mdr
