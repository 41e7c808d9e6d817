#include "nonlocal/setup.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "contacts/centre/centre_lines.hpp"
#include "contacts/columns.hpp"
#include "system/resolution.hpp"

namespace monograin::nonlocal {
namespace {

constexpr std::array<std::string_view, 2> k_regime_words{"open", "elastic"};

// Largest contact radius over R0 with all terms. Approach and force depend on 1 - a, of which a has ever fewer digits;
// beyond this radius, the approach has less than eleven.
constexpr double k_widest_of_all_terms = 1.0 - 1e-6;

/// Depth of the deepest contact that the program asks for, over R0; 0 if it asks for none.
double greatest_depth(const Settings& settings, const Contacts& contacts) {
  const double depth = settings.reach.displacement / settings.initial_radius;
  if (!(settings.reach.force > 0.0)) return depth;
  const double force = settings.reach.force / settings.force_unit();
  const double bearable = std::min(force / contacts.composite_modulus(), contacts.law().greatest_force());
  return std::max(depth, contacts.law().signed_square_under(bearable));
}

}  // namespace

Scales scales_of(const Settings& settings, std::span<const ContactClass> classes, const Contacts& contacts) {
  Scales scales;
  double reach = greatest_depth(settings, contacts);
  scales.is_below_resolution = reach > 0.0 && reach <= k_resolution;
  for (const ContactClass& c : classes) reach = std::max(reach, c.gap / settings.initial_radius);
  if (!(reach > 0.0)) reach = 1.0;
  // A program may prescribe any displacement, but before R0 a wall is at the centre, or a contact as wide as the
  // particle.
  scales.depth = std::min(reach, 1.0);
  // Beside a fixed centre, smaller distances are round-off of the surface's position.
  scales.touch = settings.centre == Centre::free ? k_touching * scales.depth : k_zero_guard * reach;
  // A guard at the touch tolerance is so large that no integrator takes a wall at rest for a root.
  scales.guard_unit = std::min(scales.depth, scales.touch / (10.0 * k_zero_guard));
  scales.idle = k_unloaded * scales.depth;
  if (settings.model.terms == Terms::all) scales.widest = k_widest_of_all_terms;
  return scales;
}

std::vector<Unknown> unknowns_of(std::span<const ContactClass> classes, const Contacts& contacts, double depth) {
  std::vector<Unknown> unknowns;
  for (const ContactClass& c : classes) {
    unknowns.push_back(
        {c.name, Unknown::Kind::differential, c.takes_force ? std::pow(depth, k_force_power) : depth, true});
  }
  for (std::size_t k = 0; k < contacts.free_count(); ++k) {
    unknowns.push_back({.name = contacts::k_centre_unknowns[k],
                        .kind = Unknown::Kind::differential,
                        .scale = depth,
                        .is_algebraic_in_residual = true,
                        .may_be_undetermined = true});
  }
  unknowns.push_back({"work", Unknown::Kind::quadrature, depth * depth * std::sqrt(depth), false});
  return unknowns;
}

std::vector<Observable> observables_of(std::span<const ContactClass> classes, Centre centre) {
  std::vector<Observable> observables{{"work", "J", {}}, {"stored_energy", "J", {}}, {"margin", "-", {}}};
  for (const ContactClass& c : classes) {
    contacts::add_contact_columns(c.name, k_regime_words, observables);
    observables.push_back({c.name + ".contact_radius_deformed", "m", {}});
  }
  if (centre == Centre::free) contacts::add_centre_columns(observables);
  return observables;
}

}  // namespace monograin::nonlocal
