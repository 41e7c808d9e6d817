#include "history/branches.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "system/undefined.hpp"

namespace monograin {
namespace {

constexpr double k_slope_share = 0.05;         ///< of the force at the reversal, by which it falls for the slope
constexpr double k_same_reversal = 0.01;       ///< share of x within which two reversals are one
constexpr double k_worth_a_line = 1.0 + 1e-3;  ///< loading beyond the last reversal, relative to its x
constexpr double k_round_off = 1e-12;          ///< share of the force at the reversal that is none

[[nodiscard]] XyCurve up_to(const XyCurve& loading, double x) {
  const auto end = std::ranges::upper_bound(loading.x, x);
  const auto count = end - loading.x.begin();
  return {{loading.x.begin(), end}, {loading.y.begin(), loading.y.begin() + count}};
}

[[nodiscard]] const XyCurve* unloading_from(const std::vector<XyCurve>& unloadings, double reversal) {
  const auto found = std::ranges::find_if(unloadings, [&](const XyCurve& unloading) {
    return std::abs(unloading.x.front() - reversal) <= k_same_reversal * std::abs(reversal);
  });
  return found == unloadings.end() ? nullptr : &*found;
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
  double largest = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < curve.x.size(); ++k) {
    if (!(curve.x[k] > largest) || !std::isfinite(curve.y[k])) continue;
    largest = curve.x[k];
    loading.x.push_back(curve.x[k]);
    loading.y.push_back(curve.y[k]);
  }
  return loading;
}

std::vector<XyCurve> unloadings(const XyCurve& curve) {
  std::vector<XyCurve> result;
  double largest = -std::numeric_limits<double>::infinity();
  std::size_t turn = 0;  // the last row at the largest x
  bool is_back = false;  // on the way back from there
  for (std::size_t k = 0; k < curve.x.size(); ++k) {
    const double x = curve.x[k];
    if (std::isnan(x)) continue;
    if (x >= largest) {
      largest = x;
      turn = k;
      is_back = false;
    } else if (turn + 1 == k) {
      is_back = true;
      result.push_back({{curve.x[turn], x}, {curve.y[turn], curve.y[k]}});
    } else if (is_back) {
      is_back = x <= result.back().x.back();
      if (!is_back) continue;
      result.back().x.push_back(x);
      result.back().y.push_back(curve.y[k]);
    }
  }
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
  const double none = k_round_off * unloading.y.front();
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
  const auto own_unloadings = unloadings(curve);
  std::vector<BranchComparison> lines;
  for (const XyCurve& unloading : unloadings(reference)) {
    const double reversal = unloading.x.front();
    BranchComparison line{.reversal = reversal,
                          .slope = k_nan,
                          .reference_slope = unloading_slope(unloading),
                          .residual = k_nan,
                          .reference_residual = residual_displacement(unloading)};
    compare_loading(loading, own_loading, line);
    if (const XyCurve* own = unloading_from(own_unloadings, reversal)) {
      line.slope = unloading_slope(*own);
      line.residual = residual_displacement(*own);
    }
    lines.push_back(line);
  }
  const bool goes_on =
      !loading.x.empty() && (lines.empty() || loading.x.back() > k_worth_a_line * lines.back().reversal);
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

}  // namespace monograin
