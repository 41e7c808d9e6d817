#include "nonlocal/particle.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "contacts/centre/obstacles.hpp"
#include "contacts/side_ahead.hpp"
#include "system/equations.hpp"
#include "system/limit.hpp"
#include "system/resolution.hpp"

namespace monograin::nonlocal {
namespace {

/// Signed square of a force-controlled class from its unknown.
double square_of(double power) { return std::pow(std::max(power, 0.0), 1.0 / k_force_power); }

[[noreturn]] void throw_pull(std::size_t i) {
  throw DomainError({.limit = Limit::wall_would_pull, .contact_class = static_cast<int>(i)});
}

}  // namespace

Particle::Particle(const Settings& settings, std::span<const ContactClass> classes)
    : settings_(settings),
      contacts_(settings.model, classes, settings.centre),
      scales_(scales_of(settings, classes, contacts_)),
      ramps_(classes.size()),
      search_(contacts_),
      motion_(contacts_),
      support_(contacts_),
      state_(contacts_.unknown_count()),
      rates_(contacts_.unknown_count()),
      all_rates_(contacts_.unknown_count() + 1),
      now_(classes.size()),
      drawn_ramps_(classes.size()) {
  for (auto* marks : {&mode.is_closed, &mode.touches}) marks->resize(classes.size());
}

// --- program

void Particle::set_ramps(std::span<const Ramp> ramps, std::span<double> y) {
  for (std::size_t i = 0; i < size(); ++i) {
    const bool was_by_force = is_force_controlled(i);
    const double unit = ramps[i].is_force_controlled() ? settings_.force_unit() : settings_.initial_radius;
    ramps_[i] = {ramps[i].start / unit, ramps[i].end / unit, ramps[i].control};
    if (was_by_force && !is_force_controlled(i)) y[i] = square_of(y[i]);
    if (!was_by_force && is_force_controlled(i)) y[i] = std::pow(std::max(y[i], 0.0), k_force_power);
  }
}

double Particle::end_of_force(std::size_t i) const noexcept {
  const Ramp& ramp = ramps_[i];
  return ramp.start > 0.0 && ramp.end <= 0.0 ? ramp.start / (ramp.start - ramp.end) : k_infinity;
}

void Particle::require_pressing_walls(double xi) const {
  for (std::size_t i = 0; i < size(); ++i) {
    if (is_force_controlled(i) && prescribed(i, xi + k_ahead) < 0.0) throw_pull(i);
  }
}

double Particle::square_under_force(std::size_t i, double xi) const {
  const double force = prescribed(i, xi);
  if (force < 0.0) throw_pull(i);
  return contacts_.law().signed_square_under(force / contacts_.composite_modulus());
}

/// Calls `ask`, and replaces its error where a prescribed force ends and would turn negative: the wall would have to
/// pull. Contacts leave the centre at the same instant, so that any trial may lack a state there, even a distant one.
void Particle::or_report_pull(double xi, auto&& ask) const {
  try {
    ask();
  } catch (const std::domain_error&) {
    for (std::size_t i = 0; i < size(); ++i) {
      if (is_force_controlled(i) && ramps_[i].end < 0.0 && square_under_force(i, xi) <= scales_.idle) throw_pull(i);
    }
    throw;
  }
}

// --- states

std::span<double> Particle::evaluate(double xi, std::span<const double> y) {
  std::ranges::copy(y.first(state_.size()), state_.begin());
  ahead_.clear();
  for (std::size_t i = 0; i < size(); ++i) {
    if (is_force_controlled(i)) state_[i] = square_under_force(i, xi);
  }
  return state_;
}

/// Copies state_ to y, as its power 3/2 where a force is prescribed.
void Particle::note(std::span<double> y) const {
  std::ranges::copy(state_, y.begin());
  for (std::size_t i = 0; i < size(); ++i) {
    if (is_force_controlled(i)) y[i] = std::pow(state_[i], k_force_power);
  }
}

std::optional<double> Particle::square_ahead(std::size_t i, double xi) {
  return contacts::side_ahead(xi, scales_.touch, [&](double later) {
    auto known = std::ranges::find(ahead_, later, &StateAhead::xi);
    if (known == ahead_.end()) {
      std::vector<double> next = ahead_.empty() ? state_ : ahead_.back().state;
      search_.solve(contacts_, ramps_, later, next);
      known = ahead_.insert(known, {later, std::move(next)});
    }
    return known->state[i];
  });
}

// --- equations

void Particle::solve(double xi, std::span<double> y) {
  evaluate(xi, y);
  // The path begins at y under force control, too: from another depth, the centre would move along another path.
  for (std::size_t i = 0; i < size(); ++i) {
    if (is_force_controlled(i)) state_[i] = square_of(y[i]);
  }
  // A contact that is open in its regime may be loaded beyond an event still to be located. The states before know
  // nothing of it.
  bool is_own_mode = true;
  for (std::size_t i = 0; i < size(); ++i) {
    is_own_mode = is_own_mode && (mode.is_closed[i] || state_[i] <= scales_.touch);
  }
  or_report_pull(xi, [&] { search_.solve(contacts_, ramps_, xi, state_, is_own_mode); });
  note(y);
}

void Particle::carry_to_support(std::span<double> y) {
  if (!has_free_centre()) return;
  evaluate(0.0, y);
  if (std::ranges::any_of(std::span(state_).first(size()), [&](double s) { return s > scales_.touch; })) return;
  Eigen::Vector3d push = Eigen::Vector3d::Zero();
  double sum = 0.0;
  std::vector<contacts::Obstacle> walls;
  std::vector<char> touches;
  for (std::size_t i = 0; i < size(); ++i) {
    const Eigen::Vector3d& mean_normal = contacts_.mean_normal(i);
    if (is_force_controlled(i)) {
      push += contacts_.weight(i) * ramps_[i].end * mean_normal;
      sum += contacts_.weight(i) * std::abs(ramps_[i].end);
    } else if (mean_normal.norm() > k_same_direction) {
      walls.push_back({i, mean_normal, ramps_[i].start});
      touches.push_back(state_[i] >= -scales_.touch);
    }
  }
  if (!(push.norm() > k_round_off * sum)) return;
  if (const auto centre = contacts::carried_to_support(push, walls, touches, contacts_.centre_of(y)))
    put_centre(contacts_, walls, *centre, y);
}

void Particle::clear_centre(double xi, std::span<double> y) {
  evaluate(xi, y);
  search_.clear_centre(contacts_, ramps_, xi, mode.is_closed, state_);
  note(y);
}

double Particle::leave_singularity(double xi, std::span<double> y) {
  if (!has_free_centre()) return xi;
  evaluate(xi, y);
  const double ahead = std::min(xi + k_ahead, 1.0);
  double later = xi;
  for (std::size_t i = 0; i < size(); ++i) {
    if (!is_force_controlled(i)) continue;
    const double end = end_of_force(i);
    const bool begins = state_[i] <= scales_.touch && prescribed(i, ahead) > prescribed(i, xi);
    // A contact is lost at the touch tolerance; the rest allows for the error of that event.
    if (begins && support_.may_be_held(contacts_, ramps_, state_, 2.0 * scales_.touch)) later = ahead;
    if (end > xi && end - xi < 2.0 * k_ahead) later = end;
  }
  if (later == xi) return xi;
  const double energy = contacts_.energy(state_);
  try {
    search_.solve(contacts_, ramps_, later, evaluate(later, y));
  } catch (const std::domain_error&) {
    return xi;  // the next evaluation from here throws again
  }
  note(y);
  y[work_slot()] += contacts_.energy(state_) - energy;
  return later;
}

/// dF/dxi of a contact, by the rates found last.
double Particle::force_rate(std::size_t i) const {
  if (is_force_controlled(i)) return ramps_[i].rate();
  const double stiffness = now_[i].stiffness;
  return stiffness > 0.0 ? stiffness * contacts_.law().at(state_[i]).approach_slope * rates_[i] : 0.0;
}

/// Speed of a wall under force control, by the rates found last.
double Particle::speed_under_force(std::size_t i) const {
  double speed = now_[i].stiffness > 0.0 ? ramps_[i].rate() / now_[i].stiffness : 0.0;
  for (std::size_t h = 0; h < size(); ++h) speed -= contacts_.coupling()(as_index(i), as_index(h)) * force_rate(h);
  for (std::size_t k = 0; k < contacts_.free_count(); ++k)
    speed -= contacts_.mean_normal(i)[as_index(k)] * rates_[size() + k];
  return speed;
}

void Particle::rates(double xi, std::span<const double> y, std::span<double> dy) {
  evaluate_contacts(xi, y);
  for (std::size_t i = 0; i < size(); ++i) {
    drawn_ramps_[i] = ramps_[i];
    if (!is_force_controlled(i)) drawn_ramps_[i].end += k_stabilization * (prescribed(i, xi) - now_[i].displacement);
  }
  const Tolerances tolerances{.touch = scales_.touch, .pull = k_stabilization, .touches = mode.touches};
  or_report_pull(xi, [&] { motion_.find(contacts_, drawn_ramps_, state_, rates_, tolerances); });
  std::ranges::copy(rates_, dy.begin());
  double power = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    if (is_force_controlled(i)) {
      // Rate of s^(3/2), the unknown; no other rate depends on it.
      const LocalContact local = contacts_.law().at(std::max(state_[i], 1e-200));
      dy[i] = ramps_[i].rate() * k_force_power / (2.0 * contacts_.composite_modulus() * local.approach_slope);
    }
    const double speed = is_force_controlled(i) ? speed_under_force(i) : ramps_[i].rate();
    power += contacts_.weight(i) * now_[i].force * speed;
  }
  dy[work_slot()] = power;
}

