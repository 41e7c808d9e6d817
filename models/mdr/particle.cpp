#include "mdr/particle.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "system/limit.hpp"
#include "system/resolution.hpp"

namespace monograin::mdr {

Particle::Particle(std::shared_ptr<const Setup> setup) : setup_(std::move(setup)), drives_(setup_->classes.size()) {
  const std::size_t count = setup_->classes.size();
  branches_.resize(count);
  at_.contacts.resize(count);
  at_.centre = setup_->centre;
  at_y_.resize(setup_->unknown_count());
  mode.loads_on.resize(count, false);
}

void Particle::start() {
  mode.is_growing = false;
  mode.held_growth = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    branches_[i] = {};
    branches_[i].resting = -setup_->classes[i].gap / setup_->length_unit();
  }
  note_change();
}

void Particle::set_drives(std::span<const Ramp> ramps) {
  for (std::size_t i = 0; i < size(); ++i) {
    const bool is_force = ramps[i].control == Control::force;
    drives_[i] = {ramps[i], is_force ? setup_->force_unit() : setup_->length_unit()};
  }
  note_change();
}

double Particle::speed_scale() const noexcept {
  double scale = 0.0;
  for (const contacts::WallDrive& drive : drives_) {
    if (!drive.is_force_controlled()) scale = std::max(scale, std::abs(drive.rate()));
  }
  return scale > 0.0 ? scale : 1.0;
}

void Particle::set_branch(std::size_t i, const ContactBranch& branch) {
  branches_[i] = branch;
  note_change();
}

void Particle::set_branches(const std::vector<ContactBranch>& branches) {
  branches_ = branches;
  note_change();
}

const Evaluation& Particle::evaluate(double xi, std::span<const double> y) {
  try_state(xi, y);
  keep_trial(xi, y);
  return at_;
}

const Evaluation& Particle::try_state(double xi, std::span<const double> y) {
  at_xi_ = k_nan;
  at_.growth = y[k_growth];
  at_.longest = 1.0;
  for (int k = 0; k < centre().free_directions(); ++k)
    at_.longest = std::max(at_.longest, std::abs(y[centre_index(k)]));
  for (std::size_t i = 0; i < size(); ++i) {
    const double by_centre = centre().approach_by_centre(i, y.subspan(k_centre));
    // The unknown of a wall under force is its approach.
    const double known = is_force_controlled(i) ? y[setup_->wall_index[i]] : prescribed_displacement(i, xi);
    at_.contacts[i].wall_displacement = is_force_controlled(i) ? known - by_centre : known;
    evaluate_contact(i, is_force_controlled(i) ? known : known + by_centre, at_.growth);
  }
  sum_up(xi);
  return at_;
}

void Particle::keep_trial(double xi, std::span<const double> y) {
  if (!(at_.volume.discriminant > 0.0)) throw DomainError(Limit::half_volume);
  at_xi_ = xi;
  at_revision_ = revision_;
  std::ranges::copy(y, at_y_.begin());
}

const Evaluation& Particle::at_state(double xi, std::span<const double> y) {
  bool is_same = at_xi_ == xi && at_revision_ == revision_ && at_y_[k_growth] == y[k_growth];
  for (std::size_t k = k_centre; is_same && k < y.size(); ++k) is_same = at_y_[k] == y[k];
  return is_same ? at_ : evaluate(xi, y);
}

void Particle::evaluate_contact(std::size_t i, double approach, double growth) {
  at_xi_ = k_nan;
  force_round_off_.reset();
  Instant& now = at_.contacts[i];
  now.approach = approach;
  now.overlap = approach + growth;
  now.contact = branches_[i].contact(law(), growth, now.overlap);
}

void Particle::assume_rate(std::size_t i, double rate) noexcept {
  at_xi_ = k_nan;
  at_.contacts[i].rate_by_time = rate;
  at_.contacts[i].rate_by_growth = 0.0;
}

double Particle::force_work(std::span<const double> y) {
  at_xi_ = k_nan;
  double sum = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    if (!is_force_controlled(i)) continue;
    evaluate_contact(i, y[setup_->wall_index[i]], y[k_growth]);
    const double wall_displacement = contact(i).approach - centre().approach_by_centre(i, y.subspan(k_centre));
    sum += count(i) * contact(i).contact.force * wall_displacement;
  }
  return sum;
}

void Particle::sum_up(double xi) {
  const double radius = 1.0 + at_.growth;
  const bool is_free = centre().is_free();
  if (is_free) {
    at_.volume_by_centre.setZero();
    at_.centre.clear();
  }
  double virial_of_all = 0.0;
  double virial = 0.0;  // of the contacts that take part in the growth
  for (std::size_t i = 0; i < size(); ++i) {
    const double one = count(i) * contact(i).contact.force * (1.0 - contact(i).approach);
    virial_of_all += one;
    if (takes_part(i)) virial += one;
  }
  VolumeSum volume(law().material.linear_compressibility, virial_of_all, virial);
  double power = 0.0;
  double force_work = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    Instant& now = at_.contacts[i];
    const bool is_under_force = is_force_controlled(i);
    const double speed = drive(i).rate();
    now.rate_by_time = is_under_force ? 0.0 : speed;
    now.rate_by_growth = 0.0;
    if (is_under_force) set_rates_under_force(i);
    if (!branches_[i].touches()) continue;
    if (is_under_force) {
      power -= count(i) * now.wall_displacement * speed;
      force_work += count(i) * drive(i).value(xi) * now.wall_displacement;
    } else {
      power += count(i) * now.contact.force * speed;
    }
    if (is_free) load_centre(i);
    if (!takes_part(i)) continue;
    const double by_approach =
        volume.add({count(i), now.contact, now.approach, now.overlap, now.rate_by_time, now.rate_by_growth}, radius);
    if (is_free && !is_under_force) at_.volume_by_centre += by_approach * centre().mean_normal(i);
  }
  at_.energy.reset();
  at_.volume = volume.finish(at_.growth);
  at_.power = power;
  at_.force_work = force_work;
  if (is_free) at_.centre.sum_up();
}

