#include "cel/core_shape.hpp"

#include <cmath>

namespace monograin::cel {
namespace {

/// Part of a tensor outside of the basis that is rounding of the normals.
constexpr double k_nothing_new = 1e-9;

double contraction(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) noexcept { return a.cwiseProduct(b).sum(); }
Eigen::Matrix3d mean_product(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) noexcept {
  return 0.5 * (a * b + b * a);
}

}  // namespace

CoreShape::CoreShape(std::span<const Eigen::Matrix3d> spreads) {
  extend(Eigen::Matrix3d::Identity());
  for (const Eigen::Matrix3d& spread : spreads) extend(spread);
  bool has_grown = true;
  while (has_grown) {
    has_grown = false;
    for (std::size_t a = 0; a < basis_.size(); ++a) {
      for (std::size_t b = a; b < basis_.size(); ++b)
        has_grown = extend(mean_product(basis_[a], basis_[b])) || has_grown;
    }
  }
  dimension_ = basis_.size();
  for (const auto& c : basis_) {
    for (const auto& a : basis_) {
      for (const auto& b : basis_) products_.push_back(contraction(c, mean_product(a, b)));
    }
  }
}

/// Adds the part of a tensor that the basis has not. @return whether there is one
bool CoreShape::extend(const Eigen::Matrix3d& tensor) {
  if (basis_.size() == k_most) return false;
  Eigen::Matrix3d rest = tensor / tensor.norm();
  for (int pass = 0; pass < 2; ++pass) {
    for (const Eigen::Matrix3d& known : basis_) rest -= contraction(known, rest) * known;
  }
  if (rest.norm() <= k_nothing_new) return false;
  basis_.push_back(rest / rest.norm());
  return true;
}

CoreShape::Tensor CoreShape::of(const Eigen::Matrix3d& tensor) const noexcept {
  Tensor components{};
  for (std::size_t i = 0; i < dimension(); ++i) components[i] = contraction(basis_[i], tensor);
  return components;
}

CoreShape::Tensor CoreShape::unit() const noexcept { return {std::sqrt(3.0)}; }

CoreShape::Map CoreShape::product_with(const Tensor& b) const {
  Map map;
  for (auto factor = products_.begin(); factor != products_.end();) {
    double& sum = map.emplace_back(0.0);
    for (std::size_t j = 0; j < dimension(); ++j) sum += *factor++ * b[j];
  }
  return map;
}

CoreShape::Tensor CoreShape::apply(const Map& map, const Tensor& a) const noexcept {
  Tensor result{};
  auto factor = map.begin();
  for (std::size_t c = 0; c < dimension(); ++c) {
    for (std::size_t i = 0; i < dimension(); ++i) result[c] += a[i] * *factor++;
  }
  return result;
}

CoreShape::Tensor CoreShape::product(const Tensor& a, const Tensor& b) const noexcept {
  Tensor result{};
  auto factor = products_.begin();
  for (std::size_t c = 0; c < dimension(); ++c) {
    for (std::size_t i = 0; i < dimension(); ++i) {
      double sum = 0.0;
      for (std::size_t j = 0; j < dimension(); ++j) sum += *factor++ * b[j];
      result[c] += a[i] * sum;
    }
  }
  return result;
}

}  // namespace monograin::cel
