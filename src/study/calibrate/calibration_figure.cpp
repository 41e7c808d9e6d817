#include "study/calibrate/calibration_figure.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

#include "catalogue.hpp"
#include "figure/chart.hpp"
#include "figure/page.hpp"
#include "study/calibrate/calibration_text.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t k_most_panels = 5;  ///< for residuals of curves

/// Label of an axis, with the observable's last part and the unit: "Contact radius [mm]".
std::string label_of(const MeasuredQuantity& quantity) {
  std::string name = quantity.observable.substr(quantity.observable.rfind('.') + 1);
  std::ranges::replace(name, '_', ' ');
  name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  const std::string unit = quantity.unit == "R0" ? "{/Helvetica-Oblique R}_0" : quantity.unit;
  return quantity.unit == "-" ? name : fmt::format("{} [{}]", name, unit);
}

std::vector<double> in_unit(const std::vector<double>& values, const MeasuredQuantity& quantity) {
  std::vector<double> result = values;
  for (double& value : result) value /= quantity.unit_factor;
  return result;
}

/// Name of a curve: its overrides, else its file.
/// @param has_sections  true: keys with the names of their sections
std::string name_of(const MeasuredCurve& curve, bool has_sections) {
  if (curve.overrides.empty()) return fs::path(curve.file).stem().string();
  std::vector<std::string> overrides = curve.overrides;
  for (std::string& text : overrides) {
    if (!has_sections) text = text.substr(text.substr(0, text.find('=')).rfind('.') + 1);
  }
  return fmt::format("{}", fmt::join(overrides, ", "));
}

/// Names of all curves as gnuplot's enhanced text. Sections are left out unless they tell curves apart.
std::vector<std::string> names_of(const std::vector<MeasuredCurve>& curves) {
  std::vector<std::string> names;
  for (const bool has_sections : {false, true}) {
    names.clear();
    for (const MeasuredCurve& curve : curves) names.push_back(figure::verbatim_text(name_of(curve, has_sections)));
    if (std::set<std::string>(names.begin(), names.end()).size() == names.size()) break;
  }
  return names;
}

/// Gives panels the same ordinate, so that they can be compared.
void share_ordinate(std::span<figure::ChartPanel> panels) {
  constexpr double k_air = 0.05;  // share of the range left free beyond the values
  double lowest = 0.0;
  double highest = 0.0;
  const auto include = [&](const std::vector<double>& values) {
    for (const double value : values) {
      lowest = std::fmin(lowest, value);
      highest = std::fmax(highest, value);
    }
  };
  for (const figure::ChartPanel& panel : panels) {
    for (const figure::ChartSeries& series : panel.series) include(series.y);
    for (const figure::ChartBand& band : panel.bands) {
      include(band.lower);
      include(band.upper);
    }
  }
  if (!(lowest < highest)) return;
  for (figure::ChartPanel& panel : panels) {
    panel.y.lowest = lowest - k_air * (highest - lowest);
    panel.y.highest = highest + k_air * (highest - lowest);
  }
}

/// "Data - fit: force [N]".
std::string data_less_fit(std::string y_label) {
  y_label[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(y_label[0])));
  return "Data - fit: " + y_label;
}

figure::Chart chart_of(const Calibration& calibration, const CalibrationResult& result) {
  using Style = figure::ChartSeries::Style;
  const std::string x_label = label_of(calibration.x);
  const std::string y_label = label_of(calibration.y);
  figure::ChartPanel curves{.x = {.label = x_label}, .y = {.label = y_label}};
  const figure::ChartPanel empty{.x = {.label = x_label}, .y = {.label = data_less_fit(y_label)}};
  const std::vector<std::string> names = names_of(calibration.curves);
  // Residuals of several curves lie on each other in one panel.
  const bool has_own_panels = names.size() > 1 && names.size() <= k_most_panels;
  std::vector<figure::ChartPanel> rests(has_own_panels ? names.size() : 1, empty);
  const std::vector<double> x = in_unit(calibration.x.values, calibration.x);
  const std::vector<double> y = in_unit(calibration.y.values, calibration.y);
  for (std::size_t c = 0; c < calibration.curves.size(); ++c) {
    const MeasuredCurve& measured = calibration.curves[c];
    const FittedCurve& fitted = result.curves[c];
    const bool is_only_one = calibration.curves.size() == 1;
    const std::string suffix = is_only_one ? "" : ": " + names[c];
    figure::ChartPanel& rest = rests[has_own_panels ? c : 0];
    if (has_own_panels) rest.note = names[c];
    const auto own_colour = is_only_one ? std::nullopt : std::optional(c);
    const std::vector<double> curve_x = in_unit(fitted.x, calibration.x);
    const std::vector<double> curve_y = in_unit(fitted.y, calibration.y);
    const auto band = [&](const std::vector<double>& middle) {
      figure::ChartBand made{
          .legend = fmt::format("{:g} % confidence band of the fit", 100.0 * result.uncertainty.level),
          .colour = 0x9FC5E8,
          .x = curve_x,
          .lower = middle,
          .upper = middle};
      for (std::size_t i = 0; i < middle.size(); ++i) {
        made.lower[i] -= fitted.band[i] / calibration.y.unit_factor;
        made.upper[i] += fitted.band[i] / calibration.y.unit_factor;
      }
      return made;
    };
    if (result.uncertainty.degrees_of_freedom > 0) {
      curves.bands.push_back(band(curve_y));
      rest.bands.push_back(band(std::vector<double>(curve_x.size(), 0.0)));
    }
    std::vector<double> own_x;
    std::vector<double> own_y;
    std::vector<double> residuals;
    for (std::size_t row = measured.begin; row < measured.end; ++row) {
      own_x.push_back(x[row]);
      own_y.push_back(y[row]);
      residuals.push_back(calibration.weights[row] > 0.0 ? y[row] - result.fit.y[row] / calibration.y.unit_factor
                                                         : k_nan);
    }
    curves.series.push_back({.legend = "fit" + suffix, .style = Style::solid, .colour = c, .x = curve_x, .y = curve_y});
    curves.series.push_back(
        {.legend = "data" + suffix, .style = Style::points, .colour = own_colour, .x = own_x, .y = own_y});
    rest.series.push_back(
        {.legend = "data" + suffix, .style = Style::points, .colour = own_colour, .x = own_x, .y = residuals});
  }
  if (has_own_panels) share_ordinate(rests);
  figure::Chart chart{{std::move(curves)}};
  std::ranges::move(rests, std::back_inserter(chart.panels));
  return chart;
}

