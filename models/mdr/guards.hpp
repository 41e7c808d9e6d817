/// Guards of the MDR system: their kinds, which of them are alive in a mode, and their values.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "mdr/contact_caps.hpp"
#include "mdr/particle.hpp"
#include "system/hybrid_system.hpp"
#include "system/resolution.hpp"

namespace monograin::mdr {

enum GuardKind : int {
  k_yield,
  k_reload,
  k_made,
  k_dent_touched,
  k_lost,
  k_retreat,
  k_turn,
  k_peel,
  k_follow,
  k_pull_off,
  k_greatest_tension,
  k_least_tension,
  k_tension_falls,
  k_tension_rises,
  k_unstable,
  k_softened,
  k_growth_on,
  k_growth_off,
  k_caps,
  k_singular,
  k_covered,
  k_greatest_force,
  k_volume,
  k_centre_reached
};

/// Rate of a contact's force, in the unit of force_rate(), that is round-off.
inline constexpr double k_steady_force = 1e-9;
/// Rate, of order one elsewhere, below which a wall or an edge is at rest: just after it has turned, its rate is an
/// error of integration.
inline constexpr double k_at_rest = 1e-8;
/// With a free centre, contacts along its directions open and close together; their guards agree to the integration
/// error only.
inline constexpr double k_together = 1e-6;
/// Growth ends where the free surface falls below this share of the particle's surface.
inline constexpr double k_least_slope = 1e-3;
/// A plastic contact under a prescribed force has reached its largest force when its stiffness is this share of that of
/// a shallow contact. Below this stiffness, the overlap would magnify errors of the radius a hundredfold and more.
inline constexpr double k_last_stiffness = 1e-2;
/// A wall this near to the centre of the particle (over R0) has reached it.
inline constexpr double k_least_distance = 1e-3;

/// Guard of a contact that does not depend on its adhesive edge: touch, loss, yield or reload.
/// @param overlap  at which the guard is evaluated, not necessarily the present overlap
[[nodiscard]] double contact_guard(const Particle& p, int kind, std::size_t i, double xi, double overlap);
/// Guard of the edge of an adhesive contact: its distance from following, peeling or pull-off, over the stretch that
/// tears its springs (at pull-off, over the critical displacement or force).
/// @param overlap  at which the guard is evaluated, not necessarily the present overlap
[[nodiscard]] double edge_guard(const Particle& p, int kind, std::size_t i, double xi, double overlap);
/// Round-off of the overlap at which a sticking edge follows again. An edge that has just come to stick leaves that
/// overlap with the square of its displacement; subtracting this keeps round-off from firing the guard.
[[nodiscard]] double edge_round_off(const Particle& p, std::size_t i);

/// Set of the guards that are alive until the next transition or the end of the step.
class GuardSet {
 public:
  void arm(Particle& p, ContactCaps& caps, double xi, std::span<const double> y);
  [[nodiscard]] std::span<const Guard> list() const noexcept { return list_; }
  void values(Particle& p, ContactCaps& caps, double xi, std::span<const double> y, std::span<double> values) const;

 private:
  /// Possible changes of a contact's overlap until the step ends.
  struct Course {
    bool is_free = false;      ///< a free centre moves the particle against the wall's prescribed displacement
    bool may_turn = false;     ///< the overlap may change its direction in mid-step
    bool may_come_in = false;  ///< the overlap may grow
    bool may_go_out = false;   ///< the overlap may shrink
  };

  [[nodiscard]] static Course course_of(const Particle& p, std::size_t i, const Motion& now);
  void add_if_reached(const Particle& p, std::size_t i, const Course& course, int kind, int direction,
                      std::string_view name);
  void arm_contact(const Particle& p, std::size_t i, const Motion& now);
  void arm_touch(const Particle& p, std::size_t i, const Course& course);
  void arm_primary_branch(const Particle& p, std::size_t i, const Motion& now, const Course& course);
  void arm_edge(const Particle& p, std::size_t i, const Course& course);
  void arm_tension(const Particle& p, std::size_t i, const Motion& now, const Course& course);
  void arm_growth(const Particle& p, const Motion& now);

  std::vector<Guard> list_;
  bool has_cap_guards_ = false;  ///< the list has guards of caps
};

}  // namespace monograin::mdr
