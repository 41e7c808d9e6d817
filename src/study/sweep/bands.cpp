#include "study/sweep/bands.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>

#include "figure/chart.hpp"
#include "figure/page.hpp"
#include "history/run.hpp"
#include "numerics/quantile.hpp"
#include "scenario/text_file.hpp"
#include "scenario/words.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

// Least share of the runs with a history that have to reach an abscissa. Runs that miss it because contacts are lost or
// limits reached may all lie on one side, so that the percentiles of the rest would be biased.
constexpr double k_least_share = 0.95;
constexpr unsigned k_band_colour = 0x9FC5E8;

/// Index of a numeric column of a history.
[[nodiscard]] std::size_t place_of(const Table& history, const std::string& name) {
  const auto found = history.find(name);
  if (found && !history.columns()[*found].holds_words()) return *found;
  std::vector<std::string_view> names;
  for (const Column& column : history.columns()) {
    if (!column.holds_words()) names.push_back(column.name);
  }
  throw std::runtime_error(fmt::format("bands: '{}' is no column of the histories{}; expected one of {}", name,
                                       did_you_mean(name, names), fmt::join(names, ", ")));
}

/// Rows of one step of a history.
struct Stretch {
  std::size_t begin = 0;
  std::size_t end = 0;
};

[[nodiscard]] std::map<std::size_t, Stretch> stretches_of(const Table& history) {
  std::map<std::size_t, Stretch> stretches;
  const std::size_t step = place_of(history, "step");
  for (std::size_t row = 0; row < history.row_count(); ++row) {
    const auto own = static_cast<std::size_t>(history.at(row, step));
    stretches.try_emplace(own, Stretch{row, row}).first->second.end = row + 1;
  }
  return stretches;
}

/// Columns of a history from which bands are made.
struct RunCurves {
  std::map<std::size_t, Stretch> stretches;  ///< by step
  std::vector<double> x;
  std::vector<std::vector<double>> y{};  ///< in the order of the request
};

/// Histories of all runs; a run that was refused has none.
/// @param bands  receives the columns of the first history
[[nodiscard]] std::vector<RunCurves> read_curves(const Sweep& sweep, const fs::path& folder, HistoryBands& bands) {
  std::vector<RunCurves> curves;
  for (std::size_t run = 1; run <= sweep.runs.size(); ++run) {
    const fs::path file = folder / "histories" / fmt::format("{}.csv", run);
    if (!fs::exists(file)) continue;
    const Table history = read_csv(file);
    const std::size_t x = place_of(history, sweep.bands->x);
    if (curves.empty()) bands.x = history.columns()[x];
    RunCurves own{.stretches = stretches_of(history), .x = history.column(sweep.bands->x)};
    for (const std::string& name : sweep.bands->y) {
      const std::size_t y = place_of(history, name);
      if (curves.empty()) bands.y.push_back(history.columns()[y]);
      own.y.push_back(history.column(name));
    }
    curves.push_back(std::move(own));
  }
  return curves;
}

/// Position at which a stretch first passes an abscissa: between a row and the next, at a share of the distance.
struct Crossing {
  std::size_t row = 0;
  double share = 0.0;
};

/// Crossings in the order of the abscissae; none for an abscissa that the stretch does not reach. Ends of runs that
/// differ by round-off are the same.
[[nodiscard]] std::vector<std::optional<Crossing>> crossings(std::span<const double> x, const Stretch& stretch,
                                                             std::span<const double> abscissae) {
  std::vector<std::optional<Crossing>> found(abscissae.size());
  const auto [lowest, highest] = std::ranges::minmax(x.subspan(stretch.begin, stretch.end - stretch.begin));
  const double same = k_same_value * std::max(std::abs(lowest), std::abs(highest));
  std::size_t row = stretch.begin;
  for (std::size_t k = 0; k < abscissae.size(); ++k) {
    const double within = std::clamp(abscissae[k], lowest, highest);
    const double abscissa = std::abs(within - abscissae[k]) <= same ? within : abscissae[k];
    for (std::size_t next = row; next + 1 < stretch.end; ++next) {
      const double share = (abscissa - x[next]) / (x[next + 1] - x[next]);
      if (!(share >= 0.0 && share <= 1.0)) continue;
      found[k] = Crossing{next, share};
      row = next;
      break;
    }
  }
  return found;
}

