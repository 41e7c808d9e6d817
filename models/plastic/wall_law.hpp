/// Contact of a plastic particle with a rigid wall, for contacts::IndependentContacts: first loading by a law, and
/// unloading. The lateral contacts of a die follow the axial walls and do not act back. Lengths in R0, stresses in the
/// strength S.
///
/// Unloading: the source has no law. `mdr` gives every yielded contact the elastic indenter that model mdr would leave
/// under the same mean pressure and contact radius; a contact that has not yielded retraces its loading curve.
///
/// A law, for a contact that is loaded for the first time to the displacement x, has
///   first_regime, limit            regime from first touch on; x at which the law ends
///   calibrated_end                 x up to which the source compares it with finite elements
///   first_power()                  power of x with which the force begins
///   is_work_costly(regime)         true where the work is a quadrature
///   configuration, radius          where contacts have neighbours
/// and, found by its namespace,
///   boundaries(law)                ends of its regimes; `undefined` beyond the last one ends the law
///   state_in(law, regime, x)       by the formulas of one regime, also a little outside of it, for x > 0
///   state_at(law, x)               by those of the regime at x
///   approach_under(law, force, near)
///                                  x under a force, whatever the regime; near: initial guess, or 0
///   work_in(law, regime, x)        int P dx of one wall from the beginning of the regime
///   work_per_wall(law, x)          int P dx of one wall from first touch
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "contacts/independent.hpp"
#include "mdr/contact.hpp"
#include "plastic/compression.hpp"

namespace monograin::plastic {

/// Share of a law's limit up to which scales and conditions are sought: at the limit itself the pressure of an enclosed
/// particle may be infinite.
inline constexpr double k_far_from_limit = 0.9;

/// Properties of a contact that its law does not hold.
struct Settings {
  double strength = 0.0;  ///< S [Pa], > 0
  bool can_unload = false;
  double composite_modulus = 0.0;  ///< E* [Pa], > 0; for unloading only
  double poisson_ratio = 0.0;      ///< for unloading only
  Reach reach{};                   ///< as contacts::Settings
};

template <class Law>
class WallLaw {
 public:
  struct Branch {
    std::size_t next = 0;         ///< boundary ahead on the primary branch
    bool has_impinged = false;    ///< has met its neighbours
    bool is_on_indenter = false;  ///< unloaded since it yielded, and not back at its largest displacement
    mdr::UnloadingShape indenter{};
  };
  static constexpr auto k_regimes = plastic::k_regimes;
  static constexpr auto k_passed_at_end = contacts::PassedAtEnd::all;

  WallLaw(const Law& law, const Settings& settings)
      : law_(law),
        settings_(settings),
        modulus_(settings.composite_modulus / settings.strength),
        boundaries_(boundaries(law)) {
    if constexpr (k_has_neighbours) {
      if (is_enclosed(law.configuration)) impingement_ = impingement_approach(law.configuration, law.radius);
    }
  }

  [[nodiscard]] const Law& law() const noexcept { return law_; }
  [[nodiscard]] double strength() const noexcept { return settings_.strength; }
  void start() noexcept {
    farthest_ = 0.0;
    has_lateral_gap_ = false;
    overshooting_.reset();
  }
  void note(double x) noexcept { farthest_ = std::max(farthest_, x); }

  // --- force and displacement

