#include "material-point/return_mapping.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "material-point/segment_ends.hpp"
#include "system/limit.hpp"
#include "system/resolution.hpp"

namespace monograin::material_point {
namespace {

// Newton's method on f = 0 ends with a strain correction below k_last_correction that begins at an f below
// k_last_excess: the next one is round-off. (Where a cap is narrow and the material hardly compressible, f is curved
// within 1e-11 of strain.) After k_most_small_corrections of that size, f itself is round-off.
constexpr double k_last_correction = 1e-11;
constexpr double k_last_excess = 1e-9;
constexpr int k_most_small_corrections = 12;
// Plastic strain within which every guess of an integrator lies, at any tolerance. A state that is farther from its
// guess than this, and than the guess's elastic strain, lies on another branch, behind a loss of uniqueness.
constexpr double k_nearby = 1e-2;
// Largest length of a return along the flow, over that of the shortest return. Next to a loss of uniqueness the flow
// runs along the surface, and an error e would move a state by sqrt(e) or more.
constexpr double k_most_detour = 1e3;

/// Yield function for a guess on the far side of a cap that the program does not leave: the tangent of f at the guess's
/// mirror image, which leads to the near side. In strains, a cap of a hardly compressible material is narrow, and a
/// guess may lie anywhere; f itself would lead to the ellipse's continuation beyond the segment's end. None for other
/// guesses.
std::optional<Yield> yield_across_cap(const Phase& phase, const Response& now) {
  const Segment segment = phase.branch.segment;
  if (segment != Segment::cap && segment != Segment::tension) return std::nullopt;
  if (phase.conditions.are_stresses()) return std::nullopt;
  const bool ends_in_compression = segment == Segment::tension;
  const double distance = *distance_to_end(phase.parameters, now.at, segment, ends_in_compression, now.p);
  const double outwards = ends_in_compression ? -1.0 : 1.0;
  if (distance >= 0.0 || outwards * pressure_rate_at_end(phase, now, ends_in_compression) > 0.0) return std::nullopt;
  const double to_image = 2.0 * outwards * distance;
  Yield yield = yield_on(phase.parameters, now.at, phase.branch, now.p + to_image, now.s);
  // Next to the end, f continues smoothly for states that are there by an error.
  if (std::abs(distance * yield.f_p) <= std::abs(now.s * yield.f_s)) return std::nullopt;
  yield.f -= yield.f_p * to_image;
  return yield;
}

/// Flow and yield function that lead back to f = 0. The shear segment of vm and vmdc is a pair of lines, c^2 = 1 with c
/// = s over the strength, and a guess that is off by more than the elastic strain lies beside the other line. The
/// distance c - 1 from the line of this side, with its own slopes, leads to the right line from anywhere.
PlasticFlow flow_to_surface(const Phase& phase, const Response& now) {
  if (const auto across = yield_across_cap(phase, now)) return plastic_flow(phase, now, *across);
  PlasticFlow flow = plastic_flow(phase, now);
  const bool is_line = phase.parameters.model != YieldModel::dpc && phase.branch.segment == Segment::shear;
  const double side = phase.branch.side;
  if (!is_line || side == 0.0) return flow;
  const double c = side * now.s / now.at.shear_strength.value;
  flow.yield.f = c - 1.0;
  for (double* slope : {&flow.gradient.phi, &flow.gradient.deviatoric, &flow.direction.deviatoric}) *slope /= 2.0 * c;
  flow.direction.phi /= 2.0 * std::abs(c);
  return flow;
}

enum class ReturnPath { flow, shortest };

/// Newton's method on f = 0 in one direction, along the flow or along the gradient of f.
///
/// A cap much narrower in one direction is a valley of f. A correction that passes the valley's floor without coming
/// inside returns to the floor, and goes on along it, where the slope across stays zero. Corrections from slope to
/// slope would be many.
class ReturnMapping {
 public:
  ReturnMapping(const Phase& phase, double xi, const PlasticStrains& guess, ReturnPath path)
      : phase_(phase), xi_(xi), is_along_flow_(path == ReturnPath::flow), guess_(guess), strains_(guess) {}

  /// Plastic strains with f = 0, not too far from the guess; none if the method does not reach them.
  [[nodiscard]] std::optional<PlasticStrains> result() {
    try {
      for (int i = 0; i < k_most_newton_steps; ++i) {
        if (!evaluate()) continue;
        if (i == 0) measure_guess();
        if (has_passed_floor()) {
          go_back_to_floor();
          continue;
        }
        if (!correct()) return std::nullopt;
        if (!has_converged()) continue;
        return is_near_guess() ? std::optional(strains_) : std::nullopt;
      }
    } catch (const std::domain_error&) {
      // A far correction that leads to where the law has no surface is a failure, too.
      if (std::abs(strains_.phi - guess_.phi) <= elastic_strain_) throw;
    }
    return std::nullopt;
  }

