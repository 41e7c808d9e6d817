#include "mdr/particle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "elastic/hertz.hpp"
#include "mdr/guards.hpp"
#include "mdr/support.hpp"
#include "system/limit.hpp"
#include "system/resolution.hpp"

namespace monograin::mdr {
namespace {

// A contact under force has reached pull-off when its contact radius is this near to that at pull-off (relative to the
// latter). Forces differ by the square of this, which is below their round-off.
constexpr double k_at_pull_off = 1e-9;

}  // namespace

Particle::Particle(std::shared_ptr<const Setup> setup) : setup_(std::move(setup)) {
  const std::size_t count = setup_->classes.size();
  walls_.resize(count);
  branches_.resize(count);
  at_.contacts.resize(count);
  at_.centre = setup_->centre;
  at_y_.resize(setup_->unknown_count());
  mode.loads_on.resize(count, false);
}

void Particle::start() {
  mode.is_growing = false;
  mode.held_radius = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    walls_[i].bears = true;
    branches_[i] = {};
    branches_[i].resting = -setup_->classes[i].gap / setup_->length_unit();
  }
  note_change();
}

void Particle::set_drives(std::span<const Ramp> ramps) {
  double largest = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    const bool is_force = ramps[i].control == Control::force;
    walls_[i].drive = {ramps[i], is_force ? setup_->force_unit() : setup_->length_unit()};
    if (is_force) largest = std::max(largest, count(i) * walls_[i].drive.size());
  }
  for (std::size_t i = 0; i < size(); ++i) {
    const double force = is_loaded(i) ? count(i) * walls_[i].drive.size() : 0.0;
    walls_[i].may_be_slight = centre().acts(i) && force > 0.0 && force <= k_no_force * largest;
  }
  note_change();
}

double Particle::speed_scale() const noexcept {
  double scale = 0.0;
  for (const Wall& wall : walls_) {
    if (!wall.drive.is_force_controlled()) scale = std::max(scale, std::abs(wall.drive.rate()));
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

bool Particle::peels_anywhere() const noexcept {
  return std::ranges::any_of(branches_, [](const ContactBranch& branch) { return branch.edge.peels(); });
}

void Particle::set_bears(std::size_t i, bool bears) {
  if (walls_[i].bears == bears) return;
  walls_[i].bears = bears;
  note_change();
}

const Evaluation& Particle::evaluate(double xi, std::span<const double> y) {
  evaluate_forces(xi, y);
  accept_volume(xi, y);
  return at_;
}

const Evaluation& Particle::evaluate_forces(double xi, std::span<const double> y) {
  at_xi_ = k_nan;
  at_.r = y[k_radius];
  at_.longest = 1.0;
  for (int k = 0; k < centre().count(); ++k) at_.longest = std::max(at_.longest, std::abs(y[centre_index(k)]));
  for (std::size_t i = 0; i < size(); ++i) {
    const double carried = carried_by_centre(i, y);
    const double wall = is_loaded(i) ? y[setup_->wall_index[i]] : prescribed_position(i, xi);
    at_.contacts[i].position = is_loaded(i) ? wall - carried : wall;
    evaluate_contact(i, is_loaded(i) ? wall : wall + carried, at_.r);
  }
  sum_up(xi);
  return at_;
}

void Particle::accept_volume(double xi, std::span<const double> y) {
  if (!(at_.volume.under_root > 0.0)) throw DomainError(Limit::half_volume);
  at_xi_ = xi;
  at_revision_ = revision_;
  std::ranges::copy(y, at_y_.begin());
}

const Evaluation& Particle::evaluated(double xi, std::span<const double> y) {
  bool is_same = at_xi_ == xi && at_revision_ == revision_ && at_y_[k_radius] == y[k_radius];
  for (std::size_t k = k_centre; is_same && k < y.size(); ++k) is_same = at_y_[k] == y[k];
  return is_same ? at_ : evaluate(xi, y);
}

void Particle::evaluate_contact(std::size_t i, double displacement, double r) {
  at_xi_ = k_nan;
  force_rounding_.reset();
  Instant& now = at_.contacts[i];
  now.displacement = displacement;
  now.overlap = displacement + r;
  now.contact = branches_[i].contact(law(), r, now.overlap);
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
    if (!is_loaded(i)) continue;
    evaluate_contact(i, y[setup_->wall_index[i]], y[k_radius]);
    const double position = contact(i).displacement - carried_by_centre(i, y);
    sum += count(i) * contact(i).contact.force * position;
  }
  return sum;
}

void Particle::sum_up(double xi) {
  const double radius = 1.0 + at_.r;
  const bool is_free = centre().is_free();
  if (is_free) {
    at_.volume_by_centre.setZero();
    at_.centre.clear();
  }
  double virial_of_all = 0.0;
  double virial = 0.0;  // of the contacts that take part in the growth
  for (std::size_t i = 0; i < size(); ++i) {
    const double one = count(i) * contact(i).contact.force * (1.0 - contact(i).displacement);
    virial_of_all += one;
    if (takes_part(i)) virial += one;
  }
  VolumeSum volume(law().material.bulk_compliance, virial_of_all, virial);
  double power = 0.0;
  double force_work = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    Instant& now = at_.contacts[i];
    const bool is_under_force = is_loaded(i);
    const double speed = walls_[i].drive.rate();
    now.rate_by_time = is_under_force ? 0.0 : speed;
    now.rate_by_growth = 0.0;
    if (is_under_force) set_rates_under_force(i);
    if (!branches_[i].touches()) continue;
    if (is_under_force) {
      power -= count(i) * now.position * speed;
      force_work += count(i) * walls_[i].drive.value(xi) * now.position;
    } else if (walls_[i].bears) {
      power += count(i) * now.contact.force * speed;
    }
    if (is_free) load_centre(i);
    if (!takes_part(i)) continue;
    const double by_displacement = volume.add(
        {count(i), now.contact, now.displacement, now.overlap, now.rate_by_time, now.rate_by_growth}, radius);
    if (is_free && !is_under_force) at_.volume_by_centre += by_displacement * centre().direction(i);
  }
  at_.energy.reset();
  at_.volume = volume.balance(at_.r);
  at_.power = power;
  at_.force_work = force_work;
  if (is_free) at_.centre.sum_up();
}

