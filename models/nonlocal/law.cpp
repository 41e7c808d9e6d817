#include "nonlocal/law.hpp"

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "system/limit.hpp"
#include "system/resolution.hpp"

namespace monograin::nonlocal {
namespace {

template <std::size_t N>
double polynomial(const std::array<double, N>& coefficients, double x) noexcept {
  double value = 0.0;
  for (std::size_t i = N; i-- > 0;) value = value * x + coefficients[i];
  return value;
}

/// 4n/((2n-1)(2n+1)), the coefficient of a^(2n+1) in the force.
constexpr double force_coefficient(double n) noexcept { return 4.0 * n / ((2.0 * n - 1.0) * (2.0 * n + 1.0)); }

/// ((1 + a^2) artanh(a) - a)/a^3. The difference cancels for a small contact, which takes the series instead. At the
/// change-over, s = 0.1, the difference has lost three bits and the series is complete.
double sphere_force(double s, double artanh_over_radius) noexcept {
  if (s > 0.1) return ((1.0 + s) * artanh_over_radius - 1.0) / s;
  double sum = 0.0;
  for (int n = 16; n > 0; --n) sum = sum * s + force_coefficient(n);
  return sum;
}

/// Integral of f from 0 to `end`. The tolerance bounds the error estimate, which is that of the embedded Gauss rule;
/// the value is exact to round-off long before. The quadrature runs over the unit interval, because Boost 1.74 does not
/// scale the estimate with the length.
double integral(const auto& f, double end) {
  return end * boost::math::quadrature::gauss_kronrod<double, 31>::integrate([&](double x) { return f(end * x); }, 0.0,
                                                                             1.0, 15, 1e-9);
}

}  // namespace

LocalLaw::LocalLaw(Terms terms) noexcept
    : terms_(terms), end_(terms == Terms::all ? 1.0 : k_infinity), greatest_force_(end_) {
  if (terms == Terms::all) {
    greatest_force_ = at(std::nextafter(end_, 0.0)).force;
    return;
  }
  const auto count = static_cast<std::size_t>(terms);
  for (std::size_t i = 0; i < count; ++i) {
    const double n = static_cast<double>(i + 1);
    approach_[i] = 1.0 / (2.0 * n - 1.0);
    slope_[i] = n / (2.0 * n - 1.0);
    force_[i] = force_coefficient(n);
  }
  // int F (dg/da) da, with dg/da = 2a dg/ds.
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < count; ++k) {
      energy_[i + k] += 2.0 * force_[i] * slope_[k] / static_cast<double>(2 * (i + k) + 5);
    }
  }
}

LocalContact LocalLaw::at(double s) const {
  if (!(s < end_)) {
    throw DomainError({Limit::contact_as_wide_as_particle, -1, "contact radius/R0", std::sqrt(s)});
  }
  if (s <= 0.0) return {.approach = s, .approach_slope = 1.0, .force = 0.0, .contact_radius = 0.0};
  const double a = std::sqrt(s);
  if (terms_ == Terms::all) {
    // artanh(a) from 1 - a = (1 - s)/(1 + a): exact up to the end.
    const double ratio = 0.5 * std::log1p(2.0 * a * (1.0 + a) / (1.0 - s)) / a;
    return {.approach = s * ratio,
            .approach_slope = 0.5 * (ratio + 1.0 / (1.0 - s)),
            .force = a * s * sphere_force(s, ratio),
            .contact_radius = a};
  }
  return {.approach = s * polynomial(approach_, s),
          .approach_slope = polynomial(slope_, s),
          .force = a * s * polynomial(force_, s),
          .contact_radius = a};
}

/// Newton's method from above for an increasing and convex function: it decreases up to the root.
template <class Step>
double LocalLaw::descend(double x, Step&& step) const {
  for (;;) {
    const double next = x - step(x);
    if (!(next < x)) return x;
    x = next;
  }
}

double LocalLaw::signed_square(double approach) const {
  if (approach <= 0.0 || terms_ == Terms::one) return approach;
  // The law of two terms gives an upper bound, because all further terms are positive.
  double bound = 2.0 * approach / (1.0 + std::sqrt(1.0 + 4.0 / 3.0 * approach));
  if (terms_ == Terms::all) {
    // artanh(a) = g/a <= g/tanh(g), because a >= tanh(g).
    const double a = std::tanh(approach / std::tanh(approach));
    bound = std::min(bound, a * a);
  }
  return descend(bound, [&](double s) {
    const LocalContact contact = at(s);
    return (contact.approach - approach) / contact.approach_slope;
  });
}

double LocalLaw::signed_square_under(double force) const {
  if (!(force >= 0.0)) throw DomainError({Limit::wall_would_pull, -1, "force over composite modulus and R0^2", force});
  if (force == 0.0) return 0.0;
  if (force > greatest_force_) {
    throw DomainError({Limit::contact_as_wide_as_particle, -1, "force over composite modulus and R0^2", force});
  }
  double bound = std::cbrt(0.75 * force);  // Hertz's contact radius; all further terms are positive
  if (terms_ == Terms::all) {
    bound = std::min({bound, std::tanh(1.0 + force), std::nextafter(end_, 0.0)});  // artanh(a) - 1 < F
  }
  const double a = descend(bound, [&](double radius) {
    const LocalContact contact = at(radius * radius);
    return (contact.force - force) / (4.0 * radius * radius * contact.approach_slope);
  });
  return a * a;
}

double LocalLaw::energy(double s) const {
  const LocalContact contact = at(s);
  if (s <= 0.0) return 0.0;
  if (terms_ != Terms::all) return contact.contact_radius * s * s * polynomial(energy_, s);
  // The integrand is analytic in x = artanh(a) up to the end of the law.
  return integral(
      [&](double x) {
        const double a = std::tanh(x);
        return at(a * a).force * (a + x * (1.0 - a * a));
      },
      std::atanh(contact.contact_radius));
}

double LocalLaw::pressure(double s, double distance_squared) const {
  if (!(s < end_)) static_cast<void>(at(s));
  const double depth = s - distance_squared;
  if (s <= 0.0 || depth <= 0.0) return 0.0;
  // Sum of flat punches that come into contact one after another, p = (1/pi) int_r^a dg/sqrt(x^2 - r^2), with
  // u^2 = x^2 - r^2.
  return 2.0 / std::numbers::pi *
         integral([&](double u) { return at(distance_squared + u * u).approach_slope; }, std::sqrt(depth));
}

}  // namespace monograin::nonlocal