/// Figure with the data and the fits of all models over them, and the residuals below.
figure::Chart chart_of(std::span<const Calibration> calibrations, std::span<const CalibrationResult> results) {
  using Style = figure::ChartSeries::Style;
  const Calibration& first = calibrations.front();
  const std::string x_label = label_of(first.x);
  const std::string y_label = label_of(first.y);
  figure::ChartPanel curves{.x = {.label = x_label}, .y = {.label = y_label}};
  figure::ChartPanel rest{.x = {.label = x_label}, .y = {.label = data_less_fit(y_label)}};
  const std::vector<double> x = in_unit(first.x.values, first.x);
  for (std::size_t k = 0; k < calibrations.size(); ++k) {
    const Calibration& calibration = calibrations[k];
    const std::string legend = figure::verbatim_text(calibration.name);
    for (const FittedCurve& fitted : results[k].curves) {
      curves.series.push_back({.legend = legend,
                               .style = Style::solid,
                               .colour = k,
                               .x = in_unit(fitted.x, first.x),
                               .y = in_unit(fitted.y, first.y)});
    }
    std::vector<double> residuals;
    for (std::size_t row = 0; row < first.y.values.size(); ++row) {
      residuals.push_back(first.weights[row] > 0.0 ? first.y.values[row] - results[k].fit.y[row] : k_nan);
    }
    rest.series.push_back(
        {.legend = legend, .style = Style::points, .colour = k, .x = x, .y = in_unit(residuals, first.y)});
  }
  curves.series.push_back({.legend = "data",
                           .style = Style::points,
                           .colour = std::nullopt,
                           .x = x,
                           .y = in_unit(first.y.values, first.y)});
  return {{std::move(curves), std::move(rest)}};
}

/// Draws a chart of a calibration. @return why there is no figure; empty: there is one
std::string draw(figure::Chart chart, const Calibration& calibration, const fs::path& file) {
  chart.references = reference_texts(*find_model(calibration.scenario.model));
  return figure::try_to_draw(chart, fmt::format("{}: {}", calibration.name, data_names(calibration)), file);
}

}  // namespace

std::string draw_calibration(const Calibration& calibration, const CalibrationResult& result, const fs::path& figure) {
  return draw(chart_of(calibration, result), calibration, figure);
}

std::string draw_report(const Calibration& calibration, const CalibrationResult& result, const fs::path& folder) {
  figure::Chart chart = chart_of(calibration, result);
  ReportLines lines = report_lines(calibration, result);
  chart.head = std::move(lines.head);
  chart.foot = std::move(lines.foot);
  return draw(std::move(chart), calibration, folder / "report.pdf");
}

std::string draw_comparison(std::span<const Calibration> calibrations, std::span<const CalibrationResult> results,
                            const fs::path& figure) {
  figure::Chart chart = chart_of(calibrations, results);
  std::vector<std::string> names;
  for (const Calibration& calibration : calibrations) {
    names.push_back(calibration.name);
    std::ranges::move(reference_texts(*find_model(calibration.scenario.model)), std::back_inserter(chart.references));
  }
  return figure::try_to_draw(chart, fmt::format("{}: {}", fmt::join(names, ", "), data_names(calibrations.front())),
                             figure);
}

}  // namespace monograin