void Particle::load_centre(std::size_t i) {
  const ContactBranch& branch = branches_[i];
  const Contact& c = contact(i).contact;
  const double stiffness = branch.tangent_stiffness(law(), c);
  const double speed = walls_[i].drive.rate();
  CentreLoad load{.count = count(i)};
  if (!is_slight(i)) {
    load.force = c.force;
    load.force_by_time = is_loaded(i) ? speed : stiffness * speed;
  }
  if (!is_loaded(i)) {
    double by_radius = c.by_radius;
    if (branch.regime == Regime::unloading && branch.edge.follows() && c.by_overlap < stiffness) {
      // The overlap at which a dent begins changes with the radius, even if the contact there bears next to nothing.
      const Contact pressed = branch.stiff_contact(law(), at_.r, contact(i).overlap, c);
      by_radius = stiffness * (pressed.by_radius / pressed.by_overlap);
    }
    load.force_by_radius = stiffness + by_radius;
    load.stiffness = c.by_overlap;
    load.tangent_stiffness = stiffness;
  }
  at_.centre.add(i, load);
}

/// Sets the derivatives of a force-controlled wall's displacement by xi and R; both are zero for a wall that stays. The
/// rate of a contact that is just being made has no bound: stiff_contact() limits it, which affects other contacts by
/// less than round-off.
void Particle::set_rates_under_force(std::size_t i) {
  Instant& now = at_.contacts[i];
  const ContactBranch& branch = branches_[i];
  const Contact c = branch.stiff_contact(law(), at_.r, now.overlap, now.contact);
  if (branch.edge.peels()) {
    // At pull-off the force no longer determines the displacement: the overlap hardly changes with the radius.
    const Indenter indenter = branch.frame(law(), at_.r, now.overlap).indenter;
    const double critical = branch.pull_off(law(), indenter).by_force.contact_radius;
    if (c.contact_radius <= (1.0 + k_at_pull_off) * critical) {
      now.rate_by_growth = -1.0;
      return;
    }
  }
  if (branch.touches() && c.by_overlap > 0.0) {
    now.rate_by_time = walls_[i].drive.rate() / c.by_overlap;
    now.rate_by_growth = -1.0 - c.by_radius / c.by_overlap;
  } else if (branch.touches() || branch.resting >= branch.touching_overlap(law(), at_.r) - at_.r) {
    now.rate_by_growth = -1.0;  // without load the wall stays at the surface
  }
}

double Particle::energy(std::size_t i, PlasticPart part) const {
  return branches_[i].energy(law(), at_.r, contact(i).overlap, contact(i).contact.contact_radius, part);
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
    if (growing) result.growth = result.demand / result.slope;
    return result;
  }
  const CentreVector by_radius = centre().by_radius();
  result.centre = centre().by_time();
  result.demand -= at_.volume_by_centre.dot(result.centre);
  result.slope += at_.volume_by_centre.dot(by_radius);
  if (growing) {
    result.growth = result.demand / result.slope;
    result.centre += result.growth * by_radius;
  }
  return result;
}

