#include "engine/event_locator.hpp"

#include <algorithm>
#include <array>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "system/resolution.hpp"

namespace monograin {
namespace {

// A guard counts as zero at its root below k_round_off_of_guard times the larger of its values at the bracket's ends,
// and below k_most_of_guard times the smaller one.
constexpr double k_round_off_of_guard = 1e-14;
constexpr double k_most_of_guard = 1e-12;
// First distance, over xi, by which a root short of zero is moved on.
constexpr double k_round_off_of_root = 1e-15;
constexpr double k_share_of_progress = 1e-2;  // width of the bracket of a root, over least_progress()
// Evaluations inside a piece for which memory is reserved: at twelve nodes, and near the end of a branch.
constexpr std::size_t k_usual_samples = 12 + k_evaluations_before_end;

}  // namespace

EventLocator::EventLocator(Equations& system, GuardSet& guard_set) : system_(system), guard_set_(guard_set) {
  for (Instant* at : {&begin_, &end_, &between_, &extremum_, &root_}) at->state.resize(system.unknowns().size());
}

void EventLocator::begin_segment(double xi, std::span<const double> y) {
  ++statistics_.segments;
  begin_.xi = end_.xi = xi;
  std::ranges::copy(y, end_.state.begin());
  for (Instant* at : {&begin_, &end_, &between_, &extremum_, &root_}) at->values.resize(guard_set_.size());
  samples_.clear();
  samples_.reserve(k_usual_samples * row_length());
  fired_.reserve(guard_set_.size());
  evaluate_guards(xi, end_.state, end_.values);
  read_sides();
}

void EventLocator::begin_piece() {
  std::swap(begin_, end_);
  end_.xi = begin_.xi;
  fired_.clear();
  forget_samples();
}

void EventLocator::sample_inside(double xi, std::span<const double> y) {
  const auto values = std::span(between_.values);
  evaluate_guards(xi, y, values);
  // A guard that is zero to within round-off keeps the side of its last value.
  const View last = sample(sample_count());
  for (std::size_t g = 0; g < values.size(); ++g) {
    if (std::abs(values[g]) <= k_zero_guard) values[g] = last.values[g];
  }
  samples_.push_back(xi);
  samples_.insert(samples_.end(), values.begin(), values.end());
}

void EventLocator::sample_inside(double xi) {
  state_at(xi, between_.state);
  sample_inside(xi, between_.state);
}

void EventLocator::evaluate_guards(double xi, std::span<const double> y, std::span<double> values) {
  ++statistics_.guard_evaluations;
  guard_set_.values(xi, y, values);
}

void EventLocator::evaluate(double xi, Instant& at) {
  at.xi = xi;
  state_at(xi, at.state);
  evaluate_guards(xi, at.state, at.values);
}

/// Replaces the value of a guard that is zero, or just past zero, where the segment begins (as at first touch) by its
/// value just ahead: the guard is on the side to which it moves.
void EventLocator::read_sides() {
  const auto is_open = [this](std::size_t g) {
    return std::abs(end_.values[g]) <= guard_tolerance() && guard_set_.directions()[g] * end_.values[g] >= 0.0;
  };
  bool any = false;
  for (std::size_t g = 0; g < end_.values.size(); ++g) any = any || is_open(g);
  if (!any) return;
  const double ahead = end_.xi + std::min(k_ahead, 0.5 * (1.0 - end_.xi));
  std::ranges::copy(end_.state, between_.state.begin());
  try {
    state_ahead(ahead, between_.state);
    evaluate_guards(ahead, between_.state, between_.values);
  } catch (const std::domain_error&) {
    return;  // no solution ahead: the first piece finds out how far solutions exist
  }
  for (std::size_t g = 0; g < end_.values.size(); ++g) {
    if (is_open(g)) end_.values[g] = between_.values[g];
  }
}

/// Stored values of the guards in the order of xi: index 0 is the beginning of the piece, then come the evaluations
/// inside it; any larger index is the end.
EventLocator::View EventLocator::sample(std::size_t index) const {
  if (index == 0) return begin_;
  if (index > sample_count()) return end_;
  const auto row = std::span(samples_).subspan((index - 1) * row_length(), row_length());
  return {row.front(), row.subspan(1)};
}

bool EventLocator::any_crosses(const View& before, const View& after) const {
  const auto directions = guard_set_.directions();
  for (std::size_t g = 0; g < directions.size(); ++g) {
    if (crosses(directions[g], before.values[g], after.values[g])) return true;
  }
  return false;
}

/// Position between an evaluation and the next at which a guard may have crossed zero and returned: the first extremum
/// of a parabola through these two values and the one after, or the one before. Without any: the next evaluation.
/// @param interval  index of the first evaluation, as in sample()
double EventLocator::hidden_extremum(std::size_t interval) const {
  const View a = sample(interval);
  const View b = sample(interval + 1);
  if (b.xi - a.xi < k_shortest_sampled || samples_.empty()) return b.xi;
  struct Third {
    std::span<const double> values;
    double per_distance_from_b = 0.0;  ///< one over the signed distance
    double per_distance_from_a = 0.0;
  };
  std::array<Third, 2> thirds;
  std::size_t count = 0;
  const auto add = [&](const View& view) {
    thirds[count++] = {view.values, 1.0 / (view.xi - b.xi), 1.0 / (view.xi - a.xi)};
  };
  if (interval < sample_count()) add(sample(interval + 2));
  if (interval > 0) add(sample(interval - 1));

  const auto directions = guard_set_.directions();
  const double per_length = 1.0 / (b.xi - a.xi);
  double extremum = b.xi;
  for (std::size_t g = 0; g < directions.size(); ++g) {
    const double at_a = a.values[g];
    const double at_b = b.values[g];
    const double sign = at_a < 0.0 ? 1.0 : -1.0;  // towards zero
    if (at_a == 0.0 || (directions[g] != 0 && directions[g] != static_cast<int>(sign))) continue;
    const double slope = (at_b - at_a) * per_length;
    for (const Third& third : std::span(thirds).first(count)) {
      const double next_slope = (third.values[g] - at_b) * third.per_distance_from_b;
      const double curvature = (next_slope - slope) * third.per_distance_from_a;
      if (!(sign * curvature < 0.0)) continue;
      const double own = 0.5 * (a.xi + b.xi - slope / curvature);
      if (own > a.xi && own < b.xi) extremum = std::min(extremum, own);
    }
  }
  return extremum;
}

/// End of an interval between two evaluations, or an extremum of guards in it, if a guard crosses zero up to there;
/// none if none crosses.
std::optional<EventLocator::View> EventLocator::crossed_in(std::size_t interval) {
  const View before = sample(interval);
  const View after = sample(interval + 1);
  if (any_crosses(before, after)) return after;
  const double extremum = hidden_extremum(interval);
  if (extremum == after.xi) return std::nullopt;
  evaluate(extremum, extremum_);
  if (any_crosses(before, extremum_)) return extremum_;
  return std::nullopt;
}

/// Moves the end of the piece to the first root in it, if there is one.
void EventLocator::locate_event() {
  fired_.clear();
  struct End {
    double root = 0.0;
    std::size_t guard = 0;
  };
  std::optional<End> of_branch;
  // Intervals between two evaluations: interval i begins at sample(i).
  for (std::size_t interval = 0; interval <= sample_count();) {
    const View before = sample(interval);
    const auto crossed = crossed_in(interval);
    if (!crossed) {
      ++interval;
      continue;
    }
    const View after = *crossed;
    std::size_t first = 0;
    double root = 0.0;
    try {
      root = first_root(before, after, first);
    } catch (const std::domain_error&) {
      // No state need exist between two evaluations if the second state is not on the branch of the first.
      const double nearer = std::midpoint(before.xi, after.xi);
      if (nearer - begin_.xi < least_progress(begin_.xi)) throw;
      interval = shorten(nearer, interval);
      continue;
    }
    const bool is_shorter = root < end_.xi - least_progress(begin_.xi);
    interval = shorten(root, interval);
    const double last_sample = sample(interval).xi;
    if (guard_set_.is_branch_end(first) && !of_branch) {
      of_branch = {root, first};
      sample_up_to(last_sample);
      continue;
    }
    // If another guard has an earlier root, the loop searches what is left of the piece again.
    if (collect_fired(first, sample(interval), is_shorter)) return;
    fired_.clear();
  }
  // The end of a branch counts as a root even if its guard is short of zero by round-off: every next piece would end
  // there as well.
  if (of_branch && of_branch->root == end_.xi) fired_.push_back(of_branch->guard);
}

/// Collects the guards that fire at the end of the piece: the first one, and those that cross zero with it.
/// @param last        values at the last evaluation before the end
/// @param is_shorter  true if the root has moved the end
/// @return false if another guard has a root before the end
bool EventLocator::collect_fired(std::size_t first, const View& last, bool is_shorter) {
  fired_.clear();
  bool has_earlier = false;
  const auto directions = guard_set_.directions();
  for (std::size_t g = 0; g < directions.size(); ++g) {
    if (g != first && !crosses(directions[g], last.values[g], end_.values[g])) continue;
    if (g == first || !is_shorter || std::abs(end_.values[g]) <= guard_tolerance())
      fired_.push_back(g);
    else
      has_earlier = true;
  }
  return !has_earlier;
}

/// Ends the piece at xi, or earlier if no state exists at xi, and drops the evaluations beyond the end.
/// @param samples  number of evaluations inside the piece to keep at most
/// @return number of evaluations left
std::size_t EventLocator::shorten(double xi, std::size_t samples) {
  if (xi < end_.xi) move_end(xi);
  while (samples > 0 && sample(samples).xi >= end_.xi) --samples;
  samples_.resize(samples * row_length());
  return samples;
}

/// Evaluates the guards between xi = last and the end that a root has given the piece, ever nearer to the end.
void EventLocator::sample_up_to(double last) {
  double distance = end_.xi - last;
  for (std::size_t k = 0; k < k_evaluations_before_end; ++k) {
    distance *= k_approach_to_end;
    if (distance < least_progress(end_.xi)) return;
    try {
      sample_inside(end_.xi - distance);
    } catch (const std::domain_error&) {
      continue;  // next to the end of the equations the solver may miss a state that exists
    }
  }
}

/// First root of any guard between two evaluations. Guards are polished in the order in which their secants cross zero;
/// a guard that has not crossed at the first root so far has its own root beyond it and is skipped.
/// @param guard  receives the guard of that root
double EventLocator::first_root(const View& before, const View& after, std::size_t& guard) {
  const auto directions = guard_set_.directions();
  candidates_.clear();
  for (std::size_t g = 0; g < directions.size(); ++g) {
    if (!crosses(directions[g], before.values[g], after.values[g])) continue;
    candidates_.push_back({g, before.values[g] / (before.values[g] - after.values[g])});
  }
  std::ranges::sort(candidates_, {}, &Candidate::share);
  double first = k_infinity;
  View up_to = after;
  for (const auto& [g, share] : candidates_) {
    if (first < up_to.xi) {
      evaluate(first, root_);
      up_to = root_;
    }
    if (!crosses(directions[g], before.values[g], up_to.values[g])) continue;
    const double root = polish(g, before, up_to);
    if (root >= first) continue;
    first = root;
    guard = g;
  }
  return first;
}

/// Root of one guard between two evaluations: at or just past zero, so that the event lies behind xi and not ahead.
double EventLocator::polish(std::size_t guard, const View& before, const View& after) {
  // If the evaluations are as near as the round-off of xi, both are the root.
  if (!(after.xi > before.xi)) return after.xi;
  const auto [smaller, larger] = std::minmax({std::abs(before.values[guard]), std::abs(after.values[guard])});
  const double round_off = std::min(k_round_off_of_guard * larger, k_most_of_guard * smaller);
  double value = 0.0;
  const auto function = [&](double xi) {
    evaluate(xi, between_);
    value = between_.values[guard];
    return std::abs(value) <= round_off ? 0.0 : value;
  };
  std::uintmax_t iterations = 100;
  const auto [below, above] = boost::math::tools::toms748_solve(
      function, before.xi, after.xi, before.values[guard], after.values[guard],
      [](double a, double b) { return b - a <= k_share_of_progress * least_progress(b); }, iterations);
  if (below < above) return above;
  // The root may be short of zero by round-off: moves on, in growing steps, until it is not.
  double root = above;
  double step = k_round_off_of_root * root;
  while (value != 0.0 && (value > 0.0) == (before.values[guard] > 0.0)) {
    root += step;
    if (root >= after.xi) return after.xi;
    function(root);
    step *= 4.0;
  }
  return root;
}

}  // namespace monograin
