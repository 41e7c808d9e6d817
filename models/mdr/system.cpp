#include "mdr/system.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "elastic/hertz.hpp"
#include "mdr/contact_profile.hpp"

namespace monograin::mdr {
namespace {

using std::numbers::pi;

constexpr std::size_t k_radius = 0;  // places of the unknowns in y
constexpr std::size_t k_work = 1;
constexpr std::size_t k_centre = 2;

constexpr double k_round_off = std::numeric_limits<double>::epsilon();
constexpr int k_newton_limit = 60;

// In the order of Regime, then what replaces them where the edge of an adhesive contact sticks or peels.
constexpr std::array<std::string_view, 7> k_regime_words{"open",      "elastic",  "fully-plastic", "unloading",
                                                         "separated", "adhering", "peeling"};
constexpr std::array<std::string_view, 2> k_hertz_words{"open", "elastic"};
constexpr double k_adhering_word = 5.0;
constexpr double k_peeling_word = 6.0;

constexpr std::array<std::string_view, 3> k_centre_names{"centre displacement 1", "centre displacement 2",
                                                         "centre displacement 3"};

/// Place of a component of the centre's displacement in y.
constexpr std::size_t centre_place(int k) noexcept { return k_centre + static_cast<std::size_t>(k); }

}  // namespace

System::System(const Settings& settings, std::vector<ContactClass> classes)
    : settings_(settings), classes_(std::move(classes)) {
  const bool yields = std::isfinite(settings_.yield_stress);
  material_ = make_material(settings_.youngs_modulus, settings_.poisson_ratio, settings_.yield_stress,
                            settings_.pressure_curve);
  stress_unit_ = yields ? settings_.yield_stress : material_.composite_modulus;
  material_.composite_modulus /= stress_unit_;
  material_.yield_stress /= stress_unit_;
  material_.bulk_compliance *= stress_unit_;
  surface_energy_ = settings_.surface_energy / (stress_unit_ * settings_.initial_radius);

  const std::size_t count = classes_.size();
  memory_.resize(count);
  now_.resize(count);
  shapes_.resize(count);
  pull_offs_.resize(count);
  edges_before_.resize(count);
  ramps_.resize(count);
  wall_places_.resize(count);

  Eigen::Matrix3Xd means(3, static_cast<Eigen::Index>(count));
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& normal : classes_[i].normals) mean += normal;
    means.col(static_cast<Eigen::Index>(i)) = mean / classes_[i].multiplicity();
  }
  // The centre can only move in ways that keep the symmetry: along the mean normals of the classes.
  if (settings_.centre_is_free) {
    Eigen::ColPivHouseholderQR<Eigen::Matrix3Xd> qr(means);
    qr.setThreshold(1e-10);
    free_count_ = static_cast<int>(qr.rank());
    const Eigen::Matrix3d q = qr.householderQ();
    free_directions_.leftCols(free_count_) = q.leftCols(free_count_);
  }
  for (Eigen::Index i = 0; i < means.cols(); ++i) directions_.emplace_back(free_directions_.transpose() * means.col(i));

  const double reach = largest_overlap_expected();
  // Displaced volume makes the radius grow with the square of the displacement.
  unknowns_ = {{"apparent radius growth (R - R0)/R0", Unknown::Kind::differential, std::min(1.0, reach * reach), true},
               {"work", Unknown::Kind::quadrature, work_scale(reach), false}};
  for (int k = 0; k < free_count_; ++k) {
    unknowns_.push_back({k_centre_names[static_cast<std::size_t>(k)], Unknown::Kind::algebraic, reach, true, true});
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!classes_[i].takes_force) continue;
    wall_places_[i] = unknowns_.size();
    unknowns_.push_back({classes_[i].name, Unknown::Kind::algebraic, reach, true, true});
  }

  trial_.resize(unknowns_.size());

  const bool grows = settings_.radius_rule != RadiusRule::fixed;
  for (std::size_t i = 0; grows && i < count; ++i) {
    for (std::size_t j = i; j < count; ++j) {
      double closest = -1.0;
      for (std::size_t m = 0; m < classes_[i].normals.size(); ++m) {
        for (std::size_t n = (i == j ? m + 1 : 0); n < classes_[j].normals.size(); ++n) {
          closest = std::max(closest, classes_[i].normals[m].dot(classes_[j].normals[n]));
        }
      }
      // Two caps on opposite sides meet only where the particle is squeezed to nothing.
      if (closest > -1.0 + 1e-12) {
        cap_pairs_.push_back({static_cast<int>(i), static_cast<int>(j), std::acos(std::clamp(closest, -1.0, 1.0))});
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
  for (const ContactClass& c : classes_) {
    observables_.push_back({c.name + ".displacement", "m", {}});
    observables_.push_back({c.name + ".overlap", "m", {}});
    observables_.push_back({c.name + ".force", "N", {}});
    observables_.push_back({c.name + ".contact_radius", "m", {}});
    observables_.push_back({c.name + ".pressure", "Pa", {}});
    observables_.push_back({c.name + ".regime", "", words});
  }
  if (settings_.centre_is_free) {
    for (const char* axis : {"centre_x", "centre_y", "centre_z"}) observables_.push_back({axis, "m", {}});
  }
}

/// How far the program goes, over R0; 1 where it does not say.
double System::largest_overlap_expected() const {
  double reach = settings_.largest_displacement / settings_.initial_radius;
  const double force = settings_.largest_force / (stress_unit_ * settings_.initial_radius * settings_.initial_radius);
  if (force > 0.0) {
    const double elastic = elastic_overlap(ElasticProfile::parabola, material_.composite_modulus, 1.0, force);
    const double plastic = std::isfinite(material_.yield_overlap_ratio) ? force / (2.0 * pi) : 0.0;
    reach = std::max(reach, std::min(1.0, std::max(elastic, plastic)));
  }
  return reach > 0.0 ? reach : 1.0;
}

/// Work of one wall up to a displacement, whichever is less of an elastic and a fully plastic contact.
double System::work_scale(double displacement) const noexcept {
  const double elastic = hertz_energy(material_.composite_modulus, 1.0, displacement);
  const double plastic = plastic_pressure(material_, 0.0).pressure * pi * displacement * displacement;
  return std::isfinite(material_.yield_overlap_ratio) ? std::min(elastic, plastic) : elastic;
}

void System::start(std::span<double> y) {
  std::ranges::fill(y, 0.0);
  memory_.assign(classes_.size(), Memory{});
  is_growing_ = false;
  held_radius_ = 0.0;
  largest_work_ = 0.0;
  lowest_dissipation_ = 0.0;
  validity_.reset();
  caps_have_met_ = false;
  has_begun_ = false;
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    const double gap = classes_[i].gap / settings_.initial_radius;
    ramps_[i] = {-gap, -gap, Control::displacement};
    memory_[i].resting = -gap;
    if (classes_[i].takes_force) y[wall_places_[i]] = -gap;
    // A free centre is held by whatever it touches; otherwise resting walls stay open until the particle grows against
    // them.
    if (gap == 0.0 && directions_[i].norm() > 1e-10) memory_[i].regime = Regime::elastic;
  }
}

void System::begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) {
  if (has_begun_) y[k_work] += force_work(y);
  const double length = settings_.initial_radius;
  for (std::size_t i = 0; i < ramps_.size(); ++i) {
    const double unit = ramps[i].control == Control::force ? stress_unit_ * length * length : length;
    ramps_[i] = {ramps[i].start / unit, ramps[i].end / unit, ramps[i].control};
    if (is_loaded(i)) memory_[i].resting = y[wall_places_[i]];
    // A driven wall that touches the fresh particle and approaches is in contact from the start, without an event.
    const bool touches_at_once = is_loaded(i) ? classes_[i].gap == 0.0 : ramps_[i].start == 0.0;
    if (!has_begun_ && touches_at_once && ramps_[i].end > 0.0) memory_[i].regime = Regime::elastic;
  }
  has_begun_ = true;
  y[k_work] -= force_work(y);
  settle(0.0, y, std::nullopt, log);
}

