#include "numerics/intervals.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <random>
#include <tuple>
#include <utility>

#include "numerics/quantile.hpp"

namespace monograin {
namespace {

constexpr double k_quadratic = 0.2;   // relative error of the predicted rise that makes an interval a tenth too wide
constexpr double k_kink_share = 0.7;  // a kink shows this share of the difference at two standard errors already at one
constexpr double k_less = 1e-3;       // fall of the cost at a better point, over the rise at one standard error
constexpr double k_end = 3e-3;        // accuracy of an interval's end, over the half-width
constexpr int k_most_steps = 12;
constexpr std::size_t k_least_rows = 20;

/// Profiles of one fit.
class Profile {
 public:
  Profile(const LeastSquaresProblem& problem, const LeastSquaresSolution& solution, const Uncertainty& uncertainty)
      : problem_(problem), solution_(solution), uncertainty_(uncertainty), residuals_(problem.residual_count) {}

  struct Point {
    double value = 0.0;
    double rise = 0.0;  ///< rise of the cost over that at one standard error; infinite without residuals
    std::vector<double> parameters;
  };

  /// Rise of the cost at given parameters, over that at one standard error; infinite without residuals.
  [[nodiscard]] double rise_at(std::span<const double> parameters) {
    ++evaluations_;
    if (!problem_.residuals(parameters, residuals_)) return std::numeric_limits<double>::infinity();
    const double rise = rise_of(cost_of(problem_, residuals_));
    keep_better({parameters.begin(), parameters.end()}, rise);
    return rise;
  }

  /// Minimises the cost with the k-th parameter held. @param start  all parameters, with the held value of the k-th
  [[nodiscard]] Point refit(std::size_t k, std::vector<double> start) {
    if (start.size() == 1) return {start[0], rise_at(start), start};
    const double value = start[k];
    const LeastSquaresProblem held = with_held(problem_, k, value);
    LocalMinimum others;
    others.parameters = start;
    others.parameters.erase(others.parameters.begin() + static_cast<std::ptrdiff_t>(k));
    for (std::size_t j = 0; j < others.parameters.size(); ++j) {
      others.parameters[j] = std::clamp(others.parameters[j], held.parameters[j].lower, held.parameters[j].upper);
    }
    const auto found = minimise_near(held, {&others, 1}, Accuracy::rough);
    evaluations_ += found ? found->evaluations : 1;
    if (!found) return {value, std::numeric_limits<double>::infinity(), std::move(start)};
    std::vector<double> all = found->parameters;
    all.insert(all.begin() + static_cast<std::ptrdiff_t>(k), value);
    const double rise = rise_of(found->cost);
    keep_better(all, rise);
    return {value, rise, std::move(all)};
  }

  /// Parameters where the k-th is moved by a distance, and the cost is least as far as its shape says.
  [[nodiscard]] std::vector<double> predicted(std::size_t k, double distance) const {
    std::vector<double> parameters = from_->parameters;
    const auto column = static_cast<Eigen::Index>(k);
    const double variance = uncertainty_.cost_covariance(column, column);
    for (std::size_t j = 0; j < parameters.size(); ++j) {
      const double both = uncertainty_.cost_covariance(static_cast<Eigen::Index>(j), column);
      if (std::isfinite(both)) parameters[j] += distance * both / variance;
    }
    return parameters;
  }

  [[nodiscard]] bool is_inside(std::span<const double> parameters) const {
    for (std::size_t j = 0; j < parameters.size(); ++j) {
      const BoundedParameter& bounds = problem_.parameters[j];
      if (!(parameters[j] >= bounds.lower && parameters[j] <= bounds.upper)) return false;
    }
    return true;
  }

  /// Lets the profile begin at another minimum.
  void begin_at(const LocalMinimum& minimum) { from_ = &minimum; }

