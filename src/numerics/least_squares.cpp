#include "numerics/least_squares.hpp"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_qrng.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <new>
#include <stdexcept>
#include <utility>

#include "numerics/descent.hpp"
#include "numerics/quiet_gsl.hpp"
#include "numerics/search_box.hpp"

namespace monograin {
namespace {

constexpr std::array<std::size_t, 4> k_scanned{31, 63, 127, 255};  // drawn points, by the number of parameters
constexpr std::size_t k_most_passed_over = 4;  // draws over wanted points, if some points have no residuals
constexpr std::size_t k_slices = 9;            // of each axis
constexpr std::size_t k_most_in_vain = 10;     // descents in a row that may find nothing better
constexpr double k_better = 0.99;              // cost of a better minimum over that of the best so far
constexpr std::size_t k_descended_to_end = 3;  // minima from which the descent goes to the end
constexpr double k_worth_an_end = 4.0;         // their largest cost over that of the best minimum
constexpr double k_same_place = 1e-3;          // distance in z below which two points are the same
constexpr double k_same_cost = 1e-9;           // relative difference of equal costs
constexpr double k_scan_share = 0.5;           // share of the draw in the progress of the search

using Bound = LeastSquaresSolution::Bound;

void check_size(const LeastSquaresProblem& problem) {
  if (problem.parameters.empty() || problem.parameters.size() > k_most_parameters) {
    throw std::invalid_argument("least squares: too many parameters, or none");
  }
}

/// Sorts points by cost, and keeps only the best of points that are near each other.
void keep_distinct(std::vector<Place>& places, double distance) {
  std::ranges::stable_sort(places, {}, &Place::cost);
  std::vector<Place> distinct;
  for (Place& place : places) {
    const auto is_same = [&](const Place& other) { return is_near(place.z, other.z, distance); };
    if (std::ranges::none_of(distinct, is_same)) distinct.push_back(std::move(place));
  }
  places = std::move(distinct);
}

/// Draws points of a Sobol sequence in z.
class SobolPoints {
 public:
  explicit SobolPoints(std::size_t size) : sequence_(gsl_qrng_alloc(gsl_qrng_sobol, static_cast<unsigned>(size))) {
    if (!sequence_) throw std::bad_alloc();
  }
  [[nodiscard]] Place next() {
    Place place{.z = std::vector<double>(sequence_->dimension)};
    gsl_qrng_get(sequence_.get(), place.z.data());
    for (double& z : place.z) z *= k_end_of_z;
    return place;
  }

 private:
  struct Free {
    void operator()(gsl_qrng* sequence) const noexcept { gsl_qrng_free(sequence); }
  };
  std::unique_ptr<gsl_qrng, Free> sequence_;
};

class Search {
 public:
  explicit Search(const LeastSquaresProblem& problem) : problem_(problem), box_(problem) {}

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
      Place end = descend(box_, starts[k], k_short_descent, ends);
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
      Place place;
      for (std::size_t k = 0; k < box_.size(); ++k) place.z.push_back(box_.z_of(k, minimum.parameters[k]));
      place.cost = box_.cost_at(place);
      if (place.cost < k_no_cost) starts.push_back(std::move(place));
    }
    if (starts.empty()) return std::nullopt;
    if (accuracy == Accuracy::full) return finish(std::move(starts));
    std::ranges::stable_sort(starts, {}, &Place::cost);
    const Place end = descend(box_, starts.front(), k_rough_descent);
    return solution(end, {end});
  }

 private:
  /// Draws points, which are densest at the bounds. Returns those with residuals, the best first.
  [[nodiscard]] std::vector<Place> scan() {
    const std::size_t wanted = k_scanned[std::min(box_.size(), k_scanned.size()) - 1];
    SobolPoints points(box_.size());
    std::vector<Place> places;
    for (std::size_t count = 0; count < k_most_passed_over * wanted && places.size() < wanted; ++count) {
      Place place = points.next();
      place.cost = box_.cost_at(place);
      if (place.cost < k_no_cost) places.push_back(std::move(place));
      advance_to(k_scan_share * std::min(1.0, static_cast<double>(count) / static_cast<double>(wanted)));
    }
    std::ranges::stable_sort(places, {}, &Place::cost);
    return places;
  }

