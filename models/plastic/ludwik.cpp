#include "plastic/ludwik.hpp"

#include <algorithm>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "plastic/compression.hpp"
#include "system/number_text.hpp"

namespace monograin::plastic {
namespace {

void require(bool holds, const std::string& demand, double value) {
  if (!holds) throw std::invalid_argument(demand + ", but is " + number_text(value));
}

/// Integrals over the strain range of a material, in e = strain/range.
class Moments {
 public:
  struct Pair {
    double plain, logarithmic;  ///< int sigma e^mu de, int sigma e^mu ln(e) de
  };

  Moments(const LudwikMaterial& material, double range) : material_(material), range_(range) {
    const double yield_strain = material.yield_stress / material.youngs_modulus;
    elastic_end_ = std::min(yield_strain / range, 1.0);
    elastic_stress_ = yield_strain < range ? material.yield_stress : material.youngs_modulus * range;
    if (yield_strain < range) end_ = end_of_range();
  }

  [[nodiscard]] Pair at(double mu) const {
    Pair sum{.plain = integral([&](double e, double stress) { return stress * std::pow(e, mu); }),
             .logarithmic = integral([&](double e, double stress) { return stress * std::pow(e, mu) * std::log(e); })};
    if (elastic_end_ > 0.0) {
      const double elastic = elastic_stress_ * std::pow(elastic_end_, mu + 1.0) / (mu + 2.0);
      sum.plain += elastic;
      sum.logarithmic += elastic * (std::log(elastic_end_) - 1.0 / (mu + 2.0));
    }
    return sum;
  }

  /// Root of int (sigma - strength eps^mu)^2 de.
  [[nodiscard]] double residual(double strength, double mu) const {
    const double scaled = strength * std::pow(range_, mu);
    double sum = integral([&](double e, double stress) {
      const double difference = stress - scaled * std::pow(e, mu);
      return difference * difference;
    });
    if (elastic_end_ > 0.0) {
      const double power = scaled * std::pow(elastic_end_, mu);
      sum += elastic_end_ * (elastic_stress_ * elastic_stress_ / 3.0 - 2.0 * elastic_stress_ * power / (mu + 2.0) +
                             power * power / (2.0 * mu + 1.0));
    }
    return std::sqrt(std::max(sum, 0.0));
  }

 private:
  // Along the plastic branch the stress is linear in t = eps_pl^(1/n).
  [[nodiscard]] double stress(double t) const noexcept { return material_.yield_stress + material_.hardening * t; }
  [[nodiscard]] double strain(double t) const noexcept {
    return std::pow(t, material_.exponent_inverse) + stress(t) / material_.youngs_modulus;
  }

  [[nodiscard]] double end_of_range() const {
    // The plastic strain alone is less than the total strain.
    const double most = std::pow(range_, 1.0 / material_.exponent_inverse);
    const auto excess = [&](double t) { return strain(t) - range_; };
    if (!(excess(most) > 0.0)) return most;  // rigid-plastic
    std::uintmax_t iterations = 200;
    const auto [below, above] =
        boost::math::tools::toms748_solve(excess, 0.0, most, boost::math::tools::eps_tolerance<double>(), iterations);
    return 0.5 * (below + above);
  }

  /// int f(e, stress) de along the plastic branch.
  template <class Function>
  [[nodiscard]] double integral(const Function& f) const {
    if (!(end_ > 0.0)) return 0.0;
    const double n = material_.exponent_inverse;
    const double elastic = material_.hardening / material_.youngs_modulus;
    const auto integrand = [&](double t) {
      const double e = strain(t) / range_;
      return e > 0.0 ? f(e, stress(t)) * (n * std::pow(t, n - 1.0) + elastic) / range_ : 0.0;
    };
    // The integrand is nearly singular at first yield, where the elastic strain is small and the plastic one even
    // smaller.
    return quadrature_.integrate(integrand, 0.0, end_, 1e-14);
  }

  LudwikMaterial material_;
  double range_;
  double elastic_end_ = 0.0;  ///< e at first yield, or 1
  double elastic_stress_ = 0.0;
  double end_ = 0.0;  ///< t at the end of the range; 0: the whole range is elastic
  mutable boost::math::quadrature::tanh_sinh<double> quadrature_;
};

/// The exponent in (0, 1) at which the condition turns from positive to negative.
template <class Condition>
double root(const Condition& condition) {
  std::uintmax_t iterations = 200;
  const auto [below, above] =
      boost::math::tools::toms748_solve(condition, 0.0, 1.0, boost::math::tools::eps_tolerance<double>(), iterations);
  return 0.5 * (below + above);
}

}  // namespace

double ludwik_stress(const LudwikMaterial& material, double plastic_strain) noexcept {
  return material.yield_stress + material.hardening * std::pow(plastic_strain, 1.0 / material.exponent_inverse);
}

HollomonMaterial fit_hollomon(const LudwikMaterial& material, double greatest_strain, HollomonFit fit) {
  const auto& [modulus, yield, hardening, n] = material;
  require(modulus > 0.0, "Young's modulus must be positive", modulus);
  require(yield >= 0.0 && std::isfinite(yield), "the yield stress must not be negative or infinite", yield);
  require(hardening >= 0.0 && std::isfinite(hardening), "the hardening K must not be negative or infinite", hardening);
  require(yield + hardening > 0.0, "the yield stress plus K must be positive", yield + hardening);
  require(n >= 1.0 && std::isfinite(n), "Ludwik's n must be finite and at least 1", n);
  require(greatest_strain > 0.0 && std::isfinite(greatest_strain), "the strain range must be positive and finite",
          greatest_strain);

  const Moments moments(material, greatest_strain);
  const double log_range = std::log(greatest_strain);
  // Both conditions are positive where a larger exponent fits better.
  if (fit == HollomonFit::both) {
    // Derivative with respect to the exponent, with the strength that fits best for each exponent.
    const auto condition = [&](double mu) {
      const auto [plain, logarithmic] = moments.at(mu);
      return logarithmic / plain + 1.0 / (2.0 * mu + 1.0);
    };
    // sigma/eps falls and sigma rises, which gives the condition these signs at the ends, up to round-off at a root.
    const double mu = condition(0.0) > 0.0 ? condition(1.0) < 0.0 ? root(condition) : 1.0 : 0.0;
    const double strength = (2.0 * mu + 1.0) * moments.at(mu).plain * std::exp(-mu * log_range);
    return {.strength = strength, .exponent = mu, .residual = moments.residual(strength, mu)};
  }
  const double strength = yield + hardening;
  const auto condition = [&](double mu) {
    const auto [plain, logarithmic] = moments.at(mu);
    const double scaled = strength * std::exp(mu * log_range) / (2.0 * mu + 1.0);
    return log_range * (plain - scaled) + logarithmic + scaled / (2.0 * mu + 1.0);
  };
  const double round_off = 1e-13 * strength;  // ideal plasticity has its root at 0, linear hardening at 1
  const double at_none = condition(0.0);
  const double at_linear = condition(1.0);
  if (at_none < -round_off || at_linear > round_off) {
    throw std::domain_error("no exponent in [0, 1] fits best with the strength Y + K = " + number_text(strength) +
                            " up to a strain of " + number_text(greatest_strain));
  }
  const double mu = at_none <= round_off ? 0.0 : at_linear >= -round_off ? 1.0 : root(condition);
  return {.strength = strength, .exponent = mu, .residual = moments.residual(strength, mu)};
}

}  // namespace monograin::plastic
