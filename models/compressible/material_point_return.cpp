// The way of a material point's state back to the yield surface.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>

#include "compressible/material_point.hpp"
#include "system/limit.hpp"

namespace monograin::compressible {
namespace {

// Newton's method on f = 0: strain correction and f before it, below both of which the next one is round-off (where a
// cap is narrow and the material hardly compressible, f is curved within 1e-11 of strain); such small corrections after
// which f is made of rounding; and how many there may be at all.
constexpr double k_last_correction = 1e-11;
// The correction after one of d is d^2 over the elastic strain: where that is tiny, d is the last one if the next is
// below this.
constexpr double k_strain_rounding = 1e-16;
constexpr double k_last_excess = 1e-9;
constexpr int k_most_small_corrections = 12;
// What is left of f by rounding, over the shares that the stresses have in it.
constexpr double k_rounding = 4.0 * std::numeric_limits<double>::epsilon();
constexpr int k_most_corrections_of_rounding = 2;
constexpr int k_most_corrections = 60;
constexpr int k_most_halvings = 20;
// Plastic strain by which no guess of an integrator is wrong at any tolerance. A state that is farther away from its
// guess than that and the elastic strain of the guess lies on another branch, behind a loss of uniqueness.
constexpr double k_nearby = 1e-2;
// How much farther than the shortest way the one along the flow may be. Next to a loss of uniqueness the flow goes
// along the surface, and errors would move a state by their root, or to anywhere.
constexpr double k_most_detour = 1e3;

}  // namespace

/// Brings the plastic strains to f = 0 along the flow or, where that does not lead there or leads along the surface, by
/// the shortest way: both strains may carry an integrator's errors. Where stresses are prescribed, f does not depend on
/// g^p, and near a critical state the flow hardly changes phi: there by the shortest way alone.
void MaterialPoint::complete(double xi, std::span<double> y) {
  if (!is_plastic_) return;
  const double phi = y[k_phi];
  const double deviatoric = y[k_deviatoric];
  const bool has_flow_alone = is_solvable();
  if (has_flow_alone || !is_stress(k_axial) || !is_stress(k_lateral)) {
    try {
      if (is_brought_back(xi, y, Way::flow)) return;
    } catch (const std::domain_error&) {
      if (has_flow_alone) throw;
    }
    y[k_phi] = phi;
    y[k_deviatoric] = deviatoric;
  }
  if (!has_flow_alone && is_brought_back(xi, y, Way::shortest)) return;
  throw DomainError(Limit::loss_of_uniqueness, "no plastic strain brings the stress back to the yield surface");
}

/// Of a guess on the far side of a cap that the program does not leave: the tangent of f at its mirror image, which
/// leads to the near side. In strains a cap of a hardly compressible material is narrow, and a guess may lie anywhere;
/// f itself would lead to the ellipse that goes on beyond the segment's end.
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
  // Next to the end f goes on smoothly, for states that are there by an error.
  if (std::abs(distance * yield.f_p) <= std::abs(now.s * yield.f_s)) return std::nullopt;
  yield.f -= yield.f_p * to_image;
  return yield;
}

/// What leads back to f = 0. The shear segment of vm and vmdc is a pair of lines, c^2 = 1 with c = s over the strength,
/// and a guess that is off by more than the elastic strain lies beside the other one: the distance c - 1 from the line
/// of this side, with its own slopes, leads to the right one from anywhere.
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

/// Newton's method on f = 0 in one direction.
///
/// A cap much narrower in one direction is a valley of f. A correction that has passed its floor without having
/// come inside goes back there, and on along the floor, where the slope across stays zero: straight down from slope to
/// slope it would take many corrections.
bool MaterialPoint::is_brought_back(double xi, std::span<double> y, Way way) {
  const double guess = y[k_phi];
  const double guessed_deviatoric = y[k_deviatoric];
  const bool has_caps = is_compressible(settings_.parameters.model);
  double elastic_strain = 0.0;
  double elastic_strain_of_guess = 0.0;
  double shortest = 0.0;
  int small_corrections = 0;
  int corrections_of_rounding = 0;
  int halvings = 0;
  double phi = 0.0;  // of the last correction
  double deviatoric = 0.0;
  Flow last;  // where it began; f, as much of it as it takes away
  std::optional<std::array<double, 2>> floor;
  try {
    for (int i = 0; i < k_most_corrections; ++i) {
      Response here;
      Flow now;
      try {
        here = response(xi, y);
        now = flow_to_surface(here);
      } catch (const std::domain_error&) {
        // Next to where moduli become infinite a correction may lead beyond: half of it, or less, does not.
        if (phi == 0.0 || ++halvings > k_most_halvings) throw;
        for (double* part : {&phi, &deviatoric, &last.yield.f}) *part *= 0.5;
        y[k_phi] -= phi;
        y[k_deviatoric] -= deviatoric;
        continue;
      }
      elastic_strain = 1.0 / stiffness_over_strength(here.at);
      if (i == 0) {
        elastic_strain_of_guess = elastic_strain;
        shortest = std::abs(now.yield.f) / std::hypot(now.f_by_phi, now.f_by_deviatoric);
      }
      const double slope = now.f_by_phi * phi + now.f_by_deviatoric * deviatoric;
      if (has_caps && last.yield.f > 0.0 && now.yield.f > 0.0 && slope > 0.0) {
        const double back = slope / (last.yield.f + slope);
        y[k_phi] -= back * phi;
        y[k_deviatoric] -= back * deviatoric;
        floor = {last.f_by_deviatoric - now.f_by_deviatoric, now.f_by_phi - last.f_by_phi};
        phi = deviatoric = 0.0;
        last = {};
        continue;
      }
      last = now;
      const bool is_along_flow = way == Way::flow;
      const double by_phi = floor ? (*floor)[0] : is_along_flow ? now.phi : now.f_by_phi;
      const double by_deviatoric = floor ? (*floor)[1] : is_along_flow ? now.deviatoric : now.f_by_deviatoric;
      const double step = -now.yield.f / (now.f_by_phi * by_phi + now.f_by_deviatoric * by_deviatoric);
      phi = step * by_phi;
      deviatoric = step * by_deviatoric;
      if (!std::isfinite(step)) return false;
      y[k_phi] += phi;
      y[k_deviatoric] += deviatoric;
      const double last_correction = std::min(k_last_correction, std::sqrt(k_strain_rounding * elastic_strain));
      if (std::hypot(phi, deviatoric) >= last_correction) {
        // Under prescribed stresses f may grow so little with phi that its rounding is a larger strain than that.
        const Yield& at = now.yield;
        const double rounding = k_rounding * (std::abs(at.f_p * here.p) + std::abs(at.f_s * here.s));
        if (!(std::abs(at.f) <= rounding) || ++corrections_of_rounding < k_most_corrections_of_rounding) continue;
      }
      const bool is_found = !has_caps || std::abs(now.yield.f) < k_last_excess;
      if (!is_found && ++small_corrections < k_most_small_corrections) continue;
      const double distance = std::hypot(y[k_phi] - guess, y[k_deviatoric] - guessed_deviatoric);
      if (is_solvable()) return true;
      if (is_along_flow && distance > std::max(k_last_correction, k_most_detour * shortest)) return false;
      return distance <= std::max(elastic_strain_of_guess, k_nearby);
    }
  } catch (const std::domain_error&) {
    // Far corrections that lead to where the law has no surface at all have found nothing, either.
    if (std::abs(y[k_phi] - guess) <= elastic_strain) throw;
  }
  return false;
}

}  // namespace monograin::compressible
