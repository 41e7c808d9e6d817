/// Edge of one adhesive contact: it follows the load, sticks, peels, or pulls off.
///
/// The contact radius is a play operator between the radius without adhesion and the one in equilibrium. A sticking
/// edge stands for the springs of the one-dimensional space (`Frame`) up to a fixed radius. It follows again where its
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

/// Constants of an adhesive interface.
struct Adhesion {
  double composite_modulus = 0.0;  ///< E*, > 0
  double surface_energy = 0.0;     ///< dg, >= 0
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
[[nodiscard]] PullOff pull_off_of(const Indenter& indenter, const Adhesion& adhesion);

/// State of an edge; the transitions return another one.
struct AdhesiveEdge {
  Edge motion = Edge::following;
  double radius = 0.0;  ///< contact radius while it sticks

  [[nodiscard]] bool follows() const noexcept { return motion == Edge::following; }
  [[nodiscard]] bool sticks() const noexcept { return motion == Edge::sticking; }
  [[nodiscard]] bool peels() const noexcept { return motion == Edge::peeling; }

  /// Begins to peel, where the springs at a sticking edge tear; none within the critical radius, where it pulls off.
  [[nodiscard]] std::optional<AdhesiveEdge> torn(const PeelState& critical) const noexcept;
  /// A sticking edge that is moved back by a displacement of its springs within round-off, so that its guard against
  /// peeling is met later. It stays where it is if that were no round-off of its radius.
  [[nodiscard]] AdhesiveEdge set_back(const Indenter& indenter, double displacement_1d) const noexcept;
};

/// Contact whose edge peels.
/// @param returns_beyond_pull_off  beyond pull-off under displacement control the edge sticks at the critical radius,
/// so
///                                 that trials of a free centre lead back
[[nodiscard]] Contact peeling_contact(const Frame& frame, const Adhesion& adhesion, const PullOff& pull_off,
                                      bool returns_beyond_pull_off);

/// delta_1D of a sticking edge under a force. An edge of no radius bears nothing, and is where it touches.
[[nodiscard]] double sticking_displacement(const Indenter& indenter, double composite_modulus, double a,
                                           double force) noexcept;

/// Guard of a sticking edge: >= 0 where no spring at it is stretched any more.
[[nodiscard]] double follow_guard(const AdhesiveEdge& edge, const Frame& frame, const Adhesion& adhesion) noexcept;
/// Guard of a sticking edge: <= 0 where the springs at it tear.
[[nodiscard]] double peel_guard(const AdhesiveEdge& edge, const Frame& frame, const Adhesion& adhesion) noexcept;
/// Guard of a peeling edge under displacement control: <= 0 beyond pull-off.
[[nodiscard]] double pull_off_guard(const PullOff& pull_off, const Frame& frame) noexcept;
/// Guard of a peeling edge under a prescribed force: <= 0 beyond pull-off.
[[nodiscard]] double pull_off_guard(const PullOff& pull_off, double force) noexcept;

/// Rate at which the springs at an edge are pressed (+) or stretched (-), over the sum of its magnitudes: what the
/// overlap does, and what a growing indenter does.
/// @param change  of the frame with the apparent radius
[[nodiscard]] double press_rate(const Frame& frame, const Frame::Change& change, double contact_radius,
                                double overlap_rate, double growth) noexcept;

/// Tangent stiffness that a contact would have if its edge stuck; its magnitude for an edge that does not peel.
[[nodiscard]] double unpeeled_stiffness(const AdhesiveEdge& edge, const Contact& contact, double composite_modulus,
                                        double by_overlap) noexcept;

}  // namespace monograin::mdr
