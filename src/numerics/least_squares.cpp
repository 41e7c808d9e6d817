#include "numerics/least_squares.hpp"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit_nlinear.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace monograin {
namespace {

constexpr std::size_t k_most_scanned = 1089;  // of the scan: 33 x 33
constexpr std::size_t k_most_per_axis = 129;  // of one parameter alone
constexpr std::size_t k_polished_to_end = 6;  // places
constexpr double k_same_place = 1e-3;         // distance in z below which two places are one
constexpr double k_near_bound = 1e-4;         // share of the range
constexpr double k_end_of_z = std::numbers::pi / 2.0;
constexpr double k_scan_share = 0.5;  // of the whole search, for its progress
constexpr double k_no_cost = std::numeric_limits<double>::infinity();

/// How far a polish goes.
struct Effort {
  std::size_t iterations;
  double step;  ///< relative change of the variables that ends it
};
constexpr Effort k_short_polish{8, 1e-4};  // enough to leave a slice for its valley
constexpr Effort k_full_polish{200, 1e-13};

template <auto Free>
struct Deleter {
  template <class T>
  void operator()(T* handle) const noexcept {
    Free(handle);
  }
};
using Vector = std::unique_ptr<gsl_vector, Deleter<gsl_vector_free>>;
using Solver = std::unique_ptr<gsl_multifit_nlinear_workspace, Deleter<gsl_multifit_nlinear_free>>;

/// GSL ends the process at an error unless it is told not to.
class QuietGsl {
 public:
  QuietGsl() : before_(gsl_set_error_handler_off()) {}
  ~QuietGsl() { gsl_set_error_handler(before_); }
  QuietGsl(const QuietGsl&) = delete;
  QuietGsl& operator=(const QuietGsl&) = delete;

 private:
  gsl_error_handler_t* before_;
};

double parameter_at(const BoundedParameter& bounds, double share) {
  if (!bounds.is_logarithmic) return std::lerp(bounds.lower, bounds.upper, share);
  const double parameter = std::exp(std::lerp(std::log(bounds.lower), std::log(bounds.upper), share));
  return std::clamp(parameter, bounds.lower, bounds.upper);
}

double share_of(const BoundedParameter& bounds, double parameter) {
  if (!bounds.is_logarithmic) return (parameter - bounds.lower) / (bounds.upper - bounds.lower);
  return std::log(parameter / bounds.lower) / std::log(bounds.upper / bounds.lower);
}

double share_at(double z) { return std::sin(z) * std::sin(z); }

/// Where z has a value of its own: sin(z)^2 takes every share twice in each period.
double folded(double z) { return std::asin(std::sqrt(std::clamp(share_at(z), 0.0, 1.0))); }

class Search {
 public:
  explicit Search(const LeastSquaresProblem& problem)
      : problem_(problem), size_(problem.parameters.size()), parameters_(size_), residuals_(problem.residual_count) {}

  std::optional<LeastSquaresSolution> run() {
    std::vector<Place> starts = slice_minima();
    add_given_start(starts);
    if (starts.empty()) return std::nullopt;
    advance_to(k_scan_share);
    for (std::size_t k = 0; k < starts.size(); ++k) {
      starts[k] = polish(starts[k], k_short_polish);
      advance_to(std::lerp(k_scan_share, 1.0, static_cast<double>(k + 1) / static_cast<double>(starts.size())));
    }
    keep_distinct(starts);
    starts.resize(std::min(starts.size(), k_polished_to_end));
    for (Place& place : starts) place = polish(place, k_full_polish);
    keep_distinct(starts);
    Place best = starts.front();
    settle_at_bounds(best);
    return solution(best, starts);
  }

 private:
  /// A point of the box, with what is known of it.
  struct Place {
    std::vector<double> z;
    std::vector<double> fixed;  ///< parameters that are held there; nan: free
    double cost = k_no_cost;
    bool has_converged = false;
  };

  [[nodiscard]] double parameter(const Place& place, std::size_t k) const {
    return std::isnan(place.fixed[k]) ? parameter_at(problem_.parameters[k], share_at(place.z[k])) : place.fixed[k];
  }

  /// Residuals with the loss put in, so that the sum of their squares is the cost: sign(r) sqrt(rho(r)).
  bool evaluate(const Place& place, std::span<double> values) {
    for (std::size_t k = 0; k < size_; ++k) parameters_[k] = parameter(place, k);
    ++evaluations_;
    if (!problem_.residuals(parameters_, values)) {
      ++failures_;
      return false;
    }
    if (problem_.loss.kind == Loss::linear) return true;
    for (double& r : values) r = std::copysign(std::sqrt(problem_.loss.rho(r)), r);
    return true;
  }

