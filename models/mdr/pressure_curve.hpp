/// Mean pressure of a fully plastic contact over the yield stress, p_Y/Y, as a function of x = delta/R: the only
/// ingredient of the MDR model that is fitted to computed contacts, and hence the one that another material replaces.
/// Source: Zunker and Kamrin (2024), eq. 28.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace monograin::mdr {

/// p_Y/Y [-] and its derivative with respect to x.
struct PressureRatio {
  double value = 0.0;
  double slope = 0.0;
};

/// The integrals of p_Y/Y x^n over x from 0, for n = 0, 1, 2.
struct PressureMoments {
  double zeroth = 0.0;
  double first = 0.0;
  double second = 0.0;
};

/// The source's fit for perfectly plastic particles: 1 + 1.75 exp(-4.4 x) (eq. 28, constants as printed).
[[nodiscard]] PressureRatio exponential_pressure(double overlap_over_radius) noexcept;

/// Moments of exponential_pressure(), for x > 0, to full relative accuracy.
[[nodiscard]] PressureMoments exponential_moments(double overlap_over_radius) noexcept;

/// Curve of p_Y/Y through samples: piecewise cubic, once continuously differentiable, and monotone between neighbouring
/// samples (Fritsch and Butland), so that it has no waves beyond those of the samples.
class PressureCurve {
 public:
  /// @param overlaps_over_radius  x of the samples: at least 4, ascending, the first 0
  /// @param pressures_over_yield  p_Y/Y there: as many, > 0
  /// @throws std::invalid_argument for samples that break these rules or are not finite
  PressureCurve(std::span<const double> overlaps_over_radius, std::span<const double> pressures_over_yield);

  /// p_Y/Y and its slope. Does not allocate.
  /// @param overlap_over_radius  x, in [0, end()]
  /// @throws std::domain_error beyond the last sample, where the curve is unknown; the message names end()
  [[nodiscard]] PressureRatio at(double overlap_over_radius) const;
  /// Moments of p_Y/Y from 0 to x. Does not allocate.
  /// @param overlap_over_radius  x, in [0, end()]
  /// @throws std::domain_error as at()
  [[nodiscard]] PressureMoments moments(double overlap_over_radius) const;

  /// x of the last sample.
  [[nodiscard]] double end() const noexcept { return knots_.back(); }
  /// First knot beyond x in the direction of a rate: where the second derivative of the curve jumps.
  /// @param overlap_over_radius  x, any
  /// @param rate                 of x, not 0
  /// @return infinity, with the sign of the rate, if no knot lies there
  [[nodiscard]] double knot_beyond(double overlap_over_radius, double rate) const noexcept;
  /// x of all samples.
  [[nodiscard]] std::span<const double> knots() const noexcept { return knots_; }

 private:
  /// Between a knot and the next, with t = x - knot: p_Y/Y = constant + linear t + quadratic t^2 + cubic t^3.
  struct Piece {
    double constant, linear, quadratic, cubic;
    PressureMoments before;  ///< moments from 0 to the knot
  };

  [[nodiscard]] std::size_t piece_at(double overlap_over_radius) const;
  [[nodiscard]] PressureMoments moments_in(std::size_t piece, double offset) const noexcept;

  std::vector<double> knots_;
  std::vector<Piece> pieces_;
};

}  // namespace monograin::mdr
