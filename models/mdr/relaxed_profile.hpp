/// Adhesive contact with a measured or computed relaxed profile, which need not be convex. Only the Python package uses
/// it; runs know convex indenters alone.
///
/// The profile of a strongly flattened particle is concave in the middle and convex at the edge. Once its whole disc
/// has been closed by compression, the contact stays compact: its edge recedes in equilibrium and turns unstable
/// outside the ring where the image has its minimum. Functions are homogeneous: lengths in any one unit, stresses in
/// any one unit. Source: Zunker and Kamrin (2024), sections 3.2 and Appendix F.2.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "mdr/adhesion.hpp"

namespace monograin::mdr {

/// One-dimensional image of a profile given by samples.
///
/// The samples are interpolated in s = r^2, because a profile that is smooth at the axis is a smooth function of s. The
/// pieces are cubics in s, their slopes those of polynomials through five neighbours. Even polynomials of degree 6 are
/// reproduced, other smooth profiles to fourth order in the distance of samples. The transform is exact for the pieces.
class RelaxedProfile {
 public:
  /// @param radii    r_i, from 0 on, ascending, at least five; the last one is the largest contact radius a_max
  /// @param heights  g3D(r_i); only their differences from that at the axis count
  /// @throws std::invalid_argument that says what is wrong with the samples
  RelaxedProfile(std::span<const double> radii, std::span<const double> heights);

  /// Radius a_max of the last sample.
  [[nodiscard]] double largest_radius() const noexcept { return radii_.back(); }
  /// Radii of the samples.
  [[nodiscard]] std::span<const double> radii() const noexcept { return radii_; }

  // The image, for x in [0, a_max]; std::domain_error outside.

  /// Image g1D(x) of the profile, counted from the axis (eq. 4), for x in [0, a_max].
  [[nodiscard]] double image_height(double x) const;
  /// Slope g1D'(x) of the image, for x in [0, a_max].
  [[nodiscard]] double image_slope(double x) const;
  /// Area below the image, S(x) = int_0^x g1D, for x in [0, a_max].
  [[nodiscard]] double image_area(double x) const;

 private:
  /// Coefficients of the profile between two samples: a cubic in r^2 less r^2 of the inner sample.
  using Piece = std::array<double, 4>;

  /// int_0^x f(G, s) dt with s = x^2 - t^2
  template <class Integrand>
  [[nodiscard]] double integral(double x, Integrand&& integrand) const;

  std::vector<double> radii_;
  std::vector<Piece> pieces_;
};

/// Force of a contact of the radius a without adhesion, 2 E* int_0^a (g1D(a) - g1D(x)) dx; may be negative where the
/// profile is concave (which only adhesion can bear).
/// @throws std::domain_error for a outside [0, a_max]
[[nodiscard]] double free_force(const RelaxedProfile& profile, double composite_modulus, double a);

/// State of an edge in equilibrium at the radius a (eq. 14). Throws as free_force() does.
[[nodiscard]] PeelState peel_state(const RelaxedProfile& profile, const Adhesion& adhesion, double a);

/// Contact radius at pull-off: the outermost root of g1D' = control_factor() Dl' (eq. 15), 0 where there is
/// none.
///
/// The search has the resolution of the samples: it misses two roots between neighbouring samples.
/// @param adhesion  without surface energy the root is the outermost minimum of the image
/// @throws std::domain_error where the edge is unstable from a_max on: the profile has to be known further out
[[nodiscard]] double critical_radius(const RelaxedProfile& profile, const Adhesion& adhesion, Control control);

/// State at pull-off. Under force control its force is the least of all states, -F_c. Throws as critical_radius() does.
[[nodiscard]] PeelState pull_off_state(const RelaxedProfile& profile, const Adhesion& adhesion, Control control);

/// Stable states from a_max down to pull-off, both included, at equal distances of the contact radius.
/// @param count  number of states, >= 2
/// @throws std::invalid_argument for a count below 2; std::domain_error as critical_radius()
[[nodiscard]] std::vector<PeelState> peel_curve(const RelaxedProfile& profile, const Adhesion& adhesion,
                                                Control control, std::size_t count);

}  // namespace monograin::mdr
