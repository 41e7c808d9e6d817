#include "plastic/system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "system/number_text.hpp"
#include "system/resolution.hpp"

namespace monograin::plastic {
namespace {

// Least typical depth over R0: shallower contacts have too few digits where a ramp prescribes the wall's displacement.
constexpr double k_least_typical = 1e-7;
// Share of a law's limit that sets scales: at the limit itself the pressure of an enclosed particle may be infinite.
constexpr double k_far_from_limit = 0.9;
// gamma/2R from which on semimech agrees with finite elements.
constexpr double k_least_trusted = 0.03;

/// Warning of a run of semimech that stays below k_least_trusted: the force against finite elements (at gamma/2R = 0.02
/// and 0.005), and D1^2 over the range of lambda to which the source fitted the law.
std::string early_stiffness_warning(Configuration configuration) {
  struct Excess {
    const char *over_finite_elements, *over_hertz;
  };
  // In the order of Configuration.
  constexpr std::array<Excess, 3> k_excess{
      {{"19 to 58", "2.20 to 3.06"}, {"18 to 50", "2.30 to 3.21"}, {"15 to 66", "2.57 to 3.58"}}};
  const Excess& excess = k_excess[static_cast<std::size_t>(configuration)];
  return "the whole run lies where the law is too stiff: below displacement/R0 = 0.03 its force (" +
         std::string(name(configuration)) + ") is " + excess.over_finite_elements +
         " % above finite elements, and in the elastic regime " + excess.over_hertz +
         " times that of Hertz over the fitted materials";
}

bool is_die(const Law& law) noexcept {
  if (const auto* semimech = std::get_if<SemimechLaw>(&law)) return semimech->configuration == Configuration::die;
  if (const auto* hardening = std::get_if<HardeningLaw>(&law)) return hardening->configuration == Configuration::die;
  return false;
}

}  // namespace

WallLaw::WallLaw(Settings settings)
    : settings_(std::move(settings)),
      modulus_(settings_.composite_modulus / settings_.strength),
      first_power_(first_power(settings_.law)),
      boundaries_(boundaries(settings_.law)),
      impingement_(impingement(settings_.law)) {
  const Law& law = settings_.law;
  if (const auto* semimech = std::get_if<SemimechLaw>(&law); semimech != nullptr && is_die(law)) {
    lateral_law_ = make_lateral(*semimech);
    lateral_boundaries_ = boundaries(*semimech, *lateral_law_);
  }
}

void WallLaw::start() noexcept {
  farthest_ = 0.0;
  has_lateral_gap_ = false;
  overshooting_.reset();
}

Regime WallLaw::primary_regime(const Branch& b) const noexcept {
  return b.next == 0 ? first_regime(settings_.law) : boundaries_[b.next - 1].beyond;
}

// --- force and displacement

double WallLaw::opening(const Branch& b) const noexcept {
  return b.is_on_indenter ? b.indenter.overlap_max - b.indenter.recovery : 0.0;
}

double WallLaw::force(const Branch& b, double x) const {
  if (x <= opening(b)) return 0.0;
  if (b.is_on_indenter) return mdr::unloading_contact(b.indenter, modulus_, x).force;
  return state_in(settings_.law, primary_regime(b), x).force;
}

double WallLaw::slope(const Branch& b, double x) const { return force_and_slope(b, x).second; }

std::pair<double, double> WallLaw::force_and_slope(const Branch& b, double x) const {
  if (b.is_on_indenter) {
    const mdr::Contact c = mdr::unloading_contact(b.indenter, modulus_, x);
    return {c.force, c.by_overlap};
  }
  const ContactState c = state_in(settings_.law, primary_regime(b), x);
  return {c.force, c.force_by_approach};
}

/// Uses the recompressed share: the displacement loses the digits of a small distance from the opening.
double WallLaw::slope_under(const Branch& b, double force) const {
  if (!b.is_on_indenter) return slope(b, displacement(b, force));
  const double share = mdr::recompressed_share(b.indenter, force);
  return mdr::recompressed_contact(b.indenter, modulus_, share).by_overlap;
}

double WallLaw::displacement(const Branch& b, double force, double near) const {
  return b.is_on_indenter ? mdr::unloading_overlap(b.indenter, force) : approach_under(settings_.law, force, near);
}

double WallLaw::coordinate_power(const Branch& b) const noexcept { return b.is_on_indenter ? 0.0 : first_power_; }

/// False in low compressibility: next to infinite pressure, an integrator's error would lead beyond the end of the law.
bool WallLaw::is_integrated(const Branch& b) const noexcept { return primary_regime(b) != Regime::low_compressibility; }

contacts::BearingContact WallLaw::contact(const Branch& b, double x) const {
  if (b.is_on_indenter) {
    const mdr::Contact c = mdr::unloading_contact(b.indenter, modulus_, x);
    return {c.force, c.contact_radius};
  }
  const ContactState c = state_in(settings_.law, primary_regime(b), x);
  return {c.force, c.contact_radius};
}

double WallLaw::work(const Branch& b, double x) const {
  if (x <= opening(b)) return 0.0;
  return b.is_on_indenter ? mdr::unloading_energy(b.indenter, x) : work_in(settings_.law, primary_regime(b), x);
}

/// True where work is a quadrature of 30 forces; for power laws and polynomials it is not.
bool WallLaw::is_work_costly(const Branch& b) const noexcept {
  return !b.is_on_indenter && !std::holds_alternative<SimilarityLaw>(settings_.law) &&
         primary_regime(b) != Regime::elastic && primary_regime(b) != Regime::elastic_volumetric;
}

double WallLaw::stored(const Branch& b, double x) const {
  if (b.is_on_indenter) return mdr::unloading_energy(b.indenter, x);
  if (primary_regime(b) == Regime::elastic) return work_per_wall(settings_.law, x);
  return mdr::plastic_energy(indenter_at(b, x));
}

contacts::Magnitudes WallLaw::magnitudes(double reach) const {
  const Law& law = settings_.law;
  const bool is_said = settings_.reach.displacement > 0.0 || settings_.reach.force > 0.0;
  reach = is_said ? std::min(reach, k_far_from_limit * limit(law)) : 0.5 * limit(law);
  // A yield point makes the range before it count, too.
  const double first = boundaries_.empty() || !begins_elastic(law) ? reach : std::min(reach, boundaries_[0].approach);
  // A depth that follows from a force has all its digits, however shallow it is.
  const double least = settings_.reach.displacement > 0.0 ? k_least_typical : 0.0;
  // Beyond the fitted range work grows by orders, and a condition may end a program long before its targets.
  return {std::max(first, least), work_per_wall(law, std::min(reach, calibrated_end(law)))};
}

// --- boundaries and branches

WallLaw::Ahead WallLaw::ahead(const Branch& b) const {
  const bool ends_before = !boundaries_.empty() && boundaries_.back().beyond == Regime::undefined;
  const double end = limit(settings_.law);
  Ahead first{{end, "limit", LimitPoint{Limit::walls_meet, -1, "displacement/R0", end}}, Kind::end};
  if (ends_before) {
    const Boundary& last = boundaries_.back();
    first.boundary = {last.approach, last.event, LimitPoint{Limit::cell_filled, -1, "displacement/R0", last.approach}};
  }
  const auto consider = [&](double position, std::string_view event, Kind kind) {
    if (position < first.boundary.position) first = {{position, event, {}, kind == Kind::of_followers}, kind};
  };
  if (b.next < boundaries_.size() && boundaries_[b.next].beyond != Regime::undefined)
    consider(boundaries_[b.next].approach, boundaries_[b.next].event, Kind::of_law);
  if (impingement_ && !b.has_impinged) consider(*impingement_, "impingement", Kind::impingement);
  if (b.next_lateral < lateral_boundaries_.size()) {
    const Boundary& lateral = lateral_boundaries_[b.next_lateral];
    consider(lateral.approach, lateral.event, Kind::of_followers);
  }
  return first;
}

void WallLaw::pass(Branch& b) const {
  switch (ahead(b).kind) {
    case Kind::of_law:
      ++b.next;
      break;
    case Kind::impingement:
      b.has_impinged = true;
      break;
    case Kind::of_followers:
      ++b.next_lateral;
      break;
    case Kind::end:
      break;
  }
}

std::optional<std::string_view> WallLaw::refuses_unloading() const noexcept {
  if (settings_.unloading != Unloading::none) return std::nullopt;
  return "unloading = \"mdr\" adds one";
}

void WallLaw::turn(Branch& b, double x) {
  if (primary_regime(b) == Regime::elastic) return;
  b.indenter = indenter_at(b, x);
  b.is_on_indenter = true;
  if (b.indenter.recovery <= x) return;
  const double ratio = b.indenter.recovery / x;
  overshooting_ = std::max(overshooting_.value_or(ratio), ratio);
}

/// Elastic indenter that the contact would leave if it were unloaded from this displacement.
mdr::UnloadingShape WallLaw::indenter_at(const Branch& b, double x) const {
  const ContactState now = state_in(settings_.law, primary_regime(b), x);
  return mdr::unloading_shape_of(modulus_, settings_.poisson_ratio, 1.0, x, now.contact_radius, now.pressure);
}

std::string_view WallLaw::made_event(const Branch& b) const noexcept {
  return b.is_on_indenter ? "dent-touched" : "contact-made";
}

int WallLaw::regime(const Branch& b, bool touches) const noexcept {
  if (b.is_on_indenter) return static_cast<int>(touches ? Regime::unloading : Regime::separated);
  return static_cast<int>(touches ? primary_regime(b) : Regime::open);
}

// --- lateral contacts

bool WallLaw::follows(const ContactClass& walls) const noexcept {
  return is_die(settings_.law) && std::abs(walls.normals.front().z()) < 0.5;
}

/// Regime of the lateral contacts. They follow the axial contacts until those unload from a plastic state; then there
/// is no law.
Regime WallLaw::lateral_regime(const Branch& leader, bool touches) const noexcept {
  if (leader.is_on_indenter) return Regime::undefined;
  if (!touches) return Regime::open;
  if (!lateral_law_) return Regime::undefined;
  return leader.next_lateral == 0 ? Regime::elastic : lateral_boundaries_[leader.next_lateral - 1].beyond;
}

contacts::VisibleContact WallLaw::follower(const Branch& leader, bool touches, double x) {
  const Regime regime = lateral_regime(leader, touches);
  contacts::VisibleContact shown{.regime = static_cast<double>(regime)};
  const bool is_undefined = regime == Regime::undefined;
  has_lateral_gap_ = has_lateral_gap_ || is_undefined;
  if (is_undefined) shown.overlap = shown.force = shown.contact_radius = shown.pressure = k_nan;
  if (is_undefined || regime == Regime::open) return shown;
  // The overlap is that of an equivalent primary contact.
  const bool is_in_small_range = regime == Regime::elastic || regime == Regime::elastic_plastic;
  if (!is_in_small_range) shown.overlap = k_nan;
  if (!(x > 0.0)) return shown;
  if (is_in_small_range) shown.overlap = lateral_approach(*lateral_law_, x).value;
  const ContactState state = lateral_state_in(std::get<SemimechLaw>(settings_.law), *lateral_law_, regime, x);
  shown.force = state.force;
  shown.contact_radius = state.contact_radius;
  shown.pressure = state.pressure;
  return shown;
}

std::vector<Diagnostic> WallLaw::warnings(double /*walls*/) const {
  std::vector<Diagnostic> result;
  for (const OutOfRange& out : settings_.out_of_range) {
    result.push_back({std::string(out.quantity) + " is outside " + number_text(out.lower) + " to " +
                          number_text(out.upper) + ", over which the source fitted the law",
                      out.quantity, out.value});
  }
  if (farthest_ > calibrated_end(settings_.law)) {
    result.push_back({"the walls have gone farther than the source compares the law with its calculations",
                      "largest displacement/R0", farthest_});
  }
  const auto* semimech = std::get_if<SemimechLaw>(&settings_.law);
  if (semimech != nullptr && farthest_ > 0.0 && farthest_ < k_least_trusted) {
    result.push_back({early_stiffness_warning(semimech->configuration), "largest displacement/R0", farthest_});
  }
  if (lateral_law_ && farthest_ > k_least_trusted) {
    result.push_back(
        {"forces of the lateral contacts are 2.1 to 3.5 times those of finite elements for axial displacement/R0 from "
         "0.03 to 0.1",
         "largest displacement/R0", farthest_});
  }
  if (has_lateral_gap_) {
    result.push_back({"the source has no law for lateral contacts in all of the range; their columns are nan there",
                      "largest displacement/R0", farthest_});
  }
  if (lateral_law_) {
    const double lambda = semimech->material.modulus_over_yield;
    if (!is_in_fitted_range(lambda, k_least_lateral_modulus_over_yield, k_greatest_lateral_modulus_over_yield)) {
      result.push_back({"outside the range over which the lateral contacts were fitted, 163.08 to 4954.4",
                        "E/((1-nu^2) Y)", lambda});
    }
  }
  if (overshooting_) {
    result.push_back(
        {"a contact recovers more than it was compressed: so small a contact is not plastic enough for "
         "unloading = \"mdr\"",
         "recovery over displacement", *overshooting_});
  }
  return result;
}

}  // namespace monograin::plastic
