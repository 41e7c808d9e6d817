// Return mapping: brings a material point's state back to the yield surface.

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>

#include "compressible/material_point.hpp"
#include "system/limit.hpp"

namespace monograin::compressible {
namespace {

// Newton's method on f = 0 ends with a strain correction below k_last_correction that begins at an f below
// k_last_excess: the next one is round-off. (Where a cap is narrow and the material hardly compressible, f is curved
// within 1e-11 of strain.) After k_most_small_corrections of that size, f itself is round-off.
constexpr double k_last_correction = 1e-11;
// The correction after one of d is d^2 over the elastic strain. Where the elastic strain is tiny, d is the last
// correction if the next one is below this.
constexpr double k_strain_rounding = 1e-16;
constexpr double k_last_excess = 1e-9;
constexpr int k_most_small_corrections = 12;
// Round-off of f, over the shares that the stresses have in f.
constexpr double k_rounding = 4.0 * std::numeric_limits<double>::epsilon();
constexpr int k_most_corrections_of_rounding = 2;
constexpr int k_most_corrections = 60;
constexpr int k_most_halvings = 20;
// Plastic strain within which every guess of an integrator lies, at any tolerance. A state that is farther from its
// guess than this, and than the guess's elastic strain, lies on another branch, behind a loss of uniqueness.
constexpr double k_nearby = 1e-2;
// Largest length of a return along the flow, over that of the shortest return. Next to a loss of uniqueness the flow
// runs along the surface, and errors would move a state by their root, or to anywhere.
constexpr double k_most_detour = 1e3;

}  // namespace

/// Brings the plastic strains to f = 0 along the flow. Where that does not arrive, or runs along the surface, takes the
/// shortest path, because both strains may carry an integrator's errors. Under prescribed stresses, f does not depend
/// on g^p, and near a critical state the flow hardly changes phi: there only the shortest path is tried.
void MaterialPoint::complete(double xi, std::span<double> y) {
  if (!is_plastic_) return;
  const double phi = y[k_phi];
  const double deviatoric = y[k_deviatoric];
  const bool has_flow_alone = is_solvable();
  if (has_flow_alone || !is_stress(k_axial) || !is_stress(k_lateral)) {
    try {
      if (is_brought_back(xi, y, ReturnPath::flow)) return;
    } catch (const std::domain_error&) {
      if (has_flow_alone) throw;
    }
    y[k_phi] = phi;
    y[k_deviatoric] = deviatoric;
  }
  if (!has_flow_alone && is_brought_back(xi, y, ReturnPath::shortest)) return;
  throw DomainError(Limit::loss_of_uniqueness, "no plastic strain brings the stress back to the yield surface");
}

/// Yield function for a guess on the far side of a cap that the program does not leave: the tangent of f at the guess's
/// mirror image, which leads to the near side. In strains, a cap of a hardly compressible material is narrow, and a
/// guess may lie anywhere; f itself would lead to the ellipse's continuation beyond the segment's end. None for other
/// guesses.
std::optional<Yield> MaterialPoint::yield_across_cap(const Response& now) const {
  const Segment segment = branch_.segment;
  if (segment != Segment::cap && segment != Segment::tension) return std::nullopt;
  if (is_stress(k_axial) && is_stress(k_lateral)) return std::nullopt;
  const bool ends_in_compression = segment == Segment::tension;
  const double distance = *distance_to_end(settings_.parameters, now.at, segment, ends_in_compression, now.p);
  const double outwards = ends_in_compression ? -1.0 : 1.0;
  if (distance >= 0.0 || outwards * pressure_rate_at_end(now, ends_in_compression) > 0.0) return std::nullopt;
  const double to_image = 2.0 * outwards * distance;
  Yield yield = yield_on(settings_.parameters, now.at, branch_, now.p + to_image, now.s);
  // Next to the end, f continues smoothly for states that are there by an error.
  if (std::abs(distance * yield.f_p) <= std::abs(now.s * yield.f_s)) return std::nullopt;
  yield.f -= yield.f_p * to_image;
  return yield;
}

/// Flow and yield function that lead back to f = 0. The shear segment of vm and vmdc is a pair of lines, c^2 = 1 with c
/// = s over the strength, and a guess that is off by more than the elastic strain lies beside the other line. The
/// distance c - 1 from the line of this side, with its own slopes, leads to the right line from anywhere.
MaterialPoint::Flow MaterialPoint::flow_to_surface(const Response& now) const {
  if (const auto across = yield_across_cap(now)) return flow(now, *across);
  Flow flow_now = flow(now);
  const bool is_line = settings_.parameters.model != YieldModel::dpc && branch_.segment == Segment::shear;
  if (!is_line || branch_.side == 0.0) return flow_now;
  const double c = branch_.side * now.s / now.at.shear_strength.value;
  flow_now.yield.f = c - 1.0;
  for (double* slope : {&flow_now.f_by_phi, &flow_now.f_by_deviatoric, &flow_now.deviatoric}) *slope /= 2.0 * c;
  flow_now.phi /= 2.0 * std::abs(c);
  return flow_now;
}

/// Newton's method on f = 0 in one direction, along the flow or along the gradient of f.
///
/// A cap much narrower in one direction is a valley of f. A correction that passes the valley's floor without coming
/// inside returns to the floor, and goes on along it, where the slope across stays zero. Corrections from slope to
/// slope would be many.
class MaterialPoint::ReturnMapping {
 public:
  /// @param y  in: the guess; out: the corrected state
  ReturnMapping(const MaterialPoint& point, double xi, std::span<double> y, ReturnPath path)
      : point_(point),
        xi_(xi),
        y_(y),
        is_along_flow_(path == ReturnPath::flow),
        has_caps_(is_compressible(point.settings_.parameters.model)),
        guess_{y[k_phi], y[k_deviatoric]} {}

