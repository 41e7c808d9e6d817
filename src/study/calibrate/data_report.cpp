#include "study/calibrate/data_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "figure/page.hpp"
#include "history/turns.hpp"
#include "scenario/faults.hpp"
#include "scenario/measured_data.hpp"
#include "scenario/text_file.hpp"
#include "scenario/units.hpp"
#include "scenario/words.hpp"
#include "study/calibrate/calibration_language.hpp"
#include "study/calibrate/text_table.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

/// Format with which a table is read again as before.
TableFormat format_as(const TableLayout& layout) {
  TableFormat format{.separator = layout.separator, .decimal = layout.decimal};
  format.skip = std::max<std::size_t>(layout.heading_line > 0 ? layout.heading_line : layout.first_line, 1) - 1;
  format.units = layout.unit_line > 0 ? TableFormat::Units::row : TableFormat::Units::none;
  format.unit_of = layout.units;
  format.most_missing = 1.0;
  return format;
}

ColumnRequest request_by_number(std::size_t number, const std::string& file) {
  return {.where = {file}, .naming = fmt::format("column {}", number), .number = number};
}

std::string name_of_column(const MeasuredColumn& column) {
  return column.heading.empty() ? fmt::format("column {}", column.number) : std::string(name_in(column.heading));
}

std::vector<ColumnSummary> summaries_of(const std::string& text, const std::string& file, const TableLayout& layout,
                                        FaultList& faults) {
  std::vector<ColumnSummary> summaries;
  for (std::size_t k = 0; k < layout.headings.size(); ++k) {
    ColumnSummary summary{.heading = layout.headings[k], .unit = layout.units[k], .is_numeric = layout.is_numeric[k]};
    if (summary.is_numeric) {
      const MeasuredData data = parse_measured(text, file, {request_by_number(k + 1, file)}, faults, format_as(layout));
      const std::vector<double>& values = data.columns.front().values;
      summary.values = values.size();
      summary.missing = data.left_out.size();
      if (!values.empty()) {
        summary.lowest = std::ranges::min(values);
        summary.highest = std::ranges::max(values);
      }
    }
    summaries.push_back(std::move(summary));
  }
  return summaries;
}

std::vector<DataBranch> branches_of(const std::vector<double>& x) {
  std::vector<DataBranch> branches;
  const std::vector<std::size_t> rows = turning_points(x);
  const std::vector<Turn> turns = turns_of(x, rows);
  const bool has_noise = noise_in(x) > 0.0;
  for (std::size_t k = 1; k < turns.size(); ++k) {
    const Turn& from = turns[k - 1];
    const Turn& to = turns[k];
    DataBranch branch{.begin = from.held_rows() > 0 ? from.held_end - 1 : rows[k - 1],
                      .end = to.held_rows() > 0 ? to.held_begin : rows[k],
                      .is_loading = std::abs(x[rows[k]]) > std::abs(x[rows[k - 1]]),
                      .held_begin = to.held_begin,
                      .held_end = to.held_end};
    branch.x_begin = has_noise ? from.x : x[branch.begin];
    branch.x_end = has_noise ? to.x : x[branch.end];
    branches.push_back(branch);
  }
  return branches;
}

/// Number of the first numeric column with a unit of the dimension. @param taken  number of a column that is left out
std::optional<std::size_t> column_of(const TableLayout& layout, Dimension dimension, std::size_t taken = 0) {
  for (std::size_t k = 0; k < layout.units.size(); ++k) {
    if (k + 1 != taken && layout.is_numeric[k] && is_unit_of(layout.units[k], dimension)) return k + 1;
  }
  return std::nullopt;
}

ColumnRequest request_of_choice(const std::string& choice, const char* name, const std::string& file) {
  ColumnRequest request{.name = choice, .where = {file}, .naming = fmt::format("{} {}", name, shown(choice))};
  const bool is_number =
      !choice.empty() && choice.size() < 6 && choice.find_first_not_of("0123456789") == std::string::npos;
  if (is_number) {
    request.number = std::stoul(choice);
    if (request.number == 0) throw_fault({file}, request.naming + ": expected a whole number from 1, or a heading");
    request.name.clear();
  }
  return request;
}

DataAxis axis_of(MeasuredColumn column) {
  std::string name = name_of_column(column);
  return {column.number, std::move(name), std::move(column.unit), std::move(column.values)};
}

std::string with_unit(const DataAxis& axis, double value) {
  const bool is_bare = axis.unit.empty() || axis.unit == "-";
  return fmt::format("{:.6g}{}{}", value, is_bare ? "" : " ", is_bare ? "" : axis.unit);
}

