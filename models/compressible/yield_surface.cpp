#include "compressible/yield_surface.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <unsupported/Eigen/AutoDiff>

namespace monograin::compressible {
namespace {

using std::sqrt;

// Segments are taken to hold this much beyond their ends where an exit is looked for, in units of the yield pressure.
constexpr double k_slack = 1e-12;

/// A number with its derivatives by p, s and phi.
using Dual = Eigen::AutoDiffScalar<Eigen::Vector3d>;

Dual variable(double value, int index) { return {value, Eigen::Vector3d::Unit(index)}; }
Dual evolving(const Evolving& quantity) { return {quantity.value, quantity.slope * Eigen::Vector3d::Unit(2)}; }

double plain(double x) { return x; }
double plain(const Dual& x) { return x.value(); }

/// What the formulas of Table 2 are made of, with or without derivatives.
template <class T>
struct Strengths {
  T yield_pressure, shear, tensile, axis_ratio, centre;
};

Strengths<double> values_of(const Properties& at) {
  return {at.yield_pressure.value, at.shear_strength.value, at.tensile_strength.value, at.axis_ratio.value,
          at.cap_centre.value};
}

Strengths<Dual> duals_of(const Properties& at) {
  return {evolving(at.yield_pressure), evolving(at.shear_strength), evolving(at.tensile_strength),
          evolving(at.axis_ratio), evolving(at.cap_centre)};
}

template <class T>
struct CapRelations {
  T slope, cohesion, stretch, arc_radius, arc_centre, start;
};

/// Table 2, below the table, with the entries of Table 3 put in: C is the shear strength.
template <class T>
CapRelations<T> cap_relations(const Strengths<T>& with, double width) {
  const T reach = with.tensile + with.centre;
  if (!(plain(reach) > 0.0)) {
    throw std::domain_error("the tensile strength is beyond the cap's centre: the shear line has no slope");
  }
  const T slope = with.shear / reach;
  const T secant = sqrt(1.0 + slope * slope);  // 1/cos pi6
  const T a = width * secant;
  const T room = 1.0 + width - a;
  if (!(plain(room) > 0.0)) throw std::domain_error("transition_width is too large for the slope of the shear line");
  CapRelations<T> cap{slope,
                      with.tensile * slope,
                      1.0 / room,
                      width * with.shear,
                      (1.0 - a) * with.shear,
                      with.centre - width * with.shear * slope / secant};
  if (!(plain(cap.arc_centre) + plain(cap.arc_radius) / plain(secant) > 0.0)) {
    throw std::domain_error("transition_width is too large: the arc reaches the axis of pressure");
  }
  return cap;
}

/// f of Table 2.
template <class T>
T yield_formula(YieldModel model, double width, const Strengths<T>& with, Branch branch, const T& p, const T& s) {
  const T y = p + with.centre;
  if (model == YieldModel::dpc) {
    const CapRelations<T> cap = cap_relations(with, width);
    if (branch.segment == Segment::cap) {
      const T x = cap.stretch * with.axis_ratio * s;
      return sqrt(T(y * y + x * x)) - with.axis_ratio * with.shear;
    }
    const T q = branch.side * s;
    if (branch.segment == Segment::transition) {
      const T w = q - cap.arc_centre;
      // Nothing below the centre belongs to the arc; from there this leads to it, and not to the far side of its
      // circle.
      if (!(plain(w) > 0.0)) return w - cap.arc_radius;
      return sqrt(T(y * y + w * w)) - cap.arc_radius;
    }
    return q + p * cap.slope - cap.cohesion;
  }
  const T c = s / with.shear;
  if (branch.segment == Segment::tension) {
    const T b = p / with.tensile;
    return b * b + c * c - 1.0;
  }
  if (branch.segment == Segment::cap) {
    const T b = y / T(with.axis_ratio * with.shear);
    return b * b + c * c - 1.0;
  }
  return c * c - 1.0;
}

/// g of Table 2: f, but for the shear line and the arc of dpc.
template <class T>
T potential_formula(YieldModel model, double width, const Strengths<T>& with, Branch branch, const T& p, const T& s) {
  if (model != YieldModel::dpc || branch.segment == Segment::cap) {
    return yield_formula(model, width, with, branch, p, s);
  }
  const CapRelations<T> cap = cap_relations(with, width);
  const T x = (p + with.centre) * cap.slope;
  const T y = cap.stretch * s;
  return sqrt(T(x * x + y * y)) - with.shear;
}

double cap_half_axis(const Strengths<double>& with) { return with.axis_ratio * with.shear; }

/// A straight way in the plane of p and s, and where it leaves a segment's formula, its interior being on the near
/// side.
struct Way {
  double p, s, p_rate, s_rate;