/// Least and largest x of a step over all runs, in the direction of the first run.
struct Abscissae {
  double lowest = 0.0;
  double highest = 0.0;
  bool is_rising = true;
};

[[nodiscard]] std::map<std::size_t, Abscissae> ranges_of(const std::vector<RunCurves>& runs) {
  std::map<std::size_t, Abscissae> ranges;
  for (const RunCurves& run : runs) {
    for (const auto& [step, stretch] : run.stretches) {
      const double first = run.x[stretch.begin];
      const double last = run.x[stretch.end - 1];
      Abscissae& range = ranges.try_emplace(step, Abscissae{first, first, last >= first}).first->second;
      for (std::size_t row = stretch.begin; row < stretch.end; ++row) {
        range.lowest = std::min(range.lowest, run.x[row]);
        range.highest = std::max(range.highest, run.x[row]);
      }
    }
  }
  return ranges;
}

[[nodiscard]] std::vector<double> abscissae_of(const Abscissae& range, int points) {
  std::vector<double> x;
  for (int k = 0; k < points; ++k) {
    const double share = static_cast<double>(range.is_rising ? k : points - 1 - k) / (points - 1);
    x.push_back(std::lerp(range.lowest, range.highest, share));
  }
  return x;
}

/// "p5" of 5, "p2.5" of 2.5.
[[nodiscard]] std::string name_of(double percentile) { return fmt::format("p{:g}", percentile); }

[[nodiscard]] Table table_of(const Sweep& sweep, const HistoryBands& bands) {
  std::vector<Column> columns{{"step", "", {}}, bands.x, {"runs", "", {}}};
  for (const Column& y : bands.y) {
    for (const double percentile : sweep.bands->percentiles) {
      columns.push_back({fmt::format("{}.{}", name_of(percentile), y.name), y.unit, {}});
    }
  }
  Table table(std::move(columns));
  table.header = {{"program", fmt::format("monograin {}", version())},
                  {"sweep", sweep.name},
                  {"sweep_digest", sweep.digest},
                  {"design", sweep.design}};
  for (const StepBands& step : bands.steps) {
    for (std::size_t i = 0; i < step.x.size(); ++i) {
      std::vector<double> row{static_cast<double>(step.step), step.x[i], static_cast<double>(step.runs[i])};
      for (const auto& of_y : step.percentiles) {
        for (const auto& values : of_y) row.push_back(values[i]);
      }
      table.append(row);
    }
  }
  return table;
}

/// "Axial contact radius [m]" of "axial.contact_radius".
[[nodiscard]] std::string label_of(const Column& column) {
  std::string name = column.name;
  std::ranges::replace_if(
      name, [](char c) { return c == '.' || c == '_'; }, ' ');
  name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  return figure::verbatim_text(column.unit.empty() || column.unit == "-" ? name
                                                                         : fmt::format("{} [{}]", name, column.unit));
}

