/// Local law of an elastic sphere against a rigid flat wall with the curvature of its profile: force and radius of one
/// contact under a given approach of its own, before the other contacts of the particle move its surface.
///
/// Everything is a function of the signed square of the contact radius, s = a^2 in contact and s = -gap (over R)
/// without: the laws are smooth in it down to first touch, where force and contact radius have infinite derivatives.
/// Lengths are over R, forces over E* R^2, pressures over E*, energies over E* R^3, with E* = E/(1 - nu^2).
/// Source: Agarwal and Gonzalez (2018), section 4 and appendix B, with all curvature sums equal to 1.
#pragma once

#include <array>

namespace monograin::nonlocal {

/// How many terms of the profile R - sqrt(R^2 - r^2) are kept. One term is Hertz's law, four are the source's. `all` is
/// the whole series, the sphere itself: g = a artanh(a), F = (1 + a^2) artanh(a) - a.
enum class Terms { one = 1, two, three, four, all };

/// One contact at a given s. Exact identity: dF/dg = 2a.
struct LocalContact {
  double approach = 0.0;        ///< g, total local approach of wall and centre
  double approach_slope = 0.0;  ///< dg/ds, >= 1
  double force = 0.0;           ///< F, compression positive, never negative
  double contact_radius = 0.0;  ///< a
};

class LocalLaw {
 public:
  explicit LocalLaw(Terms terms) noexcept;

  /// Exclusive upper bound of s: 1 for `all` terms (the contact is as wide as the sphere), infinity otherwise.
  [[nodiscard]] double end() const noexcept { return end_; }
  /// Largest force over E* R^2 for which s is below end() in double precision: above 17 for `all` terms, else infinite.
  [[nodiscard]] double greatest_force() const noexcept { return greatest_force_; }

  /// The contact at s (eqs. 25, 27, 29, 31, 33, 35). For s <= 0: g = s, and no force. Once continuously differentiable.
  /// @throws std::domain_error unless s is below end()
  [[nodiscard]] LocalContact at(double s) const;

  /// Signed square s for a given approach, by Newton's method. The closed forms (eqs. 26, 30, 34) cancel: they lose
  /// more digits the smaller a^2 is.
  /// @throws std::domain_error for an approach so large that a = 1 in double precision (above 18, `all` terms)
  [[nodiscard]] double signed_square(double approach) const;

  /// Signed square s under a force >= 0 over E* R^2; 0 for no force.
  /// @throws std::domain_error for a negative force, and for one above greatest_force()
  [[nodiscard]] double signed_square_under(double force) const;

  /// Stored energy of the contact over E* R^3, int F dg; 0 for s <= 0.
  /// @throws std::domain_error as at()
  [[nodiscard]] double energy(double s) const;

  /// Pressure over E* at a distance from the contact's middle (eq. 32); 0 outside of it. Relative error below 1e-14.
  /// @param distance_squared  (r/R)^2 >= 0
  /// @throws std::domain_error as at()
  [[nodiscard]] double pressure(double s, double distance_squared) const;

 private:
  template <class Step>
  [[nodiscard]] double descend(double contact_radius, Step&& step) const;

  Terms terms_;
  double end_;
  double greatest_force_;
  std::array<double, 4> approach_{};  ///< coefficients of g/s in s
  std::array<double, 4> slope_{};     ///< coefficients of dg/ds
  std::array<double, 4> force_{};     ///< coefficients of F/a^3
  std::array<double, 7> energy_{};    ///< coefficients of the energy over a^5
};

}  // namespace monograin::nonlocal