bool System::touches(Regime regime) noexcept {
  switch (regime) {
    case Regime::open:
    case Regime::separated:
      return false;
    case Regime::elastic:
    case Regime::fully_plastic:
    case Regime::unloading:
      return true;
  }
  return false;
}

bool System::is_member(const Memory& memory) const noexcept {
  switch (settings_.radius_rule) {
    case RadiusRule::gated:
    case RadiusRule::seed:
      return touches(memory.regime);
    case RadiusRule::yielded:
      return memory.regime == Regime::fully_plastic;
    case RadiusRule::fixed:
      return false;
  }
  return false;
}

bool System::is_open(int contact_class) const noexcept {
  return !touches(memory_[static_cast<std::size_t>(contact_class)].regime);
}

double System::largest_overlap(const Memory& memory, double r) const noexcept {
  return settings_.delta_max_rule == DeltaMaxRule::shifted ? memory.largest + r : memory.largest;
}

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
void System::look(double xi, std::span<const double> y) {
  for (std::size_t i = 0; i < now_.size(); ++i) {
    look_at(i, is_loaded(i) ? y[wall_places_[i]] : displacement_as_told(i, xi, y), y[k_radius]);
    now_[i].position = now_[i].displacement - carried_by_centre(i, y);
  }
  sum_up(xi, y[k_radius]);
}

