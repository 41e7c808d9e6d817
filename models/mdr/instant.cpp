// Contacts and walls of the MDR system at an instant.

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "mdr/system.hpp"

namespace monograin::mdr {
namespace {

// Over its contact radius there, a contact under force that is this near to pull-off has reached it: the square of
// this is below the rounding of forces.
constexpr double k_at_pull_off = 1e-9;

}  // namespace

/// Contacts of all classes at an instant.
/// @throws std::domain_error where the volume of the particle is not defined
void System::evaluate(double xi, std::span<const double> y) {
  evaluate_forces(xi, y);
  keep_evaluation(xi, y);
}

/// Evaluates all contacts without asking whether the volume of the particle is defined.
void System::evaluate_forces(double xi, std::span<const double> y) {
  drop_evaluation();
  const double r = y[k_radius];
  evaluated_radius_ = r;
  longest_ = 1.0;
  for (int k = 0; k < free_count_; ++k) longest_ = std::max(longest_, std::abs(y[centre_place(k)]));
  for (std::size_t i = 0; i < now_.size(); ++i) {
    const double carried = carried_by_centre(i, y);
    now_[i].position = is_loaded(i) ? y[wall_places_[i]] - carried : prescribed_position(i, xi);
    evaluate_contact(i, is_loaded(i) ? y[wall_places_[i]] : now_[i].position + carried, r);
  }
  sum_up(xi, r);
}

void System::keep_evaluation(double xi, std::span<const double> y) {
  if (!(sums_.under_root > 0.0)) throw DomainError(Limit::half_volume);
  seen_xi_ = xi;
  std::ranges::copy(y, seen_.begin());
}

/// Evaluates all contacts at a state, or keeps the cached evaluation if it is for the same state: right-hand side,
/// guards and observables are asked for in turn.
void System::evaluate_cached(double xi, std::span<const double> y) {
  bool is_seen = seen_xi_ == xi && seen_[k_radius] == y[k_radius];
  for (std::size_t k = k_centre; is_seen && k < y.size(); ++k) is_seen = seen_[k] == y[k];
  if (!is_seen) evaluate(xi, y);
}

void System::evaluate_contact(std::size_t i, double displacement, double r) {
  now_[i].displacement = displacement;
  now_[i].overlap = displacement + r;
  now_[i].contact = branches_[i].contact(law_, r, now_[i].overlap);
}

/// Force times displacement of the contacts under force.
double System::force_work(std::span<const double> y) {
  drop_evaluation();
  double sum = 0.0;
  for (std::size_t i = 0; i < now_.size(); ++i) {
    if (!is_loaded(i)) continue;
    evaluate_contact(i, y[wall_places_[i]], y[k_radius]);
    const double position = now_[i].displacement - carried_by_centre(i, y);
    sum += counts_[i] * now_[i].contact.force * position;
  }
  return sum;
}

double System::prescribed_force(std::size_t i, double xi) const noexcept {
  return std::lerp(ramps_[i].start, ramps_[i].end, xi);
}

/// Where the program puts a wall under displacement control, towards the place where the centre started, over R0.
double System::prescribed_position(std::size_t i, double xi) const noexcept {
  // As exact as std::lerp, which takes longer than the rest of this.
  const Ramp& ramp = ramps_[i];
  return xi == 1.0 ? ramp.end : ramp.start + xi * (ramp.end - ramp.start);
}

/// How far a free centre has come towards the walls of a class.
double System::carried_by_centre(std::size_t i, std::span<const double> y) const noexcept {
  double distance = 0.0;
  for (int k = 0; k < free_count_; ++k) distance += directions_[i][k] * y[centre_place(k)];
  return distance;
}

/// The walls under force, at a given radius.
void System::move_walls(double xi, std::span<double> y) {
  if (!takes_forces_) return;
  for (std::size_t i = 0; i < ramps_.size(); ++i) {
    if (!is_loaded(i)) continue;
    double& place = y[wall_places_[i]];
    place = branches_[i].displacement_under(law_, y[k_radius], prescribed_force(i, xi), place);
  }
}

/// The unknowns of walls that are under force at other times only.
void System::note_walls(double xi, std::span<double> y) const noexcept {
  if (!takes_forces_) return;
  for (std::size_t i = 0; i < ramps_.size(); ++i) {
    if (classes_[i].takes_force && !is_loaded(i))
      y[wall_places_[i]] = prescribed_position(i, xi) + carried_by_centre(i, y);
  }
}

/// How the displacement of a wall under force goes with xi and R; zero where it stays.
void System::set_rates_under_force(std::size_t i, double r) {
  Instant& now = now_[i];
  const double speed = ramps_[i].end - ramps_[i].start;
  const Contact c = branches_[i].stiff_contact(law_, r, now_[i].overlap, now_[i].contact);
  if (branches_[i].edge.peels()) {
    // Where it pulls off, a force holds it no longer: whatever the radius, the overlap is about that.
    const double critical =
        branches_[i].pull_off(law_, branches_[i].frame(law_, r, now.overlap).indenter).by_force.contact_radius;
    if (c.contact_radius <= (1.0 + k_at_pull_off) * critical) {
      now.rate_by_growth = -1.0;
      return;
    }
  }
  if (branches_[i].touches() && c.by_overlap > 0.0) {
    now.rate_by_time = speed / c.by_overlap;
    now.rate_by_growth = -1.0 - c.by_radius / c.by_overlap;
  } else if (branches_[i].touches() || branches_[i].resting >= branches_[i].touching_overlap(law_, r) - r) {
    now.rate_by_growth = -1.0;  // without load the wall stays at the surface
  }
}

/// Puts centre and walls where they belong at a given radius.
void System::place(double xi, std::span<double> y) {
  move_walls(xi, y);
  if (free_count_ > 0) move_centre(xi, y);
  note_walls(xi, y);
}

}  // namespace monograin::mdr
