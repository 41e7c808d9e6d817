// What is seen of a plastic particle between its walls.

#include <algorithm>
#include <stdexcept>

#include "plastic/system.hpp"
#include "system/difficulty.hpp"
#include "system/undefined.hpp"

namespace monograin::plastic {
namespace {

// gamma/2R from which on semimech agrees with finite elements.
constexpr double k_least_trusted = 0.03;

}  // namespace

double System::stored_energy(std::size_t i, double x) const {
  const Memory& memory = memory_[i];
  if (!touches(memory.regime) || x <= origin(i)) return 0.0;
  if (memory.regime == Regime::unloading) return mdr::unloading_energy(memory.indenter, x);
  if (memory.regime == Regime::elastic) return work_per_wall(settings_.law, x);
  return mdr::plastic_energy(indenter_at(i, x));
}

void System::observe(double xi, std::span<const double> y, std::span<double> values) {
  const double length = settings_.initial_radius;
  const double force_unit = settings_.strength * length * length;
  const double energy_unit = force_unit * length;
  auto out = values.begin();
  *out++ = y[work_place_] * energy_unit;
  if (settings_.unloading != Unloading::none) {
    double stored = 0.0;
    for (std::size_t i = 0; i < memory_.size(); ++i) {
      if (!is_lateral(i)) stored += classes_[i].multiplicity() * stored_energy(i, displacement(i, xi, y));
    }
    *out++ = stored * energy_unit;
    *out++ = (y[work_place_] - stored) * energy_unit;
  }
  for (std::size_t i = 0; i < memory_.size(); ++i) {
    const double x = displacement(is_lateral(i) ? first_primary_ : i, xi, y);
    const Contact c = seen(i, xi, y);
    if (!is_lateral(i)) farthest_ = std::max(farthest_, x);
    *out++ = displacement(i, xi, y) * length;
    double overlap = x;
    if (is_lateral(i)) {
      // The approach that a lateral contact behaves as if it had.
      const Regime regime = memory_[i].regime;
      const bool is_in_small_range = regime == Regime::elastic || regime == Regime::elastic_plastic;
      overlap = regime == Regime::open ? 0.0
                : is_in_small_range    ? (x > 0.0 ? lateral_approach(*lateral_law_, x).value : 0.0)
                                       : k_nan;
    }
    *out++ = overlap * length;
    *out++ = c.force * force_unit;
    *out++ = c.contact_radius * length;
    *out++ = c.pressure * settings_.strength;
    *out++ = static_cast<double>(memory_[i].regime);
  }
}

double System::quantity(Quantity quantity, int contact_class, double xi, std::span<const double> y) {
  const auto i = static_cast<std::size_t>(contact_class);
  const Contact c = seen(i, xi, y);
  const double length = settings_.initial_radius;
  return quantity_of({.force = c.force * settings_.strength * length * length,
                      .displacement = displacement(i, xi, y) * length,
                      .pressure = c.pressure * settings_.strength,
                      .contact_radius = c.contact_radius * length,
                      .apparent_radius = length},
                     quantity);
}

double System::controlled(Control control, int contact_class, double xi, std::span<const double> y) {
  if (control == Control::force) return quantity(Quantity::force, contact_class, xi, y);
  // A ramp of displacement begins where the force of the last one has taken the wall, without an integrator's error.
  const auto i = static_cast<std::size_t>(contact_class);
  const double x = displacement(i, xi, y);
  return (presses(i) ? displacement_under_force(i, prescribed(i, xi), x) : x) * settings_.initial_radius;
}

bool System::is_open(int contact_class) const noexcept {
  return !touches(memory_[static_cast<std::size_t>(contact_class)].regime);
}

/// Of the whole program: every contact is as shallow when it is made.
std::optional<Difficulty> System::difficulty(double /*xi*/, std::span<const double> /*y*/) {
  return is_shallow_ ? std::optional(Difficulty::below_resolution) : std::nullopt;
}

std::vector<Diagnostic> System::warnings() const {
  std::vector<Diagnostic> result;
  for (std::size_t k = 0; k < range_messages_.size(); ++k) {
    result.push_back({range_messages_[k], settings_.out_of_range[k].quantity, settings_.out_of_range[k].value});
  }
  if (farthest_ > calibrated_end(settings_.law)) {
    result.push_back({"the walls have gone farther than the source compares the law with its calculations",
                      "largest gamma/2R", farthest_});
  }
  if (std::holds_alternative<SemimechLaw>(settings_.law) && farthest_ > 0.0 && farthest_ < k_least_trusted) {
    result.push_back(
        {"the whole run lies where the law is too stiff: below gamma/2R = 0.03 its force is 15 to 66 % above "
         "finite elements, and in the elastic range 2.3 to 2.9 times that of Hertz",
         "largest gamma/2R", farthest_});
  }
  if (lateral_law_ && farthest_ > k_least_trusted) {
    result.push_back(
        {"forces of the lateral contacts are 2.1 to 3.5 times those of finite elements for gamma/2R from "
         "0.03 to 0.1",
         "largest gamma/2R", farthest_});
  }
  if (has_lateral_gap_) {
    result.push_back({"the source has no law for lateral contacts in all of the range; their columns are empty there",
                      "largest gamma/2R", farthest_});
  }
  if (lateral_law_) {
    const double lambda = std::get<SemimechLaw>(settings_.law).material.modulus_over_yield;
    if (lambda < k_least_lateral_modulus_over_yield || lambda > k_greatest_lateral_modulus_over_yield) {
      result.push_back({"outside the range over which the lateral contacts were fitted, 163.08 to 4954.4",
                        "E/((1-nu^2) Y)", lambda});
    }
  }
  if (overshooting_) {
    result.push_back(
        {"a contact recovers more than it was compressed: so small a contact is not plastic enough for "
         "unloading = \"mdr\"",
         "recovery over displacement", *overshooting_});
  }
  return result;
}

}  // namespace monograin::plastic
