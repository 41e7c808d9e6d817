// Files of a bench: tables, CSV and figures.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>

#include "engine/integrator.hpp"
#include "figure/chart.hpp"
#include "figure/markdown.hpp"
#include "figure/page.hpp"
#include "history/run.hpp"
#include "history/table.hpp"
#include "scenario/integrators.hpp"
#include "scenario/text_file.hpp"
#include "system/resolution.hpp"
#include "verify/bench/bench.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;
using figure::ChartSeries;

constexpr std::array k_errors{1e-4, 1e-6, 1e-8, 1e-10};
constexpr int k_measured_digits = 6;
constexpr int k_error_digits = 2;
// Smaller errors are those of the reference, and round-off.
constexpr double k_reference_error = 1e-11;

struct Line {
  std::string_view integrator;
  std::size_t panel;
  std::size_t colour;
  ChartSeries::Style style;
};

/// Lines of the integrators: those of one library share a panel and a dash pattern. In all panels together, no two
/// lines look the same.
constexpr std::array k_lines{
    Line{integrators::k_direct, 0, 0, ChartSeries::Style::points},
    Line{integrators::k_auto, 0, 1, ChartSeries::Style::points},
    Line{integrators::k_forward_euler, 0, 5, ChartSeries::Style::dotted},
    Line{integrators::k_ida, 0, 2, ChartSeries::Style::dotted},
    Line{integrators::k_cvode_adams, 1, 0, ChartSeries::Style::solid},
    Line{integrators::k_cvode_bdf, 1, 1, ChartSeries::Style::solid},
    Line{integrators::k_arkode_erk, 1, 2, ChartSeries::Style::solid},
    Line{integrators::k_arkode_dirk, 1, 3, ChartSeries::Style::solid},
    Line{integrators::k_odeint_dopri5, 2, 0, ChartSeries::Style::dashed},
    Line{integrators::k_odeint_fehlberg78, 2, 1, ChartSeries::Style::dashed},
    Line{integrators::k_odeint_bulirsch_stoer, 2, 2, ChartSeries::Style::dashed},
    Line{integrators::k_odeint_rosenbrock4, 2, 3, ChartSeries::Style::dashed},
    Line{integrators::k_gsl_rk8pd, 3, 0, ChartSeries::Style::dash_dotted},
    Line{integrators::k_gsl_msadams, 3, 1, ChartSeries::Style::dash_dotted},
    Line{integrators::k_gsl_msbdf, 3, 2, ChartSeries::Style::dash_dotted},
};
constexpr std::array<const char*, 4> k_panels{"Direct form, fixed steps, IDA", "CVODE, ARKODE", "Boost.Odeint", "GSL"};

[[nodiscard]] std::vector<std::string_view> integrators_of(const std::vector<BenchScene>& scenes) {
  std::vector<std::string_view> names;
  for (const Line& line : k_lines) {
    const bool is_there = std::ranges::any_of(scenes, [&](const BenchScene& scene) {
      return std::ranges::find(scene.points, line.integrator, &BenchPoint::integrator) != scene.points.end();
    });
    if (is_there) names.push_back(line.integrator);
  }
  return names;
}

[[nodiscard]] std::string time_text(double seconds) {
  if (!std::isfinite(seconds)) return "-";
  return seconds < 1e-3 ? fmt::format("{:.3g} us", 1e6 * seconds) : fmt::format("{:.3g} ms", 1e3 * seconds);
}

/// Least time [s] to a curve error of all integrators but "auto".
[[nodiscard]] double best_time(const BenchScene& scene, double error) {
  double best = k_nan;
  for (const BenchPoint& point : scene.points) {
    if (point.integrator != integrators::k_auto) best = std::fmin(best, time_to_error(scene, point.integrator, error));
  }
  return best;
}

