#include "material-point/yield_surface.hpp"

#include <cmath>
#include <stdexcept>

#include "system/limit.hpp"
#include "system/resolution.hpp"

namespace monograin::material_point {
namespace {

Evolving product(const Evolving& a, const Evolving& b) {
  return {a.value * b.value, a.slope * b.value + a.value * b.slope};
}

/// Half-axis of the cap's ellipse along p (Table 3, corrected).
Evolving half_axis(const Properties& at) { return product(at.axis_ratio, at.shear_strength); }

/// Table 2, von Mises and von Mises double cap: f = Psi.
Yield yield_of_von_mises(const Properties& at, Segment segment, double p, double s) {
  const Evolving& strength = at.shear_strength;
  const double c = s / strength.value;
  Yield yield{c * c - 1.0, 0.0, 2.0 * c / strength.value, -2.0 * c * c * strength.slope / strength.value};
  if (segment != Segment::shear) {
    const bool is_cap = segment == Segment::cap;
    const Evolving centre = is_cap ? at.cap_centre : Evolving{};
    const Evolving axis = is_cap ? half_axis(at) : at.tensile_strength;
    const double b = (p + centre.value) / axis.value;
    yield.f = b * b + c * c - 1.0;
    yield.f_p = 2.0 * b / axis.value;
    yield.f_phi += 2.0 * b * (centre.slope - b * axis.slope) / axis.value;
  }
  yield.Psi = yield.f;
  yield.Psi_p = yield.f_p;
  yield.Psi_s = yield.f_s;
  return yield;
}

/// Table 2, cap of dpc: f = Psi.
Yield yield_of_cap(const Properties& at, const CapConstants& cap, double p, double s) {
  const Evolving axis = half_axis(at);
  const Evolving stretch = product(cap.flow_stretch, at.axis_ratio);
  const double y = p + at.cap_centre.value;
  const double x = stretch.value * s;
  const double root = std::sqrt(y * y + x * x);
  const double f = root - axis.value;
  const double f_p = y / root;
  const double f_s = stretch.value * x / root;
  return {f, f_p, f_s, (y * at.cap_centre.slope + x * stretch.slope * s) / root - axis.slope, f, f_p, f_s};
}

/// Table 2, shear line and arc of dpc.
Yield yield_of_shear(const Properties& at, const CapConstants& cap, Branch branch, double p, double s) {
  const double y = p + at.cap_centre.value;
  const double q = branch.side * s;
  Yield yield{q + p * cap.friction_slope.value - cap.cohesion.value, cap.friction_slope.value, branch.side,
              p * cap.friction_slope.slope - cap.cohesion.slope};
  if (branch.segment == Segment::transition) {
    const double w = q - cap.arc_centre.value;
    // Only points above its centre belong to the arc. Below, f is the height, which leads to the arc and not to the far
    // side of its circle.
    const bool is_above = w > 0.0;
    const double root = is_above ? std::sqrt(y * y + w * w) : w;
    const double f_w = is_above ? w / root : 1.0;
    yield.f = root - cap.arc_radius.value;
    yield.f_p = is_above ? y / root : 0.0;
    yield.f_s = branch.side * f_w;
    yield.f_phi = yield.f_p * at.cap_centre.slope - f_w * cap.arc_centre.slope - cap.arc_radius.slope;
  }
  const double along = cap.friction_slope.value * y;
  const double across = cap.flow_stretch.value * s;
  const double root = std::sqrt(along * along + across * across);
  yield.Psi = root - at.shear_strength.value;
  yield.Psi_p = cap.friction_slope.value * along / root;
  yield.Psi_s = cap.flow_stretch.value * across / root;
  return yield;
}

/// Straight stress path in the plane of p and s. Finds where the path leaves a segment's formula, if it begins inside.
struct StressPath {
  double p, s, p_rate, s_rate;

