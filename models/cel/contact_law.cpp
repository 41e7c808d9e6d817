#include "cel/contact_law.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cel/constants.hpp"
#include "elastic/hertz.hpp"

namespace monograin::cel {
namespace {

using std::numbers::pi;
namespace k = constants;

constexpr double X = 3.0 * pi / 4.0;

/// The contact of a dent at no force, and its elastic displacement u_H at the limit force.
struct AtLimit {
  Contact contact;
  double u_H;
  Slopes log_H, log_u_H;  ///< logarithmic derivatives
};
AtLimit at_limit(const Material& material, const Dent& dent, double l, double m) noexcept {
  const double root = std::sqrt(m);
  const double wide = dent.zeta / l;
  const double rest = 1.0 - dent.q;
  const double per_zeta = 1.0 / dent.zeta;
  const double per_l = 1.0 / l;
  const double per_m = 1.0 / m;
  const double p_log = dent.p_zeta / dent.p;
  AtLimit at{.contact = {},
             .u_H = 0.0,
             .log_H = {.zeta = p_log + 2.0 * per_zeta, .l = -2.0 * per_l, .m = per_m},
             .log_u_H = {.zeta = p_log + per_zeta + dent.q_zeta / rest, .l = -per_l, .m = 0.75 * per_m}};
  Contact& contact = at.contact;
  contact.alpha = root * wide * wide;
  contact.alpha_by = {
      .zeta = 2.0 * contact.alpha * per_zeta, .l = -2.0 * contact.alpha * per_l, .m = 0.5 * contact.alpha * per_m};
  contact.H = pi * material.Y * dent.p * root * contact.alpha;
  contact.H_by = {.zeta = contact.H * at.log_H.zeta, .l = contact.H * at.log_H.l, .m = contact.H * at.log_H.m};
  at.u_H = contact.H / (2.0 * material.Es * std::sqrt(contact.alpha) * rest);
  return at;
}

/// Area over pi: the stiffness is that of a flat punch, 2 E* times its radius.
double area_of(const Material& material, double stiffness) noexcept {
  const double radius = stiffness / (2.0 * material.Es);
  return radius * radius;
}

}  // namespace

Material::Material(double yield_stress, double poisson_ratio) noexcept
    : Y(yield_stress),
      Es(composite_modulus(1.0, poisson_ratio)),
      xi_Y(k::pY * X),
      a_Y(xi_Y * Y / Es),
      xi_by_zeta(Es / Y) {}

Dent dent_of(const Material& material, double zeta) noexcept {
  const double rate = material.xi_by_zeta;
  const double x = std::max(0.0, zeta * rate - material.xi_Y);
  Dent dent;
  dent.zeta = zeta;

  const double square = zeta * zeta;
  const double per_x = 1.0 / (x + k::x1);
  const double t = x * per_x;
  const double t_zeta = rate * k::x1 * per_x * per_x;
  const double grown = square - material.a_Y * material.a_Y;
  const double fading = k::x2 / (k::x2 + x);
  const double share = k::k0 * t * t + k::k1 * grown * fading;
  dent.h = square * share;
  dent.h_zeta = 2.0 * zeta * share + square * (2.0 * k::k0 * t * t_zeta + 2.0 * k::k1 * zeta * fading -
                                               k::k1 * grown * fading * fading * rate / k::x2);

  constexpr double c = k::pinf - k::pY;
  const double tau = x / (X * c);
  const double root = std::sqrt(tau);
  const double per_root = 1.0 / (1.0 + root);
  const double p_xi = k::pY + c * tau * per_root * per_root;
  const double p_xi_log = rate * per_root * per_root * per_root / (X * p_xi);
  // The exponent k = 5 is written out in v^4 v, so that nothing is divided by h.
  static_assert(k::k == 5);
  const double per_hs = 1.0 / (dent.h + k::hs);
  const double per_h = p_xi * per_hs / k::ps;
  const double v = per_h * dent.h;
  const double v4 = v * v * v * v;
  const double sum = 1.0 + v4 * v;
  const double v_zeta = v * p_xi_log + per_h * dent.h_zeta * k::hs * per_hs;
  dent.p = p_xi * std::exp(std::log(sum) * (-1.0 / k::k));
  dent.p_zeta = dent.p * (p_xi_log - v4 * v_zeta / sum);

  dent.q = std::exp(-k::q1 * dent.h) / 3.0;
  dent.q_zeta = -k::q1 * dent.q * dent.h_zeta;
  const double fresh = std::exp(-dent.h / k::hg);
  dent.Gam = 1.0 + k::gam * (1.0 - fresh);
  dent.Gam_zeta = k::gam / k::hg * fresh * dent.h_zeta;
  return dent;
}

Contact contact_at(const Material& material, const Dent& dent, double l, double m, double u) noexcept {
  const auto [limit, u_H, log_H, log_u_H] = at_limit(material, dent, l, m);
  Contact at = limit;
  at.u = u;
  at.u_by.coordinate = 1.0;
  if (!(u > 0.0)) return at;
  const double power = 1.0 / (1.0 - dent.q);
  const double distance = power * std::log(u / u_H);
  at.F_over_H = std::exp(distance);
  at.F = at.H * at.F_over_H;
  at.F_by = {.coordinate = power * at.F / u,
             .zeta = at.F * (log_H.zeta + power * (distance * dent.q_zeta - log_u_H.zeta)),
             .l = at.F * (log_H.l - power * log_u_H.l),
             .m = at.F * (log_H.m - power * log_u_H.m)};
  at.area = area_of(material, at.F_by.coordinate);
  at.stored = at.F * u * (1.0 - dent.q) / (2.0 - dent.q);
  return at;
}

Contact contact_under(const Material& material, const Dent& dent, double l, double m, double F) noexcept {
  const auto [limit, u_H, log_H, log_u_H] = at_limit(material, dent, l, m);
  Contact at = limit;
  at.F = std::max(0.0, F);
  at.F_by.coordinate = 1.0;
  if (!(F > 0.0)) return at;
  at.F_over_H = F / at.H;
  const double rest = 1.0 - dent.q;
  const double distance = std::log(at.F_over_H);
  at.u = u_H * std::exp(rest * distance);
  at.u_by = {.coordinate = rest * at.u / F,
             .zeta = at.u * (log_u_H.zeta - rest * log_H.zeta - distance * dent.q_zeta),
             .l = at.u * (log_u_H.l - rest * log_H.l),
             .m = at.u * (log_u_H.m - rest * log_H.m)};
  at.area = area_of(material, 1.0 / at.u_by.coordinate);
  at.stored = F * at.u * rest / (2.0 - dent.q);
  return at;
}

Advance advance_of(double growth) noexcept {
  const double root = std::sqrt(growth * growth + k::w * k::w);
  constexpr double same = -0.5 * (1.0 + k::chi);
  constexpr double other = 0.5 * (1.0 - k::chi);
  const double per_root = 1.0 / root;
  return {same * growth + other * (root - k::w), same + other * growth * per_root,
          other * k::w * k::w * per_root * per_root * per_root};
}

}  // namespace monograin::cel