void append_scene(const BenchScene& scene, std::string& text) {
  text += fmt::format(
      "\n## {}\n\n{}{} rows, set-up {}, one evaluation of the law {}. Errors are against `{}`, its own against `{}`\n"
      "(which agree to {:.1g}); `auto` is `{}`.\n\n",
      scene.name, scene.title.empty() ? "" : scene.title + ": ", scene.rows, time_text(scene.setup),
      time_text(scene.evaluation), scene.reference, scene.check, scene.agreement, scene.chosen);
  std::vector<MarkdownRow> rows{{"integrator"}};
  for (const double error : k_errors) rows.front().push_back(fmt::format("time at {:.0e}", error));
  rows.front().insert(rows.front().end(), {"least error", "at rtol", "steps", "right-hand sides", "restarts"});
  for (const std::string_view name : integrators_of({scene})) {
    MarkdownRow row{std::string(name)};
    for (const double error : k_errors) row.push_back(time_text(time_to_error(scene, name, error)));
    const BenchPoint* best = nullptr;
    for (const BenchPoint& point : scene.points) {
      if (point.integrator != name || std::isnan(point.curve_error)) continue;
      if (best == nullptr || point.curve_error < best->curve_error) best = &point;
    }
    if (best == nullptr) {
      row.insert(row.end(), {"-", "-", "-", "-", "-"});
    } else {
      row.insert(row.end(),
                 {number_or_dash(best->curve_error, k_error_digits), number_or_dash(best->rtol, k_error_digits),
                  fmt::format("{}", best->statistics.steps), fmt::format("{}", best->statistics.rhs_evaluations),
                  fmt::format("{}", std::max(0L, best->statistics.segments - 1))});
    }
    rows.push_back(std::move(row));
  }
  append_markdown(text, rows);
}

/// Time of `cvode-bdf` over that of "auto", at the error that "auto" has at the default tolerance. If `cvode-bdf` never
/// reaches that error, its time to its least error gives a lower bound, marked by ">".
[[nodiscard]] std::string bdf_at_own_error(const BenchScene& scene) {
  using integrators::k_default_rtol;
  const auto own = std::ranges::find_if(scene.points, [](const BenchPoint& point) {
    return point.integrator == integrators::k_auto && std::abs(point.rtol - k_default_rtol) < 1e-3 * k_default_rtol;
  });
  if (own == scene.points.end()) return "-";
  double least = k_nan;
  for (const BenchPoint& point : scene.points) {
    if (point.integrator == integrators::k_cvode_bdf) least = std::fmin(least, point.curve_error);
  }
  const double error = std::fmax(own->curve_error, least);
  const std::string ratio = number_or_dash(time_to_error(scene, integrators::k_cvode_bdf, error) / own->fastest, 3);
  return error > own->curve_error && ratio != "-" ? "> " + ratio : ratio;
}

/// Median and largest difference of the times of "auto" and of the integrator that it chooses, which are the same runs;
/// nan if these were not both measured.
[[nodiscard]] std::pair<double, double> noise_of(const std::vector<BenchScene>& scenes) {
  std::vector<double> differences;
  for (const BenchScene& scene : scenes) {
    for (const BenchPoint& point : scene.points) {
      if (point.integrator != integrators::k_auto) continue;
      for (const BenchPoint& other : scene.points) {
        if (other.integrator != scene.chosen || other.rtol != point.rtol) continue;
        differences.push_back(std::max(point.fastest, other.fastest) / std::min(point.fastest, other.fastest) - 1.0);
      }
    }
  }
  if (differences.empty()) return {k_nan, k_nan};
  std::ranges::sort(differences);
  return {differences[differences.size() / 2], differences.back()};
}

void append_auto(const std::vector<BenchScene>& scenes, std::string& text) {
  text +=
      "\n## `auto`\n\nRatios of times. Columns \"at\": `auto` over the fastest of the other integrators at that error. "
      "Columns \"bdf\": `cvode-bdf`\nover `auto` at that error; \"bdf at its own\" is at the error that `auto` has at "
      "the default rtol, and \">\" means that\n`cvode-bdf` only comes to a larger one. \"over the floor\": `auto` over "
      "one evaluation of the law for each row.\n\n";
  std::vector<MarkdownRow> rows{{"scene", "is"}};
  for (const double error : k_errors) rows.front().push_back(fmt::format("at {:.0e}", error));
  for (const double error : k_errors) rows.front().push_back(fmt::format("bdf at {:.0e}", error));
  rows.front().insert(rows.front().end(), {"bdf at its own", "over the floor"});
  for (const BenchScene& scene : scenes) {
    MarkdownRow row{scene.name, scene.chosen};
    for (const double error : k_errors) {
      row.push_back(number_or_dash(time_to_error(scene, integrators::k_auto, error) / best_time(scene, error), 3));
    }
    for (const double error : k_errors) {
      row.push_back(number_or_dash(
          time_to_error(scene, integrators::k_cvode_bdf, error) / time_to_error(scene, integrators::k_auto, error), 3));
    }
    row.push_back(bdf_at_own_error(scene));
    row.push_back(number_or_dash(
        time_to_error(scene, integrators::k_auto, 1e-6) / (static_cast<double>(scene.rows) * scene.evaluation), 3));
    rows.push_back(std::move(row));
  }
  append_markdown(text, rows);
  const auto [middle, largest] = noise_of(scenes);
  if (std::isnan(largest)) return;
  text += fmt::format(
      "\n`auto` and the integrator that it chooses make the same runs. Their times differ by {:.1f} % in the median "
      "and by {:.1f} % at\nmost: so much of a ratio is noise.\n",
      100.0 * middle, 100.0 * largest);
}

