/// Closed forms of the Hertz contact between an elastic sphere and a rigid flat wall.
#pragma once

namespace monograin {

/// Composite modulus of an elastic body against a rigid one, E* = E/(1 - nu^2) [Pa].
///
/// @param youngs_modulus  E [Pa], > 0
/// @param poisson_ratio   nu, in (-1, 0.5]
/// Source: Zunker and Kamrin (2024), eq. 3 with a rigid second body.
[[nodiscard]] double composite_modulus(double youngs_modulus, double poisson_ratio) noexcept;

/// Normal force of an elastic sphere pressed by a rigid flat wall [N], F = (4/3) E* sqrt(R) delta^(3/2).
///
/// @param composite_modulus  E* [Pa], > 0
/// @param radius             R [m], > 0
/// @param overlap            delta [m], approach of wall and centre since first touch; <= 0: no contact, gives 0
/// @return force [N], compression positive; C1 in delta, the second derivative grows without bound as delta -> 0+
/// Source: Hertz (1882); Zunker and Kamrin (2024), eq. 25. Valid while the contact radius is well below R (not
/// checked).
[[nodiscard]] double hertz_force(double composite_modulus, double radius, double overlap) noexcept;

/// Overlap under a force >= 0 [m], delta = (3 F/(4 E* sqrt(R)))^(2/3).
[[nodiscard]] double hertz_overlap(double composite_modulus, double radius, double force) noexcept;

/// Contact radius of an elastic sphere against a rigid flat wall [m], a = sqrt(R delta); 0 without contact.
[[nodiscard]] double hertz_contact_radius(double radius, double overlap) noexcept;

/// Elastic energy stored by an elastic sphere against a rigid flat wall [J], (2/5) F delta; 0 without contact.
[[nodiscard]] double hertz_energy(double composite_modulus, double radius, double overlap) noexcept;

}  // namespace monograin