void System::look_at(std::size_t i, double displacement, double r) {
  const double radius = 1.0 + r;
  Instant& now = now_[i];
  const Memory& memory = memory_[i];
  now.displacement = displacement;
  now.overlap = displacement + r;
  if (memory.edge != Edge::following) {
    const Frame adhesive = frame(i, now.overlap, r);
    now.contact = memory.edge == Edge::sticking
                      ? sticking_contact(adhesive, material_.composite_modulus, memory.edge_radius)
                      : peeling_contact(adhesive, material_.composite_modulus, surface_energy_,
                                        pull_off(i, adhesive.indenter).by_displacement.contact_radius);
  } else {
    switch (memory.regime) {
      case Regime::open:
      case Regime::separated:
        now.contact = {};
        break;
      case Regime::elastic:
        now.contact = elastic_contact(settings_.elastic_profile, material_.composite_modulus, radius, now.overlap);
        break;
      case Regime::fully_plastic:
        now.contact = plastic_contact(material_, radius, now.overlap, memory.area_constant);
        break;
      case Regime::unloading:
        now.contact = unloading_contact(shape(i, r), material_.composite_modulus, now.overlap);
        break;
    }
  }
  if (settings_.delta_max_rule == DeltaMaxRule::shifted) now.contact.by_radius += now.contact.by_overlap_max;
}

