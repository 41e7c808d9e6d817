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

const UnloadingShape& System::shape(std::size_t i, double r) {
  const double radius = 1.0 + r;
  const double largest = memory_[i].regime == Regime::fully_plastic ? now_[i].overlap : largest_overlap(memory_[i], r);
  // While R and the largest overlap stay, so does the shape: the greater part of the cost of an unloading force.
  if (shapes_[i].radius != radius || shapes_[i].overlap_max != largest) {
    shapes_[i] = unloading_shape(material_, radius, largest, memory_[i].area_constant);
  }
  return shapes_[i];
}

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

/// An elastic contact. Where the centre is free, a trial that opens it would find a particle that nothing holds there,
/// at rest wherever it is; a force odd in the overlap leads back to where the contact just touches. From where a wall
/// has gone far within a step, one may also lead beyond the middle of the particle: the force goes on with the slope
/// there.
Contact System::touching_contact(double radius, double overlap) const {
  const double depth = free_count_ > 0 ? std::min(std::abs(overlap), radius) : overlap;
  Contact contact = elastic_contact(settings_.elastic_profile, material_.composite_modulus, radius, depth);
  if (free_count_ > 0) contact.force += contact.by_overlap * (std::abs(overlap) - depth);
  if (overlap < 0.0) {
    contact.force = -contact.force;
    contact.by_radius = -contact.by_radius;
  }
  return contact;
}

/// A contact below its largest overlap. Where the centre is free, a trial may lead far off its branch, which is short:
/// it goes on there with the slope at the largest overlap, and leads back as touching_contact() does.
Contact System::unloaded_contact(const UnloadingShape& shape, double overlap) const {
  const double modulus = material_.composite_modulus;
  if (free_count_ == 0) return unloading_contact(shape, modulus, overlap);
  const double fraction = unloading_fraction(shape, overlap);
  if (std::abs(fraction) <= 1.0) return unloading_contact(shape, modulus, overlap);
  const bool is_open = fraction > 1.0;
  const double depth = is_open ? fraction - 1.0 : 1.0 - fraction;
  const double followed = std::min(depth, is_open ? 1.0 : 2.0);
  Contact contact = unloading_contact(shape, modulus, shape.overlap_max + (followed - 1.0) * shape.recovery);
  if (depth > followed) {
    contact.by_overlap = 2.0 * modulus * shape.contact_radius_max / (1.0 - shape.rho);
    contact.force += contact.by_overlap * (depth - followed) * shape.recovery;
  }
  if (is_open) {
    contact.force = -contact.force;
    contact.by_radius = -contact.by_radius;
    contact.by_overlap_max = -contact.by_overlap_max;
  }
  return contact;
}

void System::evaluate_contact(std::size_t i, double displacement, double r) {
  now_[i].displacement = displacement;
  now_[i].overlap = displacement + r;
  now_[i].contact = contact_at(i, now_[i].overlap, r);
}

