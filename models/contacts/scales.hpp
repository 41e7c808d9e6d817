/// Scales of the unknowns of contacts, to which absolute tolerances are relative.
#pragma once

#include <cmath>
#include <stdexcept>

#include "contacts/wall_contact.hpp"
#include "system/resolution.hpp"

namespace monograin::contacts {

/// Typical magnitudes of one contact; over R0 and the law's unit.
struct Magnitudes {
  double displacement = 1.0;
  double work = 1.0;
};

struct Scales {
  double reach = 1.0;  ///< largest displacement that is expected
  Magnitudes magnitudes{};
  double coordinate = 1.0;
  double force_per_coordinate = 1.0;  ///< force over coordinate, for coordinates in proportion to the force
};

/// Displacement under a force along the present part of the primary branch; the end of the law where it has none.
template <class Law>
[[nodiscard]] double reach_under(const Law& law, const WallContact<Law>& contact, double force, double end) {
  try {
    return contact.displacement_under(law, force);
  } catch (const std::domain_error&) {
    return end;  // the force exceeds the greatest one of the law
  }
}

/// Scales of contacts on the primary branch, which reaches as far as the program goes; to the end of the law if neither
/// displacement nor force is known.
/// @param displacement  largest displacement of the program, over R0; 0: not known
/// @param force         largest force of the program, over the law's unit; 0: not known
template <class Law>
[[nodiscard]] Scales scales_of(Law& law, double displacement, double force) {
  using Contact = WallContact<Law>;
  using Branch = typename Law::Branch;
  const bool is_known = displacement > 0.0 || force > 0.0;
  const Contact last = Contact::pressed_to(law, is_known ? displacement : k_infinity, force);
  const auto ahead = last.next(law);
  const double end = ahead && ahead->limit ? ahead->position : k_infinity;
  double reach = is_known ? displacement : 1.0;
  if (force > 0.0) reach = std::max(reach, reach_under(law, last, force, end));
  reach = std::min(reach, end);

  constexpr bool k_has_own = requires { law.magnitudes(reach); };
  Scales scales{.reach = reach, .magnitudes = {.displacement = reach}};
  if constexpr (k_has_own) scales.magnitudes = law.magnitudes(reach);
  const double d = scales.magnitudes.displacement;
  const Contact typical = Contact::pressed_to(law, d, 0.0);
  const double typical_force = law.force(typical.branch(), d);
  scales.coordinate = d;
  if constexpr (requires { law.coordinate_power(Branch{}); })
    scales.coordinate = std::pow(d, law.coordinate_power(Branch{}));
  scales.force_per_coordinate = typical_force / scales.coordinate;
  if constexpr (k_has_own) return scales;
  scales.magnitudes.work = typical_force * d;
  if constexpr (requires { law.work(typical.branch(), d); }) scales.magnitudes.work = law.work(typical.branch(), d);
  return scales;
}

}  // namespace monograin::contacts
