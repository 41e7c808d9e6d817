#include "study/calibrate/thinning.hpp"

#include <span>
#include <vector>

#include "history/turns.hpp"

namespace monograin {
namespace {

/// Rows of one curve to keep: the turning points, and every `stride`-th row between them that advances in x.
std::vector<std::size_t> rows_to_keep(std::span<const double> x, std::size_t stride) {
  std::vector<std::size_t> kept;
  const std::vector<std::size_t> turns = turning_points(x);
  for (std::size_t k = 1; k < turns.size(); ++k) {
    const double end = x[turns[k]];
    const bool rises = end > x[turns[k - 1]];
    if (kept.empty()) kept.push_back(turns[k - 1]);
    for (std::size_t row = turns[k - 1] + stride; row < turns[k]; row += stride) {
      const double from = x[kept.back()];
      if (rises ? x[row] > from && x[row] < end : x[row] < from && x[row] > end) kept.push_back(row);
    }
    kept.push_back(turns[k]);
  }
  return kept;
}

}  // namespace

Calibration thinned(const Calibration& calibration, std::size_t rows) {
  Calibration thin = calibration;
  thin.x.values.clear();
  thin.y.values.clear();
  thin.weights.clear();
  thin.lines.clear();
  const std::size_t stride = (calibration.x.values.size() + rows - 1) / rows;
  for (MeasuredCurve& curve : thin.curves) {
    const std::size_t begin = thin.lines.size();
    for (const std::size_t row : rows_to_keep(curve.rows_of(calibration.x.values), stride)) {
      const std::size_t from = curve.begin + row;
      thin.x.values.push_back(calibration.x.values[from]);
      thin.y.values.push_back(calibration.y.values[from]);
      thin.weights.push_back(calibration.weights[from]);
      thin.lines.push_back(calibration.lines[from]);
    }
    curve.begin = begin;
    curve.end = thin.lines.size();
  }
  return thin;
}

}  // namespace monograin
