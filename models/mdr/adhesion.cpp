#include "mdr/adhesion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace monograin::mdr {
namespace {

using std::numbers::pi;

constexpr int k_newton_limit = 100;  // a double root at pull-off only halves the error each time

/// An edge at the radius a, on the ellipse as an angle: a = b sin(theta).
struct Edge {
  double radius = 0.0;
  double theta = 0.0;
  double sine = 0.0;
  double cosine = 0.0;
};

Edge edge_at_angle(const Indenter& indenter, double theta) noexcept {
  const double sine = std::sin(theta);
  return {indenter.half_width * sine, theta, sine, std::max(0.0, std::cos(theta))};
}

Edge edge_at(const Indenter& indenter, double a) noexcept {
  const double sine = std::min(1.0, a / indenter.half_width);
  const double cosine = std::sqrt((1.0 - sine) * (1.0 + sine));
  return {a, std::atan2(sine, cosine), sine, cosine};
}

/// Of the parabola A x^2/(4 b^2), which is also the tip of the ellipse.
double tip_curvature(const Indenter& indenter) noexcept {
  return 0.25 * indenter.height / (indenter.half_width * indenter.half_width);
}

bool is_parabola(const Indenter& indenter) noexcept { return indenter.profile == ElasticProfile::parabola; }

double height_at(const Indenter& indenter, const Edge& edge) noexcept {
  if (is_parabola(indenter)) return tip_curvature(indenter) * edge.radius * edge.radius;
  return 0.5 * indenter.height * edge.sine * edge.sine / (1.0 + edge.cosine);
}

/// int_0^a g dx
double area_below(const Indenter& indenter, const Edge& edge) noexcept {
  if (is_parabola(indenter)) return tip_curvature(indenter) * edge.radius * edge.radius * edge.radius / 3.0;
  // sin - (theta + sin cos)/2 without cancellation
  return 0.5 * indenter.height * indenter.half_width * (0.5 * phi(edge.theta) - 2.0 * phi(0.5 * edge.theta));
}

double free_force_at(const Indenter& indenter, double composite_modulus, const Edge& edge) noexcept {
  if (is_parabola(indenter)) {
    return 4.0 / 3.0 * composite_modulus * tip_curvature(indenter) * edge.radius * edge.radius * edge.radius;
  }
  return 0.5 * composite_modulus * indenter.height * indenter.half_width * phi(edge.theta);
}

PeelState peel_state_at(const Indenter& indenter, double composite_modulus, double surface_energy,
                        const Edge& edge) noexcept {
  const double stretch = critical_stretch(composite_modulus, surface_energy, edge.radius);
  return {.contact_radius = edge.radius,
          .displacement_1d = height_at(indenter, edge) - stretch,
          .force = free_force_at(indenter, composite_modulus, edge) - 2.0 * composite_modulus * edge.radius * stretch};
}

/// Slope of an edge's equilibrium, (g' - xi Dl') with g' and Dl' over the cosine on the ellipse, where g' is unbounded.
double slope(const Indenter& indenter, double stretch, double xi, const Edge& edge) noexcept {
  const double stretch_slope = xi * stretch / (2.0 * edge.radius);
  if (is_parabola(indenter)) return 2.0 * tip_curvature(indenter) * edge.radius - stretch_slope;
  return 0.5 * indenter.height / indenter.half_width * edge.sine - stretch_slope * edge.cosine;
}

/// Newton's method from above on a convex increasing function of the edge, so that it comes down to the root without
/// passing it.
/// @param step  edge -> Newton step of the radius (parabola) or of the angle (ellipse)
template <class Step>
Edge descend(const Indenter& indenter, double from, double down_to, Step&& step) noexcept {
  const bool by_radius = is_parabola(indenter);
  const auto edge = [&](double x) { return by_radius ? edge_at(indenter, x) : edge_at_angle(indenter, x); };
  const double most = by_radius ? std::numeric_limits<double>::infinity() : 0.5 * pi;
  const double least = by_radius ? down_to : edge_at(indenter, down_to).theta;
  double x = by_radius ? from : edge_at(indenter, std::min(from, indenter.half_width)).theta;
  for (int iteration = 0; iteration < k_newton_limit; ++iteration) {
    const double next = std::clamp(x + step(edge(x)), least, most);
    // Near pull-off, a double root, round-off over a tiny slope would throw it back up.
    if (!(x - next > 1e-15 * x)) break;
    x = next;
  }
  return edge(x);
}

/// How the relaxed profile at a fixed place changes with the indenter; on the ellipse times the cosine there.
double height_change(const Indenter& indenter, const Frame::Change& change, const Edge& edge) noexcept {
  const double height = height_at(indenter, edge);
  if (is_parabola(indenter)) return height * (change.height - 2.0 * change.half_width);
  return change.height * height * edge.cosine - 0.5 * indenter.height * change.half_width * edge.sine * edge.sine;
}

double sticking_force_change(const Indenter& indenter, double composite_modulus, const Frame::Change& change,
                             const Edge& edge) noexcept {
  const double below = area_below(indenter, edge);
  const double by_width =
      is_parabola(indenter) ? 2.0 * below : 0.25 * indenter.height * indenter.half_width * phi(edge.theta);
  return 2.0 * composite_modulus *
         (change.displacement * edge.radius - change.height * below + change.half_width * by_width);
}

Contact sticking_contact_at(const Frame& frame, double composite_modulus, const Edge& edge) noexcept {
  const Indenter& indenter = frame.indenter;
  const double a = edge.radius;
  return {.contact_radius = a,
          .force = free_force_at(indenter, composite_modulus, edge) +
                   2.0 * composite_modulus * a * (frame.displacement - height_at(indenter, edge)),
          .by_overlap = 2.0 * composite_modulus * a * frame.by_overlap,
          .by_radius = sticking_force_change(indenter, composite_modulus, frame.by_radius, edge),
          .by_overlap_max = sticking_force_change(indenter, composite_modulus, frame.by_overlap_max, edge)};
}

}  // namespace