  /// @return true if the method reaches f = 0, not too far from the guess
  [[nodiscard]] bool succeeds() {
    try {
      for (int i = 0; i < k_most_corrections; ++i) {
        if (!evaluate()) continue;
        if (i == 0) measure_guess();
        if (has_passed_floor()) {
          go_back_to_floor();
          continue;
        }
        if (!correct()) return false;
        if (has_converged()) return is_near_guess();
      }
    } catch (const std::domain_error&) {
      // A far correction that leads to where the law has no surface is a failure, too.
      if (std::abs(y_[k_phi] - guess_.phi) <= elastic_strain_) throw;
    }
    return false;
  }

 private:
  /// Plastic strains, or a direction or a step in them.
  struct Strains {
    double phi = 0.0;
    double deviatoric = 0.0;

    [[nodiscard]] double length() const { return std::hypot(phi, deviatoric); }
  };

  void move(const Strains& step, double share) {
    y_[k_phi] += share * step.phi;
    y_[k_deviatoric] += share * step.deviatoric;
  }

  [[nodiscard]] double slope_along(const Strains& step) const {
    return now_.f_by_phi * step.phi + now_.f_by_deviatoric * step.deviatoric;
  }

  /// Evaluates stresses and flow. Next to where moduli become infinite, a correction may leave the domain; half of it,
  /// or less, does not.
  /// @return false if half of the last correction was taken back instead
  [[nodiscard]] bool evaluate() {
    try {
      here_ = point_.response(xi_, y_);
      now_ = point_.flow_to_surface(here_);
    } catch (const std::domain_error&) {
      if (correction_.phi == 0.0 || ++halvings_ > k_most_halvings) throw;
      for (double* part : {&correction_.phi, &correction_.deviatoric, &last_.yield.f}) *part *= 0.5;
      move(correction_, -1.0);
      return false;
    }
    elastic_strain_ = 1.0 / stiffness_over_strength(here_.at);
    return true;
  }

  /// Measures how far from the guess the method may lead.
  void measure_guess() {
    elastic_strain_of_guess_ = elastic_strain_;
    shortest_ = std::abs(now_.yield.f) / std::hypot(now_.f_by_phi, now_.f_by_deviatoric);
  }

  [[nodiscard]] bool has_passed_floor() const {
    return has_caps_ && last_.yield.f > 0.0 && now_.yield.f > 0.0 && slope_along(correction_) > 0.0;
  }

  /// Takes the last correction back to the least f along it, and turns to the direction of the floor.
  void go_back_to_floor() {
    const double slope = slope_along(correction_);
    move(correction_, -(slope / (last_.yield.f + slope)));
    floor_ = {last_.f_by_deviatoric - now_.f_by_deviatoric, now_.f_by_phi - last_.f_by_phi};
    correction_ = {};
    last_ = {};
  }

  [[nodiscard]] Strains direction() const {
    if (floor_) return *floor_;
    if (is_along_flow_) return {now_.phi, now_.deviatoric};
    return {now_.f_by_phi, now_.f_by_deviatoric};
  }

  /// @return false if f does not change in the direction
  [[nodiscard]] bool correct() {
    last_ = now_;
    const Strains along = direction();
    const double step = -now_.yield.f / slope_along(along);
    correction_ = {step * along.phi, step * along.deviatoric};
    if (!std::isfinite(step)) return false;
    move(correction_, 1.0);
    return true;
  }

  /// True if the next correction would be round-off.
  [[nodiscard]] bool has_converged() {
    const double last_correction = std::min(k_last_correction, std::sqrt(k_strain_rounding * elastic_strain_));
    const bool is_small = !(correction_.length() >= last_correction);
    if (!is_small && (!is_rounding() || ++corrections_of_rounding_ < k_most_corrections_of_rounding)) return false;
    const bool is_on_surface = !has_caps_ || std::abs(now_.yield.f) < k_last_excess;
    return is_on_surface || ++small_corrections_ >= k_most_small_corrections;
  }

  /// True if f is round-off. Under prescribed stresses f may vary so little with phi that its round-off is a large
  /// strain.
  [[nodiscard]] bool is_rounding() const {
    const Yield& at = now_.yield;
    return std::abs(at.f) <= k_rounding * (std::abs(at.f_p * here_.p) + std::abs(at.f_s * here_.s));
  }

  [[nodiscard]] bool is_near_guess() const {
    if (point_.is_solvable()) return true;
    const double distance = std::hypot(y_[k_phi] - guess_.phi, y_[k_deviatoric] - guess_.deviatoric);
    if (is_along_flow_ && distance > std::max(k_last_correction, k_most_detour * shortest_)) return false;
    return distance <= std::max(elastic_strain_of_guess_, k_nearby);
  }

  const MaterialPoint& point_;
  double xi_;
  std::span<double> y_;
  bool is_along_flow_;
  bool has_caps_;
  Strains guess_;
  double elastic_strain_ = 0.0;
  double elastic_strain_of_guess_ = 0.0;
  double shortest_ = 0.0;  ///< distance of the guess from f = 0, to first order
  Response here_;
  Flow now_;
  Strains correction_;            ///< the last one
  Flow last_;                     ///< flow where the last correction began; f is the part that it takes away
  std::optional<Strains> floor_;  ///< direction along the floor of a valley
  int small_corrections_ = 0;
  int corrections_of_rounding_ = 0;
  int halvings_ = 0;
};

bool MaterialPoint::is_brought_back(double xi, std::span<double> y, ReturnPath path) const {
  return ReturnMapping(*this, xi, y, path).succeeds();
}

}  // namespace monograin::compressible