void Particle::load_centre(std::size_t i) {
  const ContactBranch& branch = branches_[i];
  const Contact& c = contact(i).contact;
  const double stiffness = branch.regularized_stiffness(law(), c);
  const double speed = drive(i).rate();
  CentreLoad load{
      .count = count(i), .force = c.force, .force_by_time = is_force_controlled(i) ? speed : stiffness * speed};
  if (!is_force_controlled(i)) {
    double by_radius = c.by_radius;
    if (branch.regime == Regime::unloading && branch.edge.follows() && c.by_overlap < stiffness) {
      // The overlap at which a dent begins changes with the radius, even if the contact there bears next to nothing.
      const Contact pressed = branch.stiff_contact(law(), at_.growth, contact(i).overlap, c);
      by_radius = stiffness * (pressed.by_radius / pressed.by_overlap);
    }
    load.force_by_radius = stiffness + by_radius;
    load.stiffness = c.by_overlap;
    load.regularized_stiffness = stiffness;
  }
  at_.centre.add(i, load);
}

/// Sets the derivatives of a force-controlled wall's approach by xi and R; both are zero for a wall that stays. The
/// rate of a contact that is just being made has no bound: stiff_contact() limits it, which affects other contacts by
/// less than round-off.
void Particle::set_rates_under_force(std::size_t i) {
  Instant& now = at_.contacts[i];
  const ContactBranch& branch = branches_[i];
  const Contact c = branch.stiff_contact(law(), at_.growth, now.overlap, now.contact);
  if (branch.edge.peels()) {
    // At pull-off the force no longer determines the displacement: the overlap hardly changes with the radius.
    const Indenter indenter = branch.image(law(), at_.growth, now.overlap).indenter;
    const double critical = branch.pull_off(law(), indenter).by_force.contact_radius;
    if (c.contact_radius <= (1.0 + k_root_of_round_off) * critical) {
      now.rate_by_growth = -1.0;
      return;
    }
  }
  if (branch.touches() && c.by_overlap > 0.0) {
    now.rate_by_time = drive(i).rate() / c.by_overlap;
    now.rate_by_growth = -1.0 - c.by_radius / c.by_overlap;
  } else if (branch.touches() || branch.resting >= branch.touching_overlap(law(), at_.growth) - at_.growth) {
    now.rate_by_growth = -1.0;  // without load the wall stays at the surface
  }
}

double Particle::energy(std::size_t i, PlasticPart part) const {
  return branches_[i].energy(law(), at_.growth, contact(i).overlap, contact(i).contact.contact_radius, part);
}

double Particle::energy(PlasticPart part) {
  // A row of the history needs both parts. They differ for plastic contacts at their largest overlap and, by the
  // surface energy, where an edge follows; otherwise the first sum serves for both.
  const bool is_either = std::ranges::none_of(branches_, [this](const ContactBranch& branch) {
    return branch.edge.follows() && (branch.regime == Regime::fully_plastic || law().adheres());
  });
  if (is_either && at_.energy) return *at_.energy;
  double sum = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    if (branches_[i].touches()) sum += count(i) * energy(i, part);
  }
  if (is_either) at_.energy = sum;
  return sum;
}

Motion Particle::motion(bool growing) const {
  const VolumeBalance& volume = at_.volume;
  Motion result{.demand = -volume.by_time, .slope = volume.by_radius};
  if (!centre().is_free()) {
    if (growing) result.growth_rate = result.demand / result.slope;
    return result;
  }
  const CentreVector by_radius = centre().by_radius();
  result.centre = centre().by_time();
  result.demand -= at_.volume_by_centre.dot(result.centre);
  result.slope += at_.volume_by_centre.dot(by_radius);
  if (growing) {
    result.growth_rate = result.demand / result.slope;
    result.centre += result.growth_rate * by_radius;
  }
  return result;
}

Motion Particle::growing_motion() const {
  Motion result = motion(true);
  if (!(result.slope > 0.0)) throw DomainError(Limit::free_surface_used_up);
  return result;
}

double Particle::magnitude_of_forces() const noexcept {
  double sum = 0.0;
  for (std::size_t i = 0; i < size(); ++i) sum += count(i) * std::abs(contact(i).contact.force);
  return sum;
}

/// Adds the round-off of forces to that of overlaps times stiffness, which idle contacts are too soft to balance. The
/// round-off of an overlap is that of the lengths whose difference it is: R0, the path of the centre, or that of the
/// wall towards it.
double Particle::force_round_off() const {
  if (force_round_off_) return *force_round_off_;
  double sum = magnitude_of_forces();
  for (std::size_t i = 0; i < size(); ++i) {
    const double length = std::max(at_.longest, std::abs(contact(i).wall_displacement));
    sum += count(i) * branches_[i].reference_stiffness(law(), at_.growth, contact(i).contact) * length;
  }
  return *(force_round_off_ = k_round_off * sum);
}

}  // namespace monograin::mdr
