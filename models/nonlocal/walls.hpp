/// Walls around an elastic sphere, the force on each of which moves the surface under all others, and the classes that
/// they form.
///
/// Lengths are over R, forces over E R^2. A class is a set of walls that share a history by symmetry.
/// Source: Agarwal and Gonzalez (2018), eqs. 17 and 18.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "nonlocal/coupling.hpp"
#include "system/walls.hpp"

namespace monograin::nonlocal {

/// Least angle between two walls [rad]. Eq. 18 is for a point force and diverges as the angle goes to zero.
constexpr double k_least_wall_angle = 0.05;

[[nodiscard]] inline Eigen::Index as_index(std::size_t index) noexcept { return static_cast<Eigen::Index>(index); }

struct Wall {
  Eigen::Vector3d normal;
  std::size_t contact_class;
};

/// Neighbours that act alike on the first wall of a class: walls of one class, at one angle from it.
struct Neighbours {
  std::size_t contact_class;
  double angle;
  double quotient;  ///< radius_quotient() of the angle
  int count;
};

/// Walls of all classes, class by class.
[[nodiscard]] std::vector<Wall> walls_of(std::span<const ContactClass> classes);

/// Mean normal of each class, one per column.
[[nodiscard]] Eigen::Matrix3Xd mean_normals_of(std::span<const ContactClass> classes);

/// Approach of each wall (row) per unit force on each wall (column).
/// @param classes  of the walls; their names stand in messages
/// @throws std::invalid_argument for walls that are the same or closer than k_least_wall_angle
[[nodiscard]] Eigen::MatrixXd influence_of(Influence influence, double poisson_ratio, std::span<const Wall> walls,
                                           std::span<const ContactClass> classes);

/// True if the force on a wall moves the surface away from another wall.
[[nodiscard]] bool has_negative_coupling(const Eigen::MatrixXd& influence) noexcept;

/// G: approach of a wall of the row's class per unit force on every wall of the column's class.
/// @throws std::invalid_argument for a class of which not every wall sees the same forces around it
[[nodiscard]] Eigen::MatrixXd coupling_of(const Eigen::MatrixXd& influence, std::span<const Wall> walls,
                                          std::span<const ContactClass> classes);

/// Neighbours of the first wall of each class.
[[nodiscard]] std::vector<std::vector<Neighbours>> neighbours_of(double poisson_ratio, std::span<const Wall> walls,
                                                                 std::size_t class_count);

/// Signed square s of each class from which its walls and others push each other off; infinite if they do not.
[[nodiscard]] std::vector<double> rivalry_of(const Eigen::MatrixXd& influence, double composite_modulus,
                                             std::span<const Wall> walls, std::size_t class_count);

}  // namespace monograin::nonlocal
