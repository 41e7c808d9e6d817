#include "numerics/legendre_series.hpp"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

namespace monograin {
namespace {

template <std::size_t count>
using Rule = boost::math::quadrature::gauss<double, count>;

// Last Legendre coefficients, over the largest one, below which a rate has converged. Its integral over the whole piece
// is accurate to the square of that, and to a fiftieth of it in between.
constexpr double k_tail = 1e-11;
// If the second half of the coefficients falls by less than k_flat, they are round-off, which shorter pieces have too.
// They may then be k_noise times as large.
constexpr double k_flat = 10.0;
constexpr double k_noise = 100.0;
// Largest result of reach(), if the coefficients show no limit.
constexpr double k_farthest = 2.0;

// Factors that depend on the degree only: their divisions would be most of the cost of a polynomial.
struct ByDegree {
  LegendreSamples growth{};     // k/(k + 1)
  LegendreSamples per_width{};  // 1/(2k + 1)

  constexpr ByDegree() {
    for (std::size_t k = 0; k < k_most_nodes; ++k) {
      const auto n = static_cast<double>(k);
      growth[k] = n / (n + 1.0);
      per_width[k] = 1.0 / (2.0 * n + 1.0);
    }
  }
};
constexpr ByDegree k_by_degree;

/// Advances Legendre polynomials from (P_(k-1), P_k) to (P_k, P_(k+1)); exact at -1 and 1.
void next_legendre(std::size_t k, double x, double& previous, double& legendre) noexcept {
  const double turned = x * legendre;
  const double after = turned + k_by_degree.growth[k] * (turned - previous);
  previous = legendre;
  legendre = after;
}

}  // namespace

const LegendreNodes& LegendreNodes::few() {
  static const LegendreNodes k_few(Rule<6>::abscissa(), Rule<6>::weights());
  return k_few;
}

const LegendreNodes& LegendreNodes::many() {
  static const LegendreNodes k_many(Rule<k_most_nodes>::abscissa(), Rule<k_most_nodes>::weights());
  return k_many;
}

LegendreNodes::LegendreNodes(std::span<const double> abscissae, std::span<const double> weights)
    : count(2 * abscissae.size()) {
  const std::size_t half = abscissae.size();
  for (std::size_t j = 0; j < count; ++j) {
    const std::size_t from_middle = j < half ? half - 1 - j : j - half;
    places[j] = (j < half ? -1.0 : 1.0) * abscissae[from_middle];
    double previous = 0.0;
    double legendre = 1.0;
    for (std::size_t k = 0; k < count; ++k) {
      to_coefficients[j][k] = 0.5 * (2.0 * static_cast<double>(k) + 1.0) * weights[from_middle] * legendre;
      next_legendre(k, places[j], previous, legendre);
    }
  }
  for (std::size_t j = 0; j < count; ++j) {
    if (j > 0) ahead[j].onward = (places[j] - place_before(j, 0)) / (place_before(j, 0) - place_before(j, 1));
    const std::size_t known = std::min(j + 1, k_known);
    for (std::size_t i = 0; i < known; ++i) {
      double slope_there = 0.0;
      const double value = cardinal(j, i, known, slope_there);
      const double distance = places[j] - place_before(j, i);
      ahead[j].values[i] = (1.0 - 2.0 * distance * slope_there) * value * value;
      ahead[j].slopes[i] = distance * value * value;
    }
  }
}

double LegendreNodes::place_before(std::size_t node, std::size_t back) const noexcept {
  return node > back ? places[node - 1 - back] : -1.0;
}

/// Value at a node of the polynomial that is 1 at the i-th of the last positions before it and 0 at the others.
/// @param slope  receives the slope of the polynomial at that i-th position
double LegendreNodes::cardinal(std::size_t node, std::size_t i, std::size_t known, double& slope) const noexcept {
  double value = 1.0;
  slope = 0.0;
  for (std::size_t m = 0; m < known; ++m) {
    if (m == i) continue;
    const double distance = place_before(node, i) - place_before(node, m);
    value *= (places[node] - place_before(node, m)) / distance;
    slope += 1.0 / distance;
  }
  return value;
}

void LegendreSeries::fit(const LegendreNodes& nodes, const LegendreSamples& samples) noexcept {
  count_ = nodes.count;
  coefficients_.fill(0.0);
  // The loop over a fixed number of coefficients adds zeros beyond the last one, and can be vectorised.
  for (std::size_t j = 0; j < count_; ++j) {
    for (std::size_t k = 0; k < k_most_nodes; ++k) coefficients_[k] += nodes.to_coefficients[j][k] * samples[j];
  }
  terms_ = count_;
  while (terms_ > 0 && coefficients_[terms_ - 1] == 0.0) --terms_;
}

double LegendreSeries::value(double t) const noexcept {
  double sum = 0.0;
  double previous = 0.0;
  double legendre = 1.0;
  for (std::size_t k = 0; k < terms_; ++k) {
    sum += coefficients_[k] * legendre;
    next_legendre(k, t, previous, legendre);
  }
  return sum;
}

double LegendreSeries::integral(double t) const noexcept {
  double sum = coefficients_[0] * (t + 1.0);
  double previous = 1.0;  // P_(k-1)
  double legendre = t;    // P_k
  for (std::size_t k = 1; k < count_; ++k) {
    const double before = previous;
    next_legendre(k, t, previous, legendre);
    sum += coefficients_[k] * (legendre - before) * k_by_degree.per_width[k];
  }
  return sum;
}

double LegendreSeries::rest(double negligible) const noexcept {
  double largest = 0.0;
  double last = 0.0;
  for (std::size_t n = 0; n < count_; ++n) {
    largest = std::max(largest, std::abs(coefficients_[n]));
    if (n + 2 >= count_) last = std::max(last, std::abs(coefficients_[n]));
  }
  return last > negligible ? last / largest : 0.0;
}

double LegendreSeries::reach(double negligible, double round_off) const noexcept {
  const double whole = largest();
  const double last = tail();
  const double allowed = std::max(k_tail * whole, 0.5 * negligible);
  const double noise = std::max(k_noise * k_tail * whole, round_off);
  const bool is_noise = largest_of(count_ / 2, count_ - 2) <= k_flat * last && last <= noise;
  if (is_noise || last == 0.0) return k_farthest;
  return std::pow(allowed / last, 1.0 / static_cast<double>(count_ - 1));
}

double LegendreSeries::tail() const noexcept {
  return std::abs(coefficients_[count_ - 1]) + std::abs(coefficients_[count_ - 2]);
}

double LegendreSeries::largest() const noexcept { return largest_of(0, count_); }

double LegendreSeries::largest_of(std::size_t begin, std::size_t end) const noexcept {
  double largest = 0.0;
  for (std::size_t k = begin; k < end; ++k) largest = std::max(largest, std::abs(coefficients_[k]));
  return largest;
}

}  // namespace monograin
