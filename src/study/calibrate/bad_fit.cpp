#include "study/calibrate/bad_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "scenario/units.hpp"
#include "study/calibrate/calibration_language.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

constexpr double k_thousand = 1e3;
constexpr double k_very_strong = 10.0;   // difference of the BIC (Kass and Raftery (1995))
constexpr double k_clearly_less = 0.25;  // share of the cost that a cause leaves, if more than noise is left

/// Lowest and highest y of the rows that count.
std::pair<double, double> range_of(const Calibration& calibration) {
  std::pair<double, double> range(k_infinity, -k_infinity);
  for (const std::size_t row : calibration.counted_rows()) {
    range.first = std::min(range.first, calibration.y.values[row]);
    range.second = std::max(range.second, calibration.y.values[row]);
  }
  return range;
}

/// A change of the data, with a clause that describes it.
struct Suspicion {
  std::string clause;
  Calibration changed;
  std::optional<std::size_t> offset{};  ///< index of a parameter that is a sought offset
};

void scale(MeasuredQuantity& quantity, double factor) {
  for (double& value : quantity.values) value *= factor;
}

/// Name of the unit that is larger or smaller by a factor; empty if there is none.
std::string_view other_unit(const MeasuredQuantity& quantity, double factor) {
  const auto dimension = calibration::dimension_of(quantity.si);
  if (!dimension) return {};
  const double wanted = quantity.unit_factor * factor;
  const auto& units = dimension_info(*dimension).units;
  const auto found =
      std::ranges::find_if(units, [=](const Unit& u) { return std::abs(u.factor / wanted - 1.0) < k_same_number; });
  return found == units.end() ? std::string_view() : found->symbol;
}

/// Multiplies x with its noise. @param factor  above zero
void scale_x(Calibration& calibration, double factor) {
  scale(calibration.x, factor);
  for (MeasuredCurve& curve : calibration.curves) curve.noise.x *= factor;
}

/// Multiplies y with its noise. @param factor  above zero
void scale_y(Calibration& calibration, double factor) {
  scale(calibration.y, factor);
  for (double& weight : calibration.weights) weight /= factor;
  for (MeasuredCurve& curve : calibration.curves) curve.noise.absolute *= factor;
}

/// Multiplies the measured displacement, with what the machine adds to it.
void scale_displacement(Calibration& calibration, double factor) {
  (calibration.machine_moves_x() ? scale_x : scale_y)(calibration, factor);
  for (MeasuredCurve& curve : calibration.curves) {
    curve.machine.offset *= factor;
    curve.machine.compliance *= factor;
    for (double& deflection : curve.machine.deflections) deflection *= factor;
  }
  for (FreeParameter& parameter : calibration.free) {
    const std::string& path = parameter.key.path;
    if (path != calibration::k_offset && path != calibration::k_compliance) continue;
    parameter.lower *= factor;
    parameter.upper *= factor;
    if (parameter.start) *parameter.start *= factor;
    if (!parameter.prior) continue;
    parameter.prior->first *= factor;
    if (parameter.prior->kind != Prior::Kind::lognormal) parameter.prior->second *= factor;
  }
}

/// Adds the suspicions that another number of walls moves than the displacement is of. A wrong factor of the force
/// cannot be found: modulus and yield stress absorb it.
void add_numbers_of_walls(const Calibration& calibration, std::vector<Suspicion>& suspicions) {
  const MeasuredQuantity& moved = calibration.machine_moves_x() ? calibration.x : calibration.y;
  if (!moved.observable.ends_with(".displacement")) return;
  const char* name = calibration.machine_moves_x() ? "x" : "y";
  const double present = calibration.curves.front().scales[calibration.machine_moves_x() ? 0 : 1];
  for (const auto& [factor, clause] :
       {std::pair(0.5, "the displacement, that of two walls, or of one wall towards another at rest"),
        std::pair(2.0, "the displacement, half of that of a wall")}) {
    Suspicion suspicion{fmt::format("{}: with scale = {:g} in {}", clause, factor * present, name), calibration};
    scale_displacement(suspicion.changed, factor);
    suspicions.push_back(std::move(suspicion));
  }
}