std::string named(const DataAxis& axis) {
  return fmt::format("column {}{}", axis.number,
                     axis.name == fmt::format("column {}", axis.number) ? "" : " '" + shown(axis.name) + "'");
}

std::string label_of(const DataAxis& axis) {
  const std::string name = figure::verbatim_text(axis.name);
  const bool is_bare = axis.unit.empty() || axis.unit == "-";
  return is_bare ? name : fmt::format("{} [{}]", name, figure::verbatim_text(axis.unit));
}

/// Meaning of a column: "axial.displacement, 1 mm = 0.001 m, times -1".
std::string meaning_of(const MeasuredQuantity& quantity, double scale) {
  std::string text = quantity.observable;
  if (quantity.unit_factor != 1.0) {
    text += fmt::format(", 1 {} = {:g} {}", quantity.unit, quantity.unit_factor, quantity.si);
  }
  return scale == 1.0 ? text : fmt::format("{}, times {:g}", text, scale);
}

/// Curve of all loading branches, or of all unloading ones; nan between them breaks the line.
figure::ChartSeries branch_series(const DataReport& report, bool is_loading) {
  using Style = figure::ChartSeries::Style;
  figure::ChartSeries series{
      .legend = is_loading ? "loading" : "unloading", .style = is_loading ? Style::solid : Style::dashed, .colour = 0};
  for (const DataBranch& branch : report.branches) {
    if (branch.is_loading != is_loading) continue;
    for (std::size_t row = branch.begin; row <= branch.end; ++row) {
      series.x.push_back(report.x.values[row]);
      series.y.push_back(report.y.values[row]);
    }
    series.x.push_back(k_nan);
    series.y.push_back(k_nan);
  }
  return series;
}

figure::ChartSeries turning_points_of(const DataReport& report) {
  figure::ChartSeries series{.legend = "turning points", .style = figure::ChartSeries::Style::points, .colour = 0};
  for (std::size_t k = 1; k < report.branches.size(); ++k) {
    series.x.push_back(report.branches[k].x_begin);
    series.y.push_back(report.y.values[report.branches[k].begin]);
  }
  return series;
}

/// Why a calibration would refuse the data.
std::vector<std::string> objections_to(const DataReport& report) {
  std::vector<std::string> objections;
  const std::size_t rows = report.lines.size() + report.left_out;
  if (static_cast<double>(report.left_out) > k_most_missing * static_cast<double>(rows)) {
    objections.push_back(
        fmt::format("a calibration refuses this file: {} of {} rows have no number in x or y, more than {:g} %",
                    report.left_out, rows, 100.0 * k_most_missing));
  }
  for (const DataAxis* axis : {&report.x, &report.y}) {
    if (axis->unit.empty() || is_known_unit(axis->unit)) continue;
    objections.push_back(fmt::format(
        "'{}' is no unit that monograin knows; a calibration needs {{ column, quantity, unit }}", shown(axis->unit)));
  }
  if (const std::size_t line = report.layout.unmatched_line; line > 0) {
    objections.push_back(fmt::format("line {} has no text for each of the {} columns, and was not taken for headings",
                                     line, report.columns.size()));
  }
  return objections;
}

}  // namespace

std::string trailer_text(const std::vector<std::size_t>& lines) {
  if (lines.empty()) return {};
  return fmt::format("{} line{} from line {}", lines.size(), lines.size() == 1 ? "" : "s", lines.front());
}