Indenter elastic_indenter(ElasticProfile profile, double radius) noexcept { return {profile, 4.0 * radius, radius}; }

Indenter unloading_indenter(const UnloadingShape& shape) noexcept {
  return {ElasticProfile::ellipse, shape.height, shape.contact_radius_max};
}

double profile_height(const Indenter& indenter, double a) noexcept { return height_at(indenter, edge_at(indenter, a)); }

double free_contact_radius(const Indenter& indenter, double displacement_1d) noexcept {
  if (displacement_1d <= 0.0) return 0.0;
  if (is_parabola(indenter)) return std::sqrt(displacement_1d / tip_curvature(indenter));
  const double y = std::min(1.0, 2.0 * displacement_1d / indenter.height);
  return indenter.half_width * std::sqrt(y * (2.0 - y));
}

double free_force(const Indenter& indenter, double composite_modulus, double a) noexcept {
  return free_force_at(indenter, composite_modulus, edge_at(indenter, a));
}

double critical_stretch(double composite_modulus, double surface_energy, double a) noexcept {
  return std::sqrt(2.0 * pi * a * surface_energy / composite_modulus);
}

double critical_radius(const Indenter& indenter, double composite_modulus, double surface_energy, Control control) {
  const double xi = control == Control::force ? 3.0 : 1.0;
  const double b = indenter.half_width;
  const double flatness = 2.0 * b / indenter.height;
  const double k = 0.5 * xi * xi * pi * surface_energy / composite_modulus * flatness * flatness;
  const double parabola = std::cbrt(k * b * b);
  if (is_parabola(indenter)) return parabola;
  // a^3 + k a^2 - k b^2 = 0: convex, with one positive root, below both of these.
  double a = std::min(parabola, b);
  for (int iteration = 0; iteration < k_newton_limit && a > 0.0; ++iteration) {
    const double step = (a * a * a - k * (b - a) * (b + a)) / (a * (3.0 * a + 2.0 * k));
    a -= step;
    if (!(std::abs(step) > 1e-16 * a)) break;
  }
  return a;
}

PeelState peel_state(const Indenter& indenter, double composite_modulus, double surface_energy, double a) noexcept {
  return peel_state_at(indenter, composite_modulus, surface_energy, edge_at(indenter, a));
}

PeelState peel_at_displacement(const Indenter& indenter, double composite_modulus, double surface_energy,
                               double critical_radius, double displacement_1d) {
  const PeelState critical = peel_state(indenter, composite_modulus, surface_energy, critical_radius);
  if (displacement_1d <= critical.displacement_1d) return critical;
  // Beyond this radius half of the tip's parabola alone exceeds the stretch, and the other half delta_1D.
  const double curvature = tip_curvature(indenter);
  const double stretch = critical_stretch(composite_modulus, surface_energy, 1.0);
  const double from = std::max(std::cbrt(4.0 * stretch * stretch / (curvature * curvature)),
                               std::sqrt(2.0 * std::max(0.0, displacement_1d) / curvature));
  const Edge edge = descend(indenter, from, critical_radius, [&](const Edge& e) {
    const double s = critical_stretch(composite_modulus, surface_energy, e.radius);
    const double excess = height_at(indenter, e) - s - displacement_1d;
    // d/da, or d/d(theta) = b cos(theta) d/da
    const double by = slope(indenter, s, 1.0, e) * (is_parabola(indenter) ? 1.0 : indenter.half_width);
    return by > 0.0 ? -excess / by : 0.0;
  });
  return peel_state_at(indenter, composite_modulus, surface_energy, edge);
}