void add_units(const Calibration& calibration, std::vector<Suspicion>& suspicions) {
  for (const auto quantity : {&Calibration::x, &Calibration::y}) {
    for (const double factor : {k_thousand, 1.0 / k_thousand}) {
      const std::string_view unit = other_unit(calibration.*quantity, factor);
      if (unit.empty()) continue;
      const char* name = quantity == &Calibration::x ? "x" : "y";
      Suspicion suspicion{
          fmt::format("the unit of {}: with {} instead of {}", name, unit, (calibration.*quantity).unit), calibration};
      (quantity == &Calibration::x ? scale_x : scale_y)(suspicion.changed, factor);
      suspicions.push_back(std::move(suspicion));
    }
  }
}

void add_signs(const Calibration& calibration, std::vector<Suspicion>& suspicions) {
  const std::array<double, 2>& scales = calibration.curves.front().scales;
  const std::string x = fmt::format("scale = {:g} in x", -scales[0]);
  const std::string y = fmt::format("scale = {:g} in y", -scales[1]);
  for (const auto& [of_x, of_y, clause] :
       {std::tuple(true, true, fmt::format("the signs of x and y: with {} and {}", x, y)),
        std::tuple(true, false, "the sign of x: with " + x), std::tuple(false, true, "the sign of y: with " + y)}) {
    Suspicion suspicion{clause, calibration};
    if (of_x) scale(suspicion.changed.x, -1.0);
    if (of_y) scale(suspicion.changed.y, -1.0);
    suspicions.push_back(std::move(suspicion));
  }
}

/// Adds the suspicion that first touch lies elsewhere within the measured displacements, unless the offset is free.
void add_offset(const Calibration& calibration, std::vector<Suspicion>& suspicions) {
  const MeasuredQuantity& moved = calibration.machine_moves_x() ? calibration.x : calibration.y;
  const bool has_room = calibration.free.size() < std::min(k_most_parameters, calibration.counted());
  if (!moved.observable.ends_with(".displacement") || calibration.find_free(calibration::k_offset) != nullptr ||
      !has_room)
    return;
  const auto [lowest, highest] = std::ranges::minmax(moved.values);
  FreeParameter offset;
  offset.lower = lowest;
  offset.upper = highest;
  offset.key = calibration::machine_keys().front();
  offset.unit = moved.unit;
  offset.unit_factor = moved.unit_factor;
  Suspicion suspicion{"the first touch: with data.offset =", calibration, calibration.free.size()};
  suspicion.changed.free.push_back(std::move(offset));
  suspicions.push_back(std::move(suspicion));
}

/// Name of the measure of the fit: "R^2", or a longer one if rows count differently.
std::string measure_of(const Calibration& calibration) {
  const bool is_plain = calibration.weighting == "absolute" && calibration.loss.kind == Loss::linear;
  return is_plain ? "R^2" : "R^2 with the weights and the loss of the fit";
}

}  // namespace

bool is_constant(const Calibration& calibration) {
  const auto [lowest, highest] = range_of(calibration);
  return highest - lowest <= k_same_number * std::max(std::abs(lowest), std::abs(highest));
}

double explained_share(const Calibration& calibration, std::span<const double> weights, double cost) {
  if (is_constant(calibration)) return k_nan;
  const std::vector<std::size_t> rows = calibration.counted_rows();
  const auto cost_of = [&](double constant) {
    double sum = 0.0;
    for (const std::size_t row : rows) {
      sum += calibration.loss.rho(weights[row] * (calibration.y.values[row] - constant));
    }
    return sum;
  };
  const auto [lowest, highest] = range_of(calibration);
  constexpr int k_digits = std::numeric_limits<double>::digits / 2;
  const auto [constant, least] = boost::math::tools::brent_find_minima(cost_of, lowest, highest, k_digits);
  return 1.0 - cost / least;
}

