/// Guards of the MDR system: their kinds, which of them are alive in a mode, and their values.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "mdr/contact_caps.hpp"
#include "mdr/particle.hpp"
#include "system/regimes.hpp"
#include "system/resolution.hpp"

namespace monograin::mdr {

/// Kinds of guards. Behind each one: its value, the unit of that value in brackets (without: of order one), and the
/// side on which it has fired. u is the unloading fraction, F a prescribed force, F_max its largest magnitude in the
/// step.
enum GuardKind : int {
  // Contacts.
  k_yield,         ///< overlap less that of yield [yield overlap]: >= 0
  k_reload,        ///< overlap less the largest one [R0]: >= 0
  k_made,          ///< overlap [R0]; under force F [F_max]: >= 0
  k_dent_touched,  ///< 1 - u; under force F [F_max]: >= 0
  k_lost,          ///< elastic: overlap [R0]; unloading: 1 - u; under force F [F_max]: <= 0. See also lost_guard()
  k_retreat,       ///< primary_branch_rate() [fastest wall]: <= 0

  // Edges of adhesive contacts, and extrema of their forces.
  k_turn,              ///< edge_rate(): changes sign, the edge stops receding or advancing
  k_peel,              ///< springs at a sticking edge, distance from tearing [stretch that tears them]: <= 0
  k_follow,            ///< springs at a sticking edge, displacement [stretch that tears them]: >= 0, not stretched
  k_pull_off,          ///< delta_1D or F less that of pull-off [that of pull-off]: <= 0
  k_greatest_tension,  ///< force_rate(): >= 0, a tension is greatest
  k_least_tension,     ///< force_rate(): <= 0, a tension is least
  k_tension_falls,     ///< force_rate() of a force at rest: >= 0, no event; the least tension comes next
  k_tension_rises,     ///< force_rate() of a force at rest: <= 0, no event; the greatest tension comes next

  // Free centre.
  k_unstable,  ///< centre_stiffness_guard(), while edges peel: <= 0
  k_softened,  ///< centre_stiffness() less its value at a fold, while plastic contacts are softened: <= 0

  // Growth and volume.
  k_growth_on,       ///< growth_drive(): >= 0
  k_growth_off,      ///< growth_drive(): <= 0
  k_caps,            ///< sine of the caps' angles less that between the normals: >= 0; its index is that of a pair
  k_singular,        ///< free surface [surface] while walls under force and centre move along: <= 0, growth runs away
  k_covered,         ///< free surface [surface] with walls and centre at rest: <= 0
  k_greatest_force,  ///< stiffness_over_initial() of a plastic contact under force: <= 0
  k_volume,          ///< 1 - 4 w over all contacts: <= 0, the volume is not defined
  k_centre_reached   ///< distance of a wall from the centre [R0]: <= 0
};

/// Distance of a guard from zero that may be an error of integration. Contacts along the directions of a free centre
/// open and close together, but their guards agree only to this. Where its course is known, a guard that ends farther
/// from zero does not fire.
inline constexpr double k_together = 1e-6;
/// Rate, of order one elsewhere, below which a wall or an edge is at rest: just after it has turned, its rate is an
/// error of integration, which k_at_rest does not cover.
inline constexpr double k_just_turned = 1e-8;
/// Growth ends where the free surface falls below this share of the particle's surface.
inline constexpr double k_least_slope = 1e-3;
/// A plastic contact under a prescribed force has reached its largest force when its stiffness is this share of that of
/// a shallow contact. Below this stiffness, the overlap would magnify errors of the radius a hundredfold and more.
inline constexpr double k_last_stiffness = 1e-2;

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