Motion Particle::growing_motion() const {
  Motion result = motion(true);
  if (!(result.slope > 0.0)) throw DomainError(Limit::free_surface_used_up);
  return result;
}

double Particle::prescribed_position(std::size_t i, double xi) const noexcept {
  // As exact as std::lerp, which takes longer than the rest of this.
  const contacts::WallDrive& drive = walls_[i].drive;
  return xi == 1.0 ? drive.end() : drive.start() + xi * drive.rate();
}

double Particle::carried_by_centre(std::size_t i, std::span<const double> y) const noexcept {
  double distance = 0.0;
  for (int k = 0; k < centre().count(); ++k) distance += centre().direction(i)[k] * y[centre_index(k)];
  return distance;
}

void Particle::move_walls(double xi, std::span<double> y) const {
  if (!setup_->takes_forces) return;
  for (std::size_t i = 0; i < size(); ++i) {
    if (!is_loaded(i)) continue;
    double& wall = y[setup_->wall_index[i]];
    wall = branches_[i].displacement_under(law(), y[k_radius], walls_[i].drive.value(xi), wall);
  }
}

void Particle::record_walls(double xi, std::span<double> y) const noexcept {
  if (!setup_->takes_forces) return;
  for (std::size_t i = 0; i < size(); ++i) {
    if (setup_->classes[i].takes_force && !is_loaded(i))
      y[setup_->wall_index[i]] = prescribed_position(i, xi) + carried_by_centre(i, y);
  }
}

double Particle::magnitude_of_forces() const noexcept {
  double sum = 0.0;
  for (std::size_t i = 0; i < size(); ++i) sum += count(i) * std::abs(contact(i).contact.force);
  return sum;
}

/// Adds the round-off of forces to that of overlaps times stiffness, which idle contacts are too soft to balance. The
/// round-off of an overlap is that of the lengths whose difference it is: R0, the path of the centre, or that of the
/// wall towards it.
double Particle::force_rounding() const {
  if (force_rounding_) return *force_rounding_;
  constexpr double round_off = std::numeric_limits<double>::epsilon();
  double sum = magnitude_of_forces();
  for (std::size_t i = 0; i < size(); ++i) {
    const double length = std::max(at_.longest, std::abs(contact(i).position));
    sum += count(i) * branches_[i].unpeeled_stiffness(law(), at_.r, contact(i).contact) * length;
  }
  return *(force_rounding_ = 4.0 * round_off * sum);
}

double Particle::resolution() const {
  return std::max(k_resolution,
                  elastic_overlap(ElasticProfile::parabola, law().material.composite_modulus, 1.0, force_rounding()));
}

/// True if an overlap is below the resolution; cheaper than comparing it with resolution().
bool Particle::is_below_resolution(double overlap) const {
  return overlap < k_resolution || hertz_force(law().material.composite_modulus, 1.0, overlap) < force_rounding();
}

bool Particle::is_idle_touch(std::size_t i) const {
  if (is_loaded(i)) return false;
  const ContactBranch& branch = branches_[i];
  const bool may_be_idle = branch.regime == Regime::elastic ? branch.is_on_primary_branch || !law().adheres()
                                                            : branch.regime == Regime::unloading && !law().adheres();
  return may_be_idle && is_below_resolution(contact(i).overlap - branch.touching_overlap(law(), at_.r));
}

/// True for a prescribed force that is round-off beside the others and that no contact supports. Its load on the centre
/// is left out: it would only push the centre off an idle wall, which then comes back.
bool Particle::is_slight(std::size_t i) { return walls_[i].may_be_slight && !is_supported(*this, i, 1.0, supports_); }

// --- rates of one contact

namespace {

/// Rate of a prescribed force less the force that growth takes away, over the sum of their magnitudes.
double loaded_rate(const Particle& p, double loading, double by_radius, double growth) noexcept {
  const double taken = by_radius * growth;
  const double scale = std::abs(loading) + std::abs(taken);
  if (scale > 0.0) return (loading - taken) / scale;
  // At the very start of growth the rate of the radius is zero, and about to become positive.
  return p.mode.is_growing && by_radius > 0.0 ? -1.0 : 0.0;
}

}  // namespace

double inward_rate(const Particle& p, std::size_t i, const Motion& motion) noexcept {
  const double carried = p.is_loaded(i) ? 0.0 : p.centre().direction(i).dot(motion.centre);
  return p.contact(i).rate_by_time + p.contact(i).rate_by_growth * motion.growth + carried;
}

