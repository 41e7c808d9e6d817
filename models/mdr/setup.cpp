#include "mdr/setup.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "elastic/hertz.hpp"

namespace monograin::mdr {

using std::numbers::pi;

CentreVector centre_of(std::span<const double> y, int free_directions) noexcept {
  CentreVector centre = CentreVector::Zero();
  for (int k = 0; k < free_directions; ++k) centre[k] = y[centre_index(k)];
  return centre;
}

void set_centre(std::span<double> y, int free_directions, const CentreVector& centre) noexcept {
  for (int k = 0; k < free_directions; ++k) y[centre_index(k)] = centre[k];
}

Setup::Setup(const Settings& given, std::vector<ContactClass> contact_classes)
    : settings(given), classes(std::move(contact_classes)), centre(classes, settings.centre_is_free) {
  law.material =
      make_material(settings.youngs_modulus, settings.poisson_ratio, settings.yield_stress, settings.pressure_curve);
  law.material.composite_modulus /= stress_unit();
  law.material.yield_stress /= stress_unit();
  law.material.linear_compressibility *= stress_unit();
  law.surface_energy = settings.surface_energy / (stress_unit() * settings.initial_radius);
  law.elastic_profile = settings.elastic_profile;
  law.delta_max_rule = settings.delta_max_rule;
  law.continues_off_branch = centre.is_free();
  for (const ContactClass& c : classes) counts.push_back(c.multiplicity());
  takes_forces = std::ranges::any_of(classes, &ContactClass::takes_force);
  std::size_t next = centre_index(centre.free_directions());
  for (const ContactClass& c : classes) wall_index.push_back(c.takes_force ? next++ : 0);
}

std::vector<Unknown> Setup::unknowns() const {
  const double reach = largest_displacement_expected();
  std::vector<Unknown> list{
      {.name = "apparent radius growth (R - R0)/R0", .scale = growth_scale(reach), .is_algebraic_in_residual = true},
      {.name = "work", .kind = Unknown::Kind::quadrature, .scale = work_scale(reach)}};
  for (int k = 0; k < centre.free_directions(); ++k) {
    list.push_back({.name = contacts::k_centre_unknowns[static_cast<std::size_t>(k)],
                    .kind = Unknown::Kind::algebraic,
                    .scale = reach,
                    .is_algebraic_in_residual = true,
                    .is_dependent = true,
                    .may_be_undetermined = true});
  }
  for (const ContactClass& c : classes) {
    if (!c.takes_force) continue;
    list.push_back({.name = c.name,
                    .kind = Unknown::Kind::algebraic,
                    .scale = reach,
                    .is_algebraic_in_residual = true,
                    .is_dependent = true});
  }
  return list;
}

/// A program may prescribe any displacement, but a contact ends where its wall has reached the centre.
double Setup::largest_displacement_expected() const {
  double reach = std::min(1.0, settings.reach.displacement / settings.initial_radius);
  const double force = settings.reach.force / force_unit();
  if (force > 0.0) {
    const double elastic = hertz_overlap(law.material.composite_modulus, 1.0, force);
    const double plastic = std::isfinite(law.material.yield_overlap_ratio) ? force / (2.0 * pi) : 0.0;
    reach = std::max(reach, std::min(1.0, std::max(elastic, plastic)));
  }
  return reach > 0.0 ? reach : 1.0;
}

/// Displaced volume makes the radius grow with the square of the displacement. By the rule `seed`, elastic volume that
/// is recovered makes it grow too, by more than that at small displacements.
double Setup::growth_scale(double displacement) const noexcept {
  const double displaced = displacement * displacement;
  if (settings.radius_rule != RadiusRule::seed) return displaced;
  const double force = hertz_force(law.material.composite_modulus, 1.0, displacement);
  return std::min(1.0, std::max(displaced, 0.5 * std::numbers::inv_pi * law.material.linear_compressibility * force));
}

double Setup::work_scale(double displacement) const noexcept {
  const double elastic = hertz_energy(law.material.composite_modulus, 1.0, displacement);
  const double plastic = plastic_pressure(law.material, 0.0).pressure * pi * displacement * displacement;
  return std::isfinite(law.material.yield_overlap_ratio) ? std::min(elastic, plastic) : elastic;
}

}  // namespace monograin::mdr
