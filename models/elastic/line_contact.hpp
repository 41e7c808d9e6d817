/// Closed form of an elastic cylinder between two rigid flat walls, in plane strain.
///
/// P load per length, D = 2 R diameter, S = P/D nominal stress, delta approach of the walls, E* = E/(1 - nu^2),
/// b half width of either contact:
///
///   b/R = sqrt(8 S/(pi E*)),   delta/D = (2 S/(pi E*)) (2 ln(4 R/b) - 1)
///
/// Source: Johnson (1985), Contact Mechanics, section 5.6; for the disc of Nezamabadi et al. (2022), section 3.
#pragma once

namespace monograin {

/// State of the cylinder. Stresses in the unit of E*.
struct LineContact {
  double strain = 0.0;      ///< delta/D
  double stress = 0.0;      ///< S
  double half_width = 0.0;  ///< b/R
  double tangent = 0.0;     ///< dS/d(delta/D); 0 at first touch, where the curve S(delta/D) has infinite curvature
};

/// Largest b/R for which the closed form is used. It treats both bodies as half-spaces, which a wider contact is not.
inline constexpr double k_widest_line_contact = 1.0;

/// State of the cylinder under a given nominal stress.
/// @param composite_modulus  E*, > 0
/// @param stress             S >= 0
/// @throws std::domain_error where the contact would be wider than k_widest_line_contact
[[nodiscard]] LineContact line_contact_under_stress(double composite_modulus, double stress);

/// State of the cylinder at a given approach, by Newton's method for ln b.
/// @param strain  delta/D >= 0
/// @throws std::domain_error where the contact would be wider than k_widest_line_contact: from delta/D = 0.443 on
[[nodiscard]] LineContact line_contact_at_strain(double composite_modulus, double strain);

}  // namespace monograin
