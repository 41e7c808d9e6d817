/// The equations of a particle, linearised about the state that was evaluated.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "cel/particle.hpp"

namespace monograin::cel {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Solves linear equations by Gaussian elimination with row scaling and pivoting.
/// @param equations  matrix, then two right sides, in whose place the solutions appear
/// @return the sign of the determinant
/// @throws DomainError if the matrix is singular
double eliminate(RowMatrix& equations);

/// Linear equations for changes of those unknowns up to the core that can move: coordinates, centre, and dents of
/// contacts that flow. Their determinant is positive at the unloaded particle.
class Tangent {
 public:
  /// Linearises the equations.
  /// @param core_flows  true: the core flows as the dents grow; false: it stays
  void set(const Particle& p, bool core_flows);
  /// Solves the equations for one or two right sides, in columns.
  /// @param solutions  for all unknowns up to the core; 0 for dents that rest
  /// @return the sign of the determinant
  double solve(const Eigen::MatrixX2d& right, Eigen::MatrixX2d& solutions);
  /// Rate of the displacement of a wall, by (K), and of a yield function.
  /// @param rates  of all unknowns up to the core, then Lam
  [[nodiscard]] double displacement_rate(std::size_t i, std::span<const double> rates) const noexcept {
    return rate_of(i, rates);
  }
  [[nodiscard]] double yield_rate(const Particle& p, std::size_t i, std::span<const double> rates);

 private:
  [[nodiscard]] std::span<double> new_row(std::size_t equation) noexcept;
  void add(const Particle& p, std::size_t i, const Slopes& by, double factor, std::span<double> row) const noexcept;
  void add_kinematics(const Particle& p, std::size_t i);
  void add_balance(const Particle& p, std::size_t equation);
  void add_yield(const Particle& p, std::size_t i);
  [[nodiscard]] double rate_of(std::size_t equation, std::span<const double> rates) const noexcept;

  // A row holds derivatives by the unknowns up to the core, by the coverage Om, and by the flow Lam.
  std::size_t om_column_ = 0, lam_column_ = 0;  ///< the last two
  RowMatrix residual_by_;
  Eigen::VectorXd Om_by_;  ///< derivatives of Om by the unknowns, and by Lam at the end
  Eigen::VectorXd l_by_flow_;
  Eigen::Matrix3d pushes_by_flow_;  ///< at given forces
  std::vector<std::size_t> moving_;
  Eigen::VectorXd flow_by_;  ///< Lam per rate of an unknown
  RowMatrix equations_;
};

}  // namespace monograin::cel
