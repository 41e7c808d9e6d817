#include "history/branches.hpp"

#include <algorithm>
#include <cmath>

#include "system/resolution.hpp"

namespace monograin {
namespace {

constexpr double k_slope_share = 0.05;    ///< fall of the force that gives the slope, over the force at the reversal
constexpr double k_same_reversal = 0.01;  ///< largest distance of equal reversals, over their x
constexpr double k_same_end = 1e-6;       ///< largest distance beyond the end of a piece that has a value, over x

[[nodiscard]] XyCurve up_to(const XyCurve& loading, double x) {
  const auto end = std::ranges::upper_bound(loading.x, x);
  const auto count = end - loading.x.begin();
  return {{loading.x.begin(), end}, {loading.y.begin(), loading.y.begin() + count}};
}

[[nodiscard]] const Excursion* excursion_from(const std::vector<Excursion>& excursions, double reversal) {
  const auto found = std::ranges::find_if(excursions, [&](const Excursion& excursion) {
    return std::abs(excursion.back.x.front() - reversal) <= k_same_reversal * std::abs(reversal);
  });
  return found == excursions.end() ? nullptr : &*found;
}

/// y at x by linear interpolation in a piece with monotone x; NaN beyond its ends.
[[nodiscard]] double value_at(const XyCurve& piece, double x) {
  if (piece.x.empty()) return k_nan;
  const double direction = piece.x.back() < piece.x.front() ? -1.0 : 1.0;
  const double reach = k_same_end * std::max(std::abs(piece.x.front()), std::abs(piece.x.back()));
  const auto along = [direction](double value) { return direction * value; };
  const auto next = std::ranges::lower_bound(piece.x, along(x), {}, along);
  const auto row = static_cast<std::size_t>(next - piece.x.begin());
  if (next == piece.x.end()) return std::abs(x - piece.x.back()) <= reach ? piece.y.back() : k_nan;
  if (row == 0) return std::abs(x - piece.x.front()) <= reach ? piece.y.front() : k_nan;
  return std::lerp(piece.y[row - 1], piece.y[row], (x - piece.x[row - 1]) / (piece.x[row] - piece.x[row - 1]));
}

/// Largest |y| distance of two pieces with monotone x, at the rows of the reference after its first one; NaN if they
/// have no common range.
[[nodiscard]] double largest_distance(const XyCurve& reference, const XyCurve& curve) {
  double largest = k_nan;
  for (std::size_t k = 1; k < reference.x.size(); ++k) {
    largest = std::fmax(largest, std::abs(value_at(curve, reference.x[k]) - reference.y[k]));
  }
  return largest;
}

/// Largest |y| of the rows before x is first exceeded.
[[nodiscard]] double largest_before(const XyCurve& curve, double x) {
  double largest = 0.0;
  for (std::size_t k = 0; k < curve.x.size() && !(curve.x[k] > x); ++k) {
    largest = std::fmax(largest, std::abs(curve.y[k]));
  }
  return largest;
}

void compare_loading(const XyCurve& reference, const XyCurve& curve, BranchComparison& line) {
  const XyCurve part = up_to(reference, line.reversal);
  const CurveDifference difference = compare_curves(part.x, part.y, curve.x, curve.y);
  line.area_error = difference.area_error;
  line.peak_error = difference.peak_error;
  line.coverage = difference.coverage;
}

}  // namespace

XyCurve first_loading(const XyCurve& curve) {
  XyCurve loading;
  double largest = -k_infinity;
  for (std::size_t k = 0; k < curve.x.size(); ++k) {
    if (!(curve.x[k] > largest) || !std::isfinite(curve.y[k])) continue;
    largest = curve.x[k];
    loading.x.push_back(curve.x[k]);
    loading.y.push_back(curve.y[k]);
  }
  return loading;
}

std::vector<Excursion> excursions(const XyCurve& curve) {
  enum class Phase { loading, unloading, reloading, none };  // none: x falls again before the reload is complete
  std::vector<Excursion> result;
  double largest = -k_infinity;
  std::size_t turn = 0;  // the last row at the largest x
  Phase phase = Phase::loading;
  for (std::size_t k = 0; k < curve.x.size(); ++k) {
    const double x = curve.x[k];
    if (std::isnan(x)) continue;
    const auto append = [&](XyCurve& piece) {
      piece.x.push_back(x);
      piece.y.push_back(curve.y[k]);
    };
    if (phase == Phase::unloading && x > result.back().back.x.back()) {
      XyCurve& back = result.back().back;
      result.back().forth = {{back.x.back()}, {back.y.back()}};
      phase = Phase::reloading;
    } else if (phase == Phase::reloading && x < result.back().forth.x.back()) {
      phase = Phase::none;
    }
    if (phase == Phase::reloading) append(result.back().forth);
    if (x >= largest) {
      largest = x;
      turn = k;
      phase = Phase::loading;
    } else if (turn + 1 == k) {
      phase = Phase::unloading;
      result.push_back({.back = {{curve.x[turn], x}, {curve.y[turn], curve.y[k]}}});
    } else if (phase == Phase::unloading) {
      append(result.back().back);
    }
  }
  return result;
}

std::vector<XyCurve> unloadings(const XyCurve& curve) {
  std::vector<XyCurve> result;
  for (Excursion& excursion : excursions(curve)) result.push_back(std::move(excursion.back));
  return result;
}

double unloading_slope(const XyCurve& unloading) {
  const double top = unloading.y.front();
  const double level = (1.0 - k_slope_share) * top;
  for (std::size_t k = 1; k < unloading.x.size(); ++k) {
    if (!(unloading.y[k] <= level)) continue;
    const double share = (unloading.y[k - 1] - level) / (unloading.y[k - 1] - unloading.y[k]);
    const double x = std::lerp(unloading.x[k - 1], unloading.x[k], share);
    return (top - level) / (unloading.x.front() - x);
  }
  return (top - unloading.y.back()) / (unloading.x.front() - unloading.x.back());
}

double residual_displacement(const XyCurve& unloading) {
  const double none = k_same_value * unloading.y.front();
  for (std::size_t k = 1; k < unloading.x.size(); ++k) {
    if (!(unloading.y[k] <= none)) continue;
    if (k < 2) return unloading.x[k];
    const auto reduced = [&](std::size_t row) { return std::pow(std::max(unloading.y[row], 0.0), 2.0 / 3.0); };
    const double slope = (reduced(k - 2) - reduced(k - 1)) / (unloading.x[k - 2] - unloading.x[k - 1]);
    const double x = unloading.x[k - 1] - reduced(k - 1) / slope;
    return std::isfinite(x) ? std::clamp(x, unloading.x[k], unloading.x[k - 1]) : unloading.x[k];
  }
  return k_nan;
}

std::vector<BranchComparison> compare_branches(const XyCurve& reference, const XyCurve& curve) {
  const XyCurve loading = first_loading(reference);
  const XyCurve own_loading = first_loading(curve);
  const auto own_excursions = excursions(curve);
  std::vector<BranchComparison> lines;
  for (const XyCurve& unloading : unloadings(reference)) {
    const double reversal = unloading.x.front();
    BranchComparison line{.reversal = reversal,
                          .slope = k_nan,
                          .reference_slope = unloading_slope(unloading),
                          .residual = k_nan,
                          .reference_residual = residual_displacement(unloading)};
    compare_loading(loading, own_loading, line);
    if (const Excursion* own = excursion_from(own_excursions, reversal)) {
      line.slope = unloading_slope(own->back);
      line.residual = residual_displacement(own->back);
    }
    lines.push_back(line);
  }
  const bool goes_on =
      !loading.x.empty() && (lines.empty() || loading.x.back() > (1.0 + k_same_reversal) * lines.back().reversal);
  if (goes_on) {
    lines.push_back({.reversal = loading.x.back(),
                     .slope = k_nan,
                     .reference_slope = k_nan,
                     .residual = k_nan,
                     .reference_residual = k_nan});
    compare_loading(loading, own_loading, lines.back());
  }
  return lines;
}

std::vector<BranchComparison> compare_bands(const XyCurve& reference, const XyCurve& curve,
                                            std::span<const double> bands, double least) {
  const XyCurve loading = first_loading(reference);
  const XyCurve own_loading = first_loading(curve);
  const auto reference_excursions = excursions(reference);
  const auto own_excursions = excursions(curve);
  std::vector<BranchComparison> lines;
  for (std::size_t band = 1; band < bands.size(); ++band) {
    const double from = bands[band - 1];
    const double to = bands[band];
    BranchComparison line{.reversal = to,
                          .area_error = k_nan,
                          .peak_error = k_nan,
                          .slope = k_nan,
                          .reference_slope = k_nan,
                          .residual = k_nan,
                          .reference_residual = k_nan};
    double rows = 0.0;
    double compared = 0.0;
    double sum = 0.0;
    for (std::size_t k = 0; k < loading.x.size(); ++k) {
      if (!(loading.x[k] >= from && loading.x[k] <= to)) continue;
      ++rows;
      if (!(std::abs(loading.y[k]) > least)) continue;
      const double distance = value_at(own_loading, loading.x[k]) / loading.y[k] - 1.0;
      if (!std::isfinite(distance)) continue;
      ++compared;
      sum += distance * distance;
      line.largest = std::fmax(line.largest, std::abs(distance));
    }
    line.coverage = rows > 0.0 ? compared / rows : k_nan;
    if (compared > 0.0) line.rms = std::sqrt(sum / compared);
    for (const Excursion& excursion : reference_excursions) {
      const double reversal = excursion.back.x.front();
      if (!(reversal > from && reversal <= to)) continue;
      const Excursion* own = excursion_from(own_excursions, reversal);
      if (own == nullptr) continue;
      const double distance =
          std::fmax(largest_distance(excursion.back, own->back), largest_distance(excursion.forth, own->forth));
      line.unloading = std::fmax(line.unloading, distance / largest_before(reference, reversal));
    }
    lines.push_back(line);
  }
  return lines;
}

}  // namespace monograin
