/// Equilibrium of a particle whose centre is free, under unilateral contacts with walls.
///
/// The centre c minimises a convex function: the energy of the contacts whose walls have a prescribed displacement,
/// less the work of the prescribed forces. Newton's method with the contacts' tangent stiffness finds the minimum. It
/// leaves directions undetermined in which no contact bears: there the centre stays where the mode began, unless idle
/// walls (which touch and bear nothing) would enter the particle; then it moves by the smallest displacement that
/// clears them. Walls carry a loose particle along in this way.
///
/// Overlaps below 1e-13 R0, and forces below the round-off of the balance, count as none. Lengths are over R0, forces
/// over any one unit.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "contacts/centre/centre_lines.hpp"
#include "contacts/centre/obstacles.hpp"

namespace monograin::contacts {

/// Part that a class of walls plays for a free centre in a mode.
enum class Role : std::uint8_t {
  away,     ///< its gap is too wide to close in this mode
  bearing,  ///< a contact of the class bears if it has an overlap
  idle      ///< the class bears nothing; a wall that touches pushes the centre along
};

/// Walls around a free centre at one instant of the program.
class CentreWalls {
 public:
  virtual ~CentreWalls() = default;

  struct Force {
    double value = 0.0;
    double slope = 0.0;  ///< dF/d(overlap), >= 0
  };
  /// Force that the program prescribes the walls of a class; none where it prescribes their displacement.
  [[nodiscard]] virtual std::optional<double> prescribed_force(std::size_t i) const = 0;
  /// Overlap that a contact would have with the centre at its initial position; negative for a gap.
  [[nodiscard]] virtual double overlap(std::size_t i) const = 0;
  /// Force of a contact at an overlap > 0.
  [[nodiscard]] virtual Force force(std::size_t i, double overlap) const = 0;
  /// Overlap under a force > 0; that at the end of the contact's branch if the branch bears less.
  [[nodiscard]] virtual double overlap_under(std::size_t i, double force) const = 0;

 protected:
  CentreWalls() = default;
  CentreWalls(const CentreWalls&) = default;
  CentreWalls& operator=(const CentreWalls&) = default;
};

class FreeCentre {
 public:
  using Vector = CentreLines::Vector;
  /// Smallest overlap (over R0) of a contact that bears; below, the contact is idle. A contact that closes by as much
  /// as k_resolution bears.
  static constexpr double k_bearing_overlap = 0.1 * k_resolution;
  explicit FreeCentre(std::span<const ContactClass> classes);

  /// Number of free directions, 0 to 3.
  [[nodiscard]] int free_directions() const noexcept { return lines_.free_directions(); }
  [[nodiscard]] const CentreLines& lines() const noexcept { return lines_; }
  /// Number of walls of a class.
  [[nodiscard]] double wall_count(std::size_t i) const noexcept { return counts_[i]; }
  /// n.c, by how much a displacement c of the centre deepens the contacts of a class.
  [[nodiscard]] double approach_by_centre(std::size_t i, const Vector& c) const noexcept {
    return lines_.mean_normal(i).dot(c);
  }
  [[nodiscard]] Eigen::Vector3d in_space(const Vector& c) const noexcept { return lines_.in_space(c); }

  /// Position of the centre in a mode.
  /// @param rest   position when the mode began
  /// @param guess  a position near to the solution
  /// @throws DomainError where prescribed forces drive it away: no wall is in the path
  [[nodiscard]] Vector equilibrium(const CentreWalls& walls, std::span<const Role> roles, const Vector& rest,
                                   const Vector& guess);
  /// Velocity of the centre at c; zero along directions in which no contact bears.
  /// @param rates  rates of the prescribed displacements and forces
  [[nodiscard]] Vector velocity(const CentreWalls& walls, std::span<const Role> roles, std::span<const double> rates,
                                const Vector& c);
  /// Decides the roles of the walls in the mode that begins now, from the equilibrium at an instant just after.
  /// @param c  in: position of the centre now; out: its position then
  void find_roles(const CentreWalls& now, const CentreWalls& then, Vector& c, std::span<Role> roles);
  /// Overlap that an idle wall would have if it did not push the centre; negative for a gap.
  /// @param c  present position of the centre
  [[nodiscard]] double unpushed_overlap(std::size_t i, const CentreWalls& walls, std::span<const Role> roles,
                                        const Vector& rest, const Vector& c);

 private:
  using Matrix = CentreLines::Matrix;
  /// Forces and stiffness along a line.
  struct Load {
    double force = 0.0;
    double stiffness = 0.0;
  };

  [[nodiscard]] bool acts(std::size_t i) const noexcept { return lines_.acts(i); }
  void sum_up(const CentreWalls& walls, std::span<const Role> roles, const Vector& c);
  [[nodiscard]] Vector net_force() const noexcept;
  [[nodiscard]] Matrix stiffest_directions() const;
  [[nodiscard]] std::optional<Vector> newton_step_if_held(const Vector& net) const;
  [[nodiscard]] Vector step(const Matrix& basis) const;
  [[nodiscard]] bool is_held() const noexcept;
  [[nodiscard]] Vector flight(const CentreWalls& walls, std::span<const Role> roles, const Vector& push,
                              const Vector& c) const;
  [[nodiscard]] double share_of_step(const CentreWalls& walls, std::span<const Role> roles, const Vector& c,
                                     const Vector& step);
  void regularize_stiffness(const CentreWalls& walls, std::span<const Role> roles, double force);
  [[nodiscard]] Vector balance(const CentreWalls& walls, std::span<const Role> roles, Vector c);
  [[nodiscard]] Matrix held_directions(const CentreWalls& walls, double least_overlap);
  [[nodiscard]] Vector with_loose_directions(const CentreWalls& walls, std::span<const Role> roles, const Vector& rest,
                                             const Vector& balanced, std::optional<std::size_t> ignored_wall);
  [[nodiscard]] bool clear_all_but(std::optional<std::size_t> ignored_wall, const CentreWalls& walls,
                                   std::span<const Role> roles, Vector& c);
  [[nodiscard]] double across_held(std::size_t i) const;

  CentreLines lines_;
  std::vector<double> counts_;  ///< walls of each class

  // Results of the last sum_up().
  std::vector<Load> loads_;     ///< loads along the lines
  std::vector<double> forces_;  ///< force of one wall of each class
  double round_off_ = 0.0;      ///< net force that is round-off
  bool is_held_ = false;        ///< contacts of comparable stiffness bear in all directions
  double prescribed_ = 0.0;     ///< sum of the magnitudes of prescribed forces
  // Work space, kept so that integrating allocates no memory.
  std::vector<double> overlaps_;
  std::vector<char> bears_;                  ///< whether a contact bears, as held_directions() has found last
  Matrix held_directions_ = Matrix::Zero();  ///< last result of held_directions()
  std::vector<Obstacle> to_clear_;
};

}  // namespace monograin::contacts
