#include "mdr/system.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "contacts/columns.hpp"
#include "elastic/hertz.hpp"
#include "system/difficulty.hpp"

namespace monograin::mdr {
namespace {

using std::numbers::pi;

// By how much the squared sine of half the angle between opposite walls falls short of 1 for round-off.
constexpr double k_opposite = 5e-13;

// In the order of Regime, then what replaces them where the edge of an adhesive contact sticks or peels.
constexpr std::array<std::string_view, 7> k_regime_words{"open",      "elastic",  "fully-plastic", "unloading",
                                                         "separated", "adhering", "peeling"};
constexpr std::array<std::string_view, 2> k_hertz_words{"open", "elastic"};

constexpr std::array<std::string_view, 3> k_centre_names{"centre displacement 1", "centre displacement 2",
                                                         "centre displacement 3"};

}  // namespace

System::System(const Settings& settings, std::vector<ContactClass> classes)
    : settings_(settings), classes_(std::move(classes)) {
  const bool yields = std::isfinite(settings_.yield_stress);
  law_.material = make_material(settings_.youngs_modulus, settings_.poisson_ratio, settings_.yield_stress,
                                settings_.pressure_curve);
  stress_unit_ = yields ? settings_.yield_stress : law_.material.composite_modulus;
  law_.elastic_profile = settings_.elastic_profile;
  law_.delta_max_rule = settings_.delta_max_rule;
  law_.material.composite_modulus /= stress_unit_;
  law_.material.yield_stress /= stress_unit_;
  law_.material.bulk_compliance *= stress_unit_;
  law_.surface_energy = settings_.surface_energy / (stress_unit_ * settings_.initial_radius);

  const std::size_t count = classes_.size();
  branches_.resize(count);
  now_.resize(count);
  edges_before_.resize(count);
  has_turned_.resize(count);
  is_left_.resize(count);
  has_resumed_.resize(count);
  goes_on_.resize(count);
  overlaps_before_.resize(count);
  branches_before_.resize(count);
  ramps_.resize(count);
  wall_places_.resize(count);
  takes_forces_ = std::ranges::any_of(classes_, &ContactClass::takes_force);
  bears_.resize(count, true);
  may_be_slight_.resize(count, false);
  backing_.reserve(2 * count);

  Eigen::Matrix3Xd means(3, static_cast<Eigen::Index>(count));
  for (std::size_t i = 0; i < count; ++i) {
    counts_.push_back(classes_[i].multiplicity());
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& normal : classes_[i].normals) mean += normal;
    means.col(static_cast<Eigen::Index>(i)) = mean / counts_[i];
  }
  // The centre can only move in ways that keep the symmetry: along the mean normals of the classes.
  if (settings_.centre_is_free) {
    Eigen::ColPivHouseholderQR<Eigen::Matrix3Xd> qr(means);
    qr.setThreshold(k_no_direction);
    free_count_ = static_cast<int>(qr.rank());
    law_.continues_off_branch = free_count_ > 0;
    const Eigen::Matrix3d q = qr.householderQ();
    free_directions_.leftCols(free_count_) = q.leftCols(free_count_);
  }
  for (Eigen::Index i = 0; i < means.cols(); ++i) directions_.emplace_back(free_directions_.transpose() * means.col(i));
  find_lines();

  const double reach = largest_overlap_expected();
  unknowns_ = {{"apparent radius growth (R - R0)/R0", Unknown::Kind::differential, growth_scale(reach), true},
               {"work", Unknown::Kind::quadrature, work_scale(reach), false}};
  for (int k = 0; k < free_count_; ++k) {
    unknowns_.push_back({.name = k_centre_names[static_cast<std::size_t>(k)],
                         .kind = Unknown::Kind::algebraic,
                         .scale = reach,
                         .is_implicitly_algebraic = true,
                         .is_dependent = true,
                         .may_rest = true});
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!classes_[i].takes_force) continue;
    wall_places_[i] = unknowns_.size();
    unknowns_.push_back({classes_[i].name, Unknown::Kind::algebraic, reach, true, true});
  }

  trial_.resize(unknowns_.size());
  seen_.resize(unknowns_.size());

  const bool grows = settings_.radius_rule != RadiusRule::fixed;
  for (std::size_t i = 0; grows && i < count; ++i) {
    for (std::size_t j = i; j < count; ++j) {
      double half_sine = 1.0;
      for (std::size_t m = 0; m < classes_[i].normals.size(); ++m) {
        for (std::size_t n = (i == j ? m + 1 : 0); n < classes_[j].normals.size(); ++n) {
          half_sine = std::min(half_sine, 0.5 * (classes_[i].normals[m] - classes_[j].normals[n]).norm());
        }
      }
      // Two caps on opposite sides meet only where the particle is squeezed to nothing.
      if (half_sine * half_sine < 1.0 - k_opposite) {
        cap_pairs_.push_back({static_cast<int>(i), static_cast<int>(j), half_sine});
      }
    }
  }

  if (grows) {
    observables_.push_back({"apparent_radius", "m", {}});
    observables_.push_back({"volume", "m3", {}});
  }
  observables_.push_back({"work", "J", {}});
  observables_.push_back({"stored_energy", "J", {}});
  observables_.push_back({"dissipation", "J", {}});
  const std::span<const std::string_view> words =
      yields ? std::span<const std::string_view>(k_regime_words) : std::span<const std::string_view>(k_hertz_words);
  for (const ContactClass& c : classes_) contacts::add_contact_columns(c.name, words, observables_);
  if (settings_.centre_is_free) {
    for (const char* axis : {"centre_x", "centre_y", "centre_z"}) observables_.push_back({axis, "m", {}});
  }
}