/// Largest errors of an integrator over all scenes. No error is known better than the references agree.
struct Constants {
  double curve = 0.0;  ///< error over rtol, where the error is not round-off
  double event = 0.0;
  double least = k_nan;  ///< the largest of the scenes' least errors
  long faults = 0;
};

[[nodiscard]] Constants constants_of(const std::vector<BenchScene>& scenes, std::string_view integrator) {
  Constants worst;
  for (const BenchScene& scene : scenes) {
    double least = k_nan;
    for (const BenchPoint& point : scene.points) {
      if (point.integrator != integrator) continue;
      if (!point.fault.empty()) ++worst.faults;
      least = std::fmin(least, std::max(point.curve_error, scene.agreement));
      if (point.curve_error > k_reference_error) worst.curve = std::max(worst.curve, point.curve_error / point.rtol);
      if (point.event_error > k_reference_error) worst.event = std::max(worst.event, point.event_error / point.rtol);
    }
    worst.least = std::isnan(worst.least) ? least : std::fmax(worst.least, least);
  }
  return worst;
}

void append_constants(const std::vector<BenchScene>& scenes, std::string& text) {
  text += fmt::format(
      "\n## Tolerances\n\nThe largest error over rtol of any scene and tolerance, of curves and of event times, where "
      "the error is\nabove {:g}; the largest of the scenes' least errors; and runs that do not end where the "
      "reference does.\n\n",
      k_reference_error);
  std::vector<MarkdownRow> rows{{"integrator", "curve", "events", "least error", "other ends"}};
  for (const std::string_view name : integrators_of(scenes)) {
    if (name == integrators::k_auto) continue;
    const Constants worst = constants_of(scenes, name);
    const bool has_tolerance = name != integrators::k_direct;
    rows.push_back({std::string(name), has_tolerance ? number_or_dash(worst.curve, k_error_digits) : "-",
                    has_tolerance ? number_or_dash(worst.event, k_error_digits) : "-",
                    number_or_dash(worst.least, k_error_digits), fmt::format("{}", worst.faults)});
  }
  append_markdown(text, rows);
}

void append_profiles(const std::vector<BenchProfile>& profiles, std::string& text) {
  if (profiles.empty()) return;
  text +=
      "\n## Where the time goes\n\nShares of one history's time on the clock, of the fastest of twenty. What is left "
      "is the integrator's own, event location and recording less what\nthe system does for them.\n\n";
  std::vector<MarkdownRow> rows{
      {"scene", "integrator", "history", "law", "linear algebra", "guards", "observables", "the rest", "law calls"}};
  for (const BenchProfile& profile : profiles) {
    const auto share = [&](double seconds) { return fmt::format("{:.0f} %", 100.0 * seconds / profile.total); };
    rows.push_back({profile.scene, profile.integrator, time_text(profile.total), share(profile.law),
                    share(profile.linear_algebra), share(profile.guards), share(profile.recording),
                    share(std::max(0.0, profile.total - profile.law - profile.linear_algebra - profile.guards -
                                            profile.recording)),
                    fmt::format("{}", profile.law_calls)});
  }
  append_markdown(text, rows);
}

void append_savings(const std::vector<BenchSaving>& savings, std::string& text) {
  if (savings.empty()) return;
  text += "\n## What is not computed\n\nEach saving, and the same run without it.\n\n";
  std::vector<MarkdownRow> rows{{"saving", "scene", "time", "without", "ratio", "difference of the curves"}};
  for (const BenchSaving& saving : savings) {
    rows.push_back({saving.what, saving.scene, time_text(saving.time), time_text(saving.undone),
                    number_or_dash(saving.undone / saving.time, 3), number_or_dash(saving.difference, k_error_digits)});
  }
  append_markdown(text, rows);
}

