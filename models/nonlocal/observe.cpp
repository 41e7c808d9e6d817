// Observables of the nonlocal system: columns of the history, quantities of conditions, surfaces, warnings.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "contacts/columns.hpp"
#include "nonlocal/system.hpp"
#include "system/resolution.hpp"

namespace monograin::nonlocal {

using std::numbers::pi;

void System::observe(double xi, std::span<const double> y, std::span<double> values) {
  Particle& p = now_.particle;
  p.evaluate_contacts(xi, y);
  const Settings& settings = p.settings();
  const double length = settings.initial_radius;
  const double force_unit = settings.force_unit();
  const double energy_unit = has_energies() ? force_unit * length : k_nan;
  const double margin = p.contacts().margin(p.state());
  now_.least_margin = std::min(now_.least_margin, margin);
  auto out = values.begin();
  *out++ = y[p.work_slot()] * energy_unit;
  *out++ = p.contacts().energy(p.state()) * energy_unit;
  *out++ = margin;
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    const ContactState& c = p.contact(i);
    const double a = c.contact_radius;
    *out++ = p.displacement(i, xi) * length;
    *out++ = p.depth(i, xi) * length;
    *out++ = c.force * force_unit;
    *out++ = a * length;
    *out++ = a > 0.0 ? c.force / (pi * a * a) * settings.youngs_modulus : 0.0;
    *out++ = p.mode.is_closed[i] ? 1.0 : 0.0;
    *out++ = a <= k_widest || settings.radius_rule == RadiusRule::none
                 ? p.contacts().deformed_radius(settings.radius_rule, i, p.state()) * length
                 : std::nan("");
  }
  if (settings.centre == Centre::free) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < p.contacts().free_count(); ++k)
      centre += p.contacts().free_directions().col(as_index(k)) * p.state()[classes_.size() + k];
    contacts::write_centre_columns(centre * length, values);
  }
}

double System::quantity(Quantity quantity, int contact_class, double xi, std::span<const double> y) {
  Particle& p = now_.particle;
  p.evaluate_contacts(xi, y);
  const auto i = static_cast<std::size_t>(contact_class);
  ContactState c = p.contact(i);
  // A lost contact carries nothing, even if the exact state still loads it, within the error of the event's time.
  if (is_open(contact_class)) c.force = c.contact_radius = 0.0;
  const double length = p.settings().initial_radius;
  const double youngs_modulus = p.settings().youngs_modulus;
  const double area = pi * c.contact_radius * c.contact_radius;
  return quantity_of({.force = c.force * youngs_modulus * length * length,
                      .displacement = p.displacement(i, xi) * length,
                      .pressure = area > 0.0 ? c.force / area * youngs_modulus : 0.0,
                      .contact_radius = c.contact_radius * length,
                      .apparent_radius = length},
                     quantity);
}

/// Pressure under the contact, and its surface, which is the wall's plane.
std::vector<SurfacePoint> System::surface(int contact_class, double xi, std::span<const double> y) {
  Particle& p = now_.particle;
  p.evaluate_contacts(xi, y);
  const auto i = static_cast<std::size_t>(contact_class);
  const ContactState& c = p.contact(i);
  if (!(c.contact_radius > 0.0)) return {};
  const double length = p.settings().initial_radius;
  const double square = p.state()[i];
  std::vector<SurfacePoint> points;
  for (int k = 0; k <= k_surface_points; ++k) {
    const double r = c.contact_radius * std::sin(0.5 * pi * k / k_surface_points);
    const double pressure = p.contacts().law().pressure(square, std::min(r * r, square));
    const double height = r < 1.0 ? r * r / (1.0 + std::sqrt(1.0 - r * r)) : std::nan("");
    points.push_back({.radius = r * length,
                      .pressure = pressure * p.contacts().composite_modulus() * p.settings().youngs_modulus,
                      .displacement = (c.approach - height) * length,
                      .relaxed_height = height * length});
  }
  return points;
}

std::vector<Diagnostic> System::warnings() const {
  std::vector<Diagnostic> result;
  if (now_.guards.has_stiffened() || now_.least_margin < k_stiff_margin) {
    result.push_back(
        {"the formulation stiffens as it nears its limit of applicability", "least margin", now_.least_margin});
  }
  return result;
}

}  // namespace monograin::nonlocal
