/// Shapes that the core of a particle can take among given walls.
///
/// The core yields by stresses that the walls make of its own shape. So its shape stays among the symmetric tensors
/// that arise from the walls' normals by sums and by products a b + b a: two of them for two walls or a die, three for
/// walls along three axes, six in general. Tensors are given by their components in an orthonormal basis of these, of
/// which the first is the unit tensor over sqrt(3): all others are deviators.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace monograin::cel {

class CoreShape {
 public:
  static constexpr std::size_t k_most = 6;
  /// Components of a symmetric tensor; those beyond dimension() are zero.
  using Tensor = std::array<double, k_most>;

  /// @param spreads  sum of n n over the walls of each class
  explicit CoreShape(std::span<const Eigen::Matrix3d> spreads);

  /// 1 where the walls load the core by pressures only.
  [[nodiscard]] std::size_t dimension() const noexcept { return dimension_; }
  /// Components of what a tensor has in common with the basis.
  [[nodiscard]] Tensor of(const Eigen::Matrix3d& tensor) const noexcept;
  /// Linear map of a tensor to one.
  using Map = std::vector<double>;
  /// The unit tensor.
  [[nodiscard]] Tensor unit() const noexcept;
  /// a -> (a b + b a)/2 for a given b.
  [[nodiscard]] Map product_with(const Tensor& b) const;
  [[nodiscard]] Tensor apply(const Map& map, const Tensor& a) const noexcept;
  /// (a b + b a)/2.
  [[nodiscard]] Tensor product(const Tensor& a, const Tensor& b) const noexcept;
  /// sum of a_ij b_ij.
  [[nodiscard]] double dot(const Tensor& a, const Tensor& b) const noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < dimension(); ++i) sum += a[i] * b[i];
    return sum;
  }
  /// A tensor times a number, without its pressure.
  [[nodiscard]] Tensor deviator(const Tensor& a, double factor) const noexcept {
    Tensor result{};
    for (std::size_t i = 1; i < dimension(); ++i) result[i] = factor * a[i];
    return result;
  }
  /// Adds a tensor times a number to a sum.
  void add(const Tensor& a, double factor, Tensor& sum) const noexcept {
    for (std::size_t i = 0; i < dimension(); ++i) sum[i] += factor * a[i];
  }

 private:
  bool extend(const Eigen::Matrix3d& tensor);

  std::vector<Eigen::Matrix3d> basis_;
  std::size_t dimension_ = 0;     ///< size of the basis
  std::vector<double> products_;  ///< of the tensors of the basis, component by component
};

}  // namespace monograin::cel