  /// End of the k-th interval on one side: value at which the profile has risen by that of t standard errors.
  /// @param is_cut  receives whether the search ended at the bound, or gave up, before that rise
  [[nodiscard]] double end(std::size_t k, bool is_above, bool& is_cut) {
    const double best = from_->parameters[k];
    const double bound = is_above ? problem_.parameters[k].upper : problem_.parameters[k].lower;
    is_cut = true;
    if (best == bound) return bound;
    const double error = uncertainty_.standard_error(k);
    const double range = std::abs(bound - best);
    double step =
        std::isfinite(error) && error > 0.0 ? std::min(uncertainty_.half_width(k), range) : k_first_step * range;
    const double t = uncertainty_.t_quantile_of(k) * uncertainty_.excess_over_cost(k);
    Point inner{best, rise_of(from_->cost), from_->parameters};
    Point outer;
    for (int count = 0;; ++count) {  // outwards
      const double value = step >= range ? bound : best + (is_above ? step : -step);
      outer = refit(k, moved(inner, k, value));
      if (outer.rise >= t * t) break;
      if (value == bound || count == k_most_steps) return value;
      inner = outer;
      step *= std::clamp(1.1 * t / std::sqrt(std::max(outer.rise, 0.01)), 1.2, 4.0);
    }
    is_cut = false;
    // The square root of the rise is nearly linear in the value.
    const auto excess = [t](const Point& point) { return std::sqrt(std::max(point.rise, 0.0)) - t; };
    double low = excess(inner);
    double high = std::min(excess(outer), k_far * t);
    for (int count = 0; count < k_most_steps; ++count) {
      const double share = low / (low - high);
      const Point point = refit(k, moved(inner, k, std::lerp(inner.value, outer.value, share)));
      const double found = excess(point);
      if (std::abs(found) <= k_end * t) return point.value;
      if (found < 0.0) {
        inner = point;
        low = found;
        high *= 0.5;  // the end that stays has less weight (the Illinois method)
      } else {
        outer = point;
        high = std::min(found, k_far * t);
        low *= 0.5;
      }
    }
    return std::lerp(inner.value, outer.value, 0.5);
  }

  [[nodiscard]] const std::optional<LocalMinimum>& better() const noexcept { return better_; }
  [[nodiscard]] long evaluations() const noexcept { return evaluations_; }

 private:
  static constexpr double k_first_step = 0.01;  // over the range
  static constexpr double k_far = 3.0;          // largest excess over t that guides the search

  [[nodiscard]] double rise_of(double cost) const { return (cost - solution_.cost) / uncertainty_.rise; }

  void keep_better(std::vector<double> parameters, double rise) {
    if (!(rise < -k_less)) return;
    const double cost = solution_.cost + rise * uncertainty_.rise;
    if (!better_ || cost < better_->cost) better_ = LocalMinimum{std::move(parameters), cost};
  }

  /// Start of the fit for another value of the k-th parameter: the others are extrapolated in proportion.
  [[nodiscard]] std::vector<double> moved(const Point& from, std::size_t k, double value) const {
    std::vector<double> start = from.parameters;
    const std::vector<double>& first = from_->parameters;
    const double done = from.value - first[k];
    if (done != 0.0) {
      const double factor = (value - first[k]) / done;
      for (std::size_t j = 0; j < start.size(); ++j) start[j] = first[j] + factor * (from.parameters[j] - first[j]);
    } else if (std::isfinite(uncertainty_.standard_error(k)) && uncertainty_.standard_error(k) > 0.0) {
      start = predicted(k, value - first[k]);
    }
    start[k] = value;
    return start;
  }

