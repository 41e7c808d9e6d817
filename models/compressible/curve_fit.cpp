#include "compressible/curve_fit.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "system/resolution.hpp"

namespace monograin::compressible {
namespace {

constexpr double k_least_exponent = 0.05;
constexpr double k_greatest_exponent = 12.0;
constexpr std::size_t k_scanned_exponents = 60;
constexpr std::size_t k_scanned_transitions = 4;  // in each interval of the data
constexpr double k_least_force = 0.02;            // least force, over fm, of points of an unloading that count
constexpr int k_full_digits = std::numeric_limits<double>::digits;

/// A minimum of a function of one variable.
struct Minimum {
  double at = 0.0;
  double value = k_infinity;
};

/// Least value of a scan over equal steps, refined by Brent's method between the neighbours of that value.
template <class Function>
Minimum scanned_minimum(const Function& function, double begin, double end, std::size_t count) {
  const auto node = [&](std::size_t k) {
    return std::lerp(begin, end, static_cast<double>(k) / static_cast<double>(count - 1));
  };
  Minimum best;
  std::size_t best_at = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double value = function(node(k));
    if (!(value < best.value)) continue;
    best = {node(k), value};
    best_at = k;
  }
  const double below = node(best_at == 0 ? 0 : best_at - 1);
  const double above = node(std::min(best_at + 1, count - 1));
  const auto [at, value] = boost::math::tools::brent_find_minima(function, below, above, k_full_digits);
  return value < best.value ? Minimum{at, value} : best;
}

/// A curve with the weights of its points in the trapezoidal rule.
class Curve {
 public:
  Curve(std::span<const double> displacements, std::span<const double> forces) : d_(displacements), f_(forces) {
    weights_.assign(d_.size(), 0.0);
    for (std::size_t i = 1; i < d_.size(); ++i) {
      const double half = 0.5 * (d_[i] - d_[i - 1]);
      weights_[i - 1] += half;
      weights_[i] += half;
    }
  }

  [[nodiscard]] std::size_t size() const noexcept { return d_.size(); }
  [[nodiscard]] double displacement(std::size_t i) const noexcept { return d_[i]; }
  /// First interval in which the transition is sought: at least one point beyond d = 0 lies before it.
  [[nodiscard]] std::size_t first() const noexcept { return d_.front() > 0.0 ? 0 : 1; }

  /// Slope of the least-squares line through the origin and the points up to an index.
  [[nodiscard]] double slope_up_to(std::size_t last) const noexcept {
    double along = 0.0;
    double square = 0.0;
    for (std::size_t i = 0; i <= last; ++i) {
      along += weights_[i] * d_[i] * f_[i];
      square += weights_[i] * d_[i] * d_[i];
    }
    return along / square;
  }

  /// Least-squares k of the whole law for a transition and an exponent.
  [[nodiscard]] double best_slope(double transition, double exponent) const noexcept {
    const LoadingLaw unit{1.0, transition, exponent};
    double along = 0.0;
    double square = 0.0;
    for (std::size_t i = 0; i < d_.size(); ++i) {
      const double b = loading_force(unit, d_[i]);
      along += weights_[i] * b * f_[i];
      square += weights_[i] * b * b;
    }
    return along / square;
  }

  [[nodiscard]] double squared_error(const LoadingLaw& law) const noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < d_.size(); ++i) {
      const double difference = loading_force(law, d_[i]) - f_[i];
      sum += weights_[i] * difference * difference;
    }
    return sum;
  }

  [[nodiscard]] FitErrors errors(const LoadingLaw& law) const noexcept {
    double area = 0.0;
    double peak = 0.0;
    for (std::size_t i = 0; i < d_.size(); ++i) {
      area += weights_[i] * f_[i];
      peak = std::max(peak, std::abs(loading_force(law, d_[i]) - f_[i]));
    }
    return {std::sqrt(squared_error(law)) / area, peak / f_.back()};
  }

 private:
  std::span<const double> d_;
  std::span<const double> f_;
  std::vector<double> weights_;
};

/// A law with its error; all parameters but the transition are the best for that transition.
struct Candidate {
  LoadingLaw law;
  double error = k_infinity;  ///< squared
};

/// The best exponent for a slope and a transition.
Candidate with_best_exponent(const Curve& curve, double slope, double transition) {
  const auto error = [&](double exponent) { return curve.squared_error({slope, transition, exponent}); };
  const Minimum best = scanned_minimum(error, k_least_exponent, k_greatest_exponent, k_scanned_exponents);
  return {{slope, transition, best.at}, best.value};
}

/// The best slope and exponent for a transition.
Candidate with_best_pair(const Curve& curve, double transition) {
  const auto law = [&](double exponent) {
    return LoadingLaw{curve.best_slope(transition, exponent), transition, exponent};
  };
  const auto error = [&](double exponent) { return curve.squared_error(law(exponent)); };
  const Minimum best = scanned_minimum(error, k_least_exponent, k_greatest_exponent, k_scanned_exponents);
  return {law(best.at), best.value};
}