[[nodiscard]] Table csv_of(const std::vector<BenchScene>& scenes) {
  Column scene_words{.name = "scene"};
  Column names{.name = "integrator"};
  for (const std::string_view name : integrators_of(scenes)) names.labels.emplace_back(name);
  for (const BenchScene& scene : scenes) scene_words.labels.push_back(scene.name);
  std::vector<Column> columns{scene_words, names};
  for (const char* name : {"rtol", "curve_error", "end_error", "event_error"}) columns.push_back({name, "", {}});
  for (const char* name : {"fastest", "median", "setup"}) columns.push_back({name, "s", {}});
  for (const char* name :
       {"steps", "rhs_evaluations", "jacobian_evaluations", "guard_evaluations", "segments", "events"}) {
    columns.push_back({name, "", {}});
  }
  Table table(std::move(columns));
  table.header = {{"title", "run time against error"}, {"machine", machine_text()}};
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    for (const BenchPoint& point : scenes[s].points) {
      const auto name = std::ranges::find(names.labels, point.integrator);
      const Statistics& counts = point.statistics;
      table.append(
          std::array{static_cast<double>(s), static_cast<double>(name - names.labels.begin()), point.rtol,
                     point.curve_error, point.end_error, point.event_error, point.fastest, point.median,
                     scenes[s].setup, static_cast<double>(counts.steps), static_cast<double>(counts.rhs_evaluations),
                     static_cast<double>(counts.jacobian_evaluations), static_cast<double>(counts.guard_evaluations),
                     static_cast<double>(counts.segments), static_cast<double>(counts.events)});
    }
  }
  return table;
}

// --- figures

using Place = std::function<std::pair<double, double>(const BenchPoint&)>;

/// Gives an axis ends at powers of ten that enclose all values of the chart along it.
void enclose(const figure::Chart& chart, std::vector<double> ChartSeries::*values, figure::ChartAxis& axis) {
  double lowest = std::log10(axis.lowest.value_or(k_infinity));
  double highest = -k_infinity;
  for (const figure::ChartPanel& panel : chart.panels) {
    for (const ChartSeries& series : panel.series) {
      for (const double value : series.*values) {
        if (!(value > 0.0 && std::isfinite(value))) continue;
        lowest = std::min(lowest, std::floor(std::log10(value)));
        highest = std::max(highest, std::ceil(std::log10(value)));
      }
    }
  }
  if (!std::isfinite(highest)) return;
  axis.lowest = std::pow(10.0, lowest);
  axis.highest = std::pow(10.0, std::max(highest, lowest + 1.0));
}

/// Leaves out empty panels and gives the others the same axes, so that they can be compared.
void compare_panels(figure::Chart& chart) {
  std::erase_if(chart.panels, [](const figure::ChartPanel& panel) { return panel.series.empty(); });
  if (chart.panels.empty()) return;
  figure::ChartAxis x = chart.panels.front().x;
  figure::ChartAxis y = chart.panels.front().y;
  enclose(chart, &ChartSeries::x, x);
  enclose(chart, &ChartSeries::y, y);
  for (figure::ChartPanel& panel : chart.panels) {
    panel.x = x;
    panel.y = y;
  }
}

/// A chart with a panel for each library, and a line for each integrator and scene.
[[nodiscard]] figure::Chart chart_of(const std::vector<BenchScene>& scenes, const figure::ChartAxis& x,
                                     const figure::ChartAxis& y, const Place& place) {
  figure::Chart chart;
  for (const char* note : k_panels) chart.panels.push_back({.x = x, .y = y, .note = note});
  for (const Line& line : k_lines) {
    for (const BenchScene& scene : scenes) {
      ChartSeries series{
          .legend = std::string(line.integrator), .style = line.style, .colour = line.colour, .is_error = true};
      for (const BenchPoint& point : scene.points) {
        if (point.integrator != line.integrator) continue;
        const auto [along, up] = place(point);
        series.x.push_back(along);
        series.y.push_back(up);
      }
      if (series.x.size() == 1) series.style = ChartSeries::Style::points;
      if (!series.x.empty()) chart.panels[line.panel].series.push_back(std::move(series));
    }
  }
  compare_panels(chart);
  return chart;
}

