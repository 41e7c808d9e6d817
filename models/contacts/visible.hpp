/// Contacts as a row of the history shows them. The functions of a law are listed in contacts/independent.hpp.
#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "contacts/columns.hpp"
#include "contacts/wall_contact.hpp"
#include "system/limit.hpp"
#include "system/number_text.hpp"

namespace monograin::contacts {

template <class Law>
inline constexpr bool k_has_contact_area = requires(const Law& law, const typename Law::Branch& b) {
  law.contact(b, 1.0);
};

/// Units of a law.
struct Units {
  double length = 1.0;  ///< R0 [m]
  double force = 1.0;   ///< [N]
  [[nodiscard]] double stress() const noexcept { return force / (length * length); }
  [[nodiscard]] double energy() const noexcept { return force * length; }

  [[nodiscard]] VisibleContact in_si(VisibleContact shown) const noexcept {
    shown.displacement *= length;
    shown.overlap *= length;
    shown.force *= force;
    shown.contact_radius *= length;
    shown.pressure *= stress();
    return shown;
  }
  [[nodiscard]] SurfacePoint in_si(SurfacePoint point) const noexcept {
    point.radius *= length;
    point.pressure *= stress();
    point.displacement *= length;
    point.relaxed_height *= length;
    return point;
  }
};

/// Numbers of a contact at a displacement, in units of the law; without the displacement of its wall.
template <class Law>
[[nodiscard]] VisibleContact visible_contact(const Law& law, const WallContact<Law>& c, double xi, double d) {
  VisibleContact shown{.overlap = d, .regime = static_cast<double>(law.regime(c.branch(), c.touches()))};
  if (!c.bears(law, d)) return shown;
  if constexpr (k_has_contact_area<Law>) {
    const BearingContact bearing = law.contact(c.branch(), d);
    shown.force = c.is_force_controlled() ? c.drive().value(xi) : bearing.force;
    shown.contact_radius = bearing.contact_radius;
    const double area = std::numbers::pi * bearing.contact_radius * bearing.contact_radius;
    shown.pressure = area > 0.0 ? shown.force / area : 0.0;
  } else {
    shown.force = c.is_force_controlled() ? c.drive().value(xi) : law.force(c.branch(), d);
  }
  if (!std::isfinite(shown.force)) {
    throw DomainError(Limit::no_solution,
                      "the law gives no finite force at a displacement of " + number_text(d, 6) + " R0");
  }
  return shown;
}

/// Numbers of a follower whose leader is at a displacement, in units of the law.
template <class Law>
[[nodiscard]] VisibleContact visible_follower(Law& law, const WallContact<Law>& leader, double d) {
  if constexpr (requires { law.follower(leader.branch(), true, d); })
    return law.follower(leader.branch(), leader.touches(), d);
  else
    return {};
}

}  // namespace monograin::contacts