double wall_rate(const Particle& p, std::size_t i, const Motion& motion) noexcept {
  if (!p.is_loaded(i)) return inward_rate(p, i, motion) / p.speed_scale();
  const Contact& c = p.contact(i).contact;
  return loaded_rate(p, p.drive(i).rate(), c.by_overlap + c.by_radius, motion.growth);
}

double overlap_rate(const Particle& p, std::size_t i, const Motion& motion) noexcept {
  if (!p.is_loaded(i)) return (inward_rate(p, i, motion) + motion.growth) / p.speed_scale();
  return loaded_rate(p, p.drive(i).rate(), p.contact(i).contact.by_radius, motion.growth);
}

double primary_branch_rate(const Particle& p, std::size_t i, const Motion& motion) noexcept {
  return p.law().is_shifted() ? wall_rate(p, i, motion) : overlap_rate(p, i, motion);
}

double edge_rate(const Particle& p, std::size_t i, const Motion& motion) {
  const Instant& now = p.contact(i);
  double overlap_speed = inward_rate(p, i, motion) + motion.growth;
  // The rate of a force-controlled contact that is just being made has no bound: the sign of the force's rate decides,
  // however small that is, and growth does not count.
  const bool is_being_made = p.is_loaded(i) && !(now.contact.by_overlap > 0.0);
  if (is_being_made) overlap_speed = p.drive(i).rate();
  if (is_being_made || motion.growth == 0.0) {
    // If a free centre keeps up with the wall, the difference of their speeds is round-off, of either sign.
    const double rounding = p.is_loaded(i) ? 0.0 : k_zero_guard * (std::abs(now.rate_by_time) + motion.centre.norm());
    return overlap_speed > rounding ? 1.0 : overlap_speed < -rounding ? -1.0 : 0.0;
  }
  return p.branch(i).press_rate(p.law(), p.at().r, now.overlap, now.contact.contact_radius, overlap_speed,
                                motion.growth);
}

double force_rate(const Particle& p, std::size_t i, const Motion& motion) {
  const Contact& c = p.contact(i).contact;
  const double scale = p.branch(i).unpeeled_stiffness(p.law(), p.at().r, c) * p.speed_scale();
  const double rate = c.by_overlap * (inward_rate(p, i, motion) + motion.growth) + c.by_radius * motion.growth;
  return scale > 0.0 ? rate / scale : 0.0;
}

double rate_if_unloaded(Particle& p, std::size_t i, double xi, std::span<const double> y) {
  const ContactBranch before = p.branch(i);
  p.set_branch(i, before.unloaded(p.law(), y[k_radius], p.contact(i).overlap));
  p.evaluate(xi, y);
  const double stiffer = std::max(1.0, p.contact(i).contact.by_overlap / p.law().plastic_stiffness());
  const double rate = stiffer * primary_branch_rate(p, i, p.motion(p.mode.is_growing));
  p.set_branch(i, before);
  p.evaluate(xi, y);
  return rate;
}

// --- growth

bool gate_is_open(const Particle& p, const Motion& motion) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!p.takes_part(i)) continue;
    // Next to stiff contacts the rate of an idle contact loses digits.
    const GrowthDrive drive{.inward_rate = inward_rate(p, i, motion),
                            .least_rate = (p.is_idle(i) ? k_at_rest : k_zero_guard) * p.speed_scale(),
                            .is_force_controlled = p.is_loaded(i),
                            .rises = p.drive(i).rate() > 0.0,
                            .is_on_primary_branch = p.branch(i).is_on_primary_branch};
    if (opens_gate(p.setup().settings.radius_rule, drive)) return true;
  }
  return false;
}

double growth_drive(const Particle& p, const Motion& motion) noexcept {
  const double scale = p.at().volume.time_scale;
  bool goes_in = false;
  bool goes_out = false;
  const bool is_undecided = !(scale > 0.0) && motion.demand == 0.0;
  for (std::size_t i = 0; is_undecided && i < p.size(); ++i) {
    if (!p.takes_part(i)) continue;
    const double rate = wall_rate(p, i, motion);
    goes_in = goes_in || rate > 0.0;
    goes_out = goes_out || rate < 0.0;
  }
  return growth_drive(motion.demand, scale, goes_out && !goes_in, p.law().material.bulk_compliance > 0.0);
}

bool has_greatest_force(const Particle& p, std::size_t i) noexcept {
  return p.is_loaded(i) && p.branch(i).regime == Regime::fully_plastic;
}

double stiffness_left(const Particle& p, std::size_t i) noexcept {
  return p.contact(i).contact.by_overlap / p.law().plastic_stiffness();
}

}  // namespace monograin::mdr
