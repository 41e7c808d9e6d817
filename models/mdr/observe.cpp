// What can be seen of the MDR system: columns of the history, energies, surfaces, warnings.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "mdr/contact_profile.hpp"
#include "mdr/system.hpp"

namespace monograin::mdr {
namespace {

using std::numbers::pi;

// Regime words of a contact whose edge does not follow, after those of Regime.
constexpr double k_adhering_word = 5.0;
constexpr double k_peeling_word = 6.0;

}  // namespace

/// Energy of the contacts that evaluate() found. A row of the history asks for both parts of it, which differ where a
/// contact is at its largest overlap, and by the surface energy where an edge follows.
double System::energy(double r, PlasticPart plastic_part) {
  const bool is_either = std::ranges::none_of(branches_, [this](const ContactBranch& memory) {
    return memory.edge.follows() && (memory.regime == Regime::fully_plastic || law_.adheres());
  });
  if (is_either && sums_.energy) return *sums_.energy;
  double sum = 0.0;
  for (std::size_t i = 0; i < now_.size(); ++i) {
    if (branches_[i].touches())
      sum += counts_[i] * branches_[i].energy(law_, r, now_[i].overlap, now_[i].contact.contact_radius, plastic_part);
  }
  if (is_either) sums_.energy = sum;
  return sum;
}

void System::observe(double xi, std::span<const double> y, std::span<double> values) {
  evaluate_cached(xi, y);
  const double r = y[k_radius];
  const double length = settings_.initial_radius;
  const double force_unit = stress_unit_ * length * length;
  const double energy_unit = force_unit * length;
  const double work = y[k_work] + sums_.force_work;
  const double stored = energy(r, PlasticPart::recoverable);

  auto out = values.begin();
  if (settings_.radius_rule != RadiusRule::fixed) {
    // There is no smaller volume; fixed steps end beyond it.
    const double w = std::min(sums_.relative_compression, 0.25);
    const double volume = 1.0 - 2.0 * w / (1.0 + std::sqrt(1.0 - 4.0 * w));
    *out++ = (1.0 + r) * length;
    *out++ = 4.0 * pi / 3.0 * length * length * length * volume;
  }
  *out++ = work * energy_unit;
  *out++ = stored * energy_unit;
  *out++ = (work - stored) * energy_unit;
  for (std::size_t i = 0; i < now_.size(); ++i) {
    const Contact c = visible_contact(i);
    *out++ = now_[i].position * length;
    *out++ = now_[i].overlap * length;
    *out++ = c.force * force_unit;
    *out++ = c.contact_radius * length;
    *out++ = c.contact_radius > 0.0 ? c.force / (pi * c.contact_radius * c.contact_radius) * stress_unit_ : 0.0;
    *out++ = branches_[i].edge.sticks()  ? k_adhering_word
             : branches_[i].edge.peels() ? k_peeling_word
                                         : static_cast<double>(branches_[i].regime);
  }
  if (settings_.centre_is_free) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (int k = 0; k < free_count_; ++k) centre += free_directions_.col(k) * y[centre_place(k)];
    for (const double x : centre) *out++ = x * length;
  }
}

Contact System::visible_contact(std::size_t i) const {
  const Instant& now = now_[i];
  // The overlap is the displacement of the wall and the growth of the radius.
  const double magnitude = 2.0 * std::abs(now.displacement) + std::abs(now.overlap);
  return branches_[i].visible(law_, evaluated_radius_, now.overlap, magnitude, now.contact);
}

double System::quantity(Quantity quantity, int contact_class, double xi, std::span<const double> y) {
  evaluate_cached(xi, y);
  const auto i = static_cast<std::size_t>(contact_class);
  const Contact contact = visible_contact(i);
  const double length = settings_.initial_radius;
  const double area = pi * contact.contact_radius * contact.contact_radius;
  return quantity_of({.force = contact.force * stress_unit_ * length * length,
                      .displacement = now_[i].position * length,
                      .pressure = area > 0.0 ? contact.force / area * stress_unit_ : 0.0,
                      .contact_radius = contact.contact_radius * length,
                      .apparent_radius = (1.0 + y[k_radius]) * length},
                     quantity);
}

std::vector<SurfacePoint> System::surface(int contact_class, double xi, std::span<const double> y) {
  evaluate(xi, y);
  const auto i = static_cast<std::size_t>(contact_class);
  const double a = now_[i].contact.contact_radius;
  if (!branches_[i].touches() || !(a > 0.0)) return {};
  const Frame now = branches_[i].frame(law_, y[k_radius], now_[i].overlap);
  std::vector<SurfacePoint> points = surface_of({.indenter = now.indenter,
                                                 .composite_modulus = law_.material.composite_modulus,
                                                 .contact_radius = std::min(a, now.indenter.half_width),
                                                 .displacement_1d = now.displacement});
  for (SurfacePoint& point : points) {
    point.radius *= settings_.initial_radius;
    point.pressure *= stress_unit_;
    point.displacement *= settings_.initial_radius;
    point.relaxed_height *= settings_.initial_radius;
  }
  return points;
}

double System::controlled(Control control, int contact_class, double xi, std::span<const double> y) {
  if (control == Control::force) return quantity(Quantity::force, contact_class, xi, y);
  evaluate(xi, y);
  return now_[static_cast<std::size_t>(contact_class)].position * settings_.initial_radius;
}

std::vector<Diagnostic> System::warnings() const {
  std::vector<Diagnostic> result;
  if (settings_.radius_rule != RadiusRule::fixed) {
    const double ratio = settings_.youngs_modulus / settings_.yield_stress;
    if (!std::isfinite(law_.material.yield_overlap_ratio)) {
      result.push_back(
          {"the material is too compliant to yield inside the model; the particle stays elastic", "E/Y", ratio});
    } else if (ratio < 10.0) {
      result.push_back({"elastic strains are not small: the model is meant for E/Y of 10 and more", "E/Y", ratio});
    }
  }
  if (caps_have_met_) {
    result.push_back({"contact caps intersect (event caps-intersect); the model is not valid beyond", "first at R/R0",
                      radius_at_caps_});
  }
  if (validity_) result.push_back(*validity_);
  return result;
}

}  // namespace monograin::mdr