/// Force times displacement of the contacts under force.
double System::force_work(std::span<const double> y) {
  double sum = 0.0;
  for (std::size_t i = 0; i < now_.size(); ++i) {
    if (!is_loaded(i)) continue;
    look_at(i, y[wall_places_[i]], y[k_radius]);
    const double position = now_[i].displacement - carried_by_centre(i, y);
    sum += classes_[i].multiplicity() * now_[i].contact.force * position;
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
      displacement_1d = profile_height(indenter, a) + (force - free_force(indenter, modulus, a)) / (2.0 * modulus * a);
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

/// Displacement of a wall as the program and a free centre make it.
double System::displacement_as_told(std::size_t i, double xi, std::span<const double> y) const noexcept {
  return std::lerp(ramps_[i].start, ramps_[i].end, xi) + carried_by_centre(i, y);
}

/// How far a free centre has come towards the walls of a class.
double System::carried_by_centre(std::size_t i, std::span<const double> y) const noexcept {
  double distance = 0.0;
  for (int k = 0; k < free_count_; ++k) distance += directions_[i][k] * y[centre_place(k)];
  return distance;
}

/// The walls under force, at a given radius.
void System::move_walls(double xi, std::span<double> y) {
  for (std::size_t i = 0; i < ramps_.size(); ++i) {
    if (!is_loaded(i)) continue;
    double& place = y[wall_places_[i]];
    place = displacement_under_force(i, xi, y[k_radius], place);
  }
}

/// The unknowns of walls that are under force at other times only.
void System::note_walls(double xi, std::span<double> y) const noexcept {
  for (std::size_t i = 0; i < ramps_.size(); ++i) {
    if (classes_[i].takes_force && !is_loaded(i)) y[wall_places_[i]] = displacement_as_told(i, xi, y);
  }
}

/// How the displacement of a wall goes with xi and R.
void System::set_rates(std::size_t i, double r) {
  Instant& now = now_[i];
  const double speed = ramps_[i].end - ramps_[i].start;
  now.rate_by_time = is_loaded(i) ? 0.0 : speed;
  now.rate_by_growth = 0.0;
  if (!is_loaded(i)) return;
  const Contact& c = now.contact;
  if (touches(memory_[i].regime) && c.by_overlap > 0.0) {
    now.rate_by_time = speed / c.by_overlap;
    now.rate_by_growth = -1.0 - c.by_radius / c.by_overlap;
  } else if (touches(memory_[i].regime) || memory_[i].resting >= touching_overlap(i, r) - r) {
    now.rate_by_growth = -1.0;  // without load the wall stays at the surface
  }
}

/// Volume balance, power and force balance of what look() found. Equations (37) and (38) in the form that can be
/// integrated.
void System::sum_up(double xi, double r) {
  const double radius = 1.0 + r;
  sums_.by_centre.setZero();
  sums_.force.setZero();
  sums_.force_by_time.setZero();
  sums_.force_by_radius.setZero();
  sums_.stiffness.setZero();
  sums_.power = 0.0;
  sums_.force_work = 0.0;

  double virial_of_all = 0.0;
  double virial = 0.0;  // of the members of the growth set
  for (std::size_t i = 0; i < now_.size(); ++i) {
    const double one = classes_[i].multiplicity() * now_[i].contact.force * (1.0 - now_[i].displacement);
    virial_of_all += one;
    if (is_member(memory_[i])) virial += one;
  }
  const double scale = 3.0 * material_.bulk_compliance / (4.0 * pi);
  sums_.relative_compression = scale * virial_of_all;
  const double w = scale * virial;
  const double under_root = 1.0 - 4.0 * w;
  if (!(under_root > 0.0)) throw std::domain_error("elastic compression to less than half the volume");
  const double root = std::sqrt(under_root);
  const double weight = material_.bulk_compliance / root / (4.0 * pi);

  double caps = 0.0;
  double overlaps = 0.0;
  sums_.by_time = 0.0;
  sums_.time_scale = 0.0;
  sums_.by_radius = 0.0;
  for (std::size_t i = 0; i < now_.size(); ++i) {
    set_rates(i, r);
    if (!touches(memory_[i].regime)) continue;
    const Instant& now = now_[i];
    const Contact& c = now.contact;
    const double count = classes_[i].multiplicity();
    const double speed = ramps_[i].end - ramps_[i].start;
    if (is_loaded(i)) {
      sums_.power -= count * now.position * speed;
      sums_.force_work += count * prescribed_force(i, xi) * now.position;
    } else {
      sums_.power += count * c.force * speed;
    }
    if (free_count_ > 0) {
      sums_.force += count * c.force * directions_[i];
      sums_.force_by_time += count * (is_loaded(i) ? speed : c.by_overlap * speed) * directions_[i];
      if (!is_loaded(i)) {
        sums_.force_by_radius += count * (c.by_overlap + c.by_radius) * directions_[i];
        sums_.stiffness += count * c.by_overlap * directions_[i] * directions_[i].transpose();
      }
    }
    if (!is_member(memory_[i])) continue;
    const double distance = 1.0 - now.displacement;
    caps += count * now.overlap * now.overlap * (3.0 * radius - now.overlap) / 12.0;
    overlaps += count * now.overlap;
    const double cap_rate = 0.25 * now.overlap * (2.0 * radius - now.overlap);
    const double volume_rate = weight * (c.by_overlap * distance - c.force);
    const double by_displacement = count * (volume_rate - cap_rate);
    sums_.by_time += by_displacement * now.rate_by_time;
    sums_.time_scale += count * (std::abs(volume_rate) + std::abs(cap_rate)) * std::abs(now.rate_by_time);
    sums_.by_radius += count * weight * (c.by_overlap + c.by_radius) * distance + by_displacement * now.rate_by_growth;
    if (free_count_ > 0 && !is_loaded(i)) sums_.by_centre += by_displacement * directions_[i];
  }
  sums_.balance = r * (1.0 + r * (1.0 + r / 3.0)) - caps + 2.0 * w / (3.0 * (1.0 + root));
  sums_.by_radius += radius * radius - 0.5 * radius * overlaps;
  if (free_count_ > 0) regularise_first_touch();
}

/// At first touch all stiffnesses vanish together; equal ones give the right motion for contacts of one law.
void System::regularise_first_touch() {
  if (sums_.stiffness.trace() != 0.0) return;
  for (std::size_t i = 0; i < now_.size(); ++i) {
    if (!touches(memory_[i].regime) || is_loaded(i)) continue;
    const double count = classes_[i].multiplicity();
    sums_.stiffness += count * directions_[i] * directions_[i].transpose();
    sums_.force_by_time += count * (ramps_[i].end - ramps_[i].start) * directions_[i];
    sums_.force_by_radius += count * directions_[i];
  }
}

/// Displacement of the centre that changes the net force by `-force`; none along directions that no contact holds.
System::Small System::balance_step(const Small& force) const {
  Small step = Small::Zero();
  if (free_count_ == 1) {
    if (sums_.stiffness(0, 0) != 0.0) step[0] = -force[0] / sums_.stiffness(0, 0);
  } else if (free_count_ > 1) {
    const Eigen::SelfAdjointEigenSolver<SmallMatrix> solver(sums_.stiffness);
    const double threshold = 1e-12 * solver.eigenvalues().cwiseAbs().maxCoeff();
    for (int k = 0; k < 3; ++k) {
      if (std::abs(solver.eigenvalues()[k]) <= threshold) continue;
      const Small direction = solver.eigenvectors().col(k);
      step -= direction * (direction.dot(force) / solver.eigenvalues()[k]);
    }
  }
  return step;
}

System::Motion System::motion(bool growing) const {
  const Small by_time = balance_step(sums_.force_by_time);
  const Small by_radius = balance_step(sums_.force_by_radius);
  Motion result{.demand = -sums_.by_time - sums_.by_centre.dot(by_time),
                .slope = sums_.by_radius + sums_.by_centre.dot(by_radius),
                .growth = 0.0,
                .centre = by_time};
  if (growing) {
    result.growth = result.demand / result.slope;
    result.centre += result.growth * by_radius;
  }
  return result;
}

System::Motion System::growing_motion() const {
  Motion result = motion(true);
  if (!(result.slope > 0.0)) throw std::domain_error("singular growth of the apparent radius");
  return result;
}

/// d(delta_o)/dxi of a wall, towards the centre positive.
double System::inward_rate(std::size_t i, const Motion& motion) const noexcept {
  const double carried = is_loaded(i) ? 0.0 : directions_[i].dot(motion.centre);
  return now_[i].rate_by_time + now_[i].rate_by_growth * motion.growth + carried;
}

void System::complete(double xi, std::span<double> y) {
  if (!is_growing_) y[k_radius] = held_radius_;
  place(xi, y);
}

/// Puts centre and walls where they belong at a given radius.
void System::place(double xi, std::span<double> y) {
  move_walls(xi, y);
  if (free_count_ > 0) move_centre(xi, y);
  note_walls(xi, y);
}

/// Newton on the balance of forces at a given radius; the force grows with the overlap, so damping is all it needs.
void System::move_centre(double xi, std::span<double> y) {
  look(xi, y);
  double step_size = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < k_newton_limit; ++iteration) {
    const double error = sums_.force.norm();
    if (error == 0.0) return;
    Small step = balance_step(sums_.force);
    if (step.norm() == 0.0) throw std::domain_error("no contact holds the free centre of the particle");
    if (step.norm() >= 0.5 * step_size && step.norm() < 1e-12) return;
    step_size = step.norm();
    Small before = Small::Zero();
    for (int k = 0; k < free_count_; ++k) before[k] = y[centre_place(k)];
    for (int halving = 0; halving < 40; ++halving) {
      for (int k = 0; k < free_count_; ++k) y[centre_place(k)] = before[k] + step[k];
      look(xi, y);
      if (sums_.force.norm() < error || step.norm() < k_round_off) break;
      step *= 0.5;
    }
    if (step.norm() < 2.0 * k_round_off) return;
  }
  throw std::domain_error("the balance of forces on the free centre was not found");
}

void System::rates(double xi, std::span<const double> y, std::span<double> dy) {
  look(xi, y);
  const Motion now = is_growing_ ? growing_motion() : Motion{};
  dy[k_radius] = now.growth;
  dy[k_work] = sums_.power;
}

void System::all_rates(double xi, std::span<const double> y, std::span<double> dy) {
  look(xi, y);
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
  look(xi, trial_);
  res[k_radius] = is_growing_ ? sums_.balance - frozen_balance_ : y[k_radius] - held_radius_;
  res[k_work] = dy[k_work] - sums_.power;
  for (std::size_t k = k_centre; k < unknowns_.size(); ++k) res[k] = y[k] - trial_[k];
}

/// Directions in which no touching contact holds the centre: there it stays where it is.
void System::hold_centre(std::span<const double> y) {
  if (free_count_ == 0) return;
  unheld_.setZero();
  for (int k = 0; k < free_count_; ++k) {
    held_centre_[k] = y[centre_place(k)];
    unheld_(k, k) = 1.0;
  }
  SmallMatrix reach = SmallMatrix::Zero();
  for (std::size_t i = 0; i < memory_.size(); ++i) {
    if (touches(memory_[i].regime) && !is_loaded(i)) reach += directions_[i] * directions_[i].transpose();
  }
  const Eigen::SelfAdjointEigenSolver<SmallMatrix> solver(reach);
  for (int k = 0; k < 3; ++k) {
    if (solver.eigenvalues()[k] <= 1e-12) continue;
    const Small direction = solver.eigenvectors().col(k);
    unheld_ -= direction * direction.transpose();
  }
}

double System::balance_residual(double xi, std::span<const double> y) {
  look(xi, y);
  return is_growing_ ? sums_.balance - frozen_balance_ : 0.0;
}

void System::solve(double xi, std::span<double> y) {
  if (is_growing_) {
    grow(xi, y);
    move_walls(xi, y);  // to the radius of the last iteration
    note_walls(xi, y);
  } else {
    complete(xi, y);
  }
}

/// Newton on the volume balance together with the balance of forces.
void System::grow(double xi, std::span<double> y) {
  double step_size = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < k_newton_limit; ++iteration) {
    move_walls(xi, y);
    look(xi, y);
    const Small to_balance = balance_step(sums_.force);
    const Small by_radius = balance_step(sums_.force_by_radius);
    const double slope = sums_.by_radius + sums_.by_centre.dot(by_radius);
    if (!(slope > 0.0)) throw std::domain_error("singular growth of the apparent radius");
    const double defect = sums_.balance - frozen_balance_ + sums_.by_centre.dot(to_balance);
    const double step = std::clamp(-defect / slope, -0.1, 0.1);
    const Small centre_step = to_balance + step * by_radius;
    y[k_radius] += step;
    for (int k = 0; k < free_count_; ++k) y[centre_place(k)] += centre_step[k];
    // Quadratic convergence: below 1e-9 the next step is round-off, unless the centre's square-root forces are still
    // settling.
    const double size = std::max(std::abs(step), centre_step.norm());
    if (size < 2.0 * k_round_off || (size < 1e-9 && free_count_ == 0)) return;
    if (size >= 0.5 * step_size && size < 1e-12) return;
    step_size = size;
  }
  throw std::domain_error("the volume balance of the growing radius has no solution nearby");
}