  const LeastSquaresProblem& problem_;
  const LeastSquaresSolution& solution_;
  const Uncertainty& uncertainty_;
  const LocalMinimum* from_ = &solution_;  ///< where the profile begins
  std::vector<double> residuals_;
  std::optional<LocalMinimum> better_;
  long evaluations_ = 0;
};

/// True if a minimum is so low that it belongs to the interval of a parameter.
bool is_low(const LeastSquaresSolution& solution, const LocalMinimum& minimum, const Uncertainty& uncertainty,
            std::size_t k) {
  const double t = uncertainty.t_quantile_of(k) * uncertainty.excess_over_cost(k);
  return (minimum.cost - solution.cost) / uncertainty.rise < t * t;
}

/// Extends intervals to those around another minimum that lies outside of one of them.
void extend(Profile& profile, const LeastSquaresSolution& solution, const LocalMinimum& minimum,
            const Uncertainty& uncertainty, std::vector<Interval>& intervals) {
  const auto lies_outside = [&](std::size_t k) {
    return minimum.parameters[k] < intervals[k].lower || minimum.parameters[k] > intervals[k].upper;
  };
  bool is_outside = false;
  for (std::size_t k = 0; k < intervals.size(); ++k) is_outside = is_outside || lies_outside(k);
  if (!is_outside) return;
  profile.begin_at(minimum);
  for (std::size_t k = 0; k < intervals.size() && !profile.better(); ++k) {
    if (!uncertainty.is_determined[k] || !is_low(solution, minimum, uncertainty, k)) continue;
    Interval& interval = intervals[k];
    bool is_cut = false;
    const double lower = profile.end(k, false, is_cut);
    if (lower < interval.lower) std::tie(interval.lower, interval.is_cut_below) = std::pair(lower, is_cut);
    const double upper = profile.end(k, true, is_cut);
    if (upper > interval.upper) std::tie(interval.upper, interval.is_cut_above) = std::pair(upper, is_cut);
  }
}

}  // namespace

std::optional<ValueBeside> value_beside(const LeastSquaresSolution& solution, const Uncertainty& uncertainty) {
  std::optional<ValueBeside> farthest;
  double largest = 1.0;  // distance over the half-width
  for (const LocalMinimum& other : solution.minima) {
    for (std::size_t k = 0; k < other.parameters.size(); ++k) {
      const double value = other.parameters[k];
      const double distance = std::abs(value - solution.parameters[k]) / uncertainty.half_width(k);
      if (!(distance > largest) || !is_low(solution, other, uncertainty, k)) continue;
      largest = distance;
      farthest = ValueBeside{k, value};
    }
  }
  return farthest;
}

CostCheck check_cost(const LeastSquaresProblem& problem, const LeastSquaresSolution& solution,
                     const Uncertainty& uncertainty) {
  Profile profile(problem, solution, uncertainty);
  CostCheck check;
  double largest = k_quadratic;
  double largest_at_one = 0.0;
  double largest_at_two = 0.0;
  for (std::size_t k = 0; k < solution.parameters.size(); ++k) {
    if (!(uncertainty.standard_error(k) > 0.0)) continue;
    bool differs = false;
    for (const double t : {2.0, -2.0, 1.0, -1.0}) {
      const std::vector<double> place = profile.predicted(k, t * uncertainty.standard_error(k));
      if (!profile.is_inside(place)) continue;  // a bound cuts the profile there
      if (std::abs(t) == 1.0 && !differs) continue;
      // At a kink, refitting finds a lower cost beside the direction of the covariance.
      const double ratio = profile.refit(k, place).rise / std::pow(t * uncertainty.excess_over_cost(k), 2);
      const double difference = std::abs(ratio - 1.0);
      differs = differs || difference > k_quadratic;
      double& of_distance = std::abs(t) == 1.0 ? largest_at_one : largest_at_two;
      of_distance = std::max(of_distance, difference);
      if (!(difference > largest)) continue;
      largest = difference;
      check.parameter = k;
      check.ratio = ratio;
      check.at = t;
    }
  }
  if (check.at != 0.0) {
    check.shape = largest_at_one >= k_kink_share * largest_at_two ? CostShape::kinked : CostShape::curved;
  }
  check.better = profile.better();
  check.evaluations = profile.evaluations();
  return check;
}

ProfileIntervals profile_intervals(const LeastSquaresProblem& problem, const LeastSquaresSolution& solution,
                                   const Uncertainty& uncertainty) {
  Profile profile(problem, solution, uncertainty);
  ProfileIntervals result;
  constexpr double k_none = std::numeric_limits<double>::quiet_NaN();
  const bool has_size = uncertainty.standard_deviation > 0.0;
  for (std::size_t k = 0; k < solution.parameters.size() && !profile.better(); ++k) {
    Interval interval{.lower = k_none, .upper = k_none};
    if (has_size && uncertainty.is_determined[k]) {
      interval.lower = profile.end(k, false, interval.is_cut_below);
      interval.upper = profile.end(k, true, interval.is_cut_above);
    }
    result.intervals.push_back(interval);
  }
  for (const LocalMinimum& other : solution.minima) {
    if (profile.better()) break;
    if (has_size) extend(profile, solution, other, uncertainty, result.intervals);
  }
  result.better = profile.better();
  result.evaluations = profile.evaluations();
  return result;
}

Interval Bootstrap::interval(std::size_t parameter, double level) const {
  std::vector<double> values;
  for (const std::vector<double>& sample : samples) values.push_back(sample[parameter]);
  std::ranges::sort(values);
  return {.lower = quantile(values, 0.5 * (1.0 - level)), .upper = quantile(values, 0.5 * (1.0 + level))};
}

double Bootstrap::standard_error(std::size_t parameter) const {
  const auto count = static_cast<double>(samples.size());
  double mean = 0.0;
  for (const std::vector<double>& sample : samples) mean += sample[parameter] / count;
  double squares = 0.0;
  for (const std::vector<double>& sample : samples) squares += std::pow(sample[parameter] - mean, 2);
  return std::sqrt(squares / (count - 1.0));
}

Bootstrap bootstrap(const LeastSquaresProblem& problem, const LeastSquaresSolution& solution,
                    const Uncertainty& uncertainty, std::size_t n, std::size_t block, std::size_t count,
                    std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  const std::size_t p = solution.parameters.size();
  const double inflation = std::sqrt(static_cast<double>(n) / static_cast<double>(n - p));
  const auto deviation = [&](std::size_t i) {
    return uncertainty.deviations.empty() ? 1.0 : uncertainty.deviations[i];
  };
  std::vector<double> alike(solution.residuals.begin(), solution.residuals.begin() + static_cast<std::ptrdiff_t>(n));
  for (std::size_t i = 0; i < n; ++i) alike[i] /= deviation(i);
  const double mean = std::accumulate(alike.begin(), alike.end(), 0.0) / static_cast<double>(n);
  std::vector<double> change(solution.residuals.size());  // change of the residuals by resampled data
  LeastSquaresProblem again = problem;
  again.progress = {};
  again.residuals = [&problem, &change](std::span<const double> parameters, std::span<double> residuals) {
    if (!problem.residuals(parameters, residuals)) return false;
    for (std::size_t i = 0; i < residuals.size(); ++i) residuals[i] += change[i];
    return true;
  };
  Bootstrap result;
  const double done_by_sample = 1.0 / static_cast<double>(count);
  for (std::size_t sample = 0; sample < count; ++sample) {
    for (std::size_t i = 0; block == 0 && i < n; ++i) {
      change[i] = deviation(i) * uncertainty.standard_deviation * normal(generator) - solution.residuals[i];
    }
    for (std::size_t i = 0; block > 0 && i < n;) {
      std::size_t from = std::uniform_int_distribution<std::size_t>(0, n - 1)(generator);
      for (std::size_t k = 0; k < block && i < n; ++k, ++i, ++from) {
        change[i] = deviation(i) * inflation * (alike[from % n] - mean) - solution.residuals[i];
      }
    }
    for (std::size_t i = n; i < change.size(); ++i) {
      change[i] = uncertainty.standard_deviation * normal(generator) - solution.residuals[i];
    }
    const LocalMinimum& start = solution;
    const auto found = minimise_near(again, {&start, 1}, Accuracy::rough);
    if (!found) continue;
    result.evaluations += found->evaluations;
    result.samples.push_back(found->parameters);
    if (problem.progress) problem.progress(done_by_sample * static_cast<double>(sample + 1));
  }
  return result;
}

std::optional<ResidualTests> test_residuals(std::span<const double> all) {
  std::vector<double> residuals;
  std::ranges::remove_copy(all, std::back_inserter(residuals), 0.0);
  if (residuals.size() < k_least_rows) return std::nullopt;
  const auto n = static_cast<double>(residuals.size());
  ResidualTests tests;
  double positive = 0.0;
  double squares = 0.0;
  double neighbours = 0.0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    positive += residuals[i] > 0.0 ? 1.0 : 0.0;
    squares += residuals[i] * residuals[i];
    if (i > 0) neighbours += residuals[i] * residuals[i - 1];
    if (i == 0 || (residuals[i] > 0.0) != (residuals[i - 1] > 0.0)) ++tests.runs;
  }
  const double negative = n - positive;
  if (positive == 0.0 || negative == 0.0) return std::nullopt;
  const boost::math::normal normal;
  const auto two_sided = [&normal](double z) {
    return 2.0 * boost::math::cdf(boost::math::complement(normal, std::abs(z)));
  };
  const double excess = 2.0 * positive * negative / n;
  tests.expected_runs = excess + 1.0;
  const double variance = excess * (excess - 1.0) / (n - 1.0);
  if (variance > 0.0)
    tests.runs_p = two_sided((static_cast<double>(tests.runs) - tests.expected_runs) / std::sqrt(variance));
  tests.correlation = neighbours / squares;
  tests.correlation_p = two_sided(tests.correlation * std::sqrt(n));
  return tests;
}

}  // namespace monograin
