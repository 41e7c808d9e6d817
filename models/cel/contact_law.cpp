#include "cel/contact_law.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "cel/constants.hpp"
#include "elastic/hertz.hpp"
#include "elastic/sphere_influence.hpp"
#include "system/resolution.hpp"

namespace monograin::cel {
namespace {

using std::numbers::pi;
namespace fit = constants;

/// Johnson's parameter of a Hertz contact over its mean pressure over Y.
constexpr double k_johnson_by_pressure = 3.0 * pi / 4.0;

/// Sine of half the angle, and last term of the series, of the self influence: part of the law's definition.
constexpr double k_self_half_sine = 0.2;
constexpr int k_last_term = 4000;

}  // namespace

Material::Material(double yield_stress, double poisson_ratio) noexcept
    : Y(yield_stress),
      Es(composite_modulus(1.0, poisson_ratio)),
      xi_Y(fit::pY * k_johnson_by_pressure),
      a_Y(xi_Y * Y / Es),
      xi_by_zeta(Es / Y) {}

/// With x = E* zeta/Y - xi_Y >= 0, by (cel-dent), (cel-pressure), (cel-limit) and (cel-influence) of
/// docs/theory/cel.md:
///   h = zeta^2 [k0 (x/(x + x1))^2 + k1 (zeta^2 - a_Y^2)/(1 + x/x2)]
///   p = p_xi (1 + v^k)^(-1/k),   v = p_xi h/(ps (h + hs)),   p_xi = pY + p_Delta tau/(1 + sqrt(tau))^2
///   q = exp(-q1 h)/3,            Gam = 1 + gam (1 - exp(-h/hg))
Dent dent_of(const Material& material, double zeta) noexcept {
  const double rate = material.xi_by_zeta;
  const double x = std::max(0.0, zeta * rate - material.xi_Y);
  Dent dent;
  dent.zeta = zeta;

  const double square = zeta * zeta;
  const double per_x = 1.0 / (x + fit::x1);
  const double t = x * per_x;
  const double t_zeta = rate * fit::x1 * per_x * per_x;
  const double grown = square - material.a_Y * material.a_Y;
  const double fading = fit::x2 / (fit::x2 + x);
  const double share = fit::k0 * t * t + fit::k1 * grown * fading;
  dent.h = square * share;
  dent.h_zeta = 2.0 * zeta * share + square * (2.0 * fit::k0 * t * t_zeta + 2.0 * fit::k1 * zeta * fading -
                                               fit::k1 * grown * fading * fading * rate / fit::x2);

  constexpr double p_Delta = fit::pinf - fit::pY;
  const double tau = x / (k_johnson_by_pressure * p_Delta);
  const double root = std::sqrt(tau);
  const double per_root = 1.0 / (1.0 + root);
  const double p_xi = fit::pY + p_Delta * tau * per_root * per_root;
  const double p_xi_log = rate * per_root * per_root * per_root / (k_johnson_by_pressure * p_xi);
  // The exponent k = 5 is written out in v^4 v, so that nothing is divided by h.
  static_assert(fit::k == 5);
  const double per_hs = 1.0 / (dent.h + fit::hs);
  const double per_h = p_xi * per_hs / fit::ps;
  const double v = per_h * dent.h;
  const double v4 = v * v * v * v;
  const double sum = 1.0 + v4 * v;
  const double v_zeta = v * p_xi_log + per_h * dent.h_zeta * fit::hs * per_hs;
  dent.p = p_xi * std::exp(std::log(sum) * (-1.0 / fit::k));
  dent.p_zeta = dent.p * (p_xi_log - v4 * v_zeta / sum);

  dent.q = std::exp(-fit::q1 * dent.h) / 3.0;
  dent.q_zeta = -fit::q1 * dent.q * dent.h_zeta;
  const double fresh = std::exp(-dent.h / fit::hg);
  dent.root_Gam = std::sqrt(1.0 + fit::gam * (1.0 - fresh));
  dent.root_Gam_zeta = 0.5 * fit::gam / fit::hg * fresh * dent.h_zeta / dent.root_Gam;
  return dent;
}

/// (cel-coverage), and the factor 1/(1 + kap Om^4) of (cel-influence).
Coverage coverage_of(double Om) noexcept {
  const double shade = 1.0 / (1.0 + fit::kap * raised<4>(Om));
  return {.Om = Om,
          .m = 1.0 - fit::m2 * Om * Om + fit::m4 * raised<4>(Om),
          .m_Om = -2.0 * fit::m2 * Om + 4.0 * fit::m4 * raised<3>(Om),
          .shade = shade,
          .shade_Om = -4.0 * fit::kap * raised<3>(Om) * shade * shade};
}

/// (cel-limit) and (cel-elastic): dF/du = F/((1 - q) u) = 2 E* sqrt(area).
Contact contact_by(const Material& material, const Dent& dent, double l, double m, double coordinate,
                   bool is_force) noexcept {
  const double rest = 1.0 - dent.q;
  const double root = std::sqrt(m);
  const double wide = dent.zeta / l;
  Contact at;
  at.alpha = root * wide * wide;
  at.H = pi * material.Y * dent.p * root * at.alpha;
  const double u_H = at.H / (2.0 * material.Es * std::sqrt(at.alpha) * rest);
  const Slopes log_alpha{.zeta = 2.0 / dent.zeta, .l = -2.0 / l, .m = 0.5 / m};
  const Slopes log_H = log_alpha + Slopes{.zeta = dent.p_zeta / dent.p, .m = 0.5 / m};
  const Slopes log_u_H = log_H - 0.5 * log_alpha + Slopes{.zeta = dent.q_zeta / rest};
  at.alpha_by = at.alpha * log_alpha;
  at.H_by = at.H * log_H;
  (is_force ? at.F_by : at.u_by).coordinate = 1.0;
  if (!(coordinate > 0.0)) {
    if (!is_force) at.u = coordinate;
    return at;
  }
  const double distance = is_force ? std::log(coordinate / at.H) : std::log(coordinate / u_H) / rest;  // ln(F/H)
  at.F_over_H = is_force ? coordinate / at.H : std::exp(distance);
  at.F = is_force ? coordinate : at.H * at.F_over_H;
  at.u = is_force ? u_H * std::exp(rest * distance) : coordinate;
  at.stored = at.F * at.u * rest / (2.0 - dent.q);
  // The stiffness is that of a flat punch, 2 E* times its radius.
  const double stiffness = at.F / (rest * at.u);
  const double radius = stiffness / (2.0 * material.Es);
  at.area = radius * radius;
  const Slopes log_u = log_u_H - rest * log_H - Slopes{.zeta = distance * dent.q_zeta};  // at a given force
  if (is_force) {
    at.u_by = at.u * log_u;
    at.u_by.coordinate = 1.0 / stiffness;
  } else {
    at.F_by = (-at.F / rest) * log_u;
    at.F_by.coordinate = stiffness;
  }
  return at;
}

/// (cel-advance): c = -[(1 + chi) y - (1 - chi) (sqrt(y^2 + w^2) - w)]/2 with y = l - 1. Away from y = 0,
/// c is near -y where the core shrinks (y < 0) and near -chi y where it bulges.
Advance advance_of(double growth) noexcept {
  const double root = std::sqrt(growth * growth + fit::w * fit::w);
  constexpr double odd = -0.5 * (1.0 + fit::chi);
  constexpr double even = 0.5 * (1.0 - fit::chi);
  const double per_root = 1.0 / root;
  return {odd * growth + even * (root - fit::w), odd + even * growth * per_root,
          even * fit::w * fit::w * per_root * per_root * per_root};
}

std::vector<Coupling> couplings_of(double poisson_ratio, std::span<const ContactClass> classes) {
  std::map<double, double> influences;  // by angle, each computed once
  const auto influence_at = [&](double angle) {
    const auto [at, is_new] = influences.try_emplace(std::round(angle / k_same_value));
    if (is_new) at->second = sphere_influence(poisson_ratio, angle);
    return at->second;
  };
  const double self = sphere_self_influence(poisson_ratio, k_self_half_sine, k_last_term);
  std::vector<Coupling> couplings;
  for (const ContactClass& c : classes) {
    const Eigen::Vector3d& normal = c.normals.front();
    for (const ContactClass& neighbour : classes) {
      Coupling& sum = couplings.emplace_back();
      for (const Eigen::Vector3d& other : neighbour.normals) {
        const double g = &other == &normal ? self : influence_at(angle_between(normal, other));
        const double mu = std::min(1.0, raised<2>(normal.dot(other)));
        sum.same += g * mu * mu;
        sum.mixed += g * mu * (1.0 - mu);
        sum.across += g * (1.0 - mu) * (1.0 - mu);
      }
    }
  }
  return couplings;
}

}  // namespace monograin::cel