std::optional<double> System::closed_quadrature(double xi, std::span<const double> y) {
  if (is_growing_) return std::nullopt;
  look(xi, y);
  return energy(y[k_radius], PlasticPart::work_done) - sums_.force_work;
}

/// Energy of the contacts that look() found.
double System::energy(double r, PlasticPart plastic_part) {
  double sum = 0.0;
  for (std::size_t i = 0; i < now_.size(); ++i) {
    if (touches(memory_[i].regime)) sum += classes_[i].multiplicity() * contact_energy(i, r, plastic_part);
  }
  return sum;
}

double System::contact_energy(std::size_t i, double r, PlasticPart plastic_part) {
  const Memory& memory = memory_[i];
  const double overlap = now_[i].overlap;
  const double a = now_[i].contact.contact_radius;
  if (memory.edge != Edge::following) {
    return adhesive_energy(frame(i, overlap, r), material_.composite_modulus, surface_energy_, a);
  }
  // A contact closes without attraction: the surface energy is lost, but can be got back.
  const double surface = plastic_part == PlasticPart::recoverable ? pi * a * a * surface_energy_ : 0.0;
  switch (memory.regime) {
    case Regime::open:
    case Regime::separated:
      break;
    case Regime::elastic:
      return elastic_energy(settings_.elastic_profile, material_.composite_modulus, 1.0 + r, overlap) - surface;
    case Regime::fully_plastic:
      if (plastic_part == PlasticPart::work_done) {
        return plastic_work_primitive(material_, 1.0 + r, overlap, memory.area_constant);
      }
      return plastic_energy(shape(i, r)) - (1.0 - shape(i, r).rho) * surface;
    case Regime::unloading:
      return unloading_energy(shape(i, r), overlap) - (1.0 - shape(i, r).rho) * surface;
  }
  return 0.0;
}