DataReport report_of_file(const fs::path& file, const DataChoice& choice) {
  DataReport report;
  report.file = name_of_file(file).string();
  const auto [bytes, problem] = read_text_file(file, k_largest_data, FileKind::any);
  if (!problem.empty()) throw_fault({report.file}, problem + "; expected a table of measured data");
  if (bytes.size() > k_largest_data) throw_fault({report.file}, "the file is too large");
  FaultList faults;
  std::vector<ColumnRequest> wanted;
  if (!choice.x.empty()) wanted.push_back(request_of_choice(choice.x, choice.x_named, report.file));
  if (!choice.y.empty()) wanted.push_back(request_of_choice(choice.y, choice.y_named, report.file));
  const MeasuredData first = parse_measured(bytes, report.file, wanted, faults, {.most_missing = 1.0});
  faults.throw_if_any();
  report.layout = first.layout;
  if (std::ranges::count(first.layout.is_numeric, true) < 2) {
    throw_fault(
        {report.file, std::max<std::size_t>(first.layout.first_line, 1)},
        fmt::format(
            "this is no table with two columns of numbers and comma, semicolon, tab or blanks between them (read "
            "with {}); if it is, give separator, decimal or skip in [data] of a calibration file",
            separator_word(first.layout.separator)));
  }
  report.columns = summaries_of(bytes, report.file, report.layout, faults);

  const auto& is_numeric = report.layout.is_numeric;
  const auto next_numeric = [&is_numeric](std::size_t begin) {
    const auto found = std::find(is_numeric.begin() + static_cast<std::ptrdiff_t>(begin), is_numeric.end(), true);
    return static_cast<std::size_t>(found - is_numeric.begin()) + 1;
  };
  std::size_t x = choice.x.empty() ? column_of(report.layout, choice.x_dimension).value_or(next_numeric(0))
                                   : first.columns.front().number;
  std::size_t y =
      choice.y.empty()
          ? column_of(report.layout, choice.y_dimension, x).value_or(next_numeric(std::min(x, is_numeric.size())))
          : first.columns.back().number;
  x = std::min(x, is_numeric.size());
  y = std::min(y, is_numeric.size());
  MeasuredData data =
      parse_measured(bytes, report.file, {request_by_number(x, report.file), request_by_number(y, report.file)}, faults,
                     format_as(report.layout));
  faults.throw_if_any();
  report.x = axis_of(std::move(data.columns[0]));
  report.y = axis_of(std::move(data.columns[1]));
  report.lines = std::move(data.lines);
  report.left_out = data.left_out.size();
  report.trailer = std::move(data.trailer);
  report.branches = branches_of(report.x.values);
  report.remarks = objections_to(report);
  return report;
}

DataReport report_of_calibration(const fs::path& folder, DataChoice choice) {
  const fs::path file = folder / k_calibration_tables[0];
  const std::vector<ColumnSummary> columns = report_of_file(file).columns;
  const auto has = [&columns](std::string_view name) {
    return std::ranges::any_of(columns, [name](const auto& column) { return name_in(column.heading) == name; });
  };
  if (choice.x_dimension == Dimension::length && has(k_particle_displacement)) choice.x = k_particle_displacement;
  if (choice.y_dimension == Dimension::force && has(k_particle_force)) choice.y = k_particle_force;
  return report_of_file(file, choice);
}

std::vector<DataReport> reports_of(const Calibration& calibration) {
  std::vector<DataReport> reports;
  FaultList faults;
  for (const MeasuredCurve& curve : calibration.curves) {
    DataReport report;
    report.file = curve.file;
    report.layout = curve.layout;
    report.columns = summaries_of(curve.text, curve.file, curve.layout, faults);
    const auto axis = [&](const MeasuredQuantity& quantity, std::size_t number) {
      DataAxis made{number, fmt::format("column {}", number), quantity.unit, {}};
      const std::string& heading = curve.layout.headings[number - 1];
      if (!heading.empty()) made.name = name_in(heading);
      for (std::size_t row = curve.begin; row < curve.end; ++row) {
        made.values.push_back(quantity.values[row] / quantity.unit_factor);
      }
      return made;
    };
    report.x = axis(calibration.x, curve.columns[0]);
    report.y = axis(calibration.y, curve.columns[1]);
    report.lines.assign(calibration.lines.begin() + static_cast<std::ptrdiff_t>(curve.begin),
                        calibration.lines.begin() + static_cast<std::ptrdiff_t>(curve.end));
    report.left_out = curve.left_out.size();
    report.trailer = curve.trailer;
    report.branches = branches_of(report.x.values);
    report.remarks = {fmt::format("x is {}", meaning_of(calibration.x, curve.scales[0])),
                      fmt::format("y is {}", meaning_of(calibration.y, curve.scales[1]))};
    const Machine& machine = curve.machine;
    if (machine.offset != 0.0) report.remarks.push_back(fmt::format("data.offset is {:g} m", machine.offset));
    if (machine.force_offset != 0.0)
      report.remarks.push_back(fmt::format("data.force_offset is {:g} N", machine.force_offset));
    if (machine.compliance != 0.0)
      report.remarks.push_back(fmt::format("data.compliance is {:g} m/N", machine.compliance));
    if (!machine.forces.empty()) report.remarks.push_back("data.compliance is a table");
    for (const FreeParameter& free : calibration.free) {
      if (free.is_of_machine()) report.remarks.push_back(free.key.path + " is sought");
    }
    reports.push_back(std::move(report));
  }
  return reports;
}

