#include "numerics/least_squares.hpp"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit_nlinear.h>
#include <gsl/gsl_multimin.h>
#include <gsl/gsl_qrng.h>

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace monograin {
namespace {

constexpr std::array<std::size_t, 4> k_scanned{31, 63, 127, 255};  // drawn points, by the number of parameters
constexpr std::size_t k_most_passed_over = 4;  // draws over wanted points, if some points have no residuals
constexpr std::size_t k_slices = 9;            // of each axis
constexpr std::size_t k_most_in_vain = 10;     // polishes in a row that may find nothing better
constexpr double k_better = 0.99;              // cost of a better minimum over that of the best so far
constexpr std::size_t k_polished_to_end = 3;   // minima that are polished to the end
constexpr double k_worth_an_end = 4.0;         // their largest cost over that of the best minimum
constexpr double k_same_place = 1e-3;          // distance in z below which two points are the same
constexpr double k_near_place = 0.02;          // distance in z below which short polishes approach the same minimum
constexpr double k_near_bound = 1e-4;          // distance from a bound, over the range
constexpr double k_end_of_z = std::numbers::pi / 2.0;
constexpr double k_scan_share = 0.5;  // share of the draw in the progress of the search
constexpr double k_no_cost = std::numeric_limits<double>::infinity();
constexpr int k_refinements = 3;
constexpr double k_small_step = 1e-4;  // a Gauss-Newton step longer than this in z shows that no minimum is near
constexpr double k_round_off_of_cost = 1e-12;  // over the cost
constexpr double k_kinked = 1e-5;              // fall of the cost predicted at a smooth minimum, over the cost, at most
constexpr double k_margin_of_noise = 1e3;
constexpr double k_longest_step = 0.1;       // side of the first simplex, in z
constexpr std::size_t k_simplex_steps = 60;  // for each parameter
constexpr double k_simplex_end = 1e-3;       // size of the last simplex, in standard errors
constexpr double k_exact_step = 1e-12;       // Gauss-Newton step in z that ends the search
constexpr double k_nearly_exact = 1e-9;      // step in z below which a minimum has converged

/// Accuracy of a polish, and kind of its derivatives.
struct Effort {
  std::size_t iterations;
  double step;      ///< estimated distance to the minimum, in z, that ends it
  bool is_central;  ///< central differences in every iteration; otherwise one-sided ones, updated by secants
};
constexpr Effort k_short_polish{7, 1e-3, false};  // enough to leave a slice for its valley
constexpr Effort k_rough_polish{20, 1e-5, false};
constexpr Effort k_long_polish{40, 1e-7, false};

template <auto Free>
struct Deleter {
  template <class T>
  void operator()(T* handle) const noexcept {
    Free(handle);
  }
};
using Vector = std::unique_ptr<gsl_vector, Deleter<gsl_vector_free>>;
using Solver = std::unique_ptr<gsl_multifit_nlinear_workspace, Deleter<gsl_multifit_nlinear_free>>;
using Simplex = std::unique_ptr<gsl_multimin_fminimizer, Deleter<gsl_multimin_fminimizer_free>>;
using Sequence = std::unique_ptr<gsl_qrng, Deleter<gsl_qrng_free>>;

/// Keeps GSL from ending the process at an error.
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

/// The value in [0, pi/2] with the same share: sin(z)^2 takes every share twice in each period.
double folded(double z) {
  return z >= 0.0 && z <= k_end_of_z ? z : std::asin(std::sqrt(std::clamp(share_at(z), 0.0, 1.0)));
}

void check_size(const LeastSquaresProblem& problem) {
  if (problem.parameters.empty() || problem.parameters.size() > k_most_parameters) {
    throw std::invalid_argument("least squares: too many parameters, or none");
  }
}

class Search {
 public:
  explicit Search(const LeastSquaresProblem& problem)
      : problem_(problem), size_(problem.parameters.size()), parameters_(size_), residuals_(problem.residual_count) {}

  std::optional<LeastSquaresSolution> run() {
    std::vector<Place> scanned = scan();
    add_given_start(scanned);
    if (scanned.empty()) return std::nullopt;
    advance_to(k_scan_share);
    const std::vector<Place> starts = starts_of(scanned);
    std::vector<Place> ends;
    double best = k_no_cost;
    std::size_t in_vain = 0;
    for (std::size_t k = 0; k < starts.size() && in_vain < k_most_in_vain; ++k) {
      Place end = polish(starts[k], k_short_polish, ends);
      in_vain = end.cost < k_better * best ? 0 : in_vain + 1;
      best = std::min(best, end.cost);
      ends.push_back(std::move(end));
      advance_to(std::lerp(k_scan_share, 1.0, static_cast<double>(k + 1) / static_cast<double>(starts.size())));
    }
    return finish(std::move(ends));
  }

  /// Searches from points that are already near minima.
  std::optional<LeastSquaresSolution> run_from(std::span<const LocalMinimum> minima, Accuracy accuracy) {
    std::vector<Place> starts;
    for (const LocalMinimum& minimum : minima) {
      Place place = place_at(minimum.parameters);
      place.cost = cost_at(place);
      if (place.cost < k_no_cost) starts.push_back(std::move(place));
    }
    if (starts.empty()) return std::nullopt;
    if (accuracy == Accuracy::full) return finish(std::move(starts));
    std::ranges::stable_sort(starts, {}, &Place::cost);
    const Place end = polish(starts.front(), k_rough_polish);
    return solution(end, {end});
  }

 private:
  /// A point of the box.
  struct Place {
    std::vector<double> z;
    double cost = k_no_cost;
    bool has_converged = false;
  };

  [[nodiscard]] double parameter(const Place& place, std::size_t k) const {
    return parameter_at(problem_.parameters[k], share_at(place.z[k]));
  }

  /// Computes sign(r) sqrt(rho(r)) of the residuals r, so that the sum of squares is the cost. Results at the last
  /// point are kept, because a polish may begin where the last one has ended.
  /// @return false if there are no residuals
  bool evaluate(const Place& place, std::span<double> values) {
    for (std::size_t k = 0; k < size_; ++k) parameters_[k] = parameter(place, k);
    if (parameters_ == last_parameters_) {
      std::ranges::copy(last_values_, values.begin());
      return true;
    }
    ++evaluations_;
    if (!problem_.residuals(parameters_, values)) {
      ++failures_;
      return false;
    }
    if (problem_.loss.kind != Loss::linear) {
      for (double& r : values.first(values.size() - problem_.plain_count)) {
        r = std::copysign(std::sqrt(problem_.loss.rho(r)), r);
      }
    }
    last_parameters_ = parameters_;
    last_values_.assign(values.begin(), values.end());
    return true;
  }

  [[nodiscard]] double cost_at(const Place& place) {
    if (!evaluate(place, residuals_)) return k_no_cost;
    const double cost = std::inner_product(residuals_.begin(), residuals_.end(), residuals_.begin(), 0.0);
    worst_cost_ = std::max(worst_cost_, cost);
    return cost;
  }

  [[nodiscard]] Place free_place() const { return {.z = std::vector<double>(size_)}; }

  [[nodiscard]] Place place_at(std::span<const double> parameters) const {
    Place place = free_place();
    for (std::size_t k = 0; k < size_; ++k) {
      const double share = share_of(problem_.parameters[k], parameters[k]);
      place.z[k] = std::asin(std::sqrt(std::clamp(share, k_near_bound, 1.0 - k_near_bound)));
    }
    return place;
  }

  /// Draws points of a Sobol sequence in z, which are densest at the bounds. Returns those with residuals, the best
  /// first.
  [[nodiscard]] std::vector<Place> scan() {
    const std::size_t wanted = k_scanned[std::min(size_, k_scanned.size()) - 1];
    const Sequence sequence(gsl_qrng_alloc(gsl_qrng_sobol, static_cast<unsigned>(size_)));
    if (!sequence) throw std::bad_alloc();
    std::vector<Place> places;
    Place place = free_place();
    for (std::size_t count = 0; count < k_most_passed_over * wanted && places.size() < wanted; ++count) {
      gsl_qrng_get(sequence.get(), place.z.data());
      for (double& z : place.z) z *= k_end_of_z;
      place.cost = cost_at(place);
      if (place.cost < k_no_cost) places.push_back(place);
      advance_to(k_scan_share * std::min(1.0, static_cast<double>(count) / static_cast<double>(wanted)));
    }
    std::ranges::stable_sort(places, {}, &Place::cost);
    return places;
  }

  /// The best point of each slice of the box, in which one parameter is nearly constant.
  [[nodiscard]] std::vector<Place> starts_of(const std::vector<Place>& scanned) const {
    std::vector<Place> starts;
    for (std::size_t k = 0; k < size_; ++k) {
      std::vector<bool> is_taken(k_slices, false);
      for (const Place& place : scanned) {  // the best first
        const double share = std::clamp(place.z[k] / k_end_of_z, 0.0, 1.0);
        const auto slice = std::min(static_cast<std::size_t>(share * k_slices), k_slices - 1);
        if (is_taken[slice]) continue;
        is_taken[slice] = true;
        if (std::ranges::any_of(starts, [&](const Place& start) { return start.z == place.z; })) continue;
        starts.push_back(place);
      }
    }
    std::ranges::stable_sort(starts, {}, &Place::cost);
    return starts;
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
    if (place.cost < k_no_cost) starts.insert(starts.begin(), std::move(place));
  }

  [[nodiscard]] LeastSquaresSolution finish(std::vector<Place> places) {
    keep_distinct(places, k_near_place);
    const double limit = k_worth_an_end * places.front().cost;
    std::erase_if(places, [&](const Place& place) { return place.cost > limit; });
    places.resize(std::min(places.size(), k_polished_to_end));
    for (Place& place : places) place = polish(place, k_long_polish);
    keep_distinct(places, k_same_place);
    places.front().has_converged = false;
    places.front() = refined(places.front());
    if (!places.front().has_converged) places.front() = refined(polish(places.front(), full_polish()));
    places.front() = past_kinks(places.front());
    const Place best = places.front();
    return settled_at_bounds(best, places);
  }

  [[nodiscard]] double nearly_exact() const { return std::max(k_nearly_exact, problem_.noise); }
  [[nodiscard]] Effort full_polish() const { return {100, nearly_exact(), true}; }

  static bool is_near(const std::vector<double>& a, const std::vector<double>& b, double distance) {
    return std::ranges::equal(a, b, [distance](double x, double y) { return std::abs(x - y) < distance; });
  }

  static bool near_one_of(const std::vector<Place>& places, const std::vector<double>& z) {
    return std::ranges::any_of(places, [&](const Place& place) { return is_near(place.z, z, k_near_place); });
  }

  /// Sorts points by cost, and keeps only the best of points that are near each other.
  static void keep_distinct(std::vector<Place>& places, double distance) {
    std::ranges::stable_sort(places, {}, &Place::cost);
    std::vector<Place> distinct;
    for (Place& place : places) {
      const auto is_same = [&](const Place& other) { return is_near(place.z, other.z, distance); };
      if (std::ranges::none_of(distinct, is_same)) distinct.push_back(std::move(place));
    }
    places = std::move(distinct);
  }

  /// Data of one polish, shared by its callbacks.
  struct Polish {
    Search& search;
    Place trial;
    bool is_central = false;
    std::vector<double> z{};         ///< point of the last residuals
    std::vector<double> values;      ///< the last residuals
    std::vector<double> before_z{};  ///< point of the last derivatives
    std::vector<double> before{};    ///< residuals at that point
    std::size_t trials = 0;          ///< residuals evaluated since then
    Eigen::MatrixXd jacobian;
    std::vector<double> above;
    std::vector<double> below;
    std::exception_ptr pending{};  ///< exceptions do not cross C

    void put(const gsl_vector* at) {
      for (std::size_t k = 0; k < trial.z.size(); ++k) trial.z[k] = gsl_vector_get(at, k);
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
      polish.z = polish.trial.z;
      ++polish.trials;
      // A point without residuals gets a higher cost than any other: GSL then refuses the step and tries a shorter one.
      if (!polish.search.evaluate(polish.trial, polish.values)) {
        const double count = static_cast<double>(polish.values.size());
        std::ranges::fill(polish.values, 2.0 * std::sqrt(polish.search.worst_cost_ / count) + 1.0);
      }
      for (std::size_t i = 0; i < polish.values.size(); ++i) gsl_vector_set(f, i, polish.values[i]);
    });
  }

  /// Gives GSL the derivatives at the point of the last residuals.
  static int jacobian_callback(const gsl_vector* z, void* self, gsl_matrix* jacobian) noexcept {
    auto& polish = *static_cast<Polish*>(self);
    return guarded(polish, [&] {
      polish.put(z);
      // A step that was not accepted at once shows that the derivatives are too old for an update.
      if (polish.is_central || polish.before.empty() || polish.trials > 1 || !update(polish)) {
        for (std::size_t k = 0; k < polish.z.size(); ++k) polish.search.differentiate(polish, k);
      }
      polish.before_z = polish.z;
      polish.before = polish.values;
      polish.trials = 0;
      for (std::size_t k = 0; k < polish.z.size(); ++k) {
        for (std::size_t i = 0; i < polish.values.size(); ++i) {
          gsl_matrix_set(jacobian, i, k, polish.jacobian(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)));
        }
      }
    });
  }

  /// Updates the derivatives by the last step (Broyden (1965), the first method). @return false if there was no step
  static bool update(Polish& polish) {
    const auto size = static_cast<Eigen::Index>(polish.z.size());
    const auto count = static_cast<Eigen::Index>(polish.values.size());
    const Eigen::VectorXd step = Eigen::Map<const Eigen::VectorXd>(polish.z.data(), size) -
                                 Eigen::Map<const Eigen::VectorXd>(polish.before_z.data(), size);
    if (step.squaredNorm() == 0.0) return false;
    const Eigen::Map<const Eigen::VectorXd> now(polish.values.data(), count);
    const Eigen::Map<const Eigen::VectorXd> before(polish.before.data(), count);
    polish.jacobian += (now - before - polish.jacobian * step) * step.transpose() / step.squaredNorm();
    return true;
  }

  /// Computes the derivative with respect to the k-th z, a column of the Jacobian.
  void differentiate(Polish& polish, std::size_t k) {
    const double middle = polish.trial.z[k];
    const double step = difference_step(polish.is_central);
    double above = middle + step;
    double below = polish.is_central ? middle - step : middle;
    const auto at = [&](double z, std::vector<double>& values) {
      polish.trial.z[k] = z;
      if (z != middle) return evaluate(polish.trial, values);
      values = polish.values;
      return true;
    };
    if (!at(above, polish.above)) {
      above = middle;
      static_cast<void>(at(above, polish.above));
      below = middle - step;
    }
    if (!at(below, polish.below)) {
      below = middle;
      static_cast<void>(at(below, polish.below));
    }
    polish.trial.z[k] = middle;
    for (std::size_t i = 0; i < polish.values.size(); ++i) {
      polish.jacobian(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
          above > below ? (polish.above[i] - polish.below[i]) / (above - below) : 0.0;
    }
  }

  /// Step h at which truncation (h, or h^2 for central differences) and round-off (noise/h) are similar.
  [[nodiscard]] double difference_step(bool is_central) const {
    return is_central ? std::cbrt(problem_.noise) : std::sqrt(problem_.noise);
  }

  [[nodiscard]] Polish prepared(const Place& start, bool is_central) {
    return {.search = *this,
            .trial = start,
            .is_central = is_central,
            .values = residuals_,
            .jacobian = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(problem_.residual_count),
                                              static_cast<Eigen::Index>(size_)),
            .above = residuals_,
            .below = residuals_};
  }

  /// Refines a minimum by Gauss-Newton steps. These do not minimise the cost itself, whose round-off hides the last
  /// half of the parameters' digits.
  [[nodiscard]] Place refined(Place place) {
    if (problem_.residual_count < size_) return place;
    Polish polish = prepared(place, true);
    const auto count = static_cast<Eigen::Index>(residuals_.size());
    for (int round = 0; round < k_refinements && evaluate(place, polish.values); ++round) {
      polish.trial = place;
      for (std::size_t k = 0; k < size_; ++k) differentiate(polish, k);
      const Eigen::Map<const Eigen::VectorXd> residuals(polish.values.data(), count);
      const Eigen::VectorXd step = polish.jacobian.completeOrthogonalDecomposition().solve(-residuals);
      if (!(step.norm() <= k_small_step)) break;
      Place next = place;
      for (std::size_t k = 0; k < size_; ++k) next.z[k] = folded(place.z[k] + step[static_cast<Eigen::Index>(k)]);
      next.cost = cost_at(next);
      if (!(next.cost <= place.cost * (1.0 + k_round_off_of_cost))) break;
      place = std::move(next);
      if (step.norm() <= nearly_exact()) place.has_converged = true;
      if (step.norm() <= k_exact_step) break;
    }
    return place;
  }

  /// Finds the minimum near a point at which derivatives predict a lower cost that does not exist. A simplex goes
  /// downhill without derivatives; its sides are scaled so that the predicted cost rises equally along them.
  [[nodiscard]] Place past_kinks(const Place& place) {
    const auto count = static_cast<Eigen::Index>(residuals_.size());
    if (count <= static_cast<Eigen::Index>(size_) || !(place.cost > 0.0)) return place;
    Polish polish = prepared(place, true);
    if (!evaluate(place, polish.values)) return place;
    for (std::size_t k = 0; k < size_; ++k) differentiate(polish, k);
    const Eigen::Map<const Eigen::VectorXd> residuals(polish.values.data(), count);
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(polish.jacobian, Eigen::ComputeThinU | Eigen::ComputeThinV);
    const double predicted = (svd.matrixU().transpose() * residuals).squaredNorm();
    const double round_off = k_margin_of_noise * problem_.noise * polish.jacobian.norm();
    if (predicted <= k_kinked * place.cost || place.cost <= round_off * round_off) return place;
    const double s = std::sqrt(place.cost / static_cast<double>(count - static_cast<Eigen::Index>(size_)));
    Descent descent{*this, place, svd.matrixV(), place, {}};
    for (Eigen::Index j = 0; j < svd.singularValues().size(); ++j) {
      descent.directions.col(j) *= std::min(s / svd.singularValues()[j], k_longest_step);
    }
    gsl_multimin_function function{cost_callback, size_, &descent};
    const Simplex simplex(gsl_multimin_fminimizer_alloc(gsl_multimin_fminimizer_nmsimplex2, size_));
    const Vector start(gsl_vector_calloc(size_));
    const Vector steps(gsl_vector_alloc(size_));
    if (!simplex || !start || !steps) throw std::bad_alloc();
    gsl_vector_set_all(steps.get(), 1.0);
    int status = gsl_multimin_fminimizer_set(simplex.get(), &function, start.get(), steps.get());
    for (std::size_t step = 0; status == GSL_SUCCESS && step < k_simplex_steps * size_; ++step) {
      status = gsl_multimin_fminimizer_iterate(simplex.get());
      if (gsl_multimin_fminimizer_size(simplex.get()) < k_simplex_end) break;
    }
    if (descent.pending) std::rethrow_exception(descent.pending);
    if (!(descent.best.cost < place.cost)) return place;
    descent.best.has_converged = gsl_multimin_fminimizer_size(simplex.get()) < k_simplex_end;
    return descent.best;
  }

  struct Descent {
    Search& search;
    Place from;
    Eigen::MatrixXd directions;
    Place best;
    std::exception_ptr pending;
  };

  static double cost_callback(const gsl_vector* u, void* self) noexcept {
    auto& descent = *static_cast<Descent*>(self);
    try {
      Place place = descent.from;
      for (std::size_t k = 0; k < place.z.size(); ++k) {
        for (std::size_t j = 0; j < place.z.size(); ++j) {
          place.z[k] +=
              descent.directions(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(j)) * gsl_vector_get(u, j);
        }
        place.z[k] = folded(place.z[k]);
      }
      place.cost = descent.search.cost_at(place);
      if (place.cost < descent.best.cost) descent.best = place;
      return place.cost < k_no_cost ? place.cost : 2.0 * descent.search.worst_cost_ + 1.0;
    } catch (...) {
      descent.pending = std::current_exception();
      return GSL_NAN;
    }
  }

  /// Goes downhill from a point until the effort is used up, the minimum is reached, or a known point is near.
  [[nodiscard]] Place polish(const Place& start, const Effort& effort, const std::vector<Place>& known = {}) {
    Polish polish = prepared(start, effort.is_central);
    if (problem_.residual_count < size_) return start;
    gsl_multifit_nlinear_fdf fdf{};
    fdf.f = residuals_callback;
    fdf.df = jacobian_callback;
    fdf.n = problem_.residual_count;
    fdf.p = size_;
    fdf.params = &polish;
    const gsl_multifit_nlinear_parameters settings = gsl_multifit_nlinear_default_parameters();
    const Solver solver(gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &settings, fdf.n, fdf.p));
    const Vector z(gsl_vector_alloc(fdf.p));
    if (!solver || !z) throw std::bad_alloc();
    for (std::size_t j = 0; j < fdf.p; ++j) gsl_vector_set(z.get(), j, start.z[j]);

    int status = gsl_multifit_nlinear_init(z.get(), &fdf, solver.get());
    bool has_converged = false;
    double step_before = 0.0;
    for (std::size_t count = 0; status == GSL_SUCCESS && count < effort.iterations && !has_converged; ++count) {
      status = gsl_multifit_nlinear_iterate(solver.get());
      const double step = gsl_blas_dnrm2(solver->dx);
      const double rate = step < step_before ? step / step_before : 1.0;
      has_converged = step * rate <= effort.step;
      step_before = step;
      if (known.empty()) continue;
      polish.put(gsl_multifit_nlinear_position(solver.get()));
      if (near_one_of(known, polish.trial.z)) break;
    }
    if (polish.pending) std::rethrow_exception(polish.pending);

    Place end = start;
    for (std::size_t j = 0; j < fdf.p; ++j) {
      end.z[j] = folded(gsl_vector_get(gsl_multifit_nlinear_position(solver.get()), j));
    }
    const double norm = gsl_blas_dnrm2(gsl_multifit_nlinear_residual(solver.get()));
    end.cost = norm * norm;
    if (!(end.cost <= start.cost)) end = start;
    // GSL reports no progress if no step, however short, lowers the cost.
    end.has_converged = has_converged || status == GSL_ENOPROG;
    return end;
  }

  /// Sets a parameter that is almost at a bound to that bound if this does not raise the cost, and searches that face
  /// of the box for its own minimum.
  [[nodiscard]] LeastSquaresSolution settled_at_bounds(const Place& best, const std::vector<Place>& all) {
    LeastSquaresSolution found = solution(best, all);
    const double round_off = problem_.noise * problem_.noise * static_cast<double>(problem_.residual_count);
    for (std::size_t k = 0; k < size_; ++k) {
      const double share = share_at(best.z[k]);
      if (share > k_near_bound && share < 1.0 - k_near_bound) continue;
      const bool is_lower = share < 0.5;
      const double bound = is_lower ? problem_.parameters[k].lower : problem_.parameters[k].upper;
      auto face = minimum_of_face(k, bound);
      evaluations_ += face ? face->evaluations : 1;
      failures_ += face ? face->failures : 1;
      constexpr double k_same_cost = 1e-9;
      if (!face || face->cost > found.cost * (1.0 + k_same_cost) + round_off) continue;
      const auto place = static_cast<std::ptrdiff_t>(k);
      using Bound = LeastSquaresSolution::Bound;
      face->parameters.insert(face->parameters.begin() + place, bound);
      face->bounds.insert(face->bounds.begin() + place, is_lower ? Bound::lower : Bound::upper);
      for (LocalMinimum& other : face->minima) other.parameters.insert(other.parameters.begin() + place, bound);
      found = std::move(*face);
      break;
    }
    found.evaluations = evaluations_;
    found.failures = failures_;
    return found;
  }

  [[nodiscard]] std::optional<LeastSquaresSolution> minimum_of_face(std::size_t k, double bound) const {
    const LeastSquaresProblem face = with_held(problem_, k, bound);
    if (size_ > 1) return Search(face).run();
    LeastSquaresSolution corner;
    corner.residuals.resize(problem_.residual_count);
    if (!face.residuals({}, corner.residuals)) return std::nullopt;
    corner.cost = cost_of(problem_, corner.residuals);
    corner.minima = {{{}, corner.cost}};
    corner.has_converged = true;
    corner.evaluations = 1;
    return corner;
  }

  [[nodiscard]] LocalMinimum minimum(const Place& place) const {
    LocalMinimum minimum{{}, place.cost};
    for (std::size_t k = 0; k < size_; ++k) minimum.parameters.push_back(parameter(place, k));
    return minimum;
  }

  [[nodiscard]] LeastSquaresSolution solution(const Place& best, const std::vector<Place>& all) {
    LeastSquaresSolution solution;
    static_cast<LocalMinimum&>(solution) = minimum(best);
    solution.bounds.assign(size_, LeastSquaresSolution::Bound::none);
    for (const Place& place : all) solution.minima.push_back(minimum(place));
    solution.residuals.resize(problem_.residual_count);
    if (problem_.loss.kind == Loss::linear && solution.parameters == last_parameters_) {
      solution.residuals = last_values_;
    } else {
      problem_.residuals(solution.parameters, solution.residuals);
      ++evaluations_;
    }
    solution.has_converged = best.has_converged;
    solution.evaluations = evaluations_;
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
  std::vector<double> last_parameters_;  ///< last parameters with residuals
  std::vector<double> last_values_;
  double worst_cost_ = 0.0;
  long evaluations_ = 0;
  long failures_ = 0;
};

}  // namespace