  [[nodiscard]] double unit_force(double radius) const noexcept { return settings_.strength * radius * radius; }
  [[nodiscard]] double opening(const Branch& b) const noexcept {
    return b.is_on_indenter ? b.indenter.overlap_max - b.indenter.recovery : 0.0;
  }
  [[nodiscard]] double force(const Branch& b, double x) const { return x <= opening(b) ? 0.0 : contact(b, x).force; }
  [[nodiscard]] double slope(const Branch& b, double x) const { return force_and_slope(b, x).second; }
  [[nodiscard]] std::pair<double, double> force_and_slope(const Branch& b, double x) const {
    if (b.is_on_indenter) {
      const mdr::Contact c = mdr::unloading_contact(b.indenter, modulus_, x);
      return {c.force, c.by_overlap};
    }
    const ContactState c = primary(b, x);
    return {c.force, c.force_by_approach};
  }
  /// Uses the recompressed share: the displacement loses the digits of a small distance from the opening.
  [[nodiscard]] double slope_under(const Branch& b, double force) const {
    if (!b.is_on_indenter) return slope(b, displacement(b, force));
    const double share = mdr::recompressed_share(b.indenter, force);
    return mdr::recompressed_contact(b.indenter, modulus_, share).by_overlap;
  }
  [[nodiscard]] double displacement(const Branch& b, double force, double near = 0.0) const {
    return b.is_on_indenter ? mdr::unloading_overlap(b.indenter, force) : approach_under(law_, force, near);
  }
  [[nodiscard]] double coordinate_power(const Branch& b) const noexcept {
    return b.is_on_indenter ? 0.0 : law_.first_power();
  }
  /// False in low compressibility: next to infinite pressure, an integrator's error would lead beyond the end of the
  /// law.
  [[nodiscard]] bool is_integrated(const Branch& b) const noexcept {
    return primary_regime(b) != Regime::low_compressibility;
  }
  [[nodiscard]] contacts::BearingContact contact(const Branch& b, double x) const {
    if (b.is_on_indenter) {
      const mdr::Contact c = mdr::unloading_contact(b.indenter, modulus_, x);
      return {c.force, c.contact_radius};
    }
    const ContactState c = primary(b, x);
    return {c.force, c.contact_radius};
  }
  [[nodiscard]] contacts::Magnitudes magnitudes(double reach) const;

  // --- energy

  [[nodiscard]] double work(const Branch& b, double x) const {
    if (x <= opening(b)) return 0.0;
    return b.is_on_indenter ? mdr::unloading_energy(b.indenter, x) : work_in(law_, primary_regime(b), x);
  }
  [[nodiscard]] bool is_work_costly(const Branch& b) const noexcept {
    return !b.is_on_indenter && law_.is_work_costly(primary_regime(b));
  }
  [[nodiscard]] bool has_stored_energy() const noexcept { return settings_.can_unload; }
  [[nodiscard]] double stored(const Branch& b, double x) const {
    if (b.is_on_indenter) return mdr::unloading_energy(b.indenter, x);
    if (primary_regime(b) == Regime::elastic) return work_per_wall(law_, x);
    return mdr::plastic_energy(indenter_at(b, x));
  }

  // --- boundaries and branches

  [[nodiscard]] contacts::Boundary next(const Branch& b) const { return ahead(b).boundary; }
  void pass(Branch& b) const;
  [[nodiscard]] std::optional<std::string_view> refuses_unloading() const noexcept {
    if (settings_.can_unload) return std::nullopt;
    return "unloading = \"mdr\" adds one";
  }
  void turn(Branch& b, double x);
  void reload(Branch& b) const noexcept { b.is_on_indenter = false; }
  [[nodiscard]] std::string_view made_event(const Branch& b) const noexcept {
    return b.is_on_indenter ? "dent-touched" : "contact-made";
  }
  [[nodiscard]] int regime(const Branch& b, bool touches) const noexcept {
    if (b.is_on_indenter) return static_cast<int>(touches ? Regime::unloading : Regime::separated);
    return static_cast<int>(touches ? primary_regime(b) : Regime::open);
  }

  // --- lateral contacts of the die

  static constexpr bool k_has_neighbours = requires(const Law& law) { law.configuration; };
  [[nodiscard]] bool follows(const ContactClass& walls) const noexcept requires k_has_neighbours {
    return law_.configuration == Configuration::die && std::abs(walls.normals.front().z()) < 0.5;
  }
  /// Blanks from first touch on, for a law that has none for lateral contacts.
  [[nodiscard]] contacts::VisibleContact follower(const Branch& leader, bool touches, double /*x*/) {
    return touches || leader.is_on_indenter ? undefined_follower() : contacts::VisibleContact{};
  }

  [[nodiscard]] std::vector<Diagnostic> warnings(double walls) const;

 protected:
  [[nodiscard]] double farthest() const noexcept { return farthest_; }
  [[nodiscard]] contacts::VisibleContact undefined_follower() {
    has_lateral_gap_ = true;
    contacts::VisibleContact shown{.regime = static_cast<double>(Regime::undefined)};
    shown.overlap = shown.force = shown.contact_radius = shown.pressure = k_nan;
    return shown;
  }

 private:
  enum class Kind { of_law, impingement, end };
  struct Ahead {
    contacts::Boundary boundary;
    Kind kind = Kind::of_law;
  };