/// Least error over the transitions in the intervals of the data. Within an interval the error is smooth. The function
/// evaluates the middle of each interval, and searches the local minima together with their neighbours.
/// @param inner  Candidate(interval, transition)
template <class Inner>
Candidate over_intervals(const Curve& curve, const Inner& inner) {
  std::vector<double> middle(curve.size() + 1, k_infinity);  // interval i is at i + 1; the outer entries are empty
  for (std::size_t i = curve.first(); i + 1 < curve.size(); ++i) {
    const Candidate found = inner(i, std::midpoint(curve.displacement(i), curve.displacement(i + 1)));
    if (found.law.stiffness > 0.0) middle[i + 1] = found.error;
  }
  Candidate best;
  for (std::size_t i = curve.first(); i + 1 < curve.size(); ++i) {
    const auto is_low = [&](std::size_t k) {
      return k > 0 && k < curve.size() && middle[k] < k_infinity && middle[k] <= middle[k - 1] &&
             middle[k] <= middle[k + 1];
    };
    if (!is_low(i) && !is_low(i + 1) && !is_low(i + 2)) continue;
    // Open to the right, because the next point joins the linear part there.
    const double begin = curve.displacement(i);
    const double end = std::nextafter(curve.displacement(i + 1), begin);
    if (!(end > begin)) continue;
    const auto error = [&](double transition) { return inner(i, transition).error; };
    const Candidate found = inner(i, scanned_minimum(error, begin, end, k_scanned_transitions).at);
    if (found.law.stiffness > 0.0 && found.error < best.error) best = found;
  }
  return best;
}

}  // namespace

FitErrors fit_errors(const LoadingLaw& law, std::span<const double> displacements, std::span<const double> forces) {
  return Curve(displacements, forces).errors(law);
}

std::optional<LoadingFit> fit_nested(std::span<const double> displacements, std::span<const double> forces) {
  const Curve curve(displacements, forces);
  if (curve.size() < curve.first() + 3 || !(*std::ranges::max_element(forces) > 0.0)) return std::nullopt;
  const auto inner = [&](std::size_t interval, double transition) {
    return with_best_exponent(curve, curve.slope_up_to(interval), transition);
  };
  const Candidate best = over_intervals(curve, inner);
  if (best.error == k_infinity) return std::nullopt;
  return LoadingFit{best.law, curve.errors(best.law)};
}

LoadingFit fit_jointly(std::span<const double> displacements, std::span<const double> forces, const LoadingFit& start) {
  const Curve curve(displacements, forces);
  const auto inner = [&](std::size_t, double transition) { return with_best_pair(curve, transition); };
  const Candidate best = over_intervals(curve, inner);
  if (!(best.error < curve.squared_error(start.law))) return start;
  return {best.law, curve.errors(best.law)};
}

std::optional<UnloadingFit> fit_unloading(std::span<const double> displacements, std::span<const double> forces,
                                          double hertz_stiffness) {
  std::vector<double> d;
  std::vector<double> f;
  for (std::size_t i = 0; i < displacements.size(); ++i) {
    if (!(forces[i] > k_least_force * forces.front()) || displacements[i] > displacements.front()) continue;
    d.push_back(displacements[i]);
    f.push_back(forces[i]);
  }
  if (d.size() < 3) return std::nullopt;
  const double largest = d.front();
  const double lowest = *std::ranges::min_element(d);
  const auto curve_of = [&](double length, double exponent) {
    return UnloadingCurve{
        .largest = largest, .force = f.front(), .length = length, .exponent = exponent, .is_clipped = false};
  };
  const auto error_of = [&](double length, double exponent) {
    const UnloadingCurve curve = curve_of(length, exponent);
    double sum = 0.0;
    for (std::size_t i = 0; i < d.size(); ++i) {
      const double force = d[i] > curve.separation() ? unloading_force(curve, d[i]) : 0.0;
      sum += (force - f[i]) * (force - f[i]);
    }
    return sum;
  };
  const auto best_exponent = [&](double length) {
    return scanned_minimum([&](double exponent) { return error_of(length, exponent); }, 1.0, 6.0, 20);
  };
  // The curve ends between just below the last point and first touch.
  const double shortest = std::min(largest, (largest - lowest) * (1.0 + k_same_number));
  const double length =
      scanned_minimum([&](double trial) { return best_exponent(trial).value; }, shortest, largest, 100).at;
  const double recovery = std::cbrt(f.front() / hertz_stiffness);
  return UnloadingFit{largest - length, {best_exponent(length).at, recovery * recovery / length}};
}

}  // namespace monograin::compressible
