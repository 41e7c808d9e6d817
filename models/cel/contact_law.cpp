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

/// Everything of a contact but its force and elastic displacement.
Contact at_limit(const Material& material, const Dent& dent, double l, double m) noexcept {
  const double root = std::sqrt(m);
  Contact at;
  const double square = dent.zeta * dent.zeta / (l * l);
  at.alpha = root * square;
  at.alpha_by = {.zeta = 2.0 * at.alpha / dent.zeta, .l = -2.0 * at.alpha / l, .m = 0.5 * at.alpha / m};
  at.H = pi * material.Y * dent.p * m * square;
  at.H_by = {.zeta = at.H * (dent.p_zeta / dent.p + 2.0 / dent.zeta), .l = -2.0 * at.H / l, .m = at.H / m};
  return at;
}

/// u_H, elastic displacement at the limit force, and its logarithmic derivatives.
struct LimitDisplacement {
  double u;
  Slopes log;
};
LimitDisplacement limit_displacement(const Material& material, const Dent& dent, const Contact& at) noexcept {
  const double rest = 1.0 - dent.q;
  const auto log_slope = [&](double Slopes::*by) { return at.H_by.*by / at.H - 0.5 * at.alpha_by.*by / at.alpha; };
  return {
      at.H / (2.0 * material.Es * std::sqrt(at.alpha) * rest),
      {.zeta = log_slope(&Slopes::zeta) + dent.q_zeta / rest, .l = log_slope(&Slopes::l), .m = log_slope(&Slopes::m)}};
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

  const double t = x / (x + k::x1);
  const double t_zeta = rate * k::x1 / ((x + k::x1) * (x + k::x1));
  const double grown = zeta * zeta - material.a_Y * material.a_Y;
  const double fading = 1.0 / (1.0 + x / k::x2);
  dent.h = zeta * zeta * (k::k0 * t * t + k::k1 * grown * fading);
  dent.h_zeta = 2.0 * dent.h / zeta + zeta * zeta *
                                          (2.0 * k::k0 * t * t_zeta + 2.0 * k::k1 * zeta * fading -
                                           k::k1 * grown * fading * fading * rate / k::x2);

  constexpr double c = k::pinf - k::pY;
  const double tau = x / (X * c);
  const double root = std::sqrt(tau);
  const double p_xi = k::pY + c * tau / ((1.0 + root) * (1.0 + root));
  const double p_xi_zeta = rate / (X * (1.0 + root) * (1.0 + root) * (1.0 + root));
  // The exponent k = 5 is written out in v^4 v, so that nothing is divided by h.
  static_assert(k::k == 5);
  const double per_h = p_xi / (k::ps * (dent.h + k::hs));
  const double v = per_h * dent.h;
  const double v4 = v * v * v * v;
  const double sum = 1.0 + v4 * v;
  const double v_zeta = per_h * (dent.h * p_xi_zeta / p_xi + dent.h_zeta * k::hs / (dent.h + k::hs));
  dent.p = p_xi * std::pow(sum, -1.0 / k::k);
  dent.p_zeta = dent.p * (p_xi_zeta / p_xi - v4 * v_zeta / sum);

  dent.q = std::exp(-k::q1 * dent.h) / 3.0;
  dent.q_zeta = -k::q1 * dent.q * dent.h_zeta;
  const double fresh = std::exp(-dent.h / k::hg);
  dent.Gam = 1.0 + k::gam * (1.0 - fresh);
  dent.Gam_zeta = k::gam / k::hg * fresh * dent.h_zeta;
  return dent;
}

Contact contact_at(const Material& material, const Dent& dent, double l, double m, double u) noexcept {
  Contact at = at_limit(material, dent, l, m);
  at.u = u;
  at.u_by.coordinate = 1.0;
  if (!(u > 0.0)) return at;
  const auto [limit, log] = limit_displacement(material, dent, at);
  const double power = 1.0 / (1.0 - dent.q);
  const double distance = std::log(u / limit);
  at.F_over_H = std::exp(power * distance);
  at.F = at.H * at.F_over_H;
  const auto slope = [&](double Slopes::*by) { return at.F * (at.H_by.*by / at.H - power * log.*by); };
  at.F_by = {.coordinate = power * at.F / u,
             .zeta = slope(&Slopes::zeta) + at.F * distance * power * power * dent.q_zeta,
             .l = slope(&Slopes::l),
             .m = slope(&Slopes::m)};
  at.area = at.alpha * std::exp(2.0 * dent.q * power * distance);
  at.stored = at.F * u * (1.0 - dent.q) / (2.0 - dent.q);
  return at;
}

Contact contact_under(const Material& material, const Dent& dent, double l, double m, double F) noexcept {
  Contact at = at_limit(material, dent, l, m);
  at.F = std::max(0.0, F);
  at.F_by.coordinate = 1.0;
  if (!(F > 0.0)) return at;
  const auto [limit, log] = limit_displacement(material, dent, at);
  at.F_over_H = F / at.H;
  const double distance = std::log(at.F_over_H);
  const double rest = 1.0 - dent.q;
  at.u = limit * std::exp(rest * distance);
  const auto slope = [&](double Slopes::*by) { return at.u * (log.*by - rest * at.H_by.*by / at.H); };
  at.u_by = {.coordinate = rest * at.u / F,
             .zeta = slope(&Slopes::zeta) - at.u * distance * dent.q_zeta,
             .l = slope(&Slopes::l),
             .m = slope(&Slopes::m)};
  at.area = at.alpha * std::exp(2.0 * dent.q * distance);
  at.stored = F * at.u * rest / (2.0 - dent.q);
  return at;
}

Advance advance_of(double l) noexcept {
  const double y = l - 1.0;
  const double root = std::sqrt(y * y + k::w * k::w);
  constexpr double same = -0.5 * (1.0 + k::chi);
  constexpr double other = 0.5 * (1.0 - k::chi);
  return {same * y + other * (root - k::w), same + other * y / root, other * k::w * k::w / (root * root * root)};
}

}  // namespace monograin::cel
