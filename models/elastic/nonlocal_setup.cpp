// Set-up of the nonlocal system: its scales, unknowns, columns, and the walls that may meet on the surface.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "contacts/centre/centre_lines.hpp"
#include "contacts/columns.hpp"
#include "elastic/nonlocal_system.hpp"

namespace monograin::nonlocal {
namespace {

constexpr std::array<std::string_view, 2> k_regime_words{"open", "elastic"};

// Walls whose angle is this near to pi never meet on the surface [rad].
constexpr double k_opposite = 1e-9;
// Difference of angles that is round-off [rad].
constexpr double k_same_angle = 1e-9;
// Touch tolerance over the program's reach: smaller distances are round-off of the surface's position.
constexpr double k_touch = 1e-13;
// Touch tolerance of a free centre, over the deepest contact: its s has the forces' round-off to the power 2/3.
constexpr double k_touch_of_free_centre = 1e-9;
// Least value of a contact's guard at the touch tolerance: a wall at rest is well off what integrators take for zero.
constexpr double k_guard_at_touch = 1e-12;
// Largest contact radius over R0 with all terms. Approach and force depend on 1 - a, of which a has ever fewer digits;
// beyond this radius, the approach has less than eleven.
constexpr double k_widest_of_all_terms = 1.0 - 1e-6;
// A program whose deepest contact is no deeper than this, over R0, works with round-off of lengths.
constexpr double k_least_depth = 1e-12;
// Contacts shallower than this, over the deepest, support a free centre too softly for an integrator.
constexpr double k_idle = 1e-6;

/// Angles at which walls of two classes may meet on the surface, each listed once.
/// @param is_one  true if both classes are the same one
std::vector<double> meeting_angles(const ContactClass& first, const ContactClass& second, bool is_one) {
  std::vector<double> angles;
  for (std::size_t m = 0; m < first.normals.size(); ++m) {
    for (std::size_t n = is_one ? m + 1 : 0; n < second.normals.size(); ++n) {
      const double angle = angle_between(first.normals[m], second.normals[n]);
      const bool is_known =
          std::ranges::any_of(angles, [&](double other) { return std::abs(other - angle) < k_same_angle; });
      if (!is_known && angle < std::numbers::pi - k_opposite) angles.push_back(angle);
    }
  }
  return angles;
}

}  // namespace

System::System(const Settings& settings, std::vector<ContactClass> classes)
    : settings_(settings),
      classes_(std::move(classes)),
      contacts_(settings.model, classes_, settings.centre),
      search_(contacts_),
      motion_(contacts_),
      support_(contacts_),
      work_place_(contacts_.unknown_count()),
      pairs_(pairs_of(classes_)) {
  const double depth = set_scales();
  list_unknowns(depth);
  list_observables();
  const Eigen::Matrix3Xd mean_normals = mean_normals_of(classes_);
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    const Eigen::Vector3d mean = mean_normals.col(static_cast<Eigen::Index>(i));
    arms_.emplace_back(contacts_.free_directions().transpose() * mean);
  }
  reserve_work_space();
}

std::vector<System::Pair> System::pairs_of(std::span<const ContactClass> classes) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    for (std::size_t j = i; j < classes.size(); ++j) {
      for (const double angle : meeting_angles(classes[i], classes[j], i == j)) pairs.push_back({i, j, angle});
    }
  }
  return pairs;
}

/// Depth of the deepest contact that the program asks for, over R0; 0 if it asks for none.
double System::greatest_depth() const {
  const double length = settings_.initial_radius;
  const double depth = settings_.largest_displacement / length;
  if (!(settings_.largest_force > 0.0)) return depth;
  const double force = settings_.largest_force / (settings_.youngs_modulus * length * length);
  const double bearable = std::min(force / contacts_.composite_modulus(), contacts_.law().greatest_force());
  return std::max(depth, contacts_.law().signed_square_under(bearable));
}

/// Sets the limits of round-off, of idle contacts and of wide contacts, from the program's reach.
/// @return scale of the unknowns
double System::set_scales() {
  double reach = greatest_depth();
  is_shallow_ = reach > 0.0 && reach <= k_least_depth;
  for (const ContactClass& c : classes_) reach = std::max(reach, c.gap / settings_.initial_radius);
  if (!(reach > 0.0)) reach = 1.0;
  // A program may prescribe any displacement, but before R0 a wall is at the centre, or a contact as wide as the
  // particle.
  const double depth = std::min(reach, 1.0);
  touch_ = settings_.centre == Centre::free ? k_touch_of_free_centre * depth : k_touch * reach;
  guard_unit_ = std::min(depth, touch_ / k_guard_at_touch);
  idle_ = k_idle * depth;
  if (settings_.model.terms == Terms::all) {
    widest_ = k_widest_of_all_terms;
    greatest_approach_ = contacts_.law().at(widest_ * widest_).approach;
  }
  return depth;
}

void System::list_unknowns(double depth) {
  for (const ContactClass& c : classes_) {
    unknowns_.push_back(
        {c.name, Unknown::Kind::differential, c.takes_force ? std::pow(depth, k_force_power) : depth, true});
  }
  for (std::size_t k = 0; k < contacts_.free_count(); ++k) {
    unknowns_.push_back({.name = contacts::k_centre_unknowns[k],
                         .kind = Unknown::Kind::differential,
                         .scale = depth,
                         .is_implicitly_algebraic = true,
                         .may_rest = true});
  }
  unknowns_.push_back({"work", Unknown::Kind::quadrature, depth * depth * std::sqrt(depth), false});
}

void System::list_observables() {
  observables_ = {{"work", "J", {}}, {"stored_energy", "J", {}}, {"margin", "-", {}}};
  for (const ContactClass& c : classes_) {
    contacts::add_contact_columns(c.name, k_regime_words, observables_);
    observables_.push_back({c.name + ".contact_radius_deformed", "m", {}});
  }
  if (settings_.centre == Centre::free) contacts::add_centre_columns(observables_);
}

/// Allocates the work space; nothing is allocated while integrating.
void System::reserve_work_space() {
  const std::size_t count = classes_.size();
  for (auto* ramps : {&ramps_, &drawn_ramps_}) ramps->resize(count);
  for (auto* state : {&state_, &rates_}) state->resize(contacts_.unknown_count());
  for (auto* marks : {&is_closed_, &touches_}) marks->resize(count);
  regimes_.resize(count);
  all_rates_.resize(unknowns_.size());
  now_.resize(count);
  edge_angles_.resize(count);
}

}  // namespace monograin::nonlocal
