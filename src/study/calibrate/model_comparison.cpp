#include "study/calibrate/model_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "figure/page.hpp"
#include "history/table.hpp"
#include "history/turns.hpp"
#include "scenario/text_file.hpp"
#include "study/calibrate/calibration_figure.hpp"
#include "study/calibrate/text_table.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

// Difference of criteria below which the data do not decide between models (Kass and Raftery (1995)).
constexpr double k_undecided = 2.0;

/// Rows of the data that are left out together.
struct Part {
  std::size_t begin = 0;
  std::size_t end = 0;
};

struct Parts {
  std::vector<Part> list;
  bool are_cycles = false;
};

/// Parts of the data. A cycle begins where x moves as it did first.
Parts parts_of(const Calibration& calibration) {
  std::vector<Part> cycles;
  std::vector<Part> stretches;
  for (const MeasuredCurve& curve : calibration.curves) {
    const std::span<const double> x = curve.rows_of(calibration.x.values);
    std::vector<std::size_t> turns;
    for (const Turn& turn : turns_of(x, turning_points(x))) turns.push_back(turn.last_row);
    for (std::size_t k = 0; k + 1 < turns.size(); ++k) {
      // The last row before a turn belongs to the stretch that ends there.
      const Part stretch{curve.begin + (k == 0 ? 0 : turns[k] + 1), curve.begin + turns[k + 1] + 1};
      stretches.push_back(stretch);
      const bool rises = x[turns[k + 1]] > x[turns[k]];
      if (k == 0 || rises == (x[turns[1]] > x[turns[0]])) {
        cycles.push_back(stretch);
      } else {
        cycles.back().end = stretch.end;
      }
    }
  }
  if (cycles.size() > 1) return {std::move(cycles), true};
  if (stretches.size() > 1) return {std::move(stretches), false};
  return {};
}

/// Sum of the squared differences of a part from a fit to the others; none if there is no such fit.
std::optional<double> squares_of_prediction(const Calibration& calibration, const Part& part) {
  Calibration others = calibration;
  std::fill(others.weights.begin() + static_cast<std::ptrdiff_t>(part.begin),
            others.weights.begin() + static_cast<std::ptrdiff_t>(part.end), 0.0);
  if (others.counted() < others.free.size()) return std::nullopt;
  const auto response = best_response(others);
  if (!response) return std::nullopt;
  double squares = 0.0;
  for (std::size_t row = part.begin; row < part.end; ++row) {
    if (calibration.weights[row] > 0.0) squares += std::pow(calibration.y.values[row] - (*response)[row], 2);
  }
  return squares;
}

std::vector<std::size_t> best_first(const ModelComparison& comparison) {
  std::vector<std::size_t> order(comparison.fits.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return comparison.fits[k].bic; });
  return order;
}

Table table_of(std::span<const Calibration> calibrations, std::span<const CalibrationResult> results,
               const ModelComparison& comparison) {
  std::vector<std::string> names;
  std::vector<std::string> models;
  for (const Calibration& calibration : calibrations) {
    names.push_back(calibration.name);
    models.push_back(calibration.scenario.model);
  }
  const std::string& unit = calibrations.front().y.si;
  Table table({{"fit", "", names},
               {"model", "", models},
               {"parameters", "", {}},
               {"points", "", {}},
               {"rms", unit, {}},
               {"r_squared", "", {}},
               {"aic", "", {}},
               {"bic", "", {}},
               {"prediction_rms", unit, {}}});
  for (const std::size_t k : best_first(comparison)) {
    const RankedFit& fit = comparison.fits[k];
    const std::vector<double> row{static_cast<double>(k),
                                  static_cast<double>(k),
                                  static_cast<double>(fit.parameters),
                                  static_cast<double>(results[k].points),
                                  results[k].goodness.rms,
                                  results[k].goodness.r_squared,
                                  fit.aic,
                                  fit.bic,
                                  fit.prediction};
    table.append(row);
  }
  return table;
}

/// A value in the unit of y, or a dash.
std::string in_y(double value, const Calibration& calibration) {
  if (!std::isfinite(value)) return "-";
  return fmt::format("{:.4g} {}", value / calibration.y.unit_factor, calibration.y.unit);
}

}  // namespace

void check_comparable(std::span<const Calibration> calibrations) {
  const Calibration& first = calibrations.front();
  for (const Calibration& other : calibrations) {
    if (other.loss.kind != Loss::linear) {
      throw std::runtime_error(
          fmt::format("{}: criteria of a comparison are of sums of squares; expected loss = \"linear\"", other.file));
    }
    if (other.x.observable != first.x.observable || other.y.observable != first.y.observable ||
        other.x.values != first.x.values || other.y.values != first.y.values) {
      throw std::runtime_error(fmt::format(
          "{}: its data are not those of {}; expected the same columns of the same files", other.file, first.file));
    }
    const auto noise_of_x = [](const MeasuredCurve& curve) { return curve.noise.x; };
    if (other.weights != first.weights || !std::ranges::equal(other.curves, first.curves, {}, noise_of_x, noise_of_x)) {
      throw std::runtime_error(
          fmt::format("{}: its weights, or its noise, are not those of {}; expected the same", other.file, first.file));
    }
  }
  for (std::size_t k = 0; k < calibrations.size(); ++k) {
    for (std::size_t j = 0; j < k; ++j) {
      if (calibrations[j].name != calibrations[k].name) continue;
      throw std::runtime_error(fmt::format("{} and {} are both called '{}'; expected different names of the files",
                                           calibrations[j].file, calibrations[k].file, calibrations[k].name));
    }
  }
}

