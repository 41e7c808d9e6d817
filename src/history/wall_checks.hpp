/// Checks of the walls in a history: whether they leave the particle enough room, and whether they hold its centre.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>

#include "history/table.hpp"
#include "system/walls.hpp"

namespace monograin {

/// A wall as the boundary of a half-space: points x with normal . x <= distance.
struct WallPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, outward
  double distance = 0.0;                              ///< of the wall from the origin, along its normal [m]
};

/// Volume of the space between walls [m3], the intersection of their half-spaces.
/// @return infinity if the walls leave it open; 0 if they have passed each other
[[nodiscard]] double space_between(std::span<const WallPlane> all);

/// Warning where the walls leave the particle less space than its own volume, at the end of a step or of the run; empty
/// if they never do, or if they enclose nothing, as two opposite walls. A solid particle without pores then fills the
/// cell, and resists as a whole.
/// @param history  has a column `displacement` for each class
/// @param radius   initial radius R0 [m], > 0
[[nodiscard]] std::optional<std::string> space_warning(const Table& history, std::span<const ContactClass> classes,
                                                       double radius);

/// Warning where the walls push a fixed centre towards another wall, by more than 1 % of the largest force of a wall;
/// empty if they never do. A net force away from all walls, as that of a single wall, is no fault: no other wall could
/// balance it.
/// @param history  has a column `force` for each class; rows in which one is undefined do not count
[[nodiscard]] std::optional<std::string> balance_warning(const Table& history, std::span<const ContactClass> classes);

/// Warning where the walls squeeze a free particle out between them: its centre moves by much more than any wall; empty
/// if it does not, or if the history has no centre.
/// @param history  has a column `displacement` for each class
/// @param radius   initial radius R0 [m], > 0
[[nodiscard]] std::optional<std::string> escape_warning(const Table& history, std::span<const ContactClass> classes,
                                                        double radius);

}  // namespace monograin
