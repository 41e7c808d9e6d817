#include "compressible/system.hpp"

#include <algorithm>
#include <numbers>

#include "system/resolution.hpp"

namespace monograin::compressible {

double WallLaw::unit_force(double radius) const noexcept {
  return std::numbers::pi * radius * radius * settings_.yield_pressure;
}

double WallLaw::force(const Branch& b, double d) const noexcept {
  return b.is_unloading ? unloading_force(b.curve, d) : force_in(settings_.law, b.part, d);
}

double WallLaw::slope(const Branch& b, double d) const noexcept {
  return b.is_unloading ? unloading_slope(b.curve, d) : slope_in(settings_.law, b.part, d);
}

double WallLaw::displacement(const Branch& b, double force) const noexcept {
  if (b.is_unloading) return unloading_displacement(b.curve, force);
  return b.part == Part::linear ? force / settings_.law.stiffness : displacement_under(settings_.law, force);
}

double WallLaw::work(const Branch& b, double d) const noexcept {
  return b.is_unloading ? recoverable_work(b.curve, d) : work_in(settings_.law, b.part, d);
}

double WallLaw::stored(const Branch& b, double d) noexcept {
  const UnloadingCurve curve = b.is_unloading ? b.curve : curve_from(d);
  least_ratio_ = std::min(least_ratio_, slope_ratio(settings_.law, curve));
  return recoverable_work(curve, d);
}

contacts::Boundary WallLaw::next(const Branch& b) const noexcept {
  if (b.part == Part::linear && settings_.law.transition < k_largest_displacement)
    return {settings_.law.transition, "transition"};
  return {k_largest_displacement, "limit",
          LimitPoint{Limit::source_data_end, -1, "displacement/R0", k_largest_displacement}};
}

void WallLaw::turn(Branch& b, double d) noexcept {
  b.curve = curve_from(d);
  b.is_unloading = true;
  if (b.curve.is_clipped) ++clipped_;
}

int WallLaw::regime(const Branch& b, bool touches) const noexcept {
  return !touches ? 0 : b.is_unloading ? 3 : b.part == Part::exponential ? 2 : 1;
}

void WallLaw::start() noexcept {
  clipped_ = 0;
  least_ratio_ = 1.0;
}

std::vector<Diagnostic> WallLaw::warnings(double walls) const {
  std::vector<Diagnostic> found = settings_.reservations;
  if (walls > 2.0) {
    found.push_back({"the law was derived between two walls; contacts of one particle do not know of each other",
                     "loaded walls", walls});
  }
  if (clipped_ > 0) {
    found.push_back(
        {"unloading would have ended before first touch, and ends there instead: so small a contact is "
         "stiffer than Hertz's",
         "such unloadings", static_cast<double>(clipped_)});
  }
  if (least_ratio_ < 1.0 - k_same_value) {
    found.push_back({"unloading is, or would be, less steep than loading: the cycle may give back more than it took",
                     "least slope over that of loading", least_ratio_});
  }
  return found;
}

}  // namespace monograin::compressible