  [[nodiscard]] double cost_at(const Place& place) {
    if (!evaluate(place, residuals_)) return k_no_cost;
    const double cost = std::inner_product(residuals_.begin(), residuals_.end(), residuals_.begin(), 0.0);
    worst_cost_ = std::max(worst_cost_, cost);
    return cost;
  }

  [[nodiscard]] Place free_place() const {
    return {std::vector<double>(size_), std::vector<double>(size_, std::numeric_limits<double>::quiet_NaN())};
  }

  [[nodiscard]] std::size_t nodes_per_axis() const {
    std::size_t count = 3;
    const auto nodes = [this](std::size_t n) { return std::pow(static_cast<double>(n), static_cast<double>(size_)); };
    while (count < k_most_per_axis && nodes(count + 1) <= k_most_scanned) ++count;
    return count;
  }

  /// The best place of each slice of the box, in which one parameter has one of its values.
  [[nodiscard]] std::vector<Place> slice_minima() {
    const std::size_t n = nodes_per_axis();
    std::vector<Place> best(size_ * n, free_place());
    std::vector<std::size_t> node(size_, 0);
    Place place = free_place();
    std::size_t total = 1;
    for (std::size_t k = 0; k < size_; ++k) total *= n;
    for (std::size_t count = 0; count < total; ++count) {
      for (std::size_t k = 0, rest = count; k < size_; ++k, rest /= n) {
        node[k] = rest % n;
        // Between the ends, where a law may be singular; equally spaced in z, so that places crowd at the bounds.
        place.z[k] = (static_cast<double>(node[k]) + 0.5) / static_cast<double>(n) * k_end_of_z;
      }
      place.cost = cost_at(place);
      for (std::size_t k = 0; k < size_; ++k) {
        Place& slice = best[k * n + node[k]];
        if (place.cost < slice.cost) slice = place;
      }
      advance_to(k_scan_share * static_cast<double>(count + 1) / static_cast<double>(total));
    }
    std::erase_if(best, [](const Place& slice) { return slice.cost == k_no_cost; });
    std::ranges::stable_sort(best, {}, &Place::cost);
    const auto is_repeated = [](const Place& a, const Place& b) { return a.z == b.z; };
    best.erase(std::unique(best.begin(), best.end(), is_repeated), best.end());
    return best;
  }

  void add_given_start(std::vector<Place>& starts) {
    Place place = starts.empty() ? free_place() : starts.front();
    bool is_given = false;
    for (std::size_t k = 0; k < size_; ++k) {
      const BoundedParameter& bounds = problem_.parameters[k];
      if (!bounds.start) continue;
      is_given = true;
      place.z[k] = std::asin(std::sqrt(std::clamp(share_of(bounds, *bounds.start), k_near_bound, 1.0 - k_near_bound)));
    }
    if (!is_given) return;
    place.cost = cost_at(place);
    if (place.cost < k_no_cost) starts.push_back(std::move(place));
  }

  /// The best first, and of those that are one place only the best.
  static void keep_distinct(std::vector<Place>& places) {
    std::ranges::stable_sort(places, {}, &Place::cost);
    std::vector<Place> distinct;
    for (Place& place : places) {
      const auto is_same = [&](const Place& other) {
        return std::ranges::equal(place.z, other.z, [](double a, double b) { return std::abs(a - b) < k_same_place; });
      };
      if (std::ranges::none_of(distinct, is_same)) distinct.push_back(std::move(place));
    }
    places = std::move(distinct);
  }

  /// Which parameters are free in a place.
  [[nodiscard]] std::vector<std::size_t> free_of(const Place& place) const {
    std::vector<std::size_t> free;
    for (std::size_t k = 0; k < size_; ++k) {
      if (std::isnan(place.fixed[k])) free.push_back(k);
    }
    return free;
  }

  /// What the callbacks of one polish share.
  struct Polish {
    Search& search;
    Place trial;
    std::vector<std::size_t> free;
    std::vector<double> values;
    std::vector<double> other;
    std::exception_ptr pending;  ///< exceptions do not cross C

    void put(const gsl_vector* z) {
      for (std::size_t j = 0; j < free.size(); ++j) trial.z[free[j]] = gsl_vector_get(z, j);
    }
  };

  template <class Call>
  static int guarded(Polish& polish, Call call) noexcept {
    try {
      call();
      return GSL_SUCCESS;
    } catch (...) {
      polish.pending = std::current_exception();
      return GSL_EFAILED;
    }
  }

  static int residuals_callback(const gsl_vector* z, void* self, gsl_vector* f) noexcept {
    auto& polish = *static_cast<Polish*>(self);
    return guarded(polish, [&] {
      polish.put(z);
      // A place without residuals is worse than any other: the step to it is refused, and a shorter one tried.
      if (!polish.search.evaluate(polish.trial, polish.values)) {
        const double count = static_cast<double>(polish.values.size());
        std::ranges::fill(polish.values, 2.0 * std::sqrt(polish.search.worst_cost_ / count) + 1.0);
      }
      for (std::size_t i = 0; i < polish.values.size(); ++i) gsl_vector_set(f, i, polish.values[i]);
    });
  }