void System::observe(double xi, std::span<const double> y, std::span<double> values) {
  look(xi, y);
  const double r = y[k_radius];
  const double length = settings_.initial_radius;
  const double force_unit = stress_unit_ * length * length;
  const double energy_unit = force_unit * length;
  const double work = y[k_work] + sums_.force_work;
  const double stored = energy(r, PlasticPart::recoverable);
  const double dissipation = work - stored;
  largest_work_ = std::max(largest_work_, work);
  lowest_dissipation_ = std::min(lowest_dissipation_, dissipation);

  auto out = values.begin();
  if (settings_.radius_rule != RadiusRule::fixed) {
    const double w = sums_.relative_compression;
    const double volume = w < 0.25 ? 1.0 - 2.0 * w / (1.0 + std::sqrt(1.0 - 4.0 * w)) : std::nan("");
    *out++ = (1.0 + r) * length;
    *out++ = 4.0 * pi / 3.0 * length * length * length * volume;
  }
  *out++ = work * energy_unit;
  *out++ = stored * energy_unit;
  *out++ = dissipation * energy_unit;
  for (std::size_t i = 0; i < now_.size(); ++i) {
    const Contact& c = now_[i].contact;
    *out++ = now_[i].displacement * length;
    *out++ = now_[i].overlap * length;
    *out++ = c.force * force_unit;
    *out++ = c.contact_radius * length;
    *out++ = c.contact_radius > 0.0 ? c.force / (pi * c.contact_radius * c.contact_radius) * stress_unit_ : 0.0;
    *out++ = memory_[i].edge == Edge::sticking  ? k_adhering_word
             : memory_[i].edge == Edge::peeling ? k_peeling_word
                                                : static_cast<double>(memory_[i].regime);
  }
  if (settings_.centre_is_free) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (int k = 0; k < free_count_; ++k) centre += free_directions_.col(k) * y[centre_place(k)];
    for (const double x : centre) *out++ = x * length;
  }
}