ModelComparison compare_models(std::span<const Calibration> calibrations, std::span<const CalibrationResult> results,
                               const std::function<void(double)>& progress) {
  check_comparable(calibrations);
  const Parts parts = parts_of(calibrations.front());
  ModelComparison comparison{.parts = parts.list.size(), .are_cycles = parts.are_cycles};
  const double steps = static_cast<double>(calibrations.size() * parts.list.size());
  double done = 0.0;
  for (std::size_t k = 0; k < calibrations.size(); ++k) {
    const Calibration& calibration = calibrations[k];
    const auto n = static_cast<double>(results[k].points);
    const double squares = results[k].goodness.sum_of_squares;
    const bool is_known = calibration.knows_noise();
    // If the noise is estimated, its size is a parameter, too.
    const auto parameters = static_cast<double>(calibration.free.size()) + (is_known ? 0.0 : 1.0);
    const double misfit = is_known ? squares + results[k].goodness.noise_growth : n * std::log(squares / n);
    double of_predictions = 0.0;
    for (const Part& part : parts.list) {
      of_predictions += squares_of_prediction(calibration, part).value_or(k_nan);
      if (progress) progress(++done / steps);
    }
    comparison.fits.push_back({.parameters = calibration.free.size(),
                               .aic = misfit + 2.0 * parameters,
                               .bic = misfit + std::log(n) * parameters,
                               .prediction = parts.list.empty() ? k_nan : std::sqrt(of_predictions / n)});
  }
  return comparison;
}

std::string comparison_text(std::span<const Calibration> calibrations, std::span<const CalibrationResult> results,
                            const ModelComparison& comparison) {
  const std::vector<std::size_t> order = best_first(comparison);
  std::vector<TextRow> rows{{"fit", "model", "parameters", "rms", "R^2", "AIC", "BIC", "rms of predictions"}};
  double least_aic = comparison.fits.front().aic;
  for (const RankedFit& fit : comparison.fits) least_aic = std::min(least_aic, fit.aic);
  const double least_bic = comparison.fits[order.front()].bic;
  for (const std::size_t k : order) {
    const RankedFit& fit = comparison.fits[k];
    rows.push_back({calibrations[k].name, calibrations[k].scenario.model, fmt::format("{}", fit.parameters),
                    in_y(results[k].goodness.rms, calibrations[k]),
                    fmt::format("{:.6f}", results[k].goodness.r_squared), fmt::format("+{:.1f}", fit.aic - least_aic),
                    fmt::format("+{:.1f}", fit.bic - least_bic), in_y(fit.prediction, calibrations[k])});
  }
  std::string text = aligned(rows) + '\n';
  if (comparison.parts > 0) {
    text += fmt::format("predictions: each of {} {} from a fit to the others\n", comparison.parts,
                        comparison.are_cycles ? "cycles" : "stretches between two turns");
  } else {
    text += "predictions: none, as the data neither turn nor are several curves\n";
  }
  const bool are_rival = order.size() > 1 && comparison.fits[order[1]].bic - least_bic < k_undecided;
  text += are_rival ? fmt::format("the data do not decide between '{}' and '{}'\n", calibrations[order[0]].name,
                                  calibrations[order[1]].name)
                    : fmt::format("the BIC is for '{}'\n", calibrations[order[0]].name);
  const auto is_dependent = [](const CalibrationResult& result) {
    return result.residual_tests && !result.residual_tests->are_independent();
  };
  if (std::ranges::any_of(results, is_dependent)) {
    text +=
        "AIC and BIC take residuals for independent, which they are not here: differences are too large, and "
        "predictions say more\n";
  }
  return text;
}

std::string comparison_report(std::span<const Calibration> calibrations, std::span<const CalibrationResult> results,
                              const ModelComparison& comparison, const std::string& figure) {
  std::string text = fmt::format("# Fits to {}\n\n```text\n{}```\n", data_names(calibrations.front()),
                                 comparison_text(calibrations, results, comparison));
  if (!figure.empty()) text += fmt::format("\n![data, fits and residuals]({})\n", figure);
  text += "\n## Reports of the fits\n\n";
  for (const Calibration& calibration : calibrations) {
    text += fmt::format("- [{0}]({0}/report.md)\n", calibration.name);
  }
  return text;
}

std::string write_comparison(std::span<const Calibration> calibrations, std::span<const CalibrationResult> results,
                             const ModelComparison& comparison, StagedFolder& folder, bool has_report,
                             std::string_view format) {
  write_text_file(folder.path() / k_comparison_marker, csv_text(table_of(calibrations, results, comparison)));
  const std::string figure = fmt::format("comparison.{}", format);
  std::string problem = draw_comparison(calibrations, results, folder.path() / figure);
  if (has_report) {
    write_text_file(folder.path() / "report.md",
                    comparison_report(calibrations, results, comparison, problem.empty() ? figure : ""));
  }
  folder.publish(folder.age());
  return problem;
}

}  // namespace monograin
