/// Directions in which a free centre can move, and the lines along which contact classes push it.
///
/// The centre can only move along the mean normals of the classes, because all walls of a class move alike. Classes of
/// parallel or opposite mean normals push it along one line. Their forces are summed up along that line before they are
/// resolved into components: the round-off of large forces that nearly cancel would otherwise act across the line,
/// where a soft contact may be all that bears. Directions that differ by no more than k_no_direction count as parallel;
/// the line is along their mean, whatever their order.
#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <span>
#include <string_view>
#include <vector>

#include "system/resolution.hpp"
#include "system/walls.hpp"

namespace monograin::contacts {

/// Names of the unknowns of a centre, along its free directions.
inline constexpr std::array<std::string_view, 3> k_centre_unknowns{"centre displacement 1", "centre displacement 2",
                                                                   "centre displacement 3"};

class CentreLines {
 public:
  /// Vectors and matrices along the free directions of the centre; entries beyond their number are zero.
  using Vector = Eigen::Vector3d;
  using Matrix = Eigen::Matrix3d;

  CentreLines() = default;
  /// @param is_free  false: nothing moves the centre
  CentreLines(std::span<const ContactClass> classes, bool is_free);

  /// Number of free directions, 0 to 3.
  [[nodiscard]] int free_directions() const noexcept { return free_directions_; }
  /// A vector along the free directions, in space.
  [[nodiscard]] Eigen::Vector3d in_space(const Vector& vector) const noexcept { return basis_ * vector; }
  [[nodiscard]] std::size_t classes() const noexcept { return mean_normals_.size(); }
  /// Mean normal of a class along the free directions.
  [[nodiscard]] const Vector& mean_normal(std::size_t i) const noexcept { return mean_normals_[i]; }
  /// True if the contacts of a class act on the centre.
  [[nodiscard]] bool acts(std::size_t i) const noexcept { return on_lines_[i].share != 0.0; }

  /// Number of lines. At least one: if no class acts on the centre, its direction is zero.
  [[nodiscard]] std::size_t size() const noexcept { return directions_.size(); }
  [[nodiscard]] const Vector& line_direction(std::size_t line) const noexcept { return directions_[line]; }
  /// Line of a class; line_direction() times share_on_line() is its mean normal.
  [[nodiscard]] std::size_t line_of(std::size_t i) const noexcept { return on_lines_[i].line; }
  [[nodiscard]] double share_on_line(std::size_t i) const noexcept { return on_lines_[i].share; }

  /// Orthonormal basis by Gram and Schmidt with pivots by stiffness: the first column along the stiffest line, the
  /// second along the line that is stiffest across the first, and so on; zero columns for directions without stiffness.
  /// Along directions in which only soft contacts bear, the forces of stiff contacts then have a component of zero, not
  /// of round-off.
  /// @param stiffness  line -> its stiffness
  template <class Stiffness>
  [[nodiscard]] Matrix stiffest_directions(Stiffness&& stiffness) const {
    Matrix basis = Matrix::Zero();
    for (int k = 0; k < free_directions_; ++k) {
      double most = 0.0;
      Vector next = Vector::Zero();
      for (std::size_t line = 0; line < size(); ++line) {
        const Vector across = directions_[line] - basis * (basis.transpose() * directions_[line]);
        const double strength = std::abs(stiffness(line)) * across.squaredNorm();
        if (strength <= most || across.norm() <= k_no_direction) continue;
        most = strength;
        next = across;
      }
      if (most == 0.0) break;
      next.normalize();
      basis.col(k) = (next - basis * (basis.transpose() * next)).normalized();
    }
    return basis;
  }
  /// Components of a line's direction in a basis, without round-off.
  [[nodiscard]] Vector components(const Matrix& basis, std::size_t line) const {
    const Vector raw = basis.transpose() * directions_[line];
    return (raw.array().abs() > k_round_off).select(raw, 0.0);
  }
  /// Displacement of the centre, along the directions of a basis, with which stiffnesses cancel forces; zero along
  /// directions in which the stiffness is round-off. Applies the pseudo-inverse of the stiffness matrix, whose diagonal
  /// is scaled to order one, so that soft directions are not cut off beside stiff ones.
  /// @param stiffness  line -> its stiffness
  /// @param force      line -> force along it
  template <class Stiffness, class Force>
  [[nodiscard]] Vector displacement_that_balances(const Matrix& basis, Stiffness&& stiffness, Force&& force) const {
    Matrix sum = Matrix::Zero();
    Vector load = Vector::Zero();
    Vector magnitudes = Vector::Zero();
    for (std::size_t line = 0; line < size(); ++line) {
      const Vector at = components(basis, line);
      sum += stiffness(line) * at * at.transpose();
      load += force(line) * at;
      magnitudes += std::abs(stiffness(line)) * at.cwiseAbs2();
    }
    const Vector scale = (magnitudes.array() > 0.0).select(magnitudes.array().rsqrt(), 0.0);
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(scale.asDiagonal() * sum * scale.asDiagonal());
    const double least = k_no_stiffness * solver.eigenvalues().cwiseAbs().maxCoeff();
    Vector result = Vector::Zero();
    for (int k = 0; k < 3; ++k) {
      if (std::abs(solver.eigenvalues()[k]) <= least) continue;
      const Vector direction = scale.cwiseProduct(solver.eigenvectors().col(k));
      result -= direction * (direction.dot(load) / solver.eigenvalues()[k]);
    }
    return basis * result;
  }

 private:
  struct OnLine {
    std::size_t line = 0;
    double share = 0.0;  ///< mean normal as a multiple of the line's direction; 0: acts along no line
  };

  int free_directions_ = 0;
  Matrix basis_ = Matrix::Zero();  ///< orthonormal, in the first columns
  std::vector<Vector> mean_normals_;
  std::vector<Vector> directions_;  ///< directions of the lines
  std::vector<OnLine> on_lines_;
};

}  // namespace monograin::contacts
