#include "mdr/adhesion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "system/resolution.hpp"

namespace monograin::mdr {
namespace {

using std::numbers::pi;

// Least slope of an edge's equilibrium, over A/b: the slope goes with the root of the distance from pull-off, and
// displacements are rounded.
constexpr double k_least_slope_of_edge = 5e-9;

/// Edge at the radius a on a profile; on the ellipse a = b sin(theta).
struct ProfileEdge {
  double radius = 0.0;
  double share = 0.0;   ///< radius over the half width: sin(theta)
  double cosine = 0.0;  ///< cosine of theta; 1 on the parabola
  double rise = 0.0;    ///< profile's height over half the indenter's: 1 - cos(theta), or (a/b)^2/2
};

ProfileEdge edge_at(const Indenter& indenter, double a) noexcept {
  const double share = a / indenter.half_width;
  if (indenter.is_parabola()) return {a, share, 1.0, 0.5 * share * share};
  const double sine = std::min(1.0, share);
  const double cosine = std::sqrt((1.0 - sine) * (1.0 + sine));
  return {a, sine, cosine, sine * sine / (1.0 + cosine)};
}

ProfileEdge edge_at_rise(const Indenter& indenter, double rise) noexcept {
  const bool by_parabola = indenter.is_parabola();
  const double share = std::sqrt(rise * (by_parabola ? 2.0 : 2.0 - rise));
  return {indenter.half_width * share, share, by_parabola ? 1.0 : 1.0 - rise, rise};
}

/// Angle theta of an edge on the ellipse.
double angle_of(const ProfileEdge& edge) noexcept { return std::atan2(edge.share, edge.cosine); }

double height_at(const Indenter& indenter, const ProfileEdge& edge) noexcept {
  return 0.5 * indenter.height * edge.rise;
}

double free_force_at(const Indenter& indenter, double composite_modulus, const ProfileEdge& edge) noexcept {
  if (indenter.is_parabola()) {
    return 4.0 / 3.0 * composite_modulus * indenter.tip_curvature() * edge.radius * edge.radius * edge.radius;
  }
  return 0.5 * composite_modulus * indenter.height * indenter.half_width *
         phi_at(angle_of(edge), edge.share, edge.cosine);
}

PeelState peel_state_at(const Indenter& indenter, const Adhesion& adhesion, const ProfileEdge& edge) noexcept {
  const double stretch = critical_stretch(adhesion, edge.radius);
  return {.contact_radius = edge.radius,
          .displacement_1d = height_at(indenter, edge) - stretch,
          .force = free_force_at(indenter, adhesion.composite_modulus, edge) -
                   2.0 * adhesion.composite_modulus * edge.radius * stretch};
}

/// Slope of an edge's equilibrium, g' - control_factor Dl', times the cosine on the ellipse, where g' is unbounded.
double slope(const Indenter& indenter, double stretch, double control_factor, const ProfileEdge& edge) noexcept {
  const double by_height = 0.5 * indenter.height / indenter.half_width * edge.share;
  return by_height - control_factor * stretch / (2.0 * edge.radius) * edge.cosine;
}

/// Slope of an edge's equilibrium under displacement control. It is zero at pull-off, and no less here than its
/// round-off.
double slope_off_pull_off(const Indenter& indenter, double stretch, const ProfileEdge& edge) noexcept {
  const double least = k_least_slope_of_edge * indenter.height / indenter.half_width;
  return std::max(least, slope(indenter, stretch, control_factor(Control::displacement), edge));
}

/// Contact radii between which an edge is searched.
struct EdgeRange {
  double from = 0.0;
  double down_to = 0.0;
};

/// Newton's method for the edge at which an excess is zero. The excess is a convex increasing function of the rise, so
/// the iteration from above comes down to the root without passing it.
/// @param range           contact radii at which the search begins, and below which it does not go
/// @param control_factor  control_factor() of displacement if the excess is a displacement; that of force if it is a
///                        force over 2 E* a
/// @param excess          (edge, stretch) -> excess
template <class Excess>
ProfileEdge descend(const Indenter& indenter, const Adhesion& adhesion, const EdgeRange& range, double control_factor,
                    Excess&& excess) noexcept {
  const double unit_stretch = critical_stretch(adhesion, indenter.half_width);
  const double most = indenter.is_parabola() ? k_infinity : 1.0;
  const double least = edge_at(indenter, range.down_to).rise;
  ProfileEdge edge = edge_at_rise(indenter, std::min(edge_at(indenter, range.from).rise, most));
  for (int iteration = 0; iteration < k_most_newton_steps; ++iteration) {
    const double stretch = unit_stretch * std::sqrt(edge.share);
    const double by_rise =
        0.5 * indenter.height - 0.5 * control_factor * stretch * edge.cosine / (edge.share * edge.share);
    if (!(by_rise > 0.0)) break;
    const double next = std::clamp(edge.rise - excess(edge, stretch) / by_rise, least, most);
    // Near pull-off, where the root is double, round-off over a tiny slope would move the edge up again.
    if (!(edge.rise - next > 1e-15 * edge.rise)) break;
    edge = edge_at_rise(indenter, next);
  }
  return edge;
}

/// Change of the relaxed profile's height at a fixed radius with the indenter; on the ellipse times the cosine there.
double height_change(const Indenter& indenter, const Image::Change& change, const ProfileEdge& edge) noexcept {
  const double height = height_at(indenter, edge);
  if (indenter.is_parabola()) return height * (change.height - 2.0 * change.half_width);
  return change.height * height * edge.cosine - 0.5 * indenter.height * change.half_width * edge.share * edge.share;
}

/// Integrals of the profile up to an edge.
struct Below {
  double area = 0.0;      ///< int_0^a g dx
  double by_width = 0.0;  ///< -d(area)/d(ln b) with the edge at a fixed radius
};

Below below(const Indenter& indenter, const ProfileEdge& edge) noexcept {
  if (indenter.is_parabola()) {
    const double area = indenter.tip_curvature() * edge.radius * edge.radius * edge.radius / 3.0;
    return {area, 2.0 * area};
  }
  const double theta = angle_of(edge);
  const double segment = phi_at(theta, edge.share, edge.cosine);
  const double unit = 0.5 * indenter.height * indenter.half_width;
  // sin - (theta + sin cos)/2 without cancellation
  return {unit * (0.5 * segment - 2.0 * phi(0.5 * theta)), 0.5 * unit * segment};
}

/// Contact whose springs stand up to a given edge, with derivatives at a fixed edge.
/// @param lift  delta_1D - g(a), displacement of the springs at the edge
Contact contact_below(const Image& image, double composite_modulus, const ProfileEdge& edge, double lift) noexcept {
  const double a = edge.radius;
  const Below springs = below(image.indenter, edge);
  const auto changed = [&](const Image::Change& change) {
    return 2.0 * composite_modulus *
           (change.displacement_1d * a - change.height * springs.area + change.half_width * springs.by_width);
  };
  return {.contact_radius = a,
          // The force without adhesion is 2 E* times the same integral.
          .force = 2.0 * composite_modulus * (springs.by_width + a * lift),
          .by_overlap = 2.0 * composite_modulus * a * image.by_overlap,
          .by_radius = changed(image.by_radius),
          .by_overlap_max = changed(image.by_overlap_max)};
}

/// Edge in equilibrium at a displacement above the critical one.
ProfileEdge peeling_edge(const Indenter& indenter, const Adhesion& adhesion, double critical_radius,
                         double displacement_1d) noexcept {
  // Beyond this radius half of the tip's parabola alone exceeds the stretch, and the other half delta_1D.
  const double curvature = indenter.tip_curvature();
  const double stretch = critical_stretch(adhesion, 1.0);
  const double from = std::max(std::cbrt(4.0 * stretch * stretch / (curvature * curvature)),
                               std::sqrt(2.0 * std::max(0.0, displacement_1d) / curvature));
  return descend(indenter, adhesion, {from, critical_radius}, control_factor(Control::displacement),
                 [&](const ProfileEdge& e, double s) { return height_at(indenter, e) - s - displacement_1d; });
}

}  // namespace

Indenter elastic_indenter(ElasticProfile profile, double radius) noexcept { return {profile, 4.0 * radius, radius}; }

Indenter unloading_indenter(const UnloadingShape& shape) noexcept {
  return {ElasticProfile::ellipse, shape.height, shape.contact_radius_max};
}

double profile_height(const Indenter& indenter, double a) noexcept { return height_at(indenter, edge_at(indenter, a)); }

double profile_round_off(const Indenter& indenter, double a) noexcept {
  const ProfileEdge edge = edge_at(indenter, a);
  // At the very end of the ellipse the slope is unbounded: there the height is uncertain by the root of the round-off.
  return 0.5 * indenter.height * edge.share * edge.share * k_round_off / std::max(edge.cosine, std::sqrt(k_round_off));
}

double free_contact_radius(const Indenter& indenter, double displacement_1d) noexcept {
  if (displacement_1d <= 0.0) return 0.0;
  if (indenter.is_parabola()) return std::sqrt(displacement_1d / indenter.tip_curvature());
  const double y = std::min(1.0, 2.0 * displacement_1d / indenter.height);
  return indenter.half_width * std::sqrt(y * (2.0 - y));
}

double free_force(const Indenter& indenter, double composite_modulus, double a) noexcept {
  return free_force_at(indenter, composite_modulus, edge_at(indenter, a));
}

double critical_stretch(const Adhesion& adhesion, double a) noexcept {
  return std::sqrt(2.0 * pi * a * adhesion.surface_energy / adhesion.composite_modulus);
}

double critical_radius(const Indenter& indenter, const Adhesion& adhesion, Control control) {
  const double factor = control_factor(control);
  const double b = indenter.half_width;
  const double flatness = 2.0 * b / indenter.height;
  const double k =
      0.5 * factor * factor * pi * adhesion.surface_energy / adhesion.composite_modulus * flatness * flatness;
  const double parabola = std::cbrt(k * b * b);
  if (indenter.is_parabola()) return parabola;
  // a^3 + k a^2 - k b^2 = 0: convex, with one positive root, below both of these. Boost 1.74 solves no cubics.
  double a = std::min(parabola, b);
  for (int iteration = 0; iteration < k_most_newton_steps && a > 0.0; ++iteration) {
    const double step = (a * a * a - k * (b - a) * (b + a)) / (a * (3.0 * a + 2.0 * k));
    a -= step;
    if (!(std::abs(step) > 1e-16 * a)) break;
  }
  return a;
}

PeelState peel_state(const Indenter& indenter, const Adhesion& adhesion, double a) noexcept {
  return peel_state_at(indenter, adhesion, edge_at(indenter, a));
}

PeelState peel_at_displacement(const Indenter& indenter, const Adhesion& adhesion, double critical_radius,
                               double displacement_1d) {
  const PeelState critical = peel_state(indenter, adhesion, critical_radius);
  if (displacement_1d <= critical.displacement_1d) return critical;
  return peel_state_at(indenter, adhesion, peeling_edge(indenter, adhesion, critical_radius, displacement_1d));
}

PeelState peel_at_force(const Indenter& indenter, const Adhesion& adhesion, double critical_radius, double force) {
  const PeelState critical = peel_state(indenter, adhesion, critical_radius);
  if (force <= critical.force) return critical;
  const double cubic = 4.0 / 3.0 * adhesion.composite_modulus * indenter.tip_curvature();
  const double stretch = 2.0 * adhesion.composite_modulus * critical_stretch(adhesion, 1.0);
  const double from =
      std::max(std::cbrt(4.0 * stretch * stretch / (cubic * cubic)), std::cbrt(2.0 * std::max(0.0, force) / cubic));
  const ProfileEdge edge = descend(indenter, adhesion, {from, critical_radius}, control_factor(Control::force),
                                   [&](const ProfileEdge& e, double s) {
                                     return (free_force_at(indenter, adhesion.composite_modulus, e) - force) /
                                                (2.0 * adhesion.composite_modulus * e.radius) -
                                            s;
                                   });
  return peel_state_at(indenter, adhesion, edge);
}

Image elastic_image(ElasticProfile profile, double radius, double overlap) noexcept {
  return {.indenter = elastic_indenter(profile, radius),
          .displacement_1d = overlap,
          .by_overlap = 1.0,
          .by_radius = {0.0, 1.0 / radius, 1.0 / radius}};
}

Image unloading_image(const UnloadingShape& shape, double overlap) noexcept {
  const double u = unloading_fraction(shape, overlap);
  const double opening = 1.0 / (1.0 - shape.rho);
  const auto change = [&](double pressure_x, double contact_radius_x, double rho_x, double overlap_max_x) {
    const double height_x = pressure_x + contact_radius_x;
    return Image::Change{
        .displacement_1d = 0.5 * shape.height * (height_x - u * rho_x * opening) - overlap_max_x * opening,
        .height = height_x,
        .half_width = contact_radius_x};
  };
  return {
      .indenter = unloading_indenter(shape),
      .displacement_1d = 0.5 * shape.height * (1.0 - u),
      .by_overlap = opening,
      .by_radius = change(shape.log_pressure_by_radius, shape.log_contact_radius_by_radius, shape.rho_by_radius, 0.0),
      .by_overlap_max = change(shape.log_pressure_by_max, shape.log_contact_radius_by_max, shape.rho_by_max, 1.0)};
}

double overlap_at(const UnloadingShape& shape, double displacement_1d) noexcept {
  return shape.overlap_max - shape.recovery * (1.0 - 2.0 * displacement_1d / shape.height);
}

Contact sticking_contact(const Image& image, double composite_modulus, double a) noexcept {
  const ProfileEdge edge = edge_at(image.indenter, a);
  return contact_below(image, composite_modulus, edge, image.displacement_1d - height_at(image.indenter, edge));
}

Contact peeling_contact(const Image& image, const Adhesion& adhesion, double critical_radius) {
  const Indenter& indenter = image.indenter;
  ProfileEdge edge = edge_at(indenter, critical_radius);
  const double critical_displacement = height_at(indenter, edge) - critical_stretch(adhesion, critical_radius);
  if (image.displacement_1d > critical_displacement) {
    edge = peeling_edge(indenter, adhesion, critical_radius, image.displacement_1d);
  }
  const double stretch = critical_stretch(adhesion, edge.radius);
  // The edge of an ellipse is widest at its end. Beyond the equilibrium there, where trials may lead, the contact has
  // an edge that sticks, so that the trial leads back.
  const bool is_widest = !indenter.is_parabola() && edge.share >= 1.0;
  if (is_widest && image.displacement_1d > height_at(indenter, edge) - stretch) {
    return sticking_contact(image, adhesion.composite_modulus, edge.radius);
  }
  Contact contact = contact_below(image, adhesion.composite_modulus, edge, -stretch);
  // The edge follows: da = d(delta_1D - g)/(g' - Dl'). At pull-off that is unbounded; it is kept finite here.
  const double follow = 2.0 * adhesion.composite_modulus * stretch / slope_off_pull_off(indenter, stretch, edge);
  const auto followed = [&](const Image::Change& change) {
    return follow * (change.displacement_1d * edge.cosine - height_change(indenter, change, edge));
  };
  contact.by_overlap -= follow * edge.cosine * image.by_overlap;
  contact.by_radius -= followed(image.by_radius);
  contact.by_overlap_max -= followed(image.by_overlap_max);
  return contact;
}

double peeling_softening(const Image& image, const Adhesion& adhesion, double a) noexcept {
  const Indenter& indenter = image.indenter;
  const ProfileEdge edge = edge_at(indenter, a);
  const double stretch = critical_stretch(adhesion, a);
  const double slope = slope_off_pull_off(indenter, stretch, edge);
  // d2F/d(delta)2 = 2 E* d(a - Dl cos/slope)/d(delta_1D) (d(delta_1D)/d(delta))^2, with da/d(delta_1D) = cos/slope. The
  // rates below are derivatives by delta_1D; that of the cosine is finite at the end of the ellipse.
  const double radius_rate = edge.cosine / slope;
  const double cosine_rate = indenter.is_parabola() ? 0.0 : -edge.share / (indenter.half_width * slope);
  const double stretch_rate = 0.5 * stretch / a * radius_rate;
  const double height_slope_rate = 0.5 * indenter.height / (indenter.half_width * indenter.half_width) * radius_rate;
  const double slope_rate = height_slope_rate + 0.5 * stretch_rate * edge.cosine / a - 0.5 * stretch / a * cosine_rate;
  const double lag_rate =  // of Dl cos/slope
      (stretch_rate * edge.cosine + stretch * (cosine_rate - edge.cosine * slope_rate / slope)) / slope;
  return 2.0 * adhesion.composite_modulus * (radius_rate - lag_rate) * image.by_overlap * image.by_overlap;
}

EdgePress edge_press(const Image& image, const Image::Change& by_radius, double a) noexcept {
  const ProfileEdge edge = edge_at(image.indenter, a);
  return {.by_overlap = image.by_overlap * edge.cosine,
          .by_radius = by_radius.displacement_1d * edge.cosine - height_change(image.indenter, by_radius, edge)};
}

double adhesive_energy(const Image& image, const Adhesion& adhesion, double a) noexcept {
  const Indenter& indenter = image.indenter;
  const ProfileEdge edge = edge_at(indenter, a);
  const double w = image.displacement_1d - height_at(indenter, edge);
  const double curvature = indenter.tip_curvature();
  // Energy of the springs without adhesion, plus what the further displacement w of all of them adds.
  const double free_energy = indenter.is_parabola()
                                 ? 8.0 / 15.0 * adhesion.composite_modulus * curvature * curvature * a * a * a * a * a
                                 : 0.25 * adhesion.composite_modulus * indenter.height * indenter.height *
                                       indenter.half_width * psi(angle_of(edge));
  const double springs = free_energy + w * (free_force_at(indenter, adhesion.composite_modulus, edge) +
                                            adhesion.composite_modulus * a * w);
  return (springs - pi * a * a * adhesion.surface_energy) / image.by_overlap;
}

}  // namespace monograin::mdr
