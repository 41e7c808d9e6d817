/// Contacts of an elastic-plastic particle: the properties of a dent, the elastic law on that dent, and the influence
/// of contacts on each other.
///
/// Lengths are over R0, stresses over E, forces over E R0^2, areas over pi R0^2; Y stands for Y/E. The dent of a
/// contact is its largest radius zeta, referred to a sphere of unit radius: zeta = a_Y on a fresh surface, and zeta
/// only grows. The law also depends on the support distance l of the core under the wall and on the coverage factor m
/// of the particle. Own law of this project; labels such as (cel-dent) are those of equations in docs/theory/cel.md.
#pragma once

#include <span>
#include <vector>

#include "system/walls.hpp"

namespace monograin::cel {

template <int n>
[[nodiscard]] constexpr double raised(double x) noexcept {
  double result = 1.0;
  for (int i = 0; i < n; ++i) result *= x;
  return result;
}

/// Elastic constants and the onset of yield.
struct Material {
  /// @param yield_stress   Y, > 0
  /// @param poisson_ratio  in [0, 0.5]
  Material(double yield_stress, double poisson_ratio) noexcept;

  double Y;
  double Es;          ///< 1/(1 - nu^2)
  double xi_Y;        ///< Johnson's parameter E* a/(Y R) at yield
  double a_Y;         ///< contact radius at yield
  double xi_by_zeta;  ///< Es/Y
};

/// Properties of a contact that follow from its dent alone, each with its derivative by zeta.
struct Dent {
  double zeta = 0.0;
  double h = 0.0, h_zeta = 0.0;                ///< plastic indentation, 0 on a fresh surface
  double p = 0.0, p_zeta = 0.0;                ///< mean pressure at the limit over Y
  double q = 0.0, q_zeta = 0.0;                ///< exponent of the elastic law, 1/3 on a fresh surface
  double root_Gam = 1.0, root_Gam_zeta = 0.0;  ///< root of the compliance by the sphere over that of a fresh contact
};
[[nodiscard]] Dent dent_of(const Material& material, double zeta) noexcept;

/// Derivatives of a quantity of a contact by its own coordinate (u, or F where a force is prescribed), its dent, its
/// support distance and the coverage factor.
struct Slopes {
  double coordinate = 0.0;
  double zeta = 0.0;
  double l = 0.0;
  double m = 0.0;

  friend Slopes operator*(double factor, const Slopes& by) noexcept {
    return {factor * by.coordinate, factor * by.zeta, factor * by.l, factor * by.m};
  }
  friend Slopes operator+(const Slopes& a, const Slopes& b) noexcept {
    return {a.coordinate + b.coordinate, a.zeta + b.zeta, a.l + b.l, a.m + b.m};
  }
  friend Slopes operator-(const Slopes& a, const Slopes& b) noexcept { return a + -1.0 * b; }
};

/// Coverage Om of the particle's surface, half the contact area over pi R0^2, and what depends on it alone.
struct Coverage {
  double Om = 0.0;
  double m = 1.0, m_Om = 0.0;          ///< factor of the limit force; the area has its root
  double shade = 1.0, shade_Om = 0.0;  ///< factor of the influence of neighbours
};
[[nodiscard]] Coverage coverage_of(double Om) noexcept;

/// A contact at an instant. An open one has u <= 0, minus its gap, and no force.
struct Contact {
  double u = 0.0;      ///< elastic displacement
  double F = 0.0;      ///< force
  double area = 0.0;   ///< contact area over pi
  double alpha = 0.0;  ///< contact area over pi at the limit force
  double H = 0.0;      ///< force at which the contact would flow by itself
  double F_over_H = 0.0;
  double stored = 0.0;  ///< elastic energy of the contact itself
  Slopes u_by{}, F_by{}, H_by{}, alpha_by{};
};

/// Contact by the law F = H (u/u_H)^(1/(1-q)), at an elastic displacement u or, with the inverse law, under a force.
/// @param coordinate  u, or F
/// @param is_force    true: the coordinate is F
[[nodiscard]] Contact contact_by(const Material& material, const Dent& dent, double l, double m, double coordinate,
                                 bool is_force) noexcept;
[[nodiscard]] inline Contact contact_at(const Material& material, const Dent& dent, double l, double m,
                                        double u) noexcept {
  return contact_by(material, dent, l, m, u, false);
}

/// Advance c of a wall into room that the core makes, and its first two derivatives by the support distance l.
struct Advance {
  double c, c_l, c_ll;
};
/// Advance of a wall at a support distance l.
/// @param growth  l - 1, given as such because it is small next to 1 while the core has hardly flowed
[[nodiscard]] Advance advance_of(double growth) noexcept;

/// Influence of the forces on all walls of one class on a wall of another:
///   G = sum g(theta) [1 + mu (root - 1)] [mu + (1 - mu) shade],   mu = cos^2 theta
/// with the product of the roots of both compliances and the factor of neighbours (Coverage::shade).
struct Coupling {
  double same = 0.0, mixed = 0.0, across = 0.0;  ///< sums of g mu^2, g mu (1 - mu), g (1 - mu)^2

  [[nodiscard]] double G(double root, double shade) const noexcept {
    return mixed + across * shade + root * by_root(shade);
  }
  [[nodiscard]] double by_root(double shade) const noexcept { return same + mixed * shade; }
  [[nodiscard]] double by_shade(double root) const noexcept { return across + root * mixed; }
};

/// Couplings of every class to every other, row by row.
[[nodiscard]] std::vector<Coupling> couplings_of(double poisson_ratio, std::span<const ContactClass> classes);

}  // namespace monograin::cel
