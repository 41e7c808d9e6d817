#include "mdr/contact_branch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "system/resolution.hpp"

namespace monograin::mdr {
namespace {

using std::numbers::pi;

/// Elastic contact. If the law continues off its branches, the force is odd in the overlap, and beyond an overlap of R
/// it rises with the slope there.
Contact elastic_branch(const ContactLaw& law, double radius, double overlap) {
  const double depth = law.continues_off_branch ? std::min(std::abs(overlap), radius) : overlap;
  Contact contact = elastic_contact(law.elastic_profile, law.material.composite_modulus, radius, depth);
  if (law.continues_off_branch) contact.force += contact.by_overlap * (std::abs(overlap) - depth);
  if (overlap < 0.0) {
    contact.force = -contact.force;
    contact.by_radius = -contact.by_radius;
  }
  return contact;
}

/// Contact below its largest overlap. If the law continues off its branches, the force is odd about the overlap at
/// which the contact opens, and more than two recoveries above that (one, below) it rises with the slope at the largest
/// overlap, 2 E* a_max/(1 - rho): the branch is short, and trials may lead far off it.
Contact unloading_branch(const ContactLaw& law, const UnloadingShape& shape, double overlap) {
  const double modulus = law.material.composite_modulus;
  if (!law.continues_off_branch) return unloading_contact(shape, modulus, overlap);
  const double fraction = unloading_fraction(shape, overlap);
  if (std::abs(fraction) <= 1.0) return unloading_contact(shape, modulus, overlap);
  const bool is_open = fraction > 1.0;
  const double depth = is_open ? fraction - 1.0 : 1.0 - fraction;
  const double followed = std::min(depth, is_open ? 1.0 : 2.0);
  Contact contact = unloading_contact(shape, modulus, shape.overlap_max + (followed - 1.0) * shape.recovery);
  if (depth > followed) {
    contact.by_overlap = 2.0 * modulus * shape.contact_radius_max / (1.0 - shape.rho);
    contact.force += contact.by_overlap * (depth - followed) * shape.recovery;
  }
  if (is_open) {
    contact.force = -contact.force;
    contact.by_radius = -contact.by_radius;
    contact.by_overlap_max = -contact.by_overlap_max;
  }
  return contact;
}

}  // namespace

double ContactLaw::least_stiffness() const noexcept {
  return 2.0 * material.composite_modulus * std::sqrt(k_resolution);
}

double ContactLaw::plastic_stiffness() const noexcept { return 2.0 * pi * material.yield_stress; }

double ContactBranch::touching_overlap(const ContactLaw& law, double growth) const {
  if (regime != Regime::separated && regime != Regime::unloading) return 0.0;
  const UnloadingShape& dent = shape(law, growth, 0.0);
  return dent.overlap_max - dent.recovery;
}

const UnloadingShape& ContactBranch::shape(const ContactLaw& law, double growth, double overlap) const {
  const double radius = 1.0 + growth;
  const double most = regime == Regime::fully_plastic ? overlap : largest_overlap(law, growth);
  if (shape_.radius != radius || shape_.overlap_max != most) {
    shape_ = unloading_shape(law.material, radius, most, area_constant);
  }
  return shape_;
}

Image ContactBranch::image(const ContactLaw& law, double growth, double overlap) const {
  return regime == Regime::elastic ? elastic_image(law.elastic_profile, 1.0 + growth, overlap)
                                   : unloading_image(shape(law, growth, overlap), overlap);
}

const PullOff& ContactBranch::pull_off(const ContactLaw& law, const Indenter& indenter) const {
  const Indenter& known = pull_off_.indenter;
  if (known.height != indenter.height || known.half_width != indenter.half_width) {
    pull_off_ = pull_off_of(indenter, law.adhesion());
  }
  return pull_off_;
}

Contact ContactBranch::contact(const ContactLaw& law, double growth, double overlap) const {
  Contact contact = [&]() -> Contact {
    if (!edge.follows()) return adhering_contact(law, growth, overlap);
    switch (regime) {
      case Regime::open:
      case Regime::separated:
        break;
      case Regime::elastic:
        return elastic_branch(law, 1.0 + growth, overlap);
      case Regime::fully_plastic:
        return plastic_contact(law.material, 1.0 + growth, overlap, area_constant);
      case Regime::unloading:
        return unloading_branch(law, shape(law, growth, overlap), overlap);
    }
    return {};
  }();
  if (law.is_shifted()) contact.by_radius += contact.by_overlap_max;
  return contact;
}

Contact ContactBranch::adhering_contact(const ContactLaw& law, double growth, double overlap) const {
  const Image at = image(law, growth, overlap);
  return edge.sticks() ? sticking_contact(at, law.material.composite_modulus, edge.radius)
                       : peeling_contact(at, law.adhesion(), pull_off(law, at.indenter), law.continues_off_branch);
}

Contact ContactBranch::stiff_contact(const ContactLaw& law, double growth, double overlap, const Contact& now) const {
  const bool is_dent = regime == Regime::unloading;
  if (!edge.follows() || !(is_dent || regime == Regime::elastic)) return now;
  const double touch = touching_overlap(law, growth);
  if (overlap - touch >= k_resolution) return now;
  return contact(law, growth, is_dent ? std::min(touch + k_resolution, largest_overlap(law, growth)) : k_resolution);
}

bool ContactBranch::is_visible(const ContactLaw& law, double growth, double overlap, double magnitude) const {
  if (!edge.follows() || (regime != Regime::elastic && regime != Regime::unloading)) return true;
  const double touch = touching_overlap(law, growth);
  return !(overlap - touch < k_round_off * (magnitude + touch));
}

double ContactBranch::approach_under(const ContactLaw& law, double growth, double force, double guess) const {
  if (!edge.follows()) {
    const Indenter indenter = image(law, growth, 0.0).indenter;
    const double modulus = law.material.composite_modulus;
    const double displacement_1d =
        edge.sticks() ? sticking_displacement(indenter, modulus, edge.radius, force)
                      : peel_at_force(indenter, law.adhesion(), pull_off(law, indenter).by_force.contact_radius, force)
                            .displacement_1d;
    return (regime == Regime::elastic ? displacement_1d : overlap_at(shape(law, growth, 0.0), displacement_1d)) -
           growth;
  }
  switch (regime) {
    case Regime::open:
    case Regime::separated:
      // A growing particle pushes an idle wall along.
      return std::min(resting, touching_overlap(law, growth) - growth);
    case Regime::elastic:
      return elastic_overlap(law.elastic_profile, law.material.composite_modulus, 1.0 + growth, force) - growth;
    case Regime::fully_plastic:
      return plastic_overlap(law.material, 1.0 + growth, force, area_constant, guess + growth) - growth;
    case Regime::unloading:
      return unloading_overlap(shape(law, growth, 0.0), force) - growth;
  }
  return guess;
}

double ContactBranch::energy(const ContactLaw& law, double growth, double overlap, double contact_radius,
                             PlasticPart part) const {
  const double modulus = law.material.composite_modulus;
  if (!edge.follows()) return adhesive_energy(image(law, growth, overlap), law.adhesion(), contact_radius);
  // A contact closes without attraction, so no work is done on the surface; opening it takes the surface energy, which
  // lowers the recoverable energy.
  const double surface =
      part == PlasticPart::recoverable ? pi * contact_radius * contact_radius * law.surface_energy : 0.0;
  switch (regime) {
    case Regime::open:
    case Regime::separated:
      break;
    case Regime::elastic:
      return elastic_energy(law.elastic_profile, modulus, 1.0 + growth, overlap) - surface;
    case Regime::fully_plastic:
      if (part == PlasticPart::work_done)
        return plastic_work_primitive(law.material, 1.0 + growth, overlap, area_constant);
      return plastic_energy(shape(law, growth, overlap)) - (1.0 - shape_.rho) * surface;
    case Regime::unloading:
      return unloading_energy(shape(law, growth, overlap), overlap) - (1.0 - shape_.rho) * surface;
  }
  return 0.0;
}

double ContactBranch::press_rate(const ContactLaw& law, double growth, double overlap, double contact_radius,
                                 double overlap_rate, double growth_rate) const {
  const Image at = image(law, growth, overlap);
  Image::Change change = at.by_radius;
  if (law.is_shifted()) {
    change.displacement_1d += at.by_overlap_max.displacement_1d;
    change.height += at.by_overlap_max.height;
    change.half_width += at.by_overlap_max.half_width;
  }
  return mdr::press_rate(at, change, contact_radius, overlap_rate, growth_rate);
}

double ContactBranch::regularized_stiffness(const ContactLaw& law, const Contact& now) const noexcept {
  const bool is_soft_at_first = regime != Regime::fully_plastic && !edge.peels();
  return is_soft_at_first ? std::max(now.by_overlap, law.least_stiffness()) : now.by_overlap;
}

double ContactBranch::reference_stiffness(const ContactLaw& law, double growth, const Contact& now) const {
  const double by_overlap = edge.peels() && regime != Regime::elastic ? 1.0 / (1.0 - shape(law, growth, 0.0).rho) : 1.0;
  return mdr::reference_stiffness(edge, now, law.material.composite_modulus, by_overlap);
}

bool ContactBranch::may_yield(const ContactLaw& law) const noexcept {
  return (is_on_primary_branch || law.is_shifted()) && std::isfinite(law.material.yield_overlap_ratio);
}

double ContactBranch::yield_guard(const ContactLaw& law, double growth, double overlap, double least) const noexcept {
  return overlap / std::max((1.0 + growth) * law.material.yield_overlap_ratio, least) - 1.0;
}

double ContactBranch::opening_guard(const ContactLaw& law, double growth, double overlap) const {
  return regime == Regime::elastic ? overlap : 1.0 - unloading_fraction(shape(law, growth, overlap), overlap);
}

ContactBranch ContactBranch::with_largest(const ContactLaw& law, double growth, double overlap) const noexcept {
  ContactBranch next = *this;
  next.largest_measure = overlap - (law.is_shifted() ? growth : 0.0);
  return next;
}

ContactBranch ContactBranch::unloaded(const ContactLaw& law, double growth, double overlap) const noexcept {
  ContactBranch next = with_largest(law, growth, overlap);
  next.is_on_primary_branch = false;
  if (regime == Regime::fully_plastic) next.regime = Regime::unloading;
  return next;
}

ContactBranch ContactBranch::reloaded() const noexcept {
  ContactBranch next = with_edge({Edge::following, edge.radius});
  next.is_on_primary_branch = true;
  if (regime == Regime::unloading) next.regime = Regime::fully_plastic;
  return next;
}

ContactBranch ContactBranch::yielded(const ContactLaw& law, double growth) const noexcept {
  ContactBranch next = reloaded();
  next.regime = Regime::fully_plastic;
  next.area_constant = yield_area_constant(law.material.yield_overlap_ratio, 1.0 + growth);
  next.shape_ = {};
  return next;
}

ContactBranch ContactBranch::made() const noexcept {
  ContactBranch next = *this;
  next.regime = regime == Regime::separated ? Regime::unloading : Regime::elastic;
  return next;
}

ContactBranch ContactBranch::lost(double approach) const noexcept {
  ContactBranch next = *this;
  next.resting = approach;
  next.regime = regime == Regime::unloading ? Regime::separated : Regime::open;
  return next;
}

ContactBranch ContactBranch::with_edge(const AdhesiveEdge& moved) const noexcept {
  ContactBranch next = *this;
  next.edge = moved;
  return next;
}

}  // namespace monograin::mdr