void Particle::residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) {
  evaluate(xi, y);
  or_report_pull(xi, [&] { nonlocal::residual(contacts_, ramps_, xi, state_, res.first(state_.size())); });
  for (std::size_t i = 0; i < size(); ++i) {
    if (is_force_controlled(i)) res[i] = y[i] - std::pow(state_[i], k_force_power);
  }
  rates(xi, y, all_rates_);
  res[work_slot()] = dy[work_slot()] - all_rates_[work_slot()];
  // The balance of forces does not determine the position of a centre that no contact supports.
  const std::size_t count = contacts_.free_count();
  if (count == 0) return;
  Eigen::Vector3d missing = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < count; ++k) missing[as_index(k)] = dy[size() + k] - all_rates_[size() + k];
  motion_.let_unheld_centre_go(contacts_, ramps_, mode.is_closed, missing, res.subspan(size(), count));
}

void Particle::branch_reach(std::span<const double> y, std::span<double> reach) const {
  std::ranges::fill(reach, k_infinity);
  for (std::size_t i = 0; i < size(); ++i) {
    const double square = is_force_controlled(i) ? square_of(y[i]) : y[i];
    reach[i] = contacts_.branch_reach(i, square);
    if (is_force_controlled(i)) reach[i] = std::pow(square + reach[i], k_force_power) - y[i];
  }
}

std::optional<Difficulty> Particle::difficulty(double xi, std::span<const double> y) {
  if (scales_.is_below_resolution) return Difficulty::below_resolution;  // the whole program is
  if (contacts_.margin(evaluate(xi, y)) < k_hard_margin) return Difficulty::near_applicability_limit;
  if (!has_free_centre() || !is_held_softly(contacts_, ramps_, state_, scales_.idle)) return std::nullopt;
  return Difficulty::singular_balance;
}

}  // namespace monograin::nonlocal
