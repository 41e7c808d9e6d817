/// Set-up of the nonlocal system: what it is made from, its scales, unknowns and columns.
#pragma once

#include <span>
#include <vector>

#include "nonlocal/contacts.hpp"
#include "system/equations.hpp"
#include "system/observables.hpp"

namespace monograin::nonlocal {

struct Settings {
  Formulation model;
  RadiusRule radius_rule = RadiusRule::closed;
  double initial_radius = 0.0;  ///< R0 [m], > 0
  double youngs_modulus = 0.0;  ///< E [Pa], > 0
  Centre centre = Centre::fixed;
  /// Gives the scales of the unknowns, to which absolute tolerances are relative. 0: unknown.
  Reach reach{};

  [[nodiscard]] double force_unit() const noexcept { return youngs_modulus * initial_radius * initial_radius; }
};

/// The power of s that is the unknown of a force-controlled class.
inline constexpr double k_force_power = 1.5;

/// Limits of round-off, of idle contacts and of wide contacts, from the program's reach.
struct Scales {
  double depth = 1.0;                ///< of the deepest contact
  double touch = 0.0;                ///< touch tolerance: |s| below this is round-off
  double guard_unit = 1.0;           ///< unit of |s| in guards of contacts
  double idle = 0.0;                 ///< least s of a contact that supports a free centre
  double widest = 1.0;               ///< largest contact radius over R0 for which states exist
  bool is_below_resolution = false;  ///< no contact of the program is deeper than round-off
};

[[nodiscard]] Scales scales_of(const Settings& settings, std::span<const ContactClass> classes,
                               const Contacts& contacts);
/// Unknowns of the contacts, then the work.
[[nodiscard]] std::vector<Unknown> unknowns_of(std::span<const ContactClass> classes, const Contacts& contacts,
                                               double depth);
[[nodiscard]] std::vector<Observable> observables_of(std::span<const ContactClass> classes, Centre centre);

}  // namespace monograin::nonlocal