/// Draws the outermost percentiles as an area, the others as dashed lines, and the median as a solid line.
[[nodiscard]] figure::ChartPanel panel_of(const Sweep& sweep, const HistoryBands& bands, std::size_t y) {
  using Style = figure::ChartSeries::Style;
  const std::vector<double>& percentiles = sweep.bands->percentiles;
  const std::size_t last = percentiles.size() - 1;
  figure::ChartPanel panel{.x = {.label = label_of(bands.x)}, .y = {.label = label_of(bands.y[y])}};
  for (const StepBands& step : bands.steps) {
    const auto& curves = step.percentiles[y];
    if (last > 0) {
      panel.bands.push_back({.legend = fmt::format("{:g} % to {:g} %", percentiles.front(), percentiles.back()),
                             .colour = k_band_colour,
                             .x = step.x,
                             .lower = curves.front(),
                             .upper = curves.back()});
    }
    for (std::size_t p = last > 0 ? 1 : 0; p < std::max<std::size_t>(last, 1); ++p) {
      const bool is_median = percentiles[p] == 50.0;
      panel.series.push_back({.legend = is_median ? "median" : fmt::format("{:g} %", percentiles[p]),
                              .style = is_median ? Style::solid : Style::dashed,
                              .colour = p,
                              .x = step.x,
                              .y = curves[p]});
    }
  }
  return panel;
}

/// Values of one step in all runs, by y and abscissa.
using StepValues = std::vector<std::vector<std::vector<double>>>;

/// Adds the interpolated values of a run, and counts the run at each abscissa that it passes.
void add_run(const RunCurves& run, const Stretch& stretch, StepBands& bands, StepValues& values) {
  const auto found = crossings(run.x, stretch, bands.x);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!found[i]) continue;
    ++bands.runs[i];
    for (std::size_t k = 0; k < run.y.size(); ++k) {
      const double value = std::lerp(run.y[k][found[i]->row], run.y[k][found[i]->row + 1], found[i]->share);
      if (std::isfinite(value)) values[k][i].push_back(value);
    }
  }
}

/// Sets the percentiles; nan where too few runs have a value.
void find_percentiles(StepBands& bands, StepValues& values, std::span<const double> percentiles, std::size_t runs) {
  bands.percentiles.assign(values.size(), std::vector(percentiles.size(), std::vector(bands.x.size(), k_nan)));
  for (std::size_t k = 0; k < values.size(); ++k) {
    for (std::size_t i = 0; i < bands.x.size(); ++i) {
      std::vector<double>& of_runs = values[k][i];
      if (static_cast<double>(of_runs.size()) < k_least_share * static_cast<double>(runs)) continue;
      std::ranges::sort(of_runs);
      for (std::size_t p = 0; p < percentiles.size(); ++p) {
        bands.percentiles[k][p][i] = quantile(of_runs, 0.01 * percentiles[p]);
      }
    }
  }
}

}  // namespace

HistoryBands bands_of(const Sweep& sweep, const fs::path& folder) {
  const BandRequest& request = *sweep.bands;
  HistoryBands bands;
  const std::vector<RunCurves> runs = read_curves(sweep, folder, bands);
  const std::map<std::size_t, Abscissae> ranges = ranges_of(runs);
  if (ranges.empty()) {
    throw std::runtime_error(fmt::format("{}: no run has a history; the reasons are in the results", folder.string()));
  }
  for (const auto& [step, range] : ranges) {
    StepBands& own = bands.steps.emplace_back(StepBands{.step = step, .x = abscissae_of(range, request.points)});
    own.runs.assign(own.x.size(), 0);
    StepValues values(request.y.size(), std::vector<std::vector<double>>(own.x.size()));
    for (const RunCurves& run : runs) {
      if (const auto stretch = run.stretches.find(step); stretch != run.stretches.end()) {
        add_run(run, stretch->second, own, values);
      }
    }
    find_percentiles(own, values, request.percentiles, sweep.runs.size());
  }
  return bands;
}

std::string write_bands(const Sweep& sweep, const HistoryBands& bands, const fs::path& folder,
                        std::string_view format) {
  write_csv(folder / k_bands_file, table_of(sweep, bands));
  figure::Chart chart;
  for (std::size_t y = 0; y < bands.y.size(); ++y) chart.panels.push_back(panel_of(sweep, bands, y));
  return figure::try_to_draw(chart, "percentiles of the histories of sweep " + sweep.name,
                             folder / fmt::format("bands.{}", format));
}

}  // namespace monograin
