#include "mdr/adhesive_edge.hpp"

#include <cmath>

#include "system/resolution.hpp"

namespace monograin::mdr {
namespace {

/// Displacement of the springs at a sticking edge, negative where they are stretched, over the stretch that tears them,
/// plus an offset. An edge of zero radius has no springs: gives the displacement itself.
double stretch_left(const AdhesiveEdge& edge, const Image& image, const Adhesion& adhesion, double offset) noexcept {
  const double w = image.displacement_1d - profile_height(image.indenter, edge.radius);
  const double stretch = critical_stretch(adhesion, edge.radius);
  return stretch == 0.0 ? w : w / stretch + offset;
}

}  // namespace

PullOff pull_off_of(const Indenter& indenter, const Adhesion& adhesion) {
  const auto state = [&](Control control) {
    return peel_state(indenter, adhesion, critical_radius(indenter, adhesion, control));
  };
  return {indenter, state(Control::displacement), state(Control::force)};
}

std::optional<AdhesiveEdge> AdhesiveEdge::torn(const PeelState& critical) const noexcept {
  if (radius <= critical.contact_radius) return std::nullopt;
  return AdhesiveEdge{Edge::peeling, radius};
}

AdhesiveEdge AdhesiveEdge::set_back(const Indenter& indenter, double displacement_1d) const noexcept {
  // The profile is steeper at the edge than this chord, so the edge moves back by no less than the round-off. An edge
  // of zero radius stays, because the comparison is false for it.
  const double steepness = (profile_height(indenter, radius) - profile_height(indenter, 0.5 * radius)) / (0.5 * radius);
  const double distance = displacement_1d / steepness;
  return distance < k_root_of_round_off * radius ? AdhesiveEdge{motion, radius - distance} : *this;
}

Contact peeling_contact(const Image& image, const Adhesion& adhesion, const PullOff& pull_off,
                        bool returns_beyond_pull_off) {
  const PeelState& limit = pull_off.by_displacement;
  if (returns_beyond_pull_off && image.displacement_1d < limit.displacement_1d) {
    return sticking_contact(image, adhesion.composite_modulus, limit.contact_radius);
  }
  return peeling_contact(image, adhesion, limit.contact_radius);
}

double sticking_displacement(const Indenter& indenter, double composite_modulus, double a, double force) noexcept {
  if (!(a > 0.0)) return 0.0;
  return profile_height(indenter, a) +
         (force - free_force(indenter, composite_modulus, a)) / (2.0 * composite_modulus * a);
}

double follow_guard(const AdhesiveEdge& edge, const Image& image, const Adhesion& adhesion) noexcept {
  return stretch_left(edge, image, adhesion, 0.0);
}

double peel_guard(const AdhesiveEdge& edge, const Image& image, const Adhesion& adhesion) noexcept {
  return stretch_left(edge, image, adhesion, 1.0);
}

double pull_off_guard(const PullOff& pull_off, const Image& image) noexcept {
  const double critical = pull_off.by_displacement.displacement_1d;
  return (image.displacement_1d - critical) / std::abs(critical);
}

double pull_off_guard(const PullOff& pull_off, double force) noexcept {
  const double critical = pull_off.by_force.force;
  return (force - critical) / std::abs(critical);
}

double press_rate(const Image& image, const Image::Change& change, double contact_radius, double overlap_rate,
                  double growth_rate) noexcept {
  const EdgePress press = edge_press(image, change, contact_radius);
  const double by_overlap = press.by_overlap * overlap_rate;
  const double by_radius = press.by_radius * growth_rate;
  const double scale = std::abs(by_overlap) + std::abs(by_radius);
  return scale > 0.0 ? (by_overlap + by_radius) / scale : 0.0;
}

double reference_stiffness(const AdhesiveEdge& edge, const Contact& contact, double composite_modulus,
                           double by_overlap) noexcept {
  return edge.peels() ? 2.0 * composite_modulus * contact.contact_radius * by_overlap : std::abs(contact.by_overlap);
}

}  // namespace monograin::mdr
