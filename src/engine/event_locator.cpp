#include "engine/event_locator.hpp"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <stdexcept>

namespace monograin {
namespace {

// Pieces of a step in which guards are looked at; events do not depend on it as long as guards cross once per piece.
constexpr double k_pieces = 32.0;
// Shorter pieces are not searched for guards that cross twice.
constexpr double k_smallest_hidden = 1e-6;
// An extremum this near to zero, over the guard in the middle of the piece, is looked at.
constexpr double k_near = 0.5;
// How far ahead the side of a guard that begins at zero is read.
constexpr double k_ahead = 1e-9;

bool crosses(int direction, double before, double after) noexcept {
  if (direction > 0) return before < 0.0 && after >= 0.0;
  if (direction < 0) return before > 0.0 && after <= 0.0;
  return (before < 0.0 && after >= 0.0) || (before > 0.0 && after <= 0.0);
}

}  // namespace

EventLocator::EventLocator(HybridSystem& system, Watch& watch) : system_(system), watch_(watch) {
  for (auto* state : {&begin_state_, &end_state_, &guess_}) state->resize(system.unknowns().size());
}

double EventLocator::next_piece_end(double xi) noexcept {
  return std::min(1.0, (std::floor(xi * k_pieces + 1e-9) + 1.0) / k_pieces);
}

void EventLocator::begin_segment(double xi, std::span<const double> y) {
  ++statistics_.segments;
  begin_ = end_ = xi;
  std::ranges::copy(y, end_state_.begin());
  for (auto* values : {&values_, &middle_values_, &begin_values_, &end_values_}) values->resize(watch_.size());
  fired_.reserve(watch_.size());
  look(end_, end_state_, end_values_);
  read_sides();
}

void EventLocator::begin_piece() {
  begin_ = end_;
  std::swap(begin_state_, end_state_);
  std::swap(begin_values_, end_values_);
  fired_.clear();
}

void EventLocator::look(double xi, std::span<const double> y, std::span<double> values) {
  ++statistics_.guard_evaluations;
  watch_.values(xi, y, values);
}

/// A guard that is zero, or just past it, where the segment begins (first touch) is on the side to which it leaves.
void EventLocator::read_sides() {
  const auto is_open = [this](std::size_t g) {
    return std::abs(end_values_[g]) <= guard_tolerance() && watch_.directions()[g] * end_values_[g] >= 0.0;
  };
  bool any = false;
  for (std::size_t g = 0; g < end_values_.size(); ++g) any = any || is_open(g);
  if (!any) return;
  const double ahead = end_ + std::min(k_ahead, 0.5 * (1.0 - end_));
  std::ranges::copy(end_state_, guess_.begin());
  try {
    state_ahead(ahead, guess_);
    look(ahead, guess_, values_);
  } catch (const std::domain_error&) {
    return;  // no solution ahead: the first piece will find out how far there is one
  }
  for (std::size_t g = 0; g < end_values_.size(); ++g) {
    if (is_open(g)) end_values_[g] = values_[g];
  }
}

/// Moves the end of the piece to the first root in it, if there is one.
void EventLocator::locate_event() {
  fired_.clear();
  for (;;) {
    const auto directions = watch_.directions();
    std::size_t first = directions.size();
    double root = end_;
    for (std::size_t g = 0; g < directions.size(); ++g) {
      if (!crosses(directions[g], begin_values_[g], end_values_[g])) continue;
      const double found = polish(g);
      if (first == directions.size() || found < root) {
        first = g;
        root = found;
      }
    }
    if (first == directions.size()) {
      if (!shorten_to_hidden_crossing()) return;
      continue;
    }
    const bool is_shorter = root < end_ - k_smallest;
    if (root < end_) move_end(root);
    // An earlier root that this piece's ends did not show is looked for again in the shorter piece.
    fired_.clear();
    bool has_earlier = false;
    for (std::size_t g = 0; g < directions.size(); ++g) {
      if (g == first) {
        fired_.push_back(g);
      } else if (crosses(directions[g], begin_values_[g], end_values_[g])) {
        if (!is_shorter || std::abs(end_values_[g]) <= guard_tolerance())
          fired_.push_back(g);
        else
          has_earlier = true;
      }
    }
    if (!has_earlier && !shorten_to_hidden_crossing()) return;
    fired_.clear();
  }
}

/// A guard that is on the same side at both ends of the piece may have crossed and come back in between. Looks at the
/// middle, and from there at the extremum of the parabola through the three; where a guard is past, ends the piece.
bool EventLocator::shorten_to_hidden_crossing() {
  if (end_ - begin_ < k_smallest_hidden || watch_.size() == 0) return false;
  const double middle = std::midpoint(begin_, end_);
  state_at(middle, guess_);
  look(middle, guess_, middle_values_);
  const auto directions = watch_.directions();
  double extremum = end_;
  for (std::size_t g = 0; g < directions.size(); ++g) {
    const double before = begin_values_[g];
    const double sign = before < 0.0 ? 1.0 : -1.0;  // towards zero
    if (before == 0.0 || (directions[g] != 0 && directions[g] != static_cast<int>(sign))) continue;
    if (crosses(directions[g], before, middle_values_[g])) {
      move_end(middle);
      return true;
    }
    const double slope = end_values_[g] - before;
    const double curvature = 2.0 * (before + end_values_[g] - 2.0 * middle_values_[g]);
    if (!(sign * curvature < 0.0)) continue;
    const double place = 0.5 - 0.5 * slope / curvature;  // share of the piece
    const double height = before + place * (slope - curvature * (1.0 - place));
    if (place <= 0.0 || place >= 1.0 || sign * height < -k_near * std::abs(middle_values_[g])) continue;
    extremum = std::min(extremum, std::lerp(begin_, end_, place));
  }
  if (extremum == end_) return false;
  state_at(extremum, guess_);
  look(extremum, guess_, middle_values_);
  for (std::size_t g = 0; g < directions.size(); ++g) {
    if (!crosses(directions[g], begin_values_[g], middle_values_[g])) continue;
    move_end(extremum);
    return true;
  }
  return false;
}

/// Root of one guard in the piece.
double EventLocator::polish(std::size_t guard) {
  if (end_values_[guard] == 0.0) return end_;
  std::uintmax_t iterations = 100;
  const auto function = [&](double xi) {
    state_at(xi, guess_);
    look(xi, guess_, values_);
    return values_[guard];
  };
  const auto [below, above] = boost::math::tools::toms748_solve(
      function, begin_, end_, begin_values_[guard], end_values_[guard],
      [](double a, double b) { return b - a <= 1e-15 * std::max(1e-3, std::abs(b)); }, iterations);
  return above;  // on or just past the boundary, so that the event lies behind and not ahead
}

}  // namespace monograin
