#include "mdr/relaxed_profile.hpp"

#include <algorithm>
#include <boost/math/interpolators/barycentric_rational.hpp>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <string>

namespace monograin::mdr {
namespace {

using std::numbers::pi;

// Number of samples whose polynomial gives a slope: enough for slopes of a higher order than that of cubic pieces. A
// rational interpolant of all samples suffers from round-off: in r^2 the samples, and their weights, crowd at the axis.
constexpr std::size_t k_stencil = 5;

// Four nodes are exact to degree 7; a cubic of x^2 - t^2 has degree 6.
using PieceRule = boost::math::quadrature::gauss<double, 4>;

void check(std::span<const double> radii, std::span<const double> heights) {
  const auto is_finite = [](double value) { return std::isfinite(value); };
  if (radii.size() != heights.size()) throw std::invalid_argument("a profile needs one height for each radius");
  if (radii.size() < k_stencil) {
    throw std::invalid_argument("a profile needs at least " + std::to_string(k_stencil) + " samples, not " +
                                std::to_string(radii.size()));
  }
  if (!std::ranges::all_of(radii, is_finite) || !std::ranges::all_of(heights, is_finite))
    throw std::invalid_argument("a sample of a profile is not finite");
  if (radii.front() != 0.0) throw std::invalid_argument("the first sample of a profile has to lie on the axis");
  if (std::ranges::adjacent_find(radii, std::ranges::greater_equal()) != radii.end())
    throw std::invalid_argument("the radii of a profile have to ascend");
}

/// Slope at sample i of the polynomial through it and its neighbours.
double slope_at(std::span<const double> x, std::span<const double> y, std::size_t i) {
  const std::size_t first = std::min(std::max(i, k_stencil / 2) - k_stencil / 2, x.size() - k_stencil);
  // A barycentric rational interpolant of the highest order is the polynomial through its points.
  return boost::math::barycentric_rational<double>(x.data() + first, y.data() + first, k_stencil, k_stencil - 1)
      .prime(x[i]);
}

}  // namespace

RelaxedProfile::RelaxedProfile(std::span<const double> radii, std::span<const double> heights) {
  check(radii, heights);
  radii_.assign(radii.begin(), radii.end());
  // Squares are scaled, so that the weights of the slopes neither overflow nor underflow in any unit.
  const double size = largest_radius() * largest_radius();
  std::vector<double> squares(radii_.size());
  std::vector<double> above_axis(radii_.size());
  for (std::size_t i = 0; i < radii_.size(); ++i) {
    squares[i] = radii_[i] * radii_[i] / size;
    above_axis[i] = heights[i] - heights[0];
  }
  if (std::ranges::adjacent_find(squares, std::ranges::greater_equal()) != squares.end())
    throw std::invalid_argument("the radii of a profile are too close to each other");
  pieces_.reserve(radii_.size() - 1);
  for (std::size_t i = 0; i + 1 < radii_.size(); ++i) {
    const double width = (radii_[i + 1] - radii_[i]) * (radii_[i + 1] + radii_[i]);
    const double secant = (above_axis[i + 1] - above_axis[i]) / width;
    const double begin = slope_at(squares, above_axis, i) / size;
    const double end = slope_at(squares, above_axis, i + 1) / size;
    pieces_.push_back({above_axis[i], begin, (3.0 * secant - 2.0 * begin - end) / width,
                       (begin + end - 2.0 * secant) / (width * width)});
  }
}

template <class Integrand>
double RelaxedProfile::integral(double x, Integrand&& integrand) const {
  if (!(x >= 0.0 && x <= largest_radius())) throw std::domain_error("radius outside the samples of the profile");
  double sum = 0.0;
  double outer = x;  // t at the inner sample of the piece
  for (std::size_t i = 0; i < pieces_.size() && radii_[i] < x; ++i) {
    const double end = std::min(x, radii_[i + 1]);
    const double inner = std::sqrt((x - end) * (x + end));
    // The distance from the piece's beginning is (outer - t)(outer + t); formed from x^2 - t^2 it would cancel.
    sum += PieceRule::integrate(
        [&](double t) { return integrand(pieces_[i], (outer - t) * (outer + t), (x - t) * (x + t)); }, inner, outer);
    outer = inner;
  }
  return sum;
}

// With s = r^2 and G(s) = g3D(r), r^2 = x^2 - t^2 turns the transform into g1D(x) = 2x int_0^x G'(x^2 - t^2) dt.

double RelaxedProfile::image_height(double x) const {
  return 2.0 * x *
         integral(x, [](const Piece& c, double d, double) { return c[1] + d * (2.0 * c[2] + d * 3.0 * c[3]); });
}

double RelaxedProfile::image_slope(double x) const {
  // 4 int_0^x (G' + s G'') dt
  return 4.0 * integral(x, [](const Piece& c, double d, double s) {
           return c[1] + d * (2.0 * c[2] + d * 3.0 * c[3]) + s * (2.0 * c[2] + d * 6.0 * c[3]);
         });
}

double RelaxedProfile::image_area(double x) const {
  // With its integrals exchanged, S is int_0^x G(x^2 - t^2) dt, which needs no derivative.
  return integral(x, [](const Piece& c, double d, double) { return c[0] + d * (c[1] + d * (c[2] + d * c[3])); });
}

double free_force(const RelaxedProfile& profile, double composite_modulus, double a) {
  return 2.0 * composite_modulus * (a * profile.image_height(a) - profile.image_area(a));
}

PeelState peel_state(const RelaxedProfile& profile, const Adhesion& adhesion, double a) {
  const double stretch = critical_stretch(adhesion, a);
  return {.contact_radius = a,
          .displacement_1d = profile.image_height(a) - stretch,
          .force = free_force(profile, adhesion.composite_modulus, a) - 2.0 * adhesion.composite_modulus * a * stretch};
}

double critical_radius(const RelaxedProfile& profile, const Adhesion& adhesion, Control control) {
  // (g1D' - control_factor Dl') sqrt(a), where the root keeps it finite at the axis: positive where the edge is stable.
  const double stretch_slope =
      control_factor(control) * std::sqrt(0.5 * pi * adhesion.surface_energy / adhesion.composite_modulus);
  const auto stability = [&](double a) { return std::sqrt(a) * profile.image_slope(a) - stretch_slope; };

  double outer = profile.largest_radius();
  double outer_value = stability(outer);
  if (!(outer_value > 0.0)) {
    throw std::domain_error("the edge of the contact is unstable at the largest radius of the profile");
  }
  for (std::size_t i = profile.radii().size() - 1; i-- > 0;) {
    const double inner = profile.radii()[i];
    const double inner_value = stability(inner);
    if (inner_value < 0.0) {
      std::uintmax_t iterations = 200;
      const auto [below, above] = boost::math::tools::toms748_solve(
          stability, inner, outer, inner_value, outer_value, boost::math::tools::eps_tolerance<double>(), iterations);
      return 0.5 * (below + above);
    }
    outer = inner;
    outer_value = inner_value;
  }
  return 0.0;
}

PeelState pull_off_state(const RelaxedProfile& profile, const Adhesion& adhesion, Control control) {
  return peel_state(profile, adhesion, critical_radius(profile, adhesion, control));
}

std::vector<PeelState> peel_curve(const RelaxedProfile& profile, const Adhesion& adhesion, Control control,
                                  std::size_t count) {
  if (count < 2) throw std::invalid_argument("a curve needs at least two states");
  const double critical = critical_radius(profile, adhesion, control);
  std::vector<PeelState> curve;
  curve.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double a =
        std::lerp(profile.largest_radius(), critical, static_cast<double>(i) / static_cast<double>(count - 1));
    curve.push_back(peel_state(profile, adhesion, a));
  }
  return curve;
}

}  // namespace monograin::mdr
