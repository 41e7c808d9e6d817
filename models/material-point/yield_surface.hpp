/// Yield functions and flow potentials in the plane of mean stress p and signed deviatoric stress s.
///
/// p is tension positive, s axial minus lateral stress, q = |s|. Every segment's formula continues smoothly beyond the
/// segment's ends, where trial steps and root searches may evaluate it.
/// Source: Edmans and Sinka (n.d.), Tables 2 and 3 (with eps = (pi4 - pi3)/pi2, corrected).
#pragma once

#include <optional>

#include "material-point/properties.hpp"

namespace monograin::material_point {

/// Pieces of a yield surface. vm has `shear` alone, vmdc all but `transition`, dpc all but `tension`.
enum class Segment { tension, shear, transition, cap };

/// Formula that is used at a point on or near the surface.
struct Branch {
  Segment segment = Segment::shear;
  /// Sign of s: q = side s. It is 0 for a state that stays on the axis s = 0, where f does not depend on s to first
  /// order. Only on the shear and transition segments of dpc does f depend on the sign; elsewhere on s squared.
  double side = -1.0;

  friend bool operator==(const Branch&, const Branch&) = default;
};

/// Yield function f and flow potential Psi of one branch, with their partial derivatives. f is without dimension for vm
/// and vmdc, and in units of the yield pressure for dpc.
struct Yield {
  double f = 0.0;
  double f_p = 0.0;
  double f_s = 0.0;
  double f_phi = 0.0;  ///< at constant p and s
  double Psi = 0.0;
  double Psi_p = 0.0;
  double Psi_s = 0.0;
};

/// Relations between the constants of the Drucker-Prager cap (Table 2, below the table; Table 3).
struct CapConstants {
  Evolving friction_slope;    ///< tan pi6 of the shear line
  Evolving cohesion;          ///< pi5, where the line meets p = 0
  Evolving arc_radius;        ///< pi8 C, where C is the shear strength
  Evolving arc_centre;        ///< (1 - A) C: the arc's centre along q, above p = -pi3
  Evolving flow_stretch;      ///< B
  Evolving transition_start;  ///< p_i: the arc begins at p = -p_i
};

/// @throws std::domain_error where the line, the arc or the cap does not exist (Lambda + pi3 <= 0, B <= 0, arc below q
/// = 0)
[[nodiscard]] CapConstants cap_constants(const Parameters& parameters, const Properties& properties);

/// Segment of the surface at a pressure.
[[nodiscard]] Segment segment_at(const Parameters& parameters, const Properties& properties, double p);

/// Branch at a stress; side -1 (axial compression) where s is zero.
[[nodiscard]] Branch branch_at(const Parameters& parameters, const Properties& properties, double p, double s);

/// f, g and their derivatives by the formula of a branch, at any p. Below the arc's centre, f is the height over the
/// top of the arc.
[[nodiscard]] Yield yield_on(const Parameters& parameters, const Properties& properties, Branch branch, double p,
                             double s);

/// f at any stress, by the segment at its pressure: negative inside, also below the arc's centre (corrected).
[[nodiscard]] double yield_function(const Parameters& parameters, const Properties& properties, double p, double s);

/// Distance along p from the end of a segment, positive inside the segment; nullopt where it has no end on that side.
/// @param towards_compression  the end at lower p, else that at higher p
[[nodiscard]] std::optional<double> distance_to_end(const Parameters& parameters, const Properties& properties,
                                                    Segment segment, bool towards_compression, double p);

/// Segment next to an end of a segment.
[[nodiscard]] Segment neighbour(const Parameters& parameters, Segment segment, bool towards_compression);

/// Point where a straight stress path (p + t p', s + t s') leaves the elastic domain.
struct Exit {
  double t = 0.0;  ///< >= 0
  Branch branch;
};
/// @param p, s  inside the domain or on its surface
/// @return none if the path never leaves the domain, or does not move
[[nodiscard]] std::optional<Exit> way_out(const Parameters& parameters, const Properties& properties, double p,
                                          double s, double p_rate, double s_rate);

}  // namespace monograin::material_point
