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

}  // namespace

EventLocator::EventLocator(Equations& system, GuardSet& guard_set, std::size_t samples)
    : system_(system), guard_set_(guard_set), most_samples_(samples + k_evaluations_before_end) {
  for (auto* state : {&begin_state_, &end_state_, &guess_}) state->resize(system.unknowns().size());
}

void EventLocator::begin_segment(double xi, std::span<const double> y) {
  ++statistics_.segments;
  begin_ = end_ = xi;
  std::ranges::copy(y, end_state_.begin());
  for (auto* values : {&values_, &extremum_values_, &root_values_, &begin_values_, &end_values_})
    values->resize(guard_set_.size());
  samples_.reserve(most_samples_);
  sample_values_.reserve(most_samples_ * guard_set_.size());
  fired_.reserve(guard_set_.size());
  evaluate_guards(end_, end_state_, end_values_);
  read_sides();
}

void EventLocator::begin_piece() {
  begin_ = end_;
  std::swap(begin_state_, end_state_);
  std::swap(begin_values_, end_values_);
  fired_.clear();
  forget_samples();
}

void EventLocator::sample_inside(double xi, std::span<const double> y) {
  sample_values_.resize((samples_.size() + 1) * guard_set_.size());
  const auto values = std::span(sample_values_).last(guard_set_.size());
  evaluate_guards(xi, y, values);
  // A guard that is zero to within round-off keeps the side of its last value.
  const View last = sample(samples_.size());
  for (std::size_t g = 0; g < values.size(); ++g) {
    if (std::abs(values[g]) <= k_zero_guard) values[g] = last.values[g];
  }
  samples_.push_back(xi);
}

void EventLocator::evaluate_guards(double xi, std::span<const double> y, std::span<double> values) {
  ++statistics_.guard_evaluations;
  guard_set_.values(xi, y, values);
}

/// Replaces the value of a guard that is zero, or just past zero, where the segment begins (as at first touch) by its
/// value just ahead: the guard is on the side to which it moves.
void EventLocator::read_sides() {
  const auto is_open = [this](std::size_t g) {
    return std::abs(end_values_[g]) <= guard_tolerance() && guard_set_.directions()[g] * end_values_[g] >= 0.0;
  };
  bool any = false;
  for (std::size_t g = 0; g < end_values_.size(); ++g) any = any || is_open(g);
  if (!any) return;
  const double ahead = end_ + std::min(k_ahead, 0.5 * (1.0 - end_));
  std::ranges::copy(end_state_, guess_.begin());
  try {
    state_ahead(ahead, guess_);
    evaluate_guards(ahead, guess_, values_);
  } catch (const std::domain_error&) {
    return;  // no solution ahead: the first piece finds out how far solutions exist
  }
  for (std::size_t g = 0; g < end_values_.size(); ++g) {
    if (is_open(g)) end_values_[g] = values_[g];
  }
}

/// Stored values of the guards in the order of xi: index 0 is the beginning of the piece, then come the evaluations
/// inside it; any larger index is the end.
EventLocator::View EventLocator::sample(std::size_t index) const {
  if (index == 0) return {begin_, begin_values_};
  if (index > samples_.size()) return {end_, end_values_};
  return {samples_[index - 1], std::span(sample_values_).subspan((index - 1) * guard_set_.size(), guard_set_.size())};
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
    View view;
    double per_distance_from_b = 0.0;  ///< one over the signed distance
    double per_distance_from_a = 0.0;
  };
  std::array<Third, 2> thirds;
  std::size_t count = 0;
  const auto add = [&](const View& view) { thirds[count++] = {view, 1.0 / (view.xi - b.xi), 1.0 / (view.xi - a.xi)}; };
  if (interval < samples_.size()) add(sample(interval + 2));
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
      const double next_slope = (third.view.values[g] - at_b) * third.per_distance_from_b;
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
  state_at(extremum, guess_);
  evaluate_guards(extremum, guess_, extremum_values_);
  const View between{extremum, extremum_values_};
  if (any_crosses(before, between)) return between;
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
  for (std::size_t interval = 0; interval <= samples_.size();) {
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
      if (nearer - begin_ < least_progress(begin_)) throw;
      interval = shorten(nearer, interval);
      continue;
    }
    const bool is_shorter = root < end_ - least_progress(begin_);
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
  if (of_branch && of_branch->root == end_) fired_.push_back(of_branch->guard);
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
    if (g != first && !crosses(directions[g], last.values[g], end_values_[g])) continue;
    if (g == first || !is_shorter || std::abs(end_values_[g]) <= guard_tolerance())
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
  samples_.resize(samples);
  if (xi < end_) move_end(xi);
  while (!samples_.empty() && samples_.back() >= end_) samples_.pop_back();
  return samples_.size();
}

/// Evaluates the guards between xi = last and the end that a root has given the piece, ever nearer to the end.
void EventLocator::sample_up_to(double last) {
  double distance = end_ - last;
  for (std::size_t k = 0; k < k_evaluations_before_end; ++k) {
    distance *= k_approach_to_end;
    if (distance < least_progress(end_)) return;
    try {
      state_at(end_ - distance, guess_);
      sample_inside(end_ - distance, guess_);
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
      state_at(first, guess_);
      evaluate_guards(first, guess_, root_values_);
      up_to = {first, root_values_};
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
    state_at(xi, guess_);
    evaluate_guards(xi, guess_, values_);
    value = values_[guard];
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