/// A scene that stands for all scenes: it has their largest event error for each integrator and tolerance.
[[nodiscard]] BenchScene worst_events(const std::vector<BenchScene>& scenes) {
  BenchScene worst{};
  for (const BenchScene& scene : scenes) {
    for (const BenchPoint& point : scene.points) {
      // `direct` and `auto` have no tolerance of their own.
      if (point.integrator == integrators::k_direct || point.integrator == integrators::k_auto) continue;
      const auto found = std::ranges::find_if(worst.points, [&](const BenchPoint& one) {
        return one.integrator == point.integrator && one.rtol == point.rtol;
      });
      if (found == worst.points.end())
        worst.points.push_back(point);
      else if (!(point.event_error <= found->event_error))
        found->event_error = point.event_error;
    }
  }
  return worst;
}

constexpr double k_least_error = 1e-16;  ///< figures show an error of zero as this

/// Times to an error over those of "auto", of the scenes in which both reach the error.
[[nodiscard]] std::vector<double> ratios_to_auto(const std::vector<BenchScene>& scenes, std::string_view integrator,
                                                 double error) {
  std::vector<double> ratios;
  for (const BenchScene& scene : scenes) {
    const double ratio = time_to_error(scene, integrator, error) / time_to_error(scene, integrators::k_auto, error);
    if (std::isfinite(ratio)) ratios.push_back(ratio);
  }
  return ratios;
}

/// Chart of the time to an error over that of "auto", geometric means. A line ends where more than a tenth of its
/// scenes drop out: those that are left are the easy ones.
[[nodiscard]] figure::Chart summary_of(const std::vector<BenchScene>& scenes) {
  constexpr double k_least_share = 0.9;
  figure::Chart chart;
  for (const char* note : k_panels) {
    chart.panels.push_back({.x = {.label = "Error of the curve", .is_logarithmic = true},
                            .y = {.label = "Time / time of auto", .is_logarithmic = true},
                            .note = note});
  }
  for (const Line& line : k_lines) {
    if (line.integrator == integrators::k_auto) continue;
    ChartSeries series{.legend = std::string(line.integrator),
                       .style = line.style == ChartSeries::Style::points ? ChartSeries::Style::dotted : line.style,
                       .colour = line.colour};
    std::size_t most = 0;
    for (int k = 3; k <= 11; ++k) {
      const double error = std::pow(10.0, -k);
      const std::vector<double> ratios = ratios_to_auto(scenes, line.integrator, error);
      most = std::max(most, ratios.size());
      if (ratios.empty() || static_cast<double>(ratios.size()) < k_least_share * static_cast<double>(most)) break;
      double sum = 0.0;
      for (const double ratio : ratios) sum += std::log(ratio);
      series.x.push_back(error);
      series.y.push_back(std::exp(sum / static_cast<double>(ratios.size())));
    }
    if (!series.x.empty()) chart.panels[line.panel].series.push_back(std::move(series));
  }
  compare_panels(chart);
  return chart;
}

std::vector<fs::path> draw_bench(const std::vector<BenchScene>& scenes, const std::string& machine,
                                 const fs::path& folder, std::string_view format) {
  const figure::ChartAxis error{.label = "Error of the curve, at least 10^{−16}", .is_logarithmic = true};
  const figure::ChartAxis time{.label = "Time of one history [ms]", .is_logarithmic = true};
  const figure::ChartAxis rtol{.label = "Relative tolerance", .is_logarithmic = true};
  const figure::ChartAxis event{.label = "Error of event times", .lowest = k_least_error, .is_logarithmic = true};
  std::vector<std::pair<std::string, figure::Chart>> charts;
  for (const BenchScene& scene : scenes) {
    charts.emplace_back("bench-" + scene.name, chart_of({scene}, error, time, [](const BenchPoint& point) {
                          return std::pair{std::max(point.curve_error, k_least_error), 1e3 * point.fastest};
                        }));
  }
  charts.emplace_back("bench-summary", summary_of(scenes));
  charts.emplace_back("bench-events", chart_of({worst_events(scenes)}, rtol, event, [](const BenchPoint& point) {
                        return std::pair{point.rtol, point.event_error};
                      }));
  std::erase_if(charts, [](const auto& named) { return named.second.panels.empty(); });
  std::vector<figure::FigureFiles> files;
  for (const auto& [name, chart] : charts) {
    files.emplace_back(folder / fmt::format("{}.{}", name, format));
    figure::expect_own_figure(files.back().figure());
  }
  std::vector<fs::path> written;
  for (std::size_t k = 0; k < charts.size(); ++k) {
    const figure::Chart& chart = charts[k].second;
    files[k].write(figure::chart_data(chart, "Run time against error; " + machine),
                   figure::chart_script(chart, files[k].format(), files[k].figure_name(), files[k].data_name()));
    written.push_back(files[k].figure());
  }
  return written;
}

}  // namespace

