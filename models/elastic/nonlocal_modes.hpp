/// Modes in which the path of a nonlocal equilibrium may turn back.
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <span>
#include <vector>

namespace monograin::nonlocal {

/// The matrix I - k^(1/2) G k^(1/2) of the stiffnesses dF/dg of walls and the influence of forces on them, whose
/// eigenvalues are those of the problem's own, unsymmetric matrix. Walls of a class have one stiffness: in a basis of
/// what classes do together, and of differences within them, the matrix falls into blocks that stay the same.
///
/// Owns its working memory: margin() and least_pivot() do not allocate, and one object is not to be used by several
/// threads.
class Modes {
 public:
  Modes() = default;
  /// @param influence   symmetric, over the walls
  /// @param class_of    for each wall; all walls of a class have the same surroundings
  /// @param of_classes  leave out the differences within classes
  Modes(const Eigen::MatrixXd& influence, std::span<const std::size_t> class_of, bool of_classes);

  /// The least eigenvalue.
  /// @param stiffness  of the classes
  [[nodiscard]] double margin(std::span<const double> stiffness);
  /// The least pivot of an elimination of the matrix less the shift; the first that is not positive, if there is one.
  [[nodiscard]] double least_pivot(std::span<const double> stiffness, double shift);

 private:
  struct Block {
    Eigen::MatrixXd coupling;
    std::vector<std::size_t> class_of;
    Eigen::MatrixXd matrix;         ///< its lower half; eliminated: pivots, and below them columns of L times them
    Eigen::VectorXd critical_mode;  ///< of the least eigenvalue, as it was found last
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigenvalues;
  };

  void set_roots(std::span<const double> stiffness) noexcept;
  void set_matrix(Block& block, double shift) const noexcept;
  [[nodiscard]] double eliminated(Block& block, double shift) const noexcept;
  [[nodiscard]] double least_eigenvalue(Block& block) const;

  std::vector<Block> blocks_;
  std::vector<double> roots_;  ///< of the stiffnesses
  std::size_t critical_ = 0;   ///< block that had the least eigenvalue
};

}  // namespace monograin::nonlocal
