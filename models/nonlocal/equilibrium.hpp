/// Search for the equilibrium of the contacts at an instant of the program.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "nonlocal/centre.hpp"
#include "nonlocal/contacts.hpp"
#include "nonlocal/equations.hpp"
#include "nonlocal/newton.hpp"

namespace monograin::nonlocal {

/// Owns its working memory, so that searches do not allocate. Two threads must not use one object at once.
class EquilibriumSearch {
 public:
  explicit EquilibriumSearch(const Contacts& contacts);

  /// Finds the state at the coordinate xi of a step of the program (ramps over R and E R^2). Uses Newton's method;
  /// where that does not contract, or would leave the branch, approaches the state in smaller steps.
  /// @param y  in: a state on the physical branch, the nearer the better, or the unloaded state (s = -gap, u = 0),
  /// which is always on it. Out: the solution that is connected with that state. Unchanged if this throws.
  /// @param is_own_mode  true if the contacts that are loaded in y are also the loaded ones of the solution
  /// @throws std::domain_error naming the numbers for a state beyond the limit of applicability, a negative force, or a
  /// centre that nothing supports
  void solve(Contacts& contacts, std::span<const Ramp> ramps, double xi, std::span<double> y, bool is_own_mode = false);

  /// Moves the centre to the nearest position where no wall under displacement control overlaps the surface, and sets y
  /// accordingly. If there is no such position, or a wall is under a force, the centre evades only redundant walls, in
  /// directions that leave the supporting contacts unchanged. With a fixed centre, sets the gaps of open walls from the
  /// forces on the others.
  /// @param is_closed  classes in contact by their regime; classes with s > 0 count as closed, too
  void clear_centre(Contacts& contacts, std::span<const Ramp> ramps, double xi, std::span<const char> is_closed,
                    std::span<double> y);

 private:
  void close_gaps(Contacts& contacts, std::span<const char> is_closed, std::span<double> y) const;
  [[nodiscard]] double shrinkage(Contacts& contacts, std::span<const double> y);
  [[nodiscard]] bool balance_from(Contacts& contacts, std::span<double> y, double factor);
  void approach_in_steps(Contacts& contacts, std::span<double> y);
  [[noreturn]] void throw_no_state(Contacts& contacts, bool is_on_branch, double done) const;
  [[nodiscard]] bool descend_to_balance(Contacts& contacts, std::span<double> y);

  CentreSearch centre_;
  Newton newton_;
  std::vector<Target> targets_;
  std::vector<Target> starts_, between_;  ///< of the path in steps, and of a point on it
  std::vector<double> trial_, state_;
};

}  // namespace monograin::nonlocal