Contact System::contact_at(std::size_t i, double overlap, double r) {
  const double radius = 1.0 + r;
  const Memory& memory = memory_[i];
  Contact contact;
  if (memory.edge != Edge::following) {
    const Frame adhesive = frame(i, overlap, r);
    if (memory.edge == Edge::sticking) {
      contact = sticking_contact(adhesive, material_.composite_modulus, memory.edge_radius);
    } else {
      const PeelState& limit = pull_off(i, adhesive.indenter).by_displacement;
      // Where the centre is free, a trial may lead beyond pull-off: an edge that sticks there leads back.
      contact = free_count_ > 0 && adhesive.displacement < limit.displacement_1d
                    ? sticking_contact(adhesive, material_.composite_modulus, limit.contact_radius)
                    : peeling_contact(adhesive, material_.composite_modulus, surface_energy_, limit.contact_radius);
    }
  } else {
    switch (memory.regime) {
      case Regime::open:
      case Regime::separated:
        break;
      case Regime::elastic:
        contact = touching_contact(radius, overlap);
        break;
      case Regime::fully_plastic:
        contact = plastic_contact(material_, radius, overlap, memory.area_constant);
        break;
      case Regime::unloading:
        contact = unloaded_contact(shape(i, r), overlap);
        break;
    }
  }
  if (settings_.delta_max_rule == DeltaMaxRule::shifted) contact.by_radius += contact.by_overlap_max;
  return contact;
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

/// The one-dimensional space of an elastic contact, or of one below its largest overlap.
Frame System::frame(std::size_t i, double overlap, double r) {
  return memory_[i].regime == Regime::elastic ? elastic_frame(settings_.elastic_profile, 1.0 + r, overlap)
                                              : unloading_frame(shape(i, r), overlap);
}

const System::PullOff& System::pull_off(std::size_t i, const Indenter& indenter) {
  PullOff& known = pull_offs_[i];
  if (known.indenter.height != indenter.height || known.indenter.half_width != indenter.half_width) {
    const double modulus = material_.composite_modulus;
    const auto state = [&](Control control) {
      return peel_state(indenter, modulus, surface_energy_,
                        critical_radius(indenter, modulus, surface_energy_, control));
    };
    known = {indenter, state(Control::displacement), state(Control::force)};
  }
  return known;
}

double System::prescribed_force(std::size_t i, double xi) const noexcept {
  return std::lerp(ramps_[i].start, ramps_[i].end, xi);
}

/// Overlap at which an open wall begins to touch.
double System::touching_overlap(std::size_t i, double r) {
  if (memory_[i].regime != Regime::separated) return 0.0;
  const UnloadingShape& dent = shape(i, r);
  return dent.overlap_max - dent.recovery;
}

/// Displacement of a wall under its prescribed force. Where no contact bears that force, the nearest that one bears: an
/// event lies between.
double System::displacement_under_force(std::size_t i, double xi, double r, double guess) {
  const Memory& memory = memory_[i];
  const double radius = 1.0 + r;
  const double modulus = material_.composite_modulus;
  const double force = prescribed_force(i, xi);
  if (memory.edge != Edge::following) {
    const Indenter indenter = frame(i, 0.0, r).indenter;
    double displacement_1d = 0.0;
    if (memory.edge == Edge::sticking) {
      const double a = memory.edge_radius;
      // An edge of no radius bears nothing, and is where it touches.
      if (a > 0.0) {
        displacement_1d =
            profile_height(indenter, a) + (force - free_force(indenter, modulus, a)) / (2.0 * modulus * a);
      }
    } else {
      displacement_1d =
          peel_at_force(indenter, modulus, surface_energy_, pull_off(i, indenter).by_force.contact_radius, force)
              .displacement_1d;
    }
    return (memory.regime == Regime::elastic ? displacement_1d : overlap_at(shape(i, r), displacement_1d)) - r;
  }
  switch (memory.regime) {
    case Regime::open:
    case Regime::separated:
      // A growing particle pushes an idle wall along.
      return std::min(memory.resting, touching_overlap(i, r) - r);
    case Regime::elastic:
      return elastic_overlap(settings_.elastic_profile, modulus, radius, force) - r;
    case Regime::fully_plastic:
      return plastic_overlap(material_, radius, force, memory.area_constant, guess + r) - r;
    case Regime::unloading:
      return unloading_overlap(shape(i, r), force) - r;
  }
  return guess;
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
    place = displacement_under_force(i, xi, y[k_radius], place);
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

/// A contact, or one as deep as rounding where it is shallower: under force it moves without bound as it is made, and
/// what that does to the others is over before any of them has moved by more than rounding.
Contact System::stiff_contact(std::size_t i, double r) {
  const Memory& memory = memory_[i];
  const bool is_dent = memory.regime == Regime::unloading;
  if (memory.edge != Edge::following || !(is_dent || memory.regime == Regime::elastic)) return now_[i].contact;
  const double touch = is_dent ? shape(i, r).overlap_max - shape(i, r).recovery : 0.0;
  if (now_[i].overlap - touch >= k_shallow) return now_[i].contact;
  return contact_at(i, is_dent ? std::min(touch + k_shallow, shape(i, r).overlap_max) : k_shallow, r);
}

/// How the displacement of a wall under force goes with xi and R; zero where it stays.
void System::set_rates_under_force(std::size_t i, double r) {
  Instant& now = now_[i];
  const double speed = ramps_[i].end - ramps_[i].start;
  const Contact c = stiff_contact(i, r);
  if (memory_[i].edge == Edge::peeling) {
    // Where it pulls off, a force holds it no longer: whatever the radius, the overlap is about that.
    const double critical = pull_off(i, frame(i, now.overlap, r).indenter).by_force.contact_radius;
    if (c.contact_radius <= (1.0 + k_at_pull_off) * critical) {
      now.rate_by_growth = -1.0;
      return;
    }
  }
  if (touches(memory_[i].regime) && c.by_overlap > 0.0) {
    now.rate_by_time = speed / c.by_overlap;
    now.rate_by_growth = -1.0 - c.by_radius / c.by_overlap;
  } else if (touches(memory_[i].regime) || memory_[i].resting >= touching_overlap(i, r) - r) {
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