  /// The best point of each slice of the box, in which one parameter is nearly constant.
  [[nodiscard]] std::vector<Place> starts_of(const std::vector<Place>& scanned) const {
    std::vector<Place> starts;
    for (std::size_t k = 0; k < box_.size(); ++k) {
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
    Place place = starts.empty() ? Place{.z = std::vector<double>(box_.size())} : starts.front();
    bool is_given = false;
    for (std::size_t k = 0; k < box_.size(); ++k) {
      if (const auto& start = problem_.parameters[k].start) {
        is_given = true;
        place.z[k] = box_.z_of(k, *start);
      }
    }
    if (!is_given) return;
    place.cost = box_.cost_at(place);
    if (place.cost < k_no_cost) starts.insert(starts.begin(), std::move(place));
  }

  [[nodiscard]] LeastSquaresSolution finish(std::vector<Place> places) {
    keep_distinct(places, k_near_place);
    const double limit = k_worth_an_end * places.front().cost;
    std::erase_if(places, [&](const Place& place) { return place.cost > limit; });
    places.resize(std::min(places.size(), k_descended_to_end));
    for (Place& place : places) place = descend(box_, place, k_long_descent);
    keep_distinct(places, k_same_place);
    places.front() = descend_over_kinks(box_, descend_to_round_off(box_, places.front()));
    return settled_at_bounds(places);
  }

  /// Sets a parameter that is almost at a bound to that bound if this does not raise the cost, and searches that face
  /// of the box for its own minimum.
  /// @param places  the best first
  [[nodiscard]] LeastSquaresSolution settled_at_bounds(const std::vector<Place>& places) {
    const Place& best = places.front();
    LeastSquaresSolution found = solution(best, places);
    const double round_off = problem_.noise * problem_.noise * static_cast<double>(problem_.residual_count);
    for (std::size_t k = 0; k < box_.size(); ++k) {
      if (!box_.is_near_bound(best, k)) continue;
      const bool is_lower = box_.share(best, k) < 0.5;
      const double bound = is_lower ? problem_.parameters[k].lower : problem_.parameters[k].upper;
      auto face = minimum_of_face(k, bound);
      box_.count(face ? face->evaluations : 1, face ? face->failures : 1);
      if (!face || face->cost > found.cost * (1.0 + k_same_cost) + round_off) continue;
      const auto place = static_cast<std::ptrdiff_t>(k);
      face->parameters.insert(face->parameters.begin() + place, bound);
      face->bounds.insert(face->bounds.begin() + place, is_lower ? Bound::lower : Bound::upper);
      for (LocalMinimum& other : face->minima) other.parameters.insert(other.parameters.begin() + place, bound);
      found = std::move(*face);
      break;
    }
    found.evaluations = box_.evaluations();
    found.failures = box_.failures();
    return found;
  }

  [[nodiscard]] std::optional<LeastSquaresSolution> minimum_of_face(std::size_t k, double bound) const {
    const LeastSquaresProblem face = with_held(problem_, k, bound);
    if (box_.size() > 1) return Search(face).run();
    LeastSquaresSolution corner;
    corner.residuals.resize(problem_.residual_count);
    if (!face.residuals({}, corner.residuals)) return std::nullopt;
    corner.cost = cost_of(problem_, corner.residuals);
    corner.minima = {{{}, corner.cost}};
    corner.has_converged = true;
    corner.evaluations = 1;
    return corner;
  }

  [[nodiscard]] LocalMinimum minimum(const Place& place) const { return {box_.parameters_at(place), place.cost}; }

  [[nodiscard]] LeastSquaresSolution solution(const Place& best, const std::vector<Place>& all) {
    LeastSquaresSolution solution;
    static_cast<LocalMinimum&>(solution) = minimum(best);
    solution.bounds.assign(box_.size(), Bound::none);
    for (const Place& place : all) solution.minima.push_back(minimum(place));
    solution.residuals = box_.residuals_at(solution.parameters);
    solution.has_converged = best.has_converged;
    solution.evaluations = box_.evaluations();
    solution.failures = box_.failures();
    return solution;
  }

  void advance_to(double done) const {
    if (problem_.progress) problem_.progress(done);
  }

  const LeastSquaresProblem& problem_;
  SearchBox box_;
};

}  // namespace

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
