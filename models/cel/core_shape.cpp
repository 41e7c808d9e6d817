#include "cel/core_shape.hpp"

namespace monograin::cel {
namespace {

/// Part of a unit tensor outside of the basis that is round-off of the normals.
constexpr double k_nothing_new = 1e-9;
constexpr std::size_t k_most_shapes = 6;  ///< components of a symmetric tensor

/// Adds to a basis the part of a tensor that lies outside of it.
/// @return whether there is such a part
bool extend(std::vector<Eigen::Matrix3d>& basis, const Eigen::Matrix3d& tensor) {
  if (basis.size() == k_most_shapes) return false;
  Eigen::Matrix3d rest = tensor.normalized();
  for (int pass = 0; pass < 2; ++pass) {
    for (const Eigen::Matrix3d& known : basis) rest -= contraction(known, rest) * known;
  }
  if (rest.norm() <= k_nothing_new) return false;
  basis.push_back(rest.normalized());
  return true;
}

}  // namespace

std::vector<Eigen::Matrix3d> core_shapes(std::span<const Eigen::Matrix3d> spreads) {
  std::vector<Eigen::Matrix3d> basis;
  extend(basis, Eigen::Matrix3d::Identity());
  for (const Eigen::Matrix3d& spread : spreads) extend(basis, spread);
  for (bool has_grown = true; has_grown;) {
    has_grown = false;
    for (std::size_t a = 0; a < basis.size(); ++a) {
      for (std::size_t b = a; b < basis.size(); ++b)
        has_grown = extend(basis, symmetric(basis[a] * basis[b])) || has_grown;
    }
  }
  if (basis.size() == 1) basis.clear();
  return basis;
}

}  // namespace monograin::cel