double System::quantity(Quantity quantity, int contact_class, double xi, std::span<const double> y) {
  look(xi, y);
  const Instant& now = now_[static_cast<std::size_t>(contact_class)];
  const double length = settings_.initial_radius;
  switch (quantity) {
    case Quantity::force:
      return now.contact.force * stress_unit_ * length * length;
    case Quantity::displacement:
      return now.displacement * length;
    case Quantity::pressure: {
      const double a = now.contact.contact_radius;
      return a > 0.0 ? now.contact.force / (pi * a * a) * stress_unit_ : 0.0;
    }
    case Quantity::contact_radius:
      return now.contact.contact_radius * length;
    case Quantity::apparent_radius:
      return (1.0 + y[k_radius]) * length;
  }
  return 0.0;
}

std::vector<SurfacePoint> System::surface(int contact_class, double xi, std::span<const double> y) {
  constexpr int k_points = 128;    // within the contact, and as many around it
  constexpr double k_reach = 2.0;  // as far as this many contact radii
  look(xi, y);
  const auto i = static_cast<std::size_t>(contact_class);
  const double a = now_[i].contact.contact_radius;
  if (!touches(memory_[i].regime) || !(a > 0.0)) return {};
  const Frame now = frame(i, now_[i].overlap, y[k_radius]);
  const ContactProfile profile{.indenter = now.indenter,
                               .composite_modulus = material_.composite_modulus,
                               .contact_radius = std::min(a, now.indenter.half_width),
                               .displacement_1d = now.displacement};
  const double length = settings_.initial_radius;
  std::vector<SurfacePoint> points;
  const auto add = [&](double r) {
    points.push_back({.radius = r * length,
                      .pressure = profile.pressure(r) * stress_unit_,
                      .displacement = profile.surface_displacement(r) * length,
                      .relaxed_height = profile.relaxed_height(r) * length});
  };
  // Closer towards the edge from both sides, where the slopes are unbounded; not at the edge itself.
  for (int k = 0; k < k_points; ++k) add(a * std::sin(0.5 * pi * k / k_points));
  for (int k = 1; k <= k_points; ++k) {
    const double share = static_cast<double>(k) / k_points;
    add(a * (1.0 + (k_reach - 1.0) * share * share));
  }
  return points;
}