double cost_of(const LeastSquaresProblem& problem, std::span<const double> residuals) noexcept {
  double cost = 0.0;
  const std::size_t lossy = residuals.size() - problem.plain_count;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    cost += i < lossy ? problem.loss.rho(residuals[i]) : residuals[i] * residuals[i];
  }
  return cost;
}

LeastSquaresProblem with_held(const LeastSquaresProblem& problem, std::size_t k, double value) {
  LeastSquaresProblem held = problem;
  held.parameters.erase(held.parameters.begin() + static_cast<std::ptrdiff_t>(k));
  held.residuals = [&problem, k, value, all = std::vector<double>(problem.parameters.size())](
                       std::span<const double> others, std::span<double> residuals) mutable {
    const auto place = static_cast<std::ptrdiff_t>(k);
    std::copy(others.begin(), others.begin() + place, all.begin());
    all[k] = value;
    std::copy(others.begin() + place, others.end(), all.begin() + place + 1);
    return problem.residuals(all, residuals);
  };
  held.progress = {};
  return held;
}

std::optional<LeastSquaresSolution> minimise(const LeastSquaresProblem& problem) {
  check_size(problem);
  const QuietGsl quiet;
  return Search(problem).run();
}

std::optional<LeastSquaresSolution> minimise_near(const LeastSquaresProblem& problem,
                                                  std::span<const LocalMinimum> starts, Accuracy accuracy) {
  check_size(problem);
  const QuietGsl quiet;
  return Search(problem).run_from(starts, accuracy);
}

}  // namespace monograin
