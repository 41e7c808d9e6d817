/// An elastic particle between rigid walls: Hertz's law at every contact. Lengths in R0, stresses in E*. The formulas
/// stand in elastic/hertz.hpp. Source: Hertz (1882); Zunker and Kamrin (2024), eq. 25.
#pragma once

#include <array>
#include <string_view>

#include "contacts/independent.hpp"
#include "elastic/hertz.hpp"
#include "mdr/contact_profile.hpp"

namespace monograin::hertz {

/// Law of one contact, for contacts::IndependentContacts.
struct WallLaw {
  struct Branch {};  ///< unloading retraces loading
  static constexpr std::array<std::string_view, 2> k_regimes{"open", "elastic"};
  static constexpr bool k_is_tested = true;  ///< tests compare its functions, so that no run has to

  double composite_modulus = 1.0;  ///< E* [Pa], > 0

  [[nodiscard]] double unit_force(double radius) const noexcept { return composite_modulus * radius * radius; }
  [[nodiscard]] double force(Branch, double d) const noexcept { return hertz_force(1.0, 1.0, d); }
  [[nodiscard]] double slope(Branch, double d) const noexcept { return 2.0 * hertz_contact_radius(1.0, d); }
  [[nodiscard]] double displacement(Branch, double force) const noexcept { return hertz_overlap(1.0, 1.0, force); }
  [[nodiscard]] double opening(Branch) const noexcept { return 0.0; }
  [[nodiscard]] double work(Branch, double d) const noexcept { return hertz_energy(1.0, 1.0, d); }
  [[nodiscard]] double stored(Branch, double d) const noexcept { return hertz_energy(1.0, 1.0, d); }
  [[nodiscard]] contacts::BearingContact contact(Branch b, double d) const noexcept {
    return {force(b, d), hertz_contact_radius(1.0, d)};
  }
  [[nodiscard]] int regime(Branch, bool touches) const noexcept { return touches ? 1 : 0; }
  [[nodiscard]] contacts::Boundary next(Branch) const noexcept {
    constexpr double distance = contacts::k_least_distance;
    return {1.0 - distance, "limit", LimitPoint{Limit::wall_at_centre, -1, "distance/R0", distance}};
  }
  [[nodiscard]] std::vector<SurfacePoint> surface(Branch, double d) const {
    return mdr::surface_of({.indenter = mdr::elastic_indenter(mdr::ElasticProfile::parabola, 1.0),
                            .composite_modulus = 1.0,
                            .contact_radius = hertz_contact_radius(1.0, d),
                            .displacement_1d = d});
  }
};

}  // namespace monograin::hertz