PeelState peel_at_force(const Indenter& indenter, double composite_modulus, double surface_energy,
                        double critical_radius, double force) {
  const PeelState critical = peel_state(indenter, composite_modulus, surface_energy, critical_radius);
  if (force <= critical.force) return critical;
  const double cubic = 4.0 / 3.0 * composite_modulus * tip_curvature(indenter);
  const double stretch = 2.0 * composite_modulus * critical_stretch(composite_modulus, surface_energy, 1.0);
  const double from =
      std::max(std::cbrt(4.0 * stretch * stretch / (cubic * cubic)), std::cbrt(2.0 * std::max(0.0, force) / cubic));
  const Edge edge = descend(indenter, from, critical_radius, [&](const Edge& e) {
    const double s = critical_stretch(composite_modulus, surface_energy, e.radius);
    const double excess =
        free_force_at(indenter, composite_modulus, e) - 2.0 * composite_modulus * e.radius * s - force;
    const double by = 2.0 * composite_modulus * e.radius * slope(indenter, s, 3.0, e) *
                      (is_parabola(indenter) ? 1.0 : indenter.half_width);
    return by > 0.0 ? -excess / by : 0.0;
  });
  return peel_state_at(indenter, composite_modulus, surface_energy, edge);
}

Frame elastic_frame(ElasticProfile profile, double radius, double overlap) noexcept {
  return {.indenter = elastic_indenter(profile, radius),
          .displacement = overlap,
          .by_overlap = 1.0,
          .by_radius = {0.0, 1.0 / radius, 1.0 / radius},
          .by_overlap_max = {}};
}

Frame unloading_frame(const UnloadingShape& shape, double overlap) noexcept {
  const double u = unloading_fraction(shape, overlap);
  const double opening = 1.0 / (1.0 - shape.rho);
  const auto change = [&](double pressure_x, double contact_radius_x, double rho_x, double overlap_max_x) {
    const double height_x = pressure_x + contact_radius_x;
    return Frame::Change{
        .displacement = 0.5 * shape.height * (height_x - u * rho_x * opening) - overlap_max_x * opening,
        .height = height_x,
        .half_width = contact_radius_x};
  };
  return {.indenter = unloading_indenter(shape),
          .displacement = 0.5 * shape.height * (1.0 - u),
          .by_overlap = opening,
          .by_radius = change(shape.pressure_by_radius, shape.contact_radius_by_radius, shape.rho_by_radius, 0.0),
          .by_overlap_max = change(shape.pressure_by_max, shape.contact_radius_by_max, shape.rho_by_max, 1.0)};
}

double overlap_at(const UnloadingShape& shape, double displacement_1d) noexcept {
  return shape.overlap_max - shape.recovery * (1.0 - 2.0 * displacement_1d / shape.height);
}

Contact sticking_contact(const Frame& frame, double composite_modulus, double a) noexcept {
  return sticking_contact_at(frame, composite_modulus, edge_at(frame.indenter, a));
}

Contact peeling_contact(const Frame& frame, double composite_modulus, double surface_energy, double critical_radius) {
  const Indenter& indenter = frame.indenter;
  const PeelState state =
      peel_at_displacement(indenter, composite_modulus, surface_energy, critical_radius, frame.displacement);
  const Edge edge = edge_at(indenter, state.contact_radius);
  const double stretch = critical_stretch(composite_modulus, surface_energy, edge.radius);
  Contact contact = sticking_contact_at(frame, composite_modulus, edge);
  contact.force = state.force;
  // The edge follows: da = d(delta_1D - g)/(g' - Dl'). At pull-off that is unbounded; it is kept finite here: the slope
  // goes with the root of the distance from there, and displacements are rounded.
  constexpr double k_root_of_rounding = 5e-9;
  const double least_slope = k_root_of_rounding * indenter.height / indenter.half_width;
  const double cosine = is_parabola(indenter) ? 1.0 : edge.cosine;
  const double follow = 2.0 * composite_modulus * stretch / std::max(least_slope, slope(indenter, stretch, 1.0, edge));
  const auto followed = [&](const Frame::Change& change) {
    return follow * (change.displacement * cosine - height_change(indenter, change, edge));
  };
  contact.by_overlap -= follow * cosine * frame.by_overlap;
  contact.by_radius -= followed(frame.by_radius);
  contact.by_overlap_max -= followed(frame.by_overlap_max);
  return contact;
}

EdgePress edge_press(const Frame& frame, const Frame::Change& by_radius, double a) noexcept {
  const Edge edge = edge_at(frame.indenter, a);
  const double cosine = is_parabola(frame.indenter) ? 1.0 : edge.cosine;
  return {.by_overlap = frame.by_overlap * cosine,
          .by_radius = by_radius.displacement * cosine - height_change(frame.indenter, by_radius, edge)};
}

double adhesive_energy(const Frame& frame, double composite_modulus, double surface_energy, double a) noexcept {
  const Indenter& indenter = frame.indenter;
  const Edge edge = edge_at(indenter, a);
  const double w = frame.displacement - height_at(indenter, edge);
  const double curvature = tip_curvature(indenter);
  // The springs as they would be without adhesion, and what the further displacement w of all of them adds.
  const double free_energy =
      is_parabola(indenter)
          ? 8.0 / 15.0 * composite_modulus * curvature * curvature * a * a * a * a * a
          : 0.25 * composite_modulus * indenter.height * indenter.height * indenter.half_width * psi(edge.theta);
  const double springs =
      free_energy + w * (free_force_at(indenter, composite_modulus, edge) + composite_modulus * a * w);
  return (springs - pi * a * a * surface_energy) / frame.by_overlap;
}

}  // namespace monograin::mdr