  [[nodiscard]] Ahead ahead(const Branch& b) const;
  [[nodiscard]] Regime primary_regime(const Branch& b) const noexcept {
    return b.next == 0 ? Law::first_regime : boundaries_[b.next - 1].beyond;
  }
  [[nodiscard]] ContactState primary(const Branch& b, double x) const { return state_in(law_, primary_regime(b), x); }
  /// Elastic indenter that the contact would leave if it were unloaded from this displacement.
  [[nodiscard]] mdr::UnloadingShape indenter_at(const Branch& b, double x) const {
    const ContactState now = primary(b, x);
    return mdr::unloading_shape_of(modulus_, settings_.poisson_ratio, 1.0, x, now.contact_radius, now.pressure);
  }

  Law law_;
  Settings settings_;
  double modulus_ = 0.0;  ///< E* over S
  Boundaries boundaries_{};
  std::optional<double> impingement_{};

  double farthest_ = 0.0;                 ///< largest x in a row
  bool has_lateral_gap_ = false;          ///< a lateral contact was undefined
  std::optional<double> overshooting_{};  ///< recovery over displacement of a contact that opens beyond first touch
};

template <class Law>
contacts::Magnitudes WallLaw<Law>::magnitudes(double reach) const {
  // Least typical depth over R0: shallower contacts have too few digits where a ramp prescribes the wall's
  // displacement.
  constexpr double k_least_typical = 1e-7;
  const bool is_known = settings_.reach.displacement > 0.0 || settings_.reach.force > 0.0;
  reach = is_known ? std::min(reach, k_far_from_limit * law_.limit) : 0.5 * law_.limit;
  // A yield point makes the range before it count, too.
  double first = reach;
  if (Law::first_regime == Regime::elastic) first = std::min(reach, boundaries_[0].approach);
  // A depth that follows from a force has all its digits, however shallow it is.
  const double least = settings_.reach.displacement > 0.0 ? k_least_typical : 0.0;
  // Beyond the fitted range work grows by orders, and a condition may end a program long before its targets.
  return {std::max(first, least), work_per_wall(law_, std::min(reach, law_.calibrated_end))};
}

template <class Law>
typename WallLaw<Law>::Ahead WallLaw<Law>::ahead(const Branch& b) const {
  const double end = law_.limit;
  Ahead first{{end, "limit", LimitPoint{Limit::walls_meet, -1, "displacement/R0", end}}, Kind::end};
  if (!boundaries_.empty() && boundaries_.back().beyond == Regime::undefined) {
    const Boundary& last = boundaries_.back();
    first.boundary = {last.approach, last.event, LimitPoint{Limit::cell_filled, -1, "displacement/R0", last.approach}};
  }
  const auto consider = [&](const contacts::Boundary& boundary, Kind kind) {
    if (boundary.position < first.boundary.position) first = {boundary, kind};
  };
  if (b.next < boundaries_.size() && boundaries_[b.next].beyond != Regime::undefined) {
    const Boundary& of_law = boundaries_[b.next];
    consider({.position = of_law.approach, .event = of_law.event, .is_singular = of_law.is_singular}, Kind::of_law);
  }
  if (impingement_ && !b.has_impinged) consider({.position = *impingement_, .event = "impingement"}, Kind::impingement);
  return first;
}

template <class Law>
void WallLaw<Law>::pass(Branch& b) const {
  switch (ahead(b).kind) {
    case Kind::of_law:
      ++b.next;
      break;
    case Kind::impingement:
      b.has_impinged = true;
      break;
    case Kind::end:
      break;
  }
}

template <class Law>
void WallLaw<Law>::turn(Branch& b, double x) {
  if (primary_regime(b) == Regime::elastic) return;
  b.indenter = indenter_at(b, x);
  b.is_on_indenter = true;
  if (b.indenter.recovery <= x) return;
  const double ratio = b.indenter.recovery / x;
  overshooting_ = std::max(overshooting_.value_or(ratio), ratio);
}

template <class Law>
std::vector<Diagnostic> WallLaw<Law>::warnings(double /*walls*/) const {
  std::vector<Diagnostic> result;
  if (farthest_ > law_.calibrated_end) {
    result.push_back({"the walls have gone farther than the source compares the law with its calculations",
                      "largest displacement/R0", farthest_});
  }
  if (has_lateral_gap_) {
    result.push_back({"the source has no law for lateral contacts in all of the range; their columns are nan there",
                      "largest displacement/R0", farthest_});
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
