// Observables of the nonlocal system: columns of the history, quantities of conditions, surfaces, warnings.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "elastic/nonlocal_system.hpp"

namespace monograin::nonlocal {

using std::numbers::pi;

void System::observe(double xi, std::span<const double> y, std::span<double> values) {
  evaluate_closely(xi, y);
  const double length = settings_.initial_radius;
  const double force_unit = settings_.youngs_modulus * length * length;
  const double energy_unit = has_energies() ? force_unit * length : std::numeric_limits<double>::quiet_NaN();
  const double margin = contacts_.margin(state_);
  least_margin_ = std::min(least_margin_, margin);
  auto out = values.begin();
  *out++ = y[work_place_] * energy_unit;
  *out++ = contacts_.energy(state_) * energy_unit;
  *out++ = margin;
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    const ContactState c = now_[i];
    const double a = c.contact_radius;
    *out++ = (is_loaded(i) ? c.displacement : prescribed(i, xi)) * length;
    *out++ = depth(i, xi) * length;
    *out++ = c.force * force_unit;
    *out++ = a * length;
    *out++ = a > 0.0 ? c.force / (pi * a * a) * settings_.youngs_modulus : 0.0;
    *out++ = static_cast<double>(regimes_[i]);
    *out++ = a <= k_widest || settings_.radius_rule == RadiusRule::none
                 ? contacts_.deformed_radius(settings_.radius_rule, i, state_) * length
                 : std::nan("");
  }
  if (settings_.centre == Centre::free) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < contacts_.free_count(); ++k) {
      centre += contacts_.free_directions().col(static_cast<Eigen::Index>(k)) * state_[classes_.size() + k];
    }
    for (const double x : centre) *out++ = x * length;
  }
}

double System::quantity(Quantity quantity, int contact_class, double xi, std::span<const double> y) {
  evaluate_closely(xi, y);
  const auto i = static_cast<std::size_t>(contact_class);
  ContactState c = now_[i];
  // A lost contact carries nothing, even if the exact state still loads it, within the error of the event's time.
  if (regimes_[i] == Regime::open) c.force = c.contact_radius = 0.0;
  const double length = settings_.initial_radius;
  const double area = pi * c.contact_radius * c.contact_radius;
  return quantity_of({.force = c.force * settings_.youngs_modulus * length * length,
                      .displacement = (is_loaded(i) ? c.displacement : prescribed(i, xi)) * length,
                      .pressure = area > 0.0 ? c.force / area * settings_.youngs_modulus : 0.0,
                      .contact_radius = c.contact_radius * length,
                      .apparent_radius = length},
                     quantity);
}

/// Pressure under the contact, and its surface, which is the wall's plane.
std::vector<SurfacePoint> System::surface(int contact_class, double xi, std::span<const double> y) {
  constexpr int k_points = 128;
  evaluate_closely(xi, y);
  const auto i = static_cast<std::size_t>(contact_class);
  const ContactState c = now_[i];
  if (!(c.contact_radius > 0.0)) return {};
  const double length = settings_.initial_radius;
  std::vector<SurfacePoint> points;
  for (int k = 0; k <= k_points; ++k) {
    const double r = c.contact_radius * std::sin(0.5 * pi * k / k_points);
    const double pressure = contacts_.law().pressure(state_[i], std::min(r * r, state_[i]));
    const double height = r < 1.0 ? r * r / (1.0 + std::sqrt(1.0 - r * r)) : std::nan("");
    points.push_back({.radius = r * length,
                      .pressure = pressure * contacts_.composite_modulus() * settings_.youngs_modulus,
                      .displacement = (c.approach - height) * length,
                      .relaxed_height = height * length});
  }
  return points;
}

std::vector<Diagnostic> System::warnings() const {
  std::vector<Diagnostic> result;
  if (has_stiffened_ || least_margin_ < k_stiff_margin) {
    result.push_back(
        {"the formulation stiffens as it nears its limit of applicability", "least margin", least_margin_});
  }
  return result;
}

}  // namespace monograin::nonlocal
