/// How idle walls, which touch and bear nothing, move a free centre.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "contacts/centre/obstacles.hpp"
#include "nonlocal/contacts.hpp"
#include "nonlocal/equations.hpp"
#include "nonlocal/newton.hpp"
#include "nonlocal/support.hpp"

namespace monograin::nonlocal {

/// Finds equilibria in which loaded contacts constrain the centre in some directions only, or in none. The centre then
/// moves no further than idle walls push it.
class CentreSearch {
 public:
  explicit CentreSearch(const Contacts& contacts);

  /// Moves a state along the straight line of targets to the given ones. The path matters, because a wall that makes
  /// contact and leaves again keeps the centre where it has moved it. A step is accepted if the same walls touch all
  /// along it, and if its halves lead to the same position.
  /// @return false, with y unchanged, where no wall is idle, where loaded contacts hold the centre in every direction,
  /// or where further walls begin to bear on the path
  [[nodiscard]] bool follow(Contacts& contacts, std::span<const Target> targets, std::span<double> y);
  /// Moves the centre clear of all walls, so that no contact is loaded. No other state is in equilibrium then: its
  /// forces balance, and the cleared centre has no overlap, hence sum_j F_j d_j <= 0 and
  /// sum_j F_j g_j <= sum_jh F_j G_jh F_h. Wherever M is positive definite, the left side is the larger one.
  /// @return false, with y unchanged, if a wall has a prescribed force, or if the walls leave no such position
  [[nodiscard]] bool clear_all(const Contacts& contacts, std::span<const Target> targets, std::span<double> y);
  /// Moves the centre clear of redundant walls, in directions that leave the supporting contacts unchanged.
  /// @param is_closed  classes in contact by their regime; classes with s > 0 count as closed, too
  void clear_redundant(const Contacts& contacts, std::span<const Target> targets, std::span<const char> is_closed,
                       std::span<double> y);

 private:
  [[nodiscard]] bool clear_idle(Contacts& contacts, std::span<double> y);
  [[nodiscard]] bool go_to(Contacts& contacts, double share, double size, std::span<double> y);
  [[nodiscard]] bool try_step(Contacts& contacts, double done, double next, double size, bool may_be_cut);

  CentreSupport support_;
  Newton newton_;
  std::vector<contacts::Obstacle> obstacles_;
  std::vector<Target> starts_, ends_, targets_;  ///< of the path, and of a point on it
  std::vector<Target> released_;                 ///< targets_, with idle walls under no force
  std::vector<double> forces_;
  std::vector<double> trial_, deepest_;
  std::vector<double> carried_;                             ///< the path's last state
  std::vector<double> at_once_, by_halves_, early_, late_;  ///< states of a step from there
};

}  // namespace monograin::nonlocal