std::string machine_text() {
  std::ifstream in("/proc/cpuinfo");
  std::string processor = "unknown processor";
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("model name")) continue;
    processor = line.substr(std::min(line.size(), line.find(':') + 2));
    break;
  }
  return fmt::format("{}; monograin {}, SUNDIALS {}, compiler {}", processor, version(), sundials_version(),
                     __VERSION__);
}

std::string bench_text(const std::vector<BenchScene>& scenes, const std::vector<BenchProfile>& profiles,
                       const std::vector<BenchSaving>& savings) {
  std::string text = fmt::format(
      "# Run time against error\n\n{}\n\nTimes are the processor times of the fastest of repeated runs of one history, "
      "recording included, set-up of the\nscene not. Errors are the largest difference of any force, stress, "
      "displacement, strain, apparent radius or work at\nany output point over its largest value. \"Time at 1e-08\": "
      "of the fastest run with no larger error.\n",
      machine_text());
  const bool has_auto = std::ranges::any_of(scenes, [](const BenchScene& scene) {
    return std::ranges::find(scene.points, integrators::k_auto, &BenchPoint::integrator) != scene.points.end();
  });
  if (has_auto) append_auto(scenes, text);
  if (!scenes.empty()) append_constants(scenes, text);
  append_profiles(profiles, text);
  append_savings(savings, text);
  for (const BenchScene& scene : scenes) append_scene(scene, text);
  return text;
}

std::vector<fs::path> redraw_bench(const fs::path& csv, const fs::path& folder, std::string_view format) {
  const Table table = read_csv(csv);
  const auto words = [&](std::string_view name) {
    const auto found = table.find(name);
    if (!found || !table.columns()[*found].holds_words()) {
      throw std::runtime_error(fmt::format("{}: has no words in a column '{}'", csv.string(), name));
    }
    return *found;
  };
  const auto numbers = [&](std::string_view name) {
    const auto found = table.find(name);
    if (!found || table.columns()[*found].holds_words()) {
      throw std::runtime_error(fmt::format("{}: has no numbers in a column '{}'", csv.string(), name));
    }
    return table.column(name);
  };
  const std::size_t scene = words("scene");
  const std::size_t integrator = words("integrator");
  const auto rtol = numbers("rtol");
  const auto curve_error = numbers("curve_error");
  const auto event_error = numbers("event_error");
  const auto fastest = numbers("fastest");
  std::vector<BenchScene> scenes;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const std::string name(table.word(row, scene));
    auto found = std::ranges::find(scenes, name, &BenchScene::name);
    if (found == scenes.end()) {
      found = scenes.emplace(scenes.end());
      found->name = name;
    }
    BenchPoint& point = found->points.emplace_back();
    point.integrator = integrators::present_name(table.word(row, integrator));
    point.rtol = rtol[row];
    point.curve_error = curve_error[row];
    point.event_error = event_error[row];
    point.fastest = fastest[row];
  }
  return draw_bench(scenes, std::string(table.header_value("machine")), folder, format);
}

std::vector<fs::path> write_bench(const std::vector<BenchScene>& scenes, const std::vector<BenchProfile>& profiles,
                                  const std::vector<BenchSaving>& savings, const fs::path& folder,
                                  std::string_view format) {
  std::vector<fs::path> written = draw_bench(scenes, machine_text(), folder, format);
  fs::create_directories(folder);
  write_text_file(folder / "bench.csv", csv_text(csv_of(scenes), k_measured_digits));
  write_text_file(folder / "bench.md", bench_text(scenes, profiles, savings));
  written.insert(written.begin(), {folder / "bench.csv", folder / "bench.md"});
  return written;
}

}  // namespace monograin
