#include "elastic/sphere_influence.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <numbers>

namespace monograin {
namespace {

using std::numbers::pi;

/// Integral from zero. The tolerance bounds the error estimate of the embedded Gauss rule; the value is exact to
/// round-off long before.
double integral(const auto& f, double end) {
  return boost::math::quadrature::gauss_kronrod<double, 31>::integrate(f, 0.0, end, 8, 1e-12);
}

/// Legendre coefficients of 4 pi times the inward normal displacement of a sphere under a point force,
///   (2n+1) u_n = alpha + (1 + nu)/(n - 1) + (p n + q)/((n + b)^2 + omega^2),   n = 0, 2, 3, ...
/// 1/(n - 1) and (p n + q)/((n + b)^2 + omega^2) are integrals int_0^inf exp(-n y) f(y) dy, of exp(y) and of kernel(y).
struct SphereModes {
  double nu, alpha, p, q, b, omega;

  explicit SphereModes(double poisson_ratio) noexcept
      : nu(poisson_ratio),
        alpha(4.0 * (1.0 - nu) * (1.0 + nu)),
        p((1.0 + nu) * (1.0 - 8.0 * nu * (1.0 - nu))),
        q((1.0 + nu) * (nu * (4.0 * nu - 1.0) - 2.0)),
        b(nu + 0.5),
        omega(std::sqrt(0.75 - nu * nu)) {}

  [[nodiscard]] double kernel(double y) const noexcept {
    return std::exp(-b * y) * (p * std::cos(omega * y) + (q - p * b) / omega * std::sin(omega * y));
  }
  [[nodiscard]] double mode_zero() const noexcept { return 1.0 - 2.0 * nu; }
  /// Coefficient of ln(1 + 1/sin(theta/2)), that is, of 1/n for large n.
  [[nodiscard]] double logarithm() const noexcept { return 2.0 * (1.0 + nu) * (1.0 - 2.0 * nu) * (1.0 - 2.0 * nu); }
};

/// Integral from `begin` to infinity of a function that decays like exp(-2 y). One Gauss-Kronrod rule on each of a few
/// pieces is exact to round-off.
double decaying_integral(const auto& f, double begin) {
  constexpr std::array k_ends{0.1, 1.0, 4.0, 12.0, 40.0};
  double sum = 0.0;
  for (const double end : k_ends) {
    if (end <= begin) continue;
    sum += boost::math::quadrature::gauss_kronrod<double, 31>::integrate(f, begin, end, 0);
    begin = end;
  }
  return sum;
}

}  // namespace

double angle_between(const Eigen::Vector3d& first, const Eigen::Vector3d& second) noexcept {
  return std::atan2(first.cross(second).norm(), first.dot(second));
}

double sphere_influence(double poisson_ratio, double theta) {
  const SphereModes modes(poisson_ratio);
  const double s = std::sin(0.5 * theta);
  const double cosine = std::cos(theta);
  // The kernel times the generating function sum_n exp(-n y) P_n = 1/D without its first two terms.
  const auto rest = [&](double y) {
    const double t = std::exp(-y);
    const double decay = -std::expm1(-y);
    return modes.kernel(y) * (1.0 / std::sqrt(decay * decay + 4.0 * t * s * s) - 1.0 - t * cosine);
  };
  const double constant = modes.alpha * (0.5 / s - cosine - 1.0) + modes.mode_zero();
  const double translation = (1.0 + modes.nu) * (1.0 - 2.0 * s - cosine - cosine * std::log(s * (1.0 + s)));
  // The integrand bends within y ~ theta.
  const double bend = std::min(theta, 1.0);
  const double sum = constant + translation + integral(rest, bend) + decaying_integral(rest, bend);
  return -sum / (4.0 * pi);
}

double sphere_self_influence(double poisson_ratio) {
  const SphereModes modes(poisson_ratio);
  // The modes without alpha and without the 1/n of the logarithm, n >= 2; sum_n (1/(n-1) - 1/n) = 1.
  const auto rest = [&](double y) { return (modes.kernel(y) - modes.p) * std::exp(-2.0 * y) / -std::expm1(-y); };
  const double sum = modes.mode_zero() - 2.0 * modes.alpha - modes.logarithm() + 1.0 + modes.nu + integral(rest, 1.0) +
                     decaying_integral(rest, 1.0);
  return -sum / (4.0 * pi);
}

double sphere_self_influence(double poisson_ratio, double half_sine, int last) {
  const SphereModes m(poisson_ratio);
  // The modes beyond `last`, from their expansion in 1/n; the sum starts halfway between two terms.
  const double square = 1.0 + m.nu + m.q - 2.0 * m.b * m.p;
  const double cube = 1.0 + m.nu + m.p * (3.0 * m.b * m.b - m.omega * m.omega) - 2.0 * m.b * m.q;
  const double first = last + 0.5;
  const double beyond = (square + 0.5 * cube / first) / first;
  const double logarithm = m.logarithm() * std::log(half_sine * (1.0 + half_sine));
  return sphere_self_influence(poisson_ratio) + (beyond + logarithm) / (4.0 * pi);
}

}  // namespace monograin
