/// Which walls support a free centre, which prescribed forces they can balance, and how the centre evades the others.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "contacts/centre/obstacles.hpp"
#include "nonlocal/contacts.hpp"
#include "nonlocal/equations.hpp"
#include "system/resolution.hpp"

namespace monograin::nonlocal {

/// True if walls under displacement control with a gap below `near` can balance the prescribed forces.
[[nodiscard]] bool may_balance(const Contacts& contacts, std::span<const Target> targets, std::span<const double> y,
                               double near = k_infinity);
/// True if, in some free direction, all walls with a gap below s are shallower than s or under force control.
[[nodiscard]] bool is_held_softly(const Contacts& contacts, std::span<const Ramp> ramps, std::span<const double> y,
                                  double s);

/// Walls that may bear, sorted into those that support the centre and redundant ones. A redundant wall carries no force
/// in any equilibrium, because no non-negative combination of normals that includes its own vanishes: the centre can
/// leave it without approaching another one. A wall under force control never supports the centre.
class CentreSupport {
 public:
  explicit CentreSupport(const Contacts& contacts) : walls_(contacts.class_count()) { normals_.reserve(walls_.size()); }

  /// @param may_bear  class -> whether it may bear
  /// @param is_force  class -> whether it is under force control
  template <class MayBear, class IsForce>
  void sort(const Contacts& contacts, MayBear&& may_bear, IsForce&& is_force) {
    for (std::size_t j = 0; j < walls_.size(); ++j) walls_[j].may_bear = may_bear(j);
    find_redundant(contacts);
    for (std::size_t j = 0; j < walls_.size(); ++j) {
      walls_[j].holds = walls_[j].may_bear && !walls_[j].is_redundant && !is_force(j);
    }
  }
  /// Sorts walls with a gap below `near`, and walls whose prescribed force starts from zero or ends there.
  void sort_near(const Contacts& contacts, std::span<const Ramp> ramps, std::span<const double> y, double near);
  /// Sorts the walls of a state. Contacts so much shallower than the deepest that they carry nothing do not support the
  /// centre. If no contact is loaded yet, walls with a gap up to `gap` count.
  /// @return true if other walls under displacement control remain, which may move the centre
  [[nodiscard]] bool sort_loaded(const Contacts& contacts, std::span<const Target> targets, std::span<const double> y,
                                 double gap = 0.0);
  /// Sorts as sort_near(). True if touching walls could balance the prescribed forces that act a little later.
  [[nodiscard]] bool may_be_held(Contacts& contacts, std::span<const Ramp> ramps, std::span<const double> y,
                                 double near);

  [[nodiscard]] bool holds(std::size_t j) const noexcept { return walls_[j].holds; }
  [[nodiscard]] bool is_redundant(std::size_t j) const noexcept { return walls_[j].is_redundant; }
  [[nodiscard]] bool has_redundant_walls() const noexcept { return std::ranges::any_of(walls_, &Wall::is_redundant); }
  /// Projector on the directions in which the centre can move without changing the contacts that support it.
  [[nodiscard]] Eigen::Matrix3d unheld_directions(const Contacts& contacts) const;

 private:
  struct Wall {
    bool may_bear = false;
    bool did_bear = false;  ///< may_bear for which is_redundant was found
    bool is_redundant = false;
    bool holds = false;
  };

  void find_redundant(const Contacts& contacts);

  std::vector<Wall> walls_;
  std::vector<Eigen::Vector3d> normals_;  ///< work space of find_redundant()
};

/// Approach of a wall while no contact is loaded; exactly 0 if the wall touches up to round-off. The round-off is
/// relative to the distance of the centre, whatever the axes along which it moves.
[[nodiscard]] double free_approach(const contacts::Obstacle& wall, const Eigen::Vector3d& centre);
/// Moves the centre within the subspace of a projector to the nearest position where no wall overlaps the surface.
/// Walls are taken in turn; one that would overlap touches the surface from then on.
/// @return false, with the centre unchanged, if the walls leave no such position
[[nodiscard]] bool clear_walls(std::span<const contacts::Obstacle> walls, const Eigen::Matrix3d& projector,
                               Eigen::Vector3d& centre);
/// clear_walls(), repeated to remove the small overlap that the round-off of a long displacement leaves.
[[nodiscard]] bool release_centre(std::span<const contacts::Obstacle> walls, const Eigen::Matrix3d& projector,
                                  Eigen::Vector3d& centre);
/// Writes the position of the centre to a state, and the gaps that the walls then have.
void put_centre(const Contacts& contacts, std::span<const contacts::Obstacle> walls, const Eigen::Vector3d& centre,
                std::span<double> y);

}  // namespace monograin::nonlocal
