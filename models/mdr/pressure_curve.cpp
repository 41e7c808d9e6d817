#include "mdr/pressure_curve.hpp"

#include <math.h>  // pchip.hpp of Boost 1.74 calls isnan unqualified; it has to come before

#include <algorithm>
#include <boost/math/interpolators/pchip.hpp>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string>

#include "system/limit.hpp"
#include "system/resolution.hpp"

namespace monograin::mdr {
namespace {

// eq. 28: p_Y/Y = 1 + k_excess exp(-k_decay delta/R); both constants as printed.
constexpr double k_excess = 1.75;
constexpr double k_decay = 4.4;

constexpr std::size_t k_least_samples = 4;

void require(bool is_met, const char* rule) {
  if (!is_met) throw std::invalid_argument(rule);
}

void check_samples(std::span<const double> x, std::span<const double> p) {
  require(x.size() == p.size(), "a pressure curve needs as many pressures as overlaps");
  require(x.size() >= k_least_samples, "a pressure curve needs at least 4 samples");
  require(x.front() == 0.0, "a pressure curve begins at zero overlap");
  // The comparisons are false for NaN, so samples that are NaN are refused.
  for (std::size_t i = 1; i < x.size(); ++i) require(x[i] > x[i - 1], "overlaps of a pressure curve ascend");
  require(std::isfinite(x.back()), "overlaps of a pressure curve are finite");
  for (const double pressure : p) require(pressure > 0.0, "pressures of a pressure curve are positive");
}

/// int_0^x t^n exp(-t) dt for n = 0, 1, 2 and x > 0, to full relative accuracy.
PressureMoments decaying_moments(double x) noexcept {
  const double decay = std::exp(-x);
  double second = 2.0 - decay * (2.0 + x * (2.0 + x));
  if (x < 2.0) {
    // The closed form cancels here. The series has positive terms only; its last one is below 1e-17 of the sum at x
    // = 2.
    double sum = 1.0;
    for (int n = 24; n > 3; --n) sum = 1.0 + x / n * sum;
    second = decay * x * x * x / 3.0 * sum;
  }
  // Downwards the recursion only adds positive terms.
  const double first = 0.5 * (second + decay * x * x);
  return {.zeroth = first + decay * x, .first = first, .second = second};
}

}  // namespace

PressureRatio exponential_pressure(double overlap_over_radius) noexcept {
  const double excess = k_excess * std::exp(-k_decay * overlap_over_radius);
  return {.value = 1.0 + excess, .slope = -k_decay * excess};
}

PressureMoments exponential_moments(double overlap_over_radius) noexcept {
  const double x = overlap_over_radius;
  const auto [zeroth, first, second] = decaying_moments(k_decay * x);
  const double scale = k_excess / k_decay;
  return {.zeroth = x + scale * zeroth,
          .first = 0.5 * x * x + scale / k_decay * first,
          .second = x * x * x / 3.0 + scale / (k_decay * k_decay) * second};
}

PressureCurve::PressureCurve(std::span<const double> overlaps_over_radius, std::span<const double> pressures_over_yield)
    : knots_(overlaps_over_radius.begin(), overlaps_over_radius.end()) {
  const std::vector<double> p(pressures_over_yield.begin(), pressures_over_yield.end());
  check_samples(knots_, p);
  const boost::math::interpolators::pchip<std::vector<double>> curve{std::vector<double>(knots_),
                                                                     std::vector<double>(p)};
  // The cubics of the curve are written out, so that value, slope and moments take one search for the interval.
  PressureMoments before;
  for (std::size_t i = 0; i + 1 < knots_.size(); ++i) {
    const double h = knots_[i + 1] - knots_[i];
    const double secant = (p[i + 1] - p[i]) / h;
    const double left = curve.prime(knots_[i]);
    const double right = curve.prime(knots_[i + 1]);
    pieces_.push_back({.constant = p[i],
                       .linear = left,
                       .quadratic = (3.0 * secant - 2.0 * left - right) / h,
                       .cubic = (left + right - 2.0 * secant) / (h * h),
                       .before = before});
    before = moments_in(i, h);
    const Piece& piece = pieces_.back();
    require(std::isfinite(piece.linear) && std::isfinite(piece.quadratic) && std::isfinite(piece.cubic),
            "samples of a pressure curve are too steep");
  }
}

std::size_t PressureCurve::piece_at(double overlap_over_radius) const {
  if (!(overlap_over_radius >= 0.0 && overlap_over_radius <= knots_.back())) {
    throw DomainError(
        Limit::pressure_table_end,
        "overlap over apparent radius outside the pressure table, which ends at " + std::to_string(knots_.back()));
  }
  // The last knot belongs to the piece before it.
  const auto next = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, overlap_over_radius);
  return static_cast<std::size_t>(next - knots_.begin()) - 1;
}

PressureRatio PressureCurve::at(double overlap_over_radius) const {
  const std::size_t i = piece_at(overlap_over_radius);
  const Piece& piece = pieces_[i];
  const double t = overlap_over_radius - knots_[i];
  return {.value = piece.constant + t * (piece.linear + t * (piece.quadratic + t * piece.cubic)),
          .slope = piece.linear + t * (2.0 * piece.quadratic + t * 3.0 * piece.cubic)};
}

double PressureCurve::knot_beyond(double overlap_over_radius, double rate) const noexcept {
  if (rate > 0.0) {
    const auto knot = std::ranges::upper_bound(knots_, overlap_over_radius);
    return knot == knots_.end() ? k_infinity : *knot;
  }
  const auto knot = std::ranges::lower_bound(knots_, overlap_over_radius);
  return knot == knots_.begin() ? -k_infinity : *std::prev(knot);
}

PressureMoments PressureCurve::moments(double overlap_over_radius) const {
  const std::size_t i = piece_at(overlap_over_radius);
  return moments_in(i, overlap_over_radius - knots_[i]);
}

PressureMoments PressureCurve::moments_in(std::size_t piece, double offset) const noexcept {
  const auto& [constant, linear, quadratic, cubic, before] = pieces_[piece];
  const double t = offset;
  // Moments about the knot, then about zero.
  const double zeroth = t * (constant + t * (linear / 2.0 + t * (quadratic / 3.0 + t * cubic / 4.0)));
  const double first = t * t * (constant / 2.0 + t * (linear / 3.0 + t * (quadratic / 4.0 + t * cubic / 5.0)));
  const double second = t * t * t * (constant / 3.0 + t * (linear / 4.0 + t * (quadratic / 5.0 + t * cubic / 6.0)));
  const double knot = knots_[piece];
  return {.zeroth = before.zeroth + zeroth,
          .first = before.first + (knot * zeroth + first),
          .second = before.second + (knot * (knot * zeroth + 2.0 * first) + second)};
}

}  // namespace monograin::mdr
