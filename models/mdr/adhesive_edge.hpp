/// Edge of one adhesive contact: it follows the load, sticks, peels, or pulls off.
///
/// The contact radius is a play operator between the radius without adhesion and the one in equilibrium. A sticking
/// edge stands for the springs of the contact's image up to a fixed radius. It follows again where its
/// springs are no longer stretched, and peels where they tear; a peeling edge pulls off where its equilibrium turns
/// unstable. Units and source as in adhesion.hpp.
#pragma once

#include <optional>

#include "mdr/adhesion.hpp"

namespace monograin::mdr {

enum class Edge {
  following,  ///< advances with the load, as without adhesion
  sticking,   ///< stays where it was when the load was reversed
  peeling     ///< recedes in equilibrium
};

/// States in which the edge of an indenter pulls off, under either control.
struct PullOff {
  Indenter indenter;
  PeelState by_displacement;
  PeelState by_force;

  [[nodiscard]] const PeelState& under(Control control) const noexcept {
    return control == Control::force ? by_force : by_displacement;
  }
};
/// States in which the edge of an indenter pulls off.
[[nodiscard]] PullOff pull_off_of(const Indenter& indenter, const Adhesion& adhesion);

/// State of an edge, as a value: transitions return another state.
struct AdhesiveEdge {
  Edge motion = Edge::following;
  double radius = 0.0;  ///< contact radius at which it sticks, or stuck last

  [[nodiscard]] bool follows() const noexcept { return motion == Edge::following; }
  [[nodiscard]] bool sticks() const noexcept { return motion == Edge::sticking; }
  [[nodiscard]] bool peels() const noexcept { return motion == Edge::peeling; }

  /// Peeling edge that remains when the springs at this sticking edge tear; none within the critical radius, where the
  /// edge pulls off at once.
  [[nodiscard]] std::optional<AdhesiveEdge> torn(const PeelState& critical) const noexcept;
  /// This sticking edge, moved back by a round-off displacement of its springs, so that the guard of peeling fires
  /// later. Unchanged if the move would be more than round-off of the radius.
  /// @param displacement_1d  the round-off
  [[nodiscard]] AdhesiveEdge set_back(const Indenter& indenter, double displacement_1d) const noexcept;
};

/// Contact whose edge peels.
/// @param returns_beyond_pull_off  true: beyond pull-off under displacement control the edge sticks at the critical
///                                 radius, so that trials of a free centre lead back
[[nodiscard]] Contact peeling_contact(const Image& image, const Adhesion& adhesion, const PullOff& pull_off,
                                      bool returns_beyond_pull_off);

/// delta_1D of a sticking edge under a force; 0 for an edge of zero radius, which touches and bears nothing.
[[nodiscard]] double sticking_displacement(const Indenter& indenter, double composite_modulus, double a,
                                           double force) noexcept;

/// Guard of a sticking edge: >= 0 where the springs at the edge are no longer stretched.
[[nodiscard]] double follow_guard(const AdhesiveEdge& edge, const Image& image, const Adhesion& adhesion) noexcept;
/// Guard of a sticking edge: <= 0 where the springs at it tear.
[[nodiscard]] double peel_guard(const AdhesiveEdge& edge, const Image& image, const Adhesion& adhesion) noexcept;
/// Guard of a peeling edge under displacement control: <= 0 beyond pull-off.
[[nodiscard]] double pull_off_guard(const PullOff& pull_off, const Image& image) noexcept;
/// Guard of a peeling edge under a prescribed force: <= 0 beyond pull-off.
[[nodiscard]] double pull_off_guard(const PullOff& pull_off, double force) noexcept;

/// Rate at which the springs at an edge are pressed (+) or stretched (-), from -1 to 1: the parts due to the overlap
/// and to the growing indenter, over the sum of their magnitudes.
/// @param change       change of the image with the apparent radius
/// @param growth_rate  d(growth)/dxi, growth = (R - R0)/R0
[[nodiscard]] double press_rate(const Image& image, const Image::Change& change, double contact_radius,
                                double overlap_rate, double growth_rate) noexcept;

/// Stiffness to compare that of a contact with: for a peeling edge, the tangent stiffness if the edge stuck; for other
/// edges, the magnitude of the contact's own stiffness.
/// @param by_overlap  d(delta_1D)/d(delta)
[[nodiscard]] double reference_stiffness(const AdhesiveEdge& edge, const Contact& contact, double composite_modulus,
                                         double by_overlap) noexcept;

}  // namespace monograin::mdr