/// How far the program goes, over R0; 1 where it does not say. It may ask for any displacement, but a contact ends
/// where its wall has reached the centre.
double System::largest_overlap_expected() const {
  double reach = std::min(1.0, settings_.largest_displacement / settings_.initial_radius);
  const double force = settings_.largest_force / (stress_unit_ * settings_.initial_radius * settings_.initial_radius);
  if (force > 0.0) {
    const double elastic = elastic_overlap(ElasticProfile::parabola, law_.material.composite_modulus, 1.0, force);
    const double plastic = std::isfinite(law_.material.yield_overlap_ratio) ? force / (2.0 * pi) : 0.0;
    reach = std::max(reach, std::min(1.0, std::max(elastic, plastic)));
  }
  return reach > 0.0 ? reach : 1.0;
}

/// Growth of the radius up to a displacement. Displaced volume makes it grow with the square of that; by the rule
/// `seed` so does elastic volume that comes back, which of small displacements is more.
double System::growth_scale(double displacement) const noexcept {
  const double displaced = displacement * displacement;
  if (settings_.radius_rule != RadiusRule::seed) return displaced;
  const double force = hertz_force(law_.material.composite_modulus, 1.0, displacement);
  return std::min(1.0, std::max(displaced, 0.5 * std::numbers::inv_pi * law_.material.bulk_compliance * force));
}

/// Work of one wall up to a displacement, whichever is less of an elastic and a fully plastic contact.
double System::work_scale(double displacement) const noexcept {
  const double elastic = hertz_energy(law_.material.composite_modulus, 1.0, displacement);
  const double plastic = plastic_pressure(law_.material, 0.0).pressure * pi * displacement * displacement;
  return std::isfinite(law_.material.yield_overlap_ratio) ? std::min(elastic, plastic) : elastic;
}

void System::start(std::span<double> y) {
  std::ranges::fill(y, 0.0);
  branches_.assign(classes_.size(), ContactBranch{});
  is_growing_ = false;
  held_radius_ = 0.0;
  validity_.reset();
  caps_have_met_ = false;
  for (CapPair& pair : cap_pairs_) pair.have_met = false;
  has_begun_ = false;
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    const double gap = classes_[i].gap / settings_.initial_radius;
    ramps_[i] = {-gap, -gap, Control::displacement};
    branches_[i].resting = -gap;
    if (classes_[i].takes_force) y[wall_places_[i]] = -gap;
    // A free centre is held by whatever it touches; otherwise resting walls stay open until the particle grows against
    // them.
    if (gap == 0.0 && directions_[i].norm() > k_no_direction) branches_[i].regime = Regime::elastic;
  }
}