  static int jacobian_callback(const gsl_vector* z, void* self, gsl_matrix* jacobian) noexcept {
    auto& polish = *static_cast<Polish*>(self);
    return guarded(polish, [&] {
      polish.put(z);
      for (std::size_t j = 0; j < polish.free.size(); ++j) {
        polish.search.differentiate(polish, polish.free[j]);
        for (std::size_t i = 0; i < polish.values.size(); ++i) gsl_matrix_set(jacobian, i, j, polish.values[i]);
      }
    });
  }

  /// Derivative with respect to one z, into polish.values.
  void differentiate(Polish& polish, std::size_t k) {
    const double middle = polish.trial.z[k];
    double above = middle + difference_step();
    double below = middle - difference_step();
    const auto at = [&](double z, std::vector<double>& values) {
      polish.trial.z[k] = z;
      return evaluate(polish.trial, values);
    };
    if (!at(above, polish.values)) {
      above = middle;
      if (!at(above, polish.values)) above = below;
    }
    if (!at(below, polish.other)) {
      below = middle;
      if (!at(below, polish.other)) below = above;
    }
    polish.trial.z[k] = middle;
    for (std::size_t i = 0; i < polish.values.size(); ++i) {
      polish.values[i] = above > below ? (polish.values[i] - polish.other[i]) / (above - below) : 0.0;
    }
  }

  /// Where truncation, h^2, and rounding, noise/h, are alike.
  [[nodiscard]] double difference_step() const { return std::cbrt(problem_.noise); }

  /// The minimum downhill from a place, as far as the effort goes.
  [[nodiscard]] Place polish(const Place& start, const Effort& effort) {
    Polish polish{*this, start, free_of(start), residuals_, residuals_, {}};
    if (polish.free.empty() || problem_.residual_count < polish.free.size()) return start;
    gsl_multifit_nlinear_fdf fdf{};
    fdf.f = residuals_callback;
    fdf.df = jacobian_callback;
    fdf.n = problem_.residual_count;
    fdf.p = polish.free.size();
    fdf.params = &polish;
    const gsl_multifit_nlinear_parameters settings = gsl_multifit_nlinear_default_parameters();
    const Solver solver(gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &settings, fdf.n, fdf.p));
    const Vector z(gsl_vector_alloc(fdf.p));
    if (!solver || !z) throw std::bad_alloc();
    for (std::size_t j = 0; j < fdf.p; ++j) gsl_vector_set(z.get(), j, start.z[polish.free[j]]);

    int status = gsl_multifit_nlinear_init(z.get(), &fdf, solver.get());
    int reason = 0;
    // The gradient of an exact fit vanishes long before its parameters are exact; their change decides.
    constexpr double k_gradient_tolerance = 1e-30;
    if (status == GSL_SUCCESS) {
      status = gsl_multifit_nlinear_driver(effort.iterations, effort.step, k_gradient_tolerance, 0.0, nullptr, nullptr,
                                           &reason, solver.get());
    }
    if (polish.pending) std::rethrow_exception(polish.pending);

    polish.put(gsl_multifit_nlinear_position(solver.get()));
    Place end = polish.trial;
    for (const std::size_t k : polish.free) end.z[k] = folded(end.z[k]);
    end.cost = cost_at(end);
    if (!(end.cost <= start.cost)) end = start;
    // No progress means that no step, however short, leads down any more.
    end.has_converged = status == GSL_SUCCESS || reason == GSL_ENOPROG;
    return end;
  }

  /// Puts parameters that lie almost at a bound on it, where that costs nothing.
  void settle_at_bounds(Place& best) {
    const double rounding = problem_.noise * problem_.noise * static_cast<double>(problem_.residual_count);
    for (std::size_t k = 0; k < size_; ++k) {
      const double share = share_at(best.z[k]);
      if (share > k_near_bound && share < 1.0 - k_near_bound) continue;
      Place fixed = best;
      fixed.fixed[k] = share < 0.5 ? problem_.parameters[k].lower : problem_.parameters[k].upper;
      fixed.cost = cost_at(fixed);
      if (fixed.cost == k_no_cost) continue;
      fixed = polish(fixed, k_full_polish);
      if (free_of(fixed).empty()) fixed.has_converged = true;
      constexpr double k_same_cost = 1e-9;
      if (fixed.cost <= best.cost * (1.0 + k_same_cost) + rounding) best = fixed;
    }
  }

  [[nodiscard]] LocalMinimum minimum(const Place& place) const {
    LocalMinimum minimum{{}, place.cost};
    for (std::size_t k = 0; k < size_; ++k) minimum.parameters.push_back(parameter(place, k));
    return minimum;
  }

