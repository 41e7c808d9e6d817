#include "cel/core.hpp"

#include <algorithm>
#include <cmath>

#include "cel/constants.hpp"
#include "system/resolution.hpp"

namespace monograin::cel {
namespace {

namespace fit = constants;

Eigen::Matrix3d symmetric(const Eigen::Matrix3d& a) noexcept { return 0.5 * (a + a.transpose()); }

Eigen::Matrix3d deviator(const Eigen::Matrix3d& a) noexcept {
  return a - a.trace() / 3.0 * Eigen::Matrix3d::Identity();
}

/// Adds to a basis the part of a tensor that lies outside of it.
/// @return whether there is such a part
bool extend(std::vector<Eigen::Matrix3d>& basis, const Eigen::Matrix3d& tensor) {
  if (basis.size() == 6) return false;  // a symmetric tensor has no more components
  Eigen::Matrix3d rest = tensor.normalized();
  for (int pass = 0; pass < 2; ++pass) {
    for (const Eigen::Matrix3d& known : basis) rest -= contraction(known, rest) * known;
  }
  if (rest.norm() <= k_same_direction) return false;
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

/// (cel-core), (cel-strength) and (cel-flow): s = sqrt(3/2 T:T)/2, S = Y (s0 + s1 e), Q = (s/S)^n2, and per Lam
///   C' = -2 sym(L C) with L = 3 n2/(8 n1) Q/s^2 T,   e' = n2 Q/(2 n1 s)
void CoreLoad::evaluate(double yield_stress) noexcept {
  Y = yield_stress;
  T = deviator(symmetric(core.C * pushes));
  per_S = 1.0 / (Y * (fit::s0 + fit::s1 * core.e));
  s = 0.5 * std::sqrt(1.5 * T.squaredNorm());
  // Pushes that balance each other in all directions leave only round-off, which has no direction.
  if (!(s > k_no_net_force * pushes.norm())) {
    s = per_s = use = Q = 0.0;
    flow = {};
    return;
  }
  per_s = 1.0 / s;
  use = s * per_S;
  Q = raised<fit::n2>(use);
  const double multiplier = static_cast<double>(fit::n2) / fit::n1 * Q * per_s;
  flow = {.C = -2.0 * multiplier * 0.375 * per_s * symmetric(T * core.C), .e = 0.5 * multiplier};
}

/// (cel-carried) and (cel-yield): tau = 3/4 n.T.n/s, z = min(max(-2 tau, 0), 1), b = z^2 (3 - 2 z),
///   weak = 1 - beta (s/S)^n3 b exp(-alpha/ab),   X = (F/(weak H))^n1,   f = (X + Q)^(1/n1) - 1
Yield yield_of(const Contact& contact, const CoreLoad& load, const Eigen::Matrix3d& wall) noexcept {
  Yield at;
  if (!(contact.F > 0.0)) return at;
  if (load.s > 0.0) {
    at.tau = 0.75 * load.per_s * contraction(wall, load.T);
    const double z = std::clamp(-2.0 * at.tau, 0.0, 1.0);
    at.b = z * z * (3.0 - 2.0 * z);
    if (at.b > 0.0) at.weak = 1.0 - fit::beta * raised<fit::n3>(load.use) * at.b * std::exp(-contact.alpha / fit::ab);
  }
  at.X = raised<fit::n1>(contact.F_over_H / at.weak);
  if (at.X + load.Q > 0.0) at.f = std::pow(at.X + load.Q, 1.0 / fit::n1) - 1.0;
  return at;
}

/// By dX = n1 X (dF/F - dH/H - dweak/weak) and dQ = n2 use^(n2-1) duse.
YieldSlopes slopes_of(const Yield& at, const Contact& contact, const CoreLoad& load, const Eigen::Matrix3d& wall,
                      const Eigen::Matrix3d& pushes_by_flow) noexcept {
  const double sum = at.X + load.Q;
  if (!(sum > 0.0) || !(contact.F > 0.0)) return {};
  const double by_X = (1.0 + at.f) * at.X / sum;
  YieldSlopes f{.by_F = by_X / contact.F, .by_H = -by_X / contact.H};
  if (!(load.s > 0.0)) return f;
  double by_use = (1.0 + at.f) / sum * (static_cast<double>(fit::n2) / fit::n1) * raised<fit::n2 - 1>(load.use);
  double by_tau = 0.0;
  if (at.b > 0.0) {
    const double by_weak = by_X / at.weak * (1.0 - at.weak);
    const double z = std::min(-2.0 * at.tau, 1.0);
    by_use += by_weak * fit::n3 / load.use;
    by_tau = by_weak / at.b * -12.0 * z * (1.0 - z);
    f.by_alpha = -by_weak / fit::ab;
  }
  const double by_s = by_use * load.per_S - by_tau * at.tau * load.per_s;
  Eigen::Matrix3d by_T = 0.375 * by_s * load.per_s * load.T;
  if (by_tau != 0.0) by_T += 0.75 * by_tau * load.per_s * deviator(wall);
  f.by_pushes = load.core.C * by_T;
  f.by_flow = contraction(by_T, load.flow.C * load.pushes) + contraction(f.by_pushes, pushes_by_flow) -
              by_use * load.use * load.per_S * load.Y * fit::s1 * load.flow.e;
  return f;
}

}  // namespace monograin::cel