  /// Out of (x0 + x1 p)^2 + (y0 + y1 s)^2 = radius^2.
  [[nodiscard]] std::optional<double> out_of(double x0, double x1, double y0, double y1, double radius) const {
    const double x = x0 + x1 * p;
    const double y = y0 + y1 * s;
    const double dx = x1 * p_rate;
    const double dy = y1 * s_rate;
    const double a = dx * dx + dy * dy;
    if (a == 0.0) return std::nullopt;
    const double b = x * dx + y * dy;
    const double c = (x - radius) * (x + radius) + y * y;
    // b^2 - a c without the digits that the two have in common where the way comes from far away.
    const double across = x * dy - y * dx;
    const double discriminant = a * radius * radius - across * across;
    // A way that begins outside by an error, along the tangent, need not meet the ellipse at all.
    if (discriminant < 0.0) return c > 0.0 ? std::optional(0.0) : std::nullopt;
    const double root = std::sqrt(discriminant);
    return b > 0.0 ? -c / (b + root) : (root - b) / a;
  }
};

}  // namespace

CapConstants cap_constants(const Parameters& parameters, const Properties& properties) {
  const auto cap = cap_relations(values_of(properties), parameters.transition_width);
  return {cap.slope, cap.cohesion, cap.arc_radius, cap.arc_centre, cap.stretch, cap.start};
}

double transition_start_slope(const Parameters& parameters, const Properties& properties) {
  return cap_relations(duals_of(properties), parameters.transition_width).start.derivatives()[2];
}

Segment segment_at(const Parameters& parameters, const Properties& properties, double p) {
  if (parameters.model == YieldModel::vm) return Segment::shear;
  if (p < -properties.cap_centre.value) return Segment::cap;
  if (parameters.model == YieldModel::vmdc) return p > 0.0 ? Segment::tension : Segment::shear;
  const bool is_shear = p > -cap_constants(parameters, properties).transition_start;
  return is_shear || parameters.transition_width == 0.0 ? Segment::shear : Segment::transition;
}

Branch branch_at(const Parameters& parameters, const Properties& properties, double p, double s) {
  return {segment_at(parameters, properties, p), s > 0.0 ? 1.0 : -1.0};
}

Yield yield_on(const Parameters& parameters, const Properties& properties, Branch branch, double p, double s) {
  const Strengths<Dual> with = duals_of(properties);
  const Dual p_dual = variable(p, 0);
  const Dual s_dual = variable(s, 1);
  const Dual f = yield_formula(parameters.model, parameters.transition_width, with, branch, p_dual, s_dual);
  Yield yield{f.value(), f.derivatives()[0], f.derivatives()[1], f.derivatives()[2]};
  if (parameters.model == YieldModel::dpc && branch.segment != Segment::cap) {
    const Dual g = potential_formula(parameters.model, parameters.transition_width, with, branch, p_dual, s_dual);
    yield.g = g.value();
    yield.g_p = g.derivatives()[0];
    yield.g_s = g.derivatives()[1];
  } else {
    yield.g = yield.f;
    yield.g_p = yield.f_p;
    yield.g_s = yield.f_s;
  }
  return yield;
}

double yield_function(const Parameters& parameters, const Properties& properties, double p, double s) {
  const Strengths<double> with = values_of(properties);
  const Branch branch = branch_at(parameters, properties, p, s);
  const double f = yield_formula(parameters.model, parameters.transition_width, with, branch, p, s);
  if (branch.segment != Segment::transition) return f;
  const auto cap = cap_relations(with, parameters.transition_width);
  const bool is_below_centre = std::abs(s) <= cap.arc_centre;
  return is_below_centre ? -std::hypot(p + with.centre, std::abs(s) - cap.arc_centre) - cap.arc_radius : f;
}

std::optional<double> distance_to_end(const Parameters& parameters, const Properties& properties, Segment segment,
                                      bool towards_compression, double p) {
  const double centre = properties.cap_centre.value;
  const bool has_arc = parameters.model == YieldModel::dpc && parameters.transition_width > 0.0;
  if (parameters.model == YieldModel::vm) return std::nullopt;
  const auto arc_start = [&] { return cap_constants(parameters, properties).transition_start; };
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
  const Strengths<double> with = values_of(properties);
  const Way way{p, s, p_rate, s_rate};
  std::optional<Exit> first;
  const auto consider = [&](Segment segment, double side, std::optional<double> t) {
    if (!t) return;
    const double at = std::max(*t, 0.0);
    const double reached = p + at * p_rate;
    for (const bool towards_compression : {false, true}) {
      const auto inside = distance_to_end(parameters, properties, segment, towards_compression, reached);
      if (inside && *inside < -k_slack) return;
    }
    if (!first || at < first->t) first = Exit{at, {segment, side}};
  };
  const double shear_side = s + s_rate > 0.0 ? 1.0 : -1.0;
  if (parameters.model != YieldModel::dpc) {
    const double by_strength = 1.0 / with.shear;
    consider(Segment::shear, shear_side, way.out_of(0.0, 0.0, 0.0, by_strength, 1.0));
    if (parameters.model == YieldModel::vm) return first;
    consider(Segment::tension, shear_side, way.out_of(0.0, 1.0 / with.tensile, 0.0, by_strength, 1.0));
    const double by_axis = 1.0 / cap_half_axis(with);
    consider(Segment::cap, shear_side, way.out_of(by_axis * with.centre, by_axis, 0.0, by_strength, 1.0));
    return first;
  }
  const auto cap = cap_relations(with, parameters.transition_width);
  for (const double side : {-1.0, 1.0}) {
    const double rate = side * s_rate + p_rate * cap.slope;
    if (rate > 0.0) {
      const double t = -(side * s + p * cap.slope - cap.cohesion) / rate;
      if (side * (s + std::max(t, 0.0) * s_rate) >= -k_slack) consider(Segment::shear, side, t);
    }
    if (parameters.transition_width == 0.0) continue;
    const auto t = way.out_of(with.centre, 1.0, -cap.arc_centre, side, cap.arc_radius);
    if (t && side * (s + *t * s_rate) > cap.arc_centre) consider(Segment::transition, side, t);
  }
  const auto out = way.out_of(with.centre, 1.0, 0.0, cap.stretch * with.axis_ratio, cap_half_axis(with));
  consider(Segment::cap, out && s + *out * s_rate > 0.0 ? 1.0 : -1.0, out);
  return first;
}

}  // namespace monograin::compressible