double System::wall_position(int contact_class, double xi, std::span<const double> y) {
  look(xi, y);
  return now_[static_cast<std::size_t>(contact_class)].position * settings_.initial_radius;
}

std::vector<Finding> System::warnings() const {
  std::vector<Finding> result;
  if (settings_.radius_rule != RadiusRule::fixed) {
    const double ratio = settings_.youngs_modulus / settings_.yield_stress;
    if (!std::isfinite(material_.yield_overlap_ratio)) {
      result.push_back(
          {"the material is too compliant to yield inside the model; the particle stays elastic", "E/Y", ratio});
    } else if (ratio < 10.0) {
      result.push_back({"elastic strains are not small: the model is meant for E/Y of 10 and more", "E/Y", ratio});
    }
  }
  if (caps_have_met_) {
    result.push_back({"contact caps intersect (event caps-intersect); the model is not valid beyond", "first at R/R0",
                      radius_at_caps_});
  }
  if (validity_) result.push_back(*validity_);
  if (lowest_dissipation_ < -1e-6 * largest_work_) {
    result.push_back({"the growing apparent radius creates energy; radius_rule = \"yielded\" avoids it",
                      "lowest dissipation over work", lowest_dissipation_ / largest_work_});
  }
  return result;
}

}  // namespace monograin::mdr