std::string likely_cause(const Calibration& calibration, const FitTrial& fit) {
  std::vector<Suspicion> suspicions;
  add_units(calibration, suspicions);
  add_signs(calibration, suspicions);
  add_offset(calibration, suspicions);
  add_numbers_of_walls(calibration, suspicions);
  double best = k_least_explained;
  std::string cause;
  for (const Suspicion& suspicion : suspicions) {
    const TrialFit trial = fit(suspicion.changed);
    if (!(trial.explained > best)) continue;
    best = trial.explained;
    cause = suspicion.clause;
    if (suspicion.offset) {
      const FreeParameter& offset = suspicion.changed.free[*suspicion.offset];
      cause += fmt::format(" \"{:.4g} {}\"", trial.parameters[*suspicion.offset] / offset.unit_factor, offset.unit);
    }
    cause += fmt::format(", {} is {:.4f}", measure_of(calibration), trial.explained);
  }
  return cause;
}

std::string doubt_displacement(const Calibration& calibration, const CalibrationResult& result, const FitTrial& fit) {
  if (!result.residual_tests || result.residual_tests->are_independent()) return {};
  std::vector<Suspicion> suspicions;
  add_numbers_of_walls(calibration, suspicions);
  double least = 1.0;
  std::string doubt;
  for (const Suspicion& suspicion : suspicions) {
    const TrialFit trial = fit(suspicion.changed);
    const double left = (1.0 - trial.explained) / (1.0 - result.goodness.explained);  // share of the cost
    const double difference = -static_cast<double>(result.points) * std::log(left);   // of the BIC, if that is noise
    const bool is_clear = trial.is_noise ? difference > k_very_strong : left < k_clearly_less;
    if (!is_clear || !(left < least)) continue;
    least = left;
    doubt = fmt::format("the residuals are not noise; likely cause: {}, they are {:.2g} times as large{}",
                        suspicion.clause, std::sqrt(left), trial.is_noise ? ", and noise" : "");
  }
  if (doubt.empty()) return {};
  return doubt + "; a scenario whose walls move as those of the machine needs no scale";
}

std::vector<std::string> warnings_of(const Calibration& calibration, const CalibrationResult& result,
                                     const FitTrial& fit) {
  if (result.uncertainty.degrees_of_freedom == 0) return {};
  if (result.goodness.explained >= k_least_explained) {
    std::string doubt = doubt_displacement(calibration, result, fit);
    return doubt.empty() ? std::vector<std::string>() : std::vector{std::move(doubt)};
  }
  // A robust loss hardly tells the constant from a fit where its scale is as small as the noise.
  if (calibration.loss.kind != Loss::linear && result.goodness.r_squared >= k_least_explained) return {};
  if (is_constant(calibration)) {
    return {"y is the same in every row: the data say nothing of the parameters; expected the column that changes"};
  }
  const auto rows = calibration.counted_rows();
  const bool never_touches = std::ranges::all_of(rows, [&result](std::size_t row) { return result.fit.y[row] == 0.0; });
  std::string warning = never_touches ? "no datum touches the particle: the fit is zero in every row"
                                      : fmt::format("the fit is {}: {} = {:.4g}",
                                                    result.goodness.explained < 0.0 ? "worse than a constant" : "bad",
                                                    measure_of(calibration), result.goodness.explained);
  const std::string cause = likely_cause(calibration, fit);
  warning +=
      cause.empty()
          ? "; no other unit, sign or first touch, and neither half nor twice the displacement makes it good: check "
            "data, law and bounds"
          : "; likely cause: " + cause;
  return {std::move(warning)};
}

}  // namespace monograin