 private:
  void move(const PlasticStrains& step, double share) {
    strains_.phi += share * step.phi;
    strains_.deviatoric += share * step.deviatoric;
  }

  [[nodiscard]] double slope_along(const PlasticStrains& step) const {
    return now_.gradient.phi * step.phi + now_.gradient.deviatoric * step.deviatoric;
  }

  /// Evaluates stresses and flow. Next to where moduli become infinite, a correction may leave the domain; half of it,
  /// or less, does not.
  /// @return false if half of the last correction was taken back instead
  [[nodiscard]] bool evaluate() {
    try {
      here_ = response(phase_, xi_, strains_);
      now_ = flow_to_surface(phase_, here_);
    } catch (const std::domain_error&) {
      if (++halvings_ > k_most_halvings) throw;
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
    shortest_ = std::abs(now_.yield.f) / now_.gradient.length();
  }

  [[nodiscard]] bool has_passed_floor() const {
    return last_.yield.f > 0.0 && now_.yield.f > 0.0 && slope_along(correction_) > 0.0;
  }

  /// Takes the last correction back to the least f along it, and turns to the direction of the floor.
  void go_back_to_floor() {
    const double slope = slope_along(correction_);
    move(correction_, -(slope / (last_.yield.f + slope)));
    floor_ = {last_.gradient.deviatoric - now_.gradient.deviatoric, now_.gradient.phi - last_.gradient.phi};
    correction_ = {};
    last_ = {};
  }

  [[nodiscard]] PlasticStrains direction() const {
    if (floor_) return *floor_;
    return is_along_flow_ ? now_.direction : now_.gradient;
  }

  /// @return false if f does not change in the direction
  [[nodiscard]] bool correct() {
    last_ = now_;
    const PlasticStrains along = direction();
    const double step = -now_.yield.f / slope_along(along);
    correction_ = {step * along.phi, step * along.deviatoric};
    if (!std::isfinite(step)) return false;
    move(correction_, 1.0);
    return true;
  }

  /// True if the next correction would be round-off.
  [[nodiscard]] bool has_converged() {
    // The correction after one of d is d^2 over the elastic strain, which may be tiny.
    const double last_correction = std::min(k_last_correction, std::sqrt(k_epsilon * elastic_strain_));
    const bool is_small = !(correction_.length() >= last_correction);
    if (!is_small && !is_round_off()) return false;
    return std::abs(now_.yield.f) < k_last_excess || ++small_corrections_ >= k_most_small_corrections;
  }

  /// True if f is round-off. Under prescribed stresses f may vary so little with phi that its round-off is a large
  /// strain.
  [[nodiscard]] bool is_round_off() const {
    const Yield& at = now_.yield;
    return std::abs(at.f) <= k_round_off * (std::abs(at.f_p * here_.p) + std::abs(at.f_s * here_.s));
  }

  [[nodiscard]] bool is_near_guess() const {
    if (phase_.has_straight_flow) return true;
    const double distance = std::hypot(strains_.phi - guess_.phi, strains_.deviatoric - guess_.deviatoric);
    if (is_along_flow_ && distance > std::max(k_last_correction, k_most_detour * shortest_)) return false;
    return distance <= std::max(elastic_strain_of_guess_, k_nearby);
  }

  const Phase& phase_;
  double xi_;
  bool is_along_flow_;
  PlasticStrains guess_;
  PlasticStrains strains_;
  double elastic_strain_ = 0.0;
  double elastic_strain_of_guess_ = 0.0;
  double shortest_ = 0.0;  ///< distance of the guess from f = 0, to first order
  Response here_;
  PlasticFlow now_;
  PlasticStrains correction_;            ///< the last one
  PlasticFlow last_;                     ///< flow where the last correction began; f is the part that it takes away
  std::optional<PlasticStrains> floor_;  ///< direction along the floor of a valley
  int small_corrections_ = 0;
  int halvings_ = 0;
};

}  // namespace

PlasticStrains returned_to_surface(const Phase& phase, double xi, const PlasticStrains& guess) {
  if (phase.has_straight_flow || !phase.conditions.are_stresses()) {
    try {
      if (const auto found = ReturnMapping(phase, xi, guess, ReturnPath::flow).result()) return *found;
    } catch (const std::domain_error&) {
      if (phase.has_straight_flow) throw;
    }
  }
  if (!phase.has_straight_flow) {
    if (const auto found = ReturnMapping(phase, xi, guess, ReturnPath::shortest).result()) return *found;
  }
  throw DomainError(Limit::loss_of_uniqueness, "no plastic strain brings the stress back to the yield surface");
}

}  // namespace monograin::material_point
