/// Modes in which the path of a nonlocal equilibrium may turn back.
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <span>
#include <vector>

namespace monograin::nonlocal {

/// The matrix I - k^(1/2) G k^(1/2) of the stiffnesses dF/dg of walls and the influence of forces on them, whose
/// eigenvalues are those of the problem's own, unsymmetric matrix. All walls of a class have one stiffness. In a basis
/// of the common motions of classes and of differences within them, the matrix therefore splits into blocks, the same
/// ones at every state.
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
  /// Smallest pivot of an elimination of the matrix minus the shift; the first that is not positive, if there is one.
  [[nodiscard]] double least_pivot(std::span<const double> stiffness, double shift);

 private:
  struct Block {
    Eigen::MatrixXd coupling;
    std::vector<std::size_t> class_of;
    Eigen::MatrixXd matrix;         ///< lower half; once eliminated: pivots, and below them columns of L times them
    Eigen::VectorXd critical_mode;  ///< mode of the least eigenvalue found last
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigenvalues;
  };

  void set_roots(std::span<const double> stiffness) noexcept;
  void set_matrix(Block& block, double shift) const noexcept;
  [[nodiscard]] double eliminated(Block& block, double shift) const noexcept;
  [[nodiscard]] double least_eigenvalue(Block& block) const;

  std::vector<Block> blocks_;
  std::vector<double> roots_;  ///< square roots of the stiffnesses
  std::size_t critical_ = 0;   ///< block that had the least eigenvalue
};

}  // namespace monograin::nonlocal
