// Transitions of one contact of the MDR system, and how fast it goes towards them.

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mdr/adhesion_validity.hpp"
#include "mdr/guards.hpp"
#include "mdr/system.hpp"

namespace monograin::mdr {

double System::speed_scale() const noexcept {
  double scale = 0.0;
  for (const Ramp& ramp : ramps_) {
    if (ramp.control == Control::displacement) scale = std::max(scale, std::abs(ramp.end - ramp.start));
  }
  return scale > 0.0 ? scale : 1.0;
}

/// How fast a wall goes in, of order one. Under force only the sign means something: what the force asks for over the
/// sum of that and what the growth takes away.
double System::wall_rate(std::size_t i, const Motion& now) const noexcept {
  if (!is_loaded(i)) return inward_rate(i, now) / speed_scale();
  const Contact& c = now_[i].contact;
  return loaded_rate(ramps_[i].end - ramps_[i].start, c.by_overlap + c.by_radius, now.growth);
}

/// How fast the overlap goes up, likewise.
double System::overlap_rate(std::size_t i, const Motion& now) const noexcept {
  if (!is_loaded(i)) return (inward_rate(i, now) + now.growth) / speed_scale();
  return loaded_rate(ramps_[i].end - ramps_[i].start, now_[i].contact.by_radius, now.growth);
}

/// Rate of the quantity that defines the largest overlap: the overlap itself, or the displacement of the wall with
/// delta_max_rule = shifted.
double System::primary_branch_rate(std::size_t i, const Motion& now) const noexcept {
  return law_.is_shifted() ? wall_rate(i, now) : overlap_rate(i, now);
}

/// Rate of the largest overlap if this contact began to unload here, times the ratio of stiffnesses. A contact that
/// would load again as soon as it unloads alternates between the two without end: it stays on its loading branch until
/// this rate is negative.
double System::rate_if_turned(std::size_t i, double xi, std::span<const double> y) {
  const ContactBranch before = branches_[i];
  branches_[i] = branches_[i].unloaded(law_, y[k_radius], now_[i].overlap);
  drop_evaluation();
  evaluate(xi, y);
  const double stiffer = std::max(1.0, now_[i].contact.by_overlap / law_.plastic_stiffness());
  const double rate = stiffer * primary_branch_rate(i, motion(is_growing_));
  branches_[i] = before;
  evaluate(xi, y);
  return rate;
}

/// Whether the springs at the edge of a contact are being pressed (+) or stretched (-), of order one: what the overlap
/// does over the sum of that and what the growing indenter does.
double System::edge_rate(std::size_t i, double r, const Motion& now) {
  const Contact& c = now_[i].contact;
  double overlap_speed = inward_rate(i, now) + now.growth;
  // A contact under force that is just being made moves with the force alone, and without bound: however small the
  // force is, growth is nothing beside that.
  const bool is_being_made = is_loaded(i) && !(c.by_overlap > 0.0);
  if (is_being_made) overlap_speed = ramps_[i].end - ramps_[i].start;
  if (is_being_made || now.growth == 0.0) {
    // Where a free centre keeps up with a wall, what is left of their speeds has any sign.
    const double rounding = is_loaded(i) ? 0.0 : k_touch * (std::abs(now_[i].rate_by_time) + now.centre.norm());
    return overlap_speed > rounding ? 1.0 : overlap_speed < -rounding ? -1.0 : 0.0;
  }
  return branches_[i].press_rate(law_, r, now_[i].overlap, c.contact_radius, overlap_speed, now.growth);
}

double System::loaded_rate(double loading, double by_radius, double growth) const noexcept {
  const double taken = by_radius * growth;
  const double scale = std::abs(loading) + std::abs(taken);
  if (scale > 0.0) return (loading - taken) / scale;
  // At the very start of growth its rate is zero, and about to be positive.
  return is_growing_ && by_radius > 0.0 ? -1.0 : 0.0;
}

void System::start_unloading(std::size_t i, double r, std::string_view why, std::vector<Event>& log) {
  branches_[i] = branches_[i].unloaded(law_, r, now_[i].overlap);
  drop_evaluation();
  has_turned_[i] = true;
  log.push_back({why, static_cast<int>(i)});
  if (!law_.adheres()) return;
  stick(i, log);
  check_adhesion(i, r);
}

/// Whether the model's convex indenter, which knows no yielding in tension, will do for this contact (F.7).
void System::check_adhesion(std::size_t i, double r) {
  if (validity_) return;
  const ContactBranch& branch = branches_[i];
  const PullOff& limits = branch.pull_off(law_, branch.frame(law_, r, now_[i].overlap).indenter);
  const double critical = limits.under(ramps_[i].control).contact_radius;
  const double peak = peak_radius_over_initial_radius(now_[i].displacement, law_.material.yield_overlap_ratio);
  const double zone =
      plastic_zone_size(law_.material.composite_modulus, law_.surface_energy, law_.material.yield_stress);
  switch (adhesion_validity(critical, peak, zone)) {
    case AdhesionValidity::valid:
      break;
    case AdhesionValidity::peak_failure:
      validity_ = {"pull-off is not predicted well: the contact's middle is dented beyond its critical radius",
                   "critical radius over that of the ring", critical / peak};
      break;
    case AdhesionValidity::yielding_failure:
      validity_ = {"pull-off is not predicted well: yielding at the contact's edge is not small-scale (15 and more)",
                   "critical diameter over the plastic zone", 2.0 * critical / zone};
      break;
  }
}

void System::stick(std::size_t i, std::vector<Event>& log) {
  branches_[i].edge = {Edge::sticking, now_[i].contact.contact_radius};
  log.push_back({"stick", static_cast<int>(i)});
}

/// Pull-off: the edge is no longer stable, and the contact opens at once.
void System::separate(std::size_t i, double r, std::span<double> y, std::vector<Event>& log) {
  ContactBranch& memory = branches_[i];
  const bool is_touch = memory.edge.sticks() && memory.edge.radius == 0.0;
  if (is_loaded(i)) {
    const Instant& now = now_[i];
    // The wall keeps the work done on it so far. Where the contact holds negative energy, the load has at least to
    // supply that in the snap.
    const double supplied = std::max(
        0.0, -branches_[i].energy(law_, r, now_[i].overlap, now_[i].contact.contact_radius, PlasticPart::recoverable));
    y[k_work] += counts_[i] * (now.contact.force * now.position + supplied);
    memory.resting = now.displacement;
  }
  memory.edge.motion = Edge::following;
  branches_[i] = branches_[i].lost(now_[i].displacement);
  log.push_back({is_touch ? "contact-lost" : "pull-off", static_cast<int>(i)});
  if (free_count_ == 0) return;
  // A free centre springs back from there: what peeled on the other side is relieved.
  for (std::size_t j = 0; j < branches_.size(); ++j) {
    if (branches_[j].edge.peels() && !is_loaded(j)) stick(j, log);
  }
}

/// The contact that gives way where several of them cannot hold a free centre between them any more: of those that
/// peel the one whose wall withdraws fastest.
std::optional<std::size_t> System::weakest_contact() const noexcept {
  std::optional<std::size_t> weakest;
  for (std::size_t i = 0; i < branches_.size(); ++i) {
    if (!branches_[i].edge.peels() || is_loaded(i) || directions_[i].norm() < k_no_direction) continue;
    const auto speed = [&](std::size_t j) { return ramps_[j].end - ramps_[j].start; };
    if (!weakest || speed(i) < speed(*weakest)) weakest = i;
  }
  return weakest;
}

/// True if a plastic contact is softened past its peak so far that it may no longer constrain a free centre.
bool System::is_any_softened() const noexcept {
  constexpr double k_softened_share = 0.1;
  for (std::size_t i = 0; i < branches_.size(); ++i) {
    const bool is_plastic = branches_[i].regime == Regime::fully_plastic;
    if (is_plastic && now_[i].contact.by_overlap < k_softened_share * law_.plastic_stiffness()) return true;
  }
  return false;
}

/// Tangent stiffness of a free centre in its softest direction, over what it would be if no edge peeled and no contact
/// were softened past its peak. Zero where the equilibrium turns back.
System::CentreStiffness System::centre_stiffness() {
  for (Line& line : lines_) line.held = line.unsoftened = 0.0;
  for (std::size_t i = 0; i < branches_.size(); ++i) {
    if (!branches_[i].touches() || is_loaded(i)) continue;
    const double along = on_lines_[i].along;
    const double count = counts_[i] * along * along;
    Line& line = lines_[on_lines_[i].line];
    line.held += count * branches_[i].tangent_stiffness(law_, now_[i].contact);
    // Two contacts that are alike lose their stiffness together where they peel or soften, and with it the sum of what
    // they are.
    const double at_first = branches_[i].regime == Regime::fully_plastic
                                ? law_.plastic_stiffness()
                                : branches_[i].tangent_stiffness(law_, now_[i].contact);
    line.unsoftened +=
        count * std::max(branches_[i].unpeeled_stiffness(law_, evaluated_radius_, now_[i].contact), at_first);
  }
  // The stiffness of one direction is not to be lost in the rounding of another's.
  const SmallMatrix basis = stiffest_directions(&Line::unsoftened);
  SmallMatrix held = SmallMatrix::Zero();
  SmallMatrix unsoftened = SmallMatrix::Zero();
  for (const Line& line : lines_) {
    const Small at = components(basis, line);
    held += line.held * at * at.transpose();
    unsoftened += line.unsoftened * at * at.transpose();
  }
  for (int k = 0; k < 3; ++k) {
    if (unsoftened(k, k) == 0.0) held(k, k) = unsoftened(k, k) = 1.0;
  }
  const Small scale = unsoftened.diagonal().cwiseSqrt().cwiseInverse();
  const SmallMatrix numerator = scale.asDiagonal() * held * scale.asDiagonal();
  const SmallMatrix denominator = scale.asDiagonal() * unsoftened * scale.asDiagonal();
  const Eigen::GeneralizedSelfAdjointEigenSolver<SmallMatrix> solver(numerator, denominator);
  return {solver.eigenvalues()[0], basis * scale.cwiseProduct(solver.eigenvectors().col(0))};
}

/// Round-off of that stiffness next to a fold, where it goes with the root of the distance: beyond the fold there is no
/// state, or one in which the contacts hold the centre no more.
double System::round_off_of(const CentreStiffness& softest, double r) {
  double softening = 0.0;
  for (std::size_t i = 0; i < branches_.size(); ++i) {
    if (!branches_[i].edge.peels() || is_loaded(i)) continue;
    const double along = std::abs(directions_[i].dot(softest.direction));
    const Frame at = branches_[i].frame(law_, r, now_[i].overlap);
    const double modulus = law_.material.composite_modulus;
    const double of_one = peeling_softening(at, modulus, law_.surface_energy, now_[i].contact.contact_radius);
    softening += counts_[i] * std::abs(of_one) * along * along * along;
  }
  return std::sqrt(2.0 * softening * softest.direction.norm() * rounding_of_forces());
}

/// Distance of that stiffness from the fold.
double System::centre_stiffness_guard(double r) {
  const CentreStiffness softest = centre_stiffness();
  const double rounding = std::min(round_off_of(softest, r), k_at_fold);
  return softest.value - std::max(k_least_centre_stiffness, rounding);
}

/// The springs at a sticking edge tear: it recedes in equilibrium, or, within the critical radius, at once.
void System::start_peeling(std::size_t i, double r, std::span<double> y, std::vector<Event>& log) {
  const ContactBranch& branch = branches_[i];
  const PullOff& limits = branch.pull_off(law_, branch.frame(law_, r, now_[i].overlap).indenter);
  const std::optional<AdhesiveEdge> peeling = branch.edge.torn(limits.under(ramps_[i].control));
  if (!peeling) {
    separate(i, r, y, log);
    return;
  }
  branches_[i].edge = *peeling;
  log.push_back({"peel", static_cast<int>(i)});
}

}  // namespace monograin::mdr