  /// Parameter t at which the path leaves (x0 + x1 p)^2 + (y0 + y1 s)^2 = radius^2.
  [[nodiscard]] std::optional<double> out_of(double x0, double x1, double y0, double y1, double radius) const {
    const double x = x0 + x1 * p;
    const double y = y0 + y1 * s;
    const double dx = x1 * p_rate;
    const double dy = y1 * s_rate;
    const double a = dx * dx + dy * dy;
    if (a == 0.0) return std::nullopt;
    const double b = x * dx + y * dy;
    const double c = (x - radius) * (x + radius) + y * y;
    // b^2 - a c, without the digits that the two have in common if the path comes from far away.
    const double across = x * dy - y * dx;
    const double discriminant = a * radius * radius - across * across;
    // A path that begins outside by an error, along the tangent, need not meet the ellipse at all.
    if (discriminant < 0.0) return c > 0.0 ? std::optional(0.0) : std::nullopt;
    const double root = std::sqrt(discriminant);
    return b > 0.0 ? -c / (b + root) : (root - b) / a;
  }
};

}  // namespace

CapConstants cap_constants(const Parameters& parameters, const Properties& properties) {
  const double width = parameters.transition_width;
  const Evolving& shear = properties.shear_strength;
  const Evolving& tensile = properties.tensile_strength;
  const Evolving& centre = properties.cap_centre;
  const double reach = tensile.value + centre.value;
  if (!(reach > 0.0)) {
    throw DomainError(Limit::cap_centre_at_zero_pressure,
                      "the tensile strength is beyond the cap's centre: the shear line has no slope");
  }
  const double tangent = shear.value / reach;
  const Evolving friction{tangent, (shear.slope - tangent * (tensile.slope + centre.slope)) / reach};
  const double secant = std::sqrt(1.0 + tangent * tangent);
  const Evolving sine{tangent / secant, friction.slope / (secant * secant * secant)};
  const Evolving a{width * secant, width * sine.value * friction.slope};
  const Evolving arc_radius{width * shear.value, width * shear.slope};
  const Evolving arc_centre = product({1.0 - a.value, -a.slope}, shear);
  if (!(arc_centre.value + arc_radius.value / secant > 0.0)) {
    throw DomainError(Limit::cap_arc_too_wide, "transition_width is too large: the arc reaches the axis of pressure");
  }
  const double stretch = 1.0 / (1.0 + width - a.value);  // positive while the arc stays off the axis of pressure
  const Evolving arc_reach = product(arc_radius, sine);
  return {friction,
          product(tensile, friction),
          arc_radius,
          arc_centre,
          {stretch, stretch * stretch * a.slope},
          {centre.value - arc_reach.value, centre.slope - arc_reach.slope}};
}

Segment segment_at(const Parameters& parameters, const Properties& properties, double p) {
  if (parameters.model == YieldModel::vm) return Segment::shear;
  if (p < -properties.cap_centre.value) return Segment::cap;
  if (parameters.model == YieldModel::vmdc) return p > 0.0 ? Segment::tension : Segment::shear;
  const bool is_shear = p > -cap_constants(parameters, properties).transition_start.value;
  return is_shear || parameters.transition_width == 0.0 ? Segment::shear : Segment::transition;
}

Branch branch_at(const Parameters& parameters, const Properties& properties, double p, double s) {
  return {segment_at(parameters, properties, p), s > 0.0 ? 1.0 : -1.0};
}

Yield yield_on(const Parameters& parameters, const Properties& properties, Branch branch, double p, double s) {
  if (parameters.model != YieldModel::dpc) return yield_of_von_mises(properties, branch.segment, p, s);
  const CapConstants cap = cap_constants(parameters, properties);
  if (branch.segment == Segment::cap) return yield_of_cap(properties, cap, p, s);
  return yield_of_shear(properties, cap, branch, p, s);
}

double yield_function(const Parameters& parameters, const Properties& properties, double p, double s) {
  const Branch branch = branch_at(parameters, properties, p, s);
  if (branch.segment == Segment::transition) {
    const CapConstants cap = cap_constants(parameters, properties);
    const double w = std::abs(s) - cap.arc_centre.value;
    if (w <= 0.0) return -std::hypot(p + properties.cap_centre.value, w) - cap.arc_radius.value;
  }
  return yield_on(parameters, properties, branch, p, s).f;
}

std::optional<double> distance_to_end(const Parameters& parameters, const Properties& properties, Segment segment,
                                      bool towards_compression, double p) {
  const double centre = properties.cap_centre.value;
  const bool has_arc = parameters.model == YieldModel::dpc && parameters.transition_width > 0.0;
  if (parameters.model == YieldModel::vm) return std::nullopt;
  const auto arc_start = [&] { return cap_constants(parameters, properties).transition_start.value; };
  switch (segment) {
    case Segment::tension:
      if (towards_compression) return p;
      return std::nullopt;
    case Segment::shear:
      if (towards_compression) return p + (has_arc ? arc_start() : centre);
      if (parameters.model == YieldModel::vmdc) return -p;
      return std::nullopt;
    case Segment::transition:
      return towards_compression ? p + centre : -(p + arc_start());
    case Segment::cap:
      if (towards_compression) return std::nullopt;
      return -(p + centre);
  }
  return std::nullopt;
}

Segment neighbour(const Parameters& parameters, Segment segment, bool towards_compression) {
  const bool has_arc = parameters.model == YieldModel::dpc && parameters.transition_width > 0.0;
  switch (segment) {
    case Segment::tension:
      return Segment::shear;
    case Segment::shear:
      if (!towards_compression) return Segment::tension;
      return has_arc ? Segment::transition : Segment::cap;
    case Segment::transition:
      return towards_compression ? Segment::cap : Segment::shear;
    case Segment::cap:
      return has_arc ? Segment::transition : Segment::shear;
  }
  return segment;
}

std::optional<Exit> way_out(const Parameters& parameters, const Properties& properties, double p, double s,
                            double p_rate, double s_rate) {
  const double centre = properties.cap_centre.value;
  const StressPath path{p, s, p_rate, s_rate};
  std::optional<Exit> first;
  const auto consider = [&](Segment segment, double side, std::optional<double> t) {
    if (!t) return;
    const double at = std::max(*t, 0.0);
    const double reached = p + at * p_rate;
    // Segments that meet must overlap by round-off, or a path between them would find no exit.
    for (const bool towards_compression : {false, true}) {
      const auto inside = distance_to_end(parameters, properties, segment, towards_compression, reached);
      if (inside && *inside < -k_same_value) return;
    }
    if (!first || at < first->t) first = Exit{at, {segment, side}};
  };
  const double shear_side = s + s_rate > 0.0 ? 1.0 : -1.0;
  if (parameters.model != YieldModel::dpc) {
    const double by_strength = 1.0 / properties.shear_strength.value;
    consider(Segment::shear, shear_side, path.out_of(0.0, 0.0, 0.0, by_strength, 1.0));
    if (parameters.model == YieldModel::vm) return first;
    consider(Segment::tension, shear_side,
             path.out_of(0.0, 1.0 / properties.tensile_strength.value, 0.0, by_strength, 1.0));
    const double by_axis = 1.0 / half_axis(properties).value;
    consider(Segment::cap, shear_side, path.out_of(by_axis * centre, by_axis, 0.0, by_strength, 1.0));
    return first;
  }
  const CapConstants cap = cap_constants(parameters, properties);
  for (const double side : {-1.0, 1.0}) {
    const double rate = side * s_rate + p_rate * cap.friction_slope.value;
    if (rate > 0.0) {
      const double t = -(side * s + p * cap.friction_slope.value - cap.cohesion.value) / rate;
      if (side * (s + std::max(t, 0.0) * s_rate) >= -k_same_value) consider(Segment::shear, side, t);
    }
    if (parameters.transition_width == 0.0) continue;
    const auto t = path.out_of(centre, 1.0, -cap.arc_centre.value, side, cap.arc_radius.value);
    if (t && side * (s + *t * s_rate) > cap.arc_centre.value) consider(Segment::transition, side, t);
  }
  const auto out =
      path.out_of(centre, 1.0, 0.0, cap.flow_stretch.value * properties.axis_ratio.value, half_axis(properties).value);
  consider(Segment::cap, out && s + *out * s_rate > 0.0 ? 1.0 : -1.0, out);
  return first;
}

}  // namespace monograin::material_point