  [[nodiscard]] LeastSquaresSolution solution(const Place& best, const std::vector<Place>& all) {
    LeastSquaresSolution solution;
    static_cast<LocalMinimum&>(solution) = minimum(best);
    for (std::size_t k = 0; k < size_; ++k) {
      const bool is_lower = best.fixed[k] == problem_.parameters[k].lower;
      using Bound = LeastSquaresSolution::Bound;
      solution.bounds.push_back(std::isnan(best.fixed[k]) ? Bound::none : is_lower ? Bound::lower : Bound::upper);
    }
    for (const Place& place : all) solution.minima.push_back(minimum(place));
    solution.residuals.resize(problem_.residual_count);
    problem_.residuals(solution.parameters, solution.residuals);
    solution.has_converged = best.has_converged;
    solution.evaluations = evaluations_ + 1;
    solution.failures = failures_;
    return solution;
  }

  void advance_to(double done) const {
    if (problem_.progress) problem_.progress(done);
  }

  const LeastSquaresProblem& problem_;
  std::size_t size_;
  std::vector<double> parameters_;
  std::vector<double> residuals_;
  double worst_cost_ = 0.0;
  long evaluations_ = 0;
  long failures_ = 0;
};

}  // namespace

double LossFunction::rho(double residual) const noexcept {
  const double u = residual / scale;
  switch (kind) {
    case Loss::linear:
      return residual * residual;
    case Loss::huber:
      return std::abs(u) <= 1.0 ? residual * residual : scale * scale * (2.0 * std::abs(u) - 1.0);
    case Loss::soft_l1:  // sqrt(1 + u^2) - 1 in a form that keeps its digits
      return 2.0 * residual * residual / (std::sqrt(1.0 + u * u) + 1.0);
    case Loss::cauchy:
      return scale * scale * std::log1p(u * u);
  }
  return 0.0;
}

double LossFunction::influence(double residual) const noexcept {
  const double u = residual / scale;
  switch (kind) {
    case Loss::linear:
      return residual;
    case Loss::huber:
      return scale * std::clamp(u, -1.0, 1.0);
    case Loss::soft_l1:
      return residual / std::sqrt(1.0 + u * u);
    case Loss::cauchy:
      return residual / (1.0 + u * u);
  }
  return 0.0;
}

double LossFunction::curvature(double residual) const noexcept {
  const double u2 = residual * residual / (scale * scale);
  switch (kind) {
    case Loss::linear:
      return 1.0;
    case Loss::huber:
      return u2 <= 1.0 ? 1.0 : 0.0;
    case Loss::soft_l1:
      return 1.0 / ((1.0 + u2) * std::sqrt(1.0 + u2));
    case Loss::cauchy:
      return (1.0 - u2) / ((1.0 + u2) * (1.0 + u2));
  }
  return 0.0;
}

std::optional<LeastSquaresSolution> minimise(const LeastSquaresProblem& problem) {
  if (problem.parameters.empty() || problem.parameters.size() > k_most_parameters) {
    throw std::invalid_argument("least squares: too many parameters, or none");
  }
  const QuietGsl quiet;
  return Search(problem).run();
}

double difference_step(const LeastSquaresProblem& problem, std::span<const double> parameters, std::size_t k) {
  const double range = problem.parameters[k].upper - problem.parameters[k].lower;
  const double scale = parameters[k] == 0.0 ? range : std::min(std::abs(parameters[k]), range);
  return std::cbrt(problem.noise) * scale;
}

Eigen::MatrixXd residual_jacobian(const LeastSquaresProblem& problem, std::span<const double> parameters) {
  const auto rows = static_cast<Eigen::Index>(problem.residual_count);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(parameters.size()));
  std::vector<double> trial(parameters.begin(), parameters.end());
  for (std::size_t k = 0; k < trial.size(); ++k) {
    const double lower = problem.parameters[k].lower;
    const double upper = problem.parameters[k].upper;
    const double present = trial[k];
    const double step = difference_step(problem, parameters, k);
    Eigen::VectorXd above(rows);
    Eigen::VectorXd below(rows);
    const auto at = [&](double value, Eigen::VectorXd& residuals) {
      trial[k] = value;
      return problem.residuals(trial, {residuals.data(), problem.residual_count});
    };
    double right = std::min(present + step, upper);
    double left = std::max(present - step, lower);
    if (!at(right, above)) {
      right = present;
      if (!at(right, above)) continue;
    }
    if (!at(left, below)) {
      left = present;
      if (!at(left, below)) continue;
    }
    trial[k] = present;
    if (right > left) jacobian.col(static_cast<Eigen::Index>(k)) = (above - below) / (right - left);
  }
  return jacobian;
}

}  // namespace monograin