void System::begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) {
  if (has_begun_) y[k_work] += force_work(y);
  const double length = settings_.initial_radius;
  for (std::size_t i = 0; i < ramps_.size(); ++i) {
    const double unit = ramps[i].control == Control::force ? stress_unit_ * length * length : length;
    ramps_[i] = {ramps[i].start / unit, ramps[i].end / unit, ramps[i].control};
    if (is_loaded(i)) branches_[i].resting = y[wall_places_[i]];
    // A driven wall that touches the fresh particle and approaches is in contact from the start, without an event.
    const bool touches_at_once = is_loaded(i) ? classes_[i].gap == 0.0 : ramps_[i].start == 0.0;
    if (!has_begun_ && touches_at_once && ramps_[i].end > 0.0) branches_[i].regime = Regime::elastic;
  }
  has_begun_ = true;
  y[k_work] -= force_work(y);
  has_turned_.assign(branches_.size(), false);
  is_left_.assign(branches_.size(), false);
  find_slight_forces();
  if (free_count_ > 0) evaluate(0.0, y);
  for (std::size_t i = 0; i < ramps_.size(); ++i) {
    // The nearest walls close with it, as no guard is met by one that touches already.
    const bool begins_to_press = is_loaded(i) && ramps_[i].start == 0.0 && ramps_[i].end > 0.0;
    if (begins_to_press && branches_[i].touches()) meet_balanced(i, true, y[k_radius], log);
  }
  resolve_mode(0.0, y, std::nullopt, log);
  if (const auto end = meet_caps_at_once(0.0, y, log)) throw CannotBegin(*end);
  if (const auto end = reach_centre_at_once(0.0, y)) throw CannotBegin(*end);
}

bool System::is_open(int contact_class) const noexcept {
  return !branches_[static_cast<std::size_t>(contact_class)].touches();
}

std::optional<Difficulty> System::difficulty(double xi, std::span<const double> y) {
  // Of the whole program: every contact is as shallow when it is made.
  if (!(largest_overlap_expected() > k_resolution)) return Difficulty::below_resolution;
  if (free_count_ == 0 || !weakest_contact()) return std::nullopt;
  evaluate(xi, y);
  if (least_centre_stiffness() >= k_soft_centre) return std::nullopt;
  return Difficulty::soft_centre;
}

void System::complete(double xi, std::span<double> y) {
  if (!is_growing_) y[k_radius] = held_radius_;
  const bool may_peel_off = free_count_ > 0 && weakest_contact();
  bool is_balanced = true;
  try {
    place(xi, y);
  } catch (const std::domain_error&) {
    // A guess beyond pull-off leads to there, where the force that is left is least.
    is_balanced = false;
    if (!may_peel_off || !leave_saddle(xi, y, is_balanced)) throw;
  }
  if (!may_peel_off) return;
  if (is_balanced) leave_saddle(xi, y, is_balanced);
  note_walls(xi, y);
}

void System::rates(double xi, std::span<const double> y, std::span<double> dy) {
  evaluate_cached(xi, y);
  const Motion now = is_growing_ ? growing_motion() : Motion{};
  dy[k_radius] = now.growth;
  dy[k_work] = sums_.power;
}

void System::all_rates(double xi, std::span<const double> y, std::span<double> dy) {
  evaluate(xi, y);
  const Motion now = is_growing_ ? growing_motion() : motion(false);
  dy[k_radius] = now.growth;
  dy[k_work] = sums_.power;
  for (int k = 0; k < free_count_; ++k) dy[centre_place(k)] = now.centre[k];
  for (std::size_t i = 0; i < now_.size(); ++i) {
    if (classes_[i].takes_force) {
      dy[wall_places_[i]] = inward_rate(i, now);
    }
  }
}

void System::residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) {
  // Centre and walls under force stand where the radius puts them, so that their singular rows do not couple to the
  // others.
  std::ranges::copy(y, trial_.begin());
  for (int k = 0; k < free_count_; ++k) {
    for (int j = 0; j < free_count_; ++j) {
      trial_[centre_place(k)] -= unheld_(k, j) * (y[centre_place(j)] - held_centre_[j]);
    }
  }
  place(xi, trial_);
  evaluate(xi, trial_);
  // Beyond where growth would run away there is no balance to be found; the rates end there, too.
  if (is_growing_) static_cast<void>(growing_motion());
  res[k_radius] = is_growing_ ? sums_.balance - frozen_balance_ : y[k_radius] - held_radius_;
  res[k_work] = dy[k_work] - sums_.power;
  for (std::size_t k = k_centre; k < unknowns_.size(); ++k) res[k] = y[k] - trial_[k];
}

void System::solve(double xi, std::span<double> y) {
  if (is_growing_) {
    grow(xi, y);
    check_hold();
    move_walls(xi, y);  // to the radius of the last iteration
    note_walls(xi, y);
  } else {
    complete(xi, y);
  }
}

std::optional<double> System::closed_quadrature(double xi, std::span<const double> y) {
  if (is_growing_) return std::nullopt;
  evaluate_cached(xi, y);
  return energy(y[k_radius], PlasticPart::work_done) - sums_.force_work;
}

}  // namespace monograin::mdr