std::string data_text(const DataReport& report) {
  const TableLayout& layout = report.layout;
  const auto line = [](std::size_t number) {
    return number > 0 ? fmt::format("line {}", number) : std::string("none");
  };
  const bool has_units = std::ranges::any_of(layout.units, [](const std::string& unit) { return !unit.empty(); });
  std::string text = report.file + '\n';
  for (const auto& [what, value] : std::vector<std::pair<const char*, std::string>>{
           {"encoding", layout.encoding},
           {"separator", std::string(separator_word(layout.separator))},
           {"decimal", layout.decimal == '.' ? "point" : "comma"},
           {"headings", line(layout.heading_line)},
           {"units", layout.unit_line == 0 && has_units ? "in the headings" : line(layout.unit_line)},
           {"rows", fmt::format("{}{}", report.lines.size(),
                                report.lines.empty()
                                    ? ""
                                    : fmt::format(", lines {} to {}", report.lines.front(), report.lines.back()))},
           {"left out",
            fmt::format(
                "{} without x or y{}", report.left_out,
                report.trailer.empty() ? "" : fmt::format("; {} below the table", trailer_text(report.trailer)))}}) {
    text += fmt::format("  {:<11}{}\n", what, value);
  }
  std::vector<TextRow> columns{{"column", "number", "unit", "values", "missing", "lowest", "highest"}};
  for (std::size_t k = 0; k < report.columns.size(); ++k) {
    const ColumnSummary& column = report.columns[k];
    TextRow row{column.heading.empty() ? "-" : shown(column.heading), fmt::format("{}", k + 1),
                column.unit.empty() ? "-" : shown(column.unit)};
    if (column.is_numeric) {
      row.insert(row.end(), {fmt::format("{}", column.values), fmt::format("{}", column.missing),
                             fmt::format("{:.6g}", column.lowest), fmt::format("{:.6g}", column.highest)});
    } else {
      row.insert(row.end(), {"text", "-", "-", "-"});
    }
    columns.push_back(std::move(row));
  }
  text += '\n' + aligned(columns);
  text += fmt::format("\nx: {}, y: {}\n", named(report.x), named(report.y));
  for (const std::string& remark : report.remarks) text += remark + '\n';
  std::vector<TextRow> branches{{"branch", "lines", "rows", "x from", "to", "y from", "to"}};
  const auto add = [&](std::string name, std::size_t begin, std::size_t end, double x_begin, double x_end) {
    branches.push_back({std::move(name), fmt::format("{}-{}", report.lines[begin], report.lines[end]),
                        fmt::format("{}", end - begin + 1), with_unit(report.x, x_begin), with_unit(report.x, x_end),
                        with_unit(report.y, report.y.values[begin]), with_unit(report.y, report.y.values[end])});
  };
  std::array<std::size_t, 3> counts{};
  for (const DataBranch& branch : report.branches) {
    const std::size_t count = ++counts[branch.is_loading ? 0 : 1];
    add(fmt::format("{} {}", branch.is_loading ? "loading" : "unloading", count), branch.begin, branch.end,
        branch.x_begin, branch.x_end);
    if (branch.held_end == branch.held_begin) continue;
    add(fmt::format("hold {}", ++counts[2]), branch.held_begin, branch.held_end - 1, branch.x_end, branch.x_end);
  }
  if (branches.size() > 1) text += '\n' + aligned(branches);
  return text;
}

figure::Chart data_chart(const std::vector<DataReport>& reports) {
  figure::ChartPanel panel{.x = {.label = label_of(reports.front().x)}, .y = {.label = label_of(reports.front().y)}};
  const bool has_several = reports.size() > 1;  // each report then has a colour of its own
  for (std::size_t c = 0; c < reports.size(); ++c) {
    const std::string suffix =
        has_several ? ": " + figure::verbatim_text(fs::path(reports[c].file).stem().string()) : std::string();
    std::array<figure::ChartSeries, 3> series{branch_series(reports[c], true), branch_series(reports[c], false),
                                              turning_points_of(reports[c])};
    for (std::size_t k = 0; k < series.size(); ++k) {
      if (series[k].x.empty()) continue;
      series[k].legend += suffix;
      series[k].colour = has_several ? c : k;
      panel.series.push_back(std::move(series[k]));
    }
  }
  return {{std::move(panel)}, {}};
}

void draw_data(const std::vector<DataReport>& reports, const fs::path& output) {
  figure::draw_chart(data_chart(reports), reports.front().file, output);
}

}  // namespace monograin
