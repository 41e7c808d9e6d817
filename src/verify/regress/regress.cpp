#include "verify/regress/regress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string_view>

#include "history/compare.hpp"
#include "history/run.hpp"
#include "scenario/integrators.hpp"
#include "scenario/text_file.hpp"
#include "scene/scene.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

// Tolerance of integrated curves, over their rtol.
constexpr double k_rtol_multiple = 50.0;
// Tolerances of a stored curve that had to be integrated itself, over those of the scenario.
constexpr double k_tighter = 1e-2;

constexpr std::size_t k_most_faults = 4;  // of one run: one change may touch every column
constexpr std::string_view k_events_suffix = ".events.csv";

constexpr std::array<std::string_view, 4> k_integrators{integrators::k_direct, integrators::k_cvode_adams,
                                                        integrators::k_cvode_bdf, integrators::k_ida};

bool has_direct_form(const CheckedScenario& scenario) { return make_scene(scenario).system->is_solvable(); }

Run run_with(CheckedScenario scenario, std::string_view integrator) {
  scenario.numerics.integrator = integrator;
  return run_scenario(scenario);
}

/// A history with the squares of contact radii. A contact radius begins like a square root: an overlap that is wrong by
/// 1e-12 R0 makes it wrong by 1e-6 R0 just after first touch.
Table with_smooth_columns(const Table& history) {
  Table smooth(history.columns());
  std::vector<double> row;
  for (std::size_t i = 0; i < history.row_count(); ++i) {
    row.assign(history.row(i).begin(), history.row(i).end());
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (history.columns()[c].name.find(".contact_radius") != std::string::npos) row[c] *= row[c];
    }
    smooth.append(row);
  }
  return smooth;
}

/// Collects the faults of one run as one sentence.
class FaultText {
 public:
  void add(std::string fault) {
    if (++count_ <= k_most_faults) text_ += (text_.empty() ? "" : "; ") + fault;
  }
  [[nodiscard]] std::string text() const {
    return count_ <= k_most_faults ? text_ : fmt::format("{}; and {} more", text_, count_ - k_most_faults);
  }

 private:
  std::string text_;
  std::size_t count_ = 0;
};

void add_gaps(const Comparison& run_to_stored, const Comparison& stored_to_run, FaultText& faults) {
  for (const Gap& gap : run_to_stored.gaps) faults.add(fmt::format("{} {}", gap.column, gap.problem));
  for (const Gap& gap : stored_to_run.gaps) {
    if (std::ranges::find(run_to_stored.gaps, gap.column, &Gap::column) != run_to_stored.gaps.end()) continue;
    faults.add(fmt::format("stored {} {}", gap.column, gap.problem));
  }
}

/// Keeps the largest difference of a run from its stored curve, and its column.
void take(double difference, const std::string& column, RegressionResult& result) {
  if (difference <= result.difference || std::isnan(result.difference)) return;  // nan is taken, and stays
  result.difference = difference;
  result.column = column;
}

/// Compares the values at events, row by row, over the largest value of each column in the history.
void compare_at_events(const Table& expected, const Table& now, const Table& history, RegressionResult& result) {
  for (const Column& column : expected.columns()) {
    const auto of_now = now.find(column.name);
    if (column.holds_words() || column.name == "time" || !history.find(column.name) || !of_now) continue;
    double largest = 0.0;
    for (const double value : history.column(column.name)) largest = std::fmax(largest, std::abs(value));
    if (largest == 0.0) continue;
    const std::vector<double> stored = expected.column(column.name);
    for (std::size_t row = 0; row < stored.size(); ++row) {
      const double value = now.at(row, *of_now);
      if (std::isnan(value) && std::isnan(stored[row])) continue;
      take(std::abs(value - stored[row]) / largest, fmt::format("{} at an event", column.name), result);
    }
  }
}

void compare_with_stored(const Run& run, const fs::path& curves, RegressionResult& result) {
  const fs::path curve = curves / (run.scenario.name + ".csv");
  if (!fs::exists(curve)) {
    result.fault = fmt::format("{} is missing; 'monograin regress --accept' stores it", curve.string());
    return;
  }
  const Table history = read_csv(curve);
  const Table events = read_csv(curves / (run.scenario.name + std::string(k_events_suffix)));
  FaultText faults;
  if (history.header_value("scenario_digest") != scenario_digest(run.scenario)) {
    faults.add("the scenario has changed since its curve was stored");
  }
  if (run.record.status != RunStatus::complete) faults.add(run.record.message);
  const Comparison of_events = compare_events(events, run.record.events);
  for (const Gap& gap : of_events.gaps) faults.add(fmt::format("{} {}", gap.column, gap.problem));
  const Table expected = with_smooth_columns(history);
  const Table now = with_smooth_columns(run.record.history);
  const Comparison of_run = compare_tables(expected, now, "time", "");
  // The run may have something that the stored curve lacks, too.
  add_gaps(of_run, compare_tables(now, expected, "time", ""), faults);
  result.difference = 0.0;
  for (const CurveDifference& difference : of_run.curves) take(difference.linf, difference.y, result);
  if (of_events.gaps.empty()) {
    result.event_time = of_events.curves.empty() ? 0.0 : of_events.curves.front().linf;
    compare_at_events(with_smooth_columns(events), with_smooth_columns(run.record.events), expected, result);
  }
  result.fault = faults.text();
}

RegressionResult compare(const Run& run, const fs::path& curves) {
  RegressionResult result{.scenario = run.scenario.name, .integrator = run.integrator.used};
  result.tolerance =
      run.integrator.is_direct() ? integrators::k_direct_tolerance : k_rtol_multiple * run.scenario.numerics.rtol;
  try {
    compare_with_stored(run, curves, result);
  } catch (const std::runtime_error& error) {
    result.fault = error.what();
  }
  return result;
}

/// Stored curves whose scenario no longer exists.
std::vector<RegressionResult> orphaned_curves(const std::vector<fs::path>& scenarios, const fs::path& curves) {
  std::set<std::string> names;
  for (const fs::path& file : scenarios) names.insert(file.stem().string());
  std::vector<RegressionResult> results;
  std::vector<fs::path> files;
  if (fs::is_directory(curves)) files.assign(fs::directory_iterator(curves), fs::directory_iterator());
  std::ranges::sort(files);
  for (const fs::path& file : files) {
    std::string name = file.filename().string();
    if (!name.ends_with(".csv")) continue;
    const std::size_t suffix = name.ends_with(k_events_suffix) ? k_events_suffix.size() : 4;
    name.erase(name.size() - suffix);
    if (!names.insert(name).second) continue;
    results.push_back(
        {.scenario = name,
         .fault = fmt::format("{} has no scenario; remove it, or bring {}.toml back", file.string(), name)});
  }
  return results;
}

}  // namespace

std::vector<RegressionResult> regress(const fs::path& scenarios, const fs::path& curves) {
  const std::vector<fs::path> files = toml_files(scenarios, "scenario", "--scenarios");
  std::vector<RegressionResult> results = orphaned_curves(files, curves);
  for (const fs::path& file : files) {
    const CheckedScenario scenario = read_scenario(file);
    const bool has_direct = has_direct_form(scenario);
    for (const std::string_view integrator : k_integrators) {
      if (has_direct || integrator != integrators::k_direct)
        results.push_back(compare(run_with(scenario, integrator), curves));
    }
  }
  return results;
}

std::vector<RegressionResult> accept_curves(const fs::path& scenarios, const fs::path& curves) {
  const std::vector<fs::path> files = toml_files(scenarios, "scenario", "--scenarios");
  std::vector<RegressionResult> results = orphaned_curves(files, curves);
  std::vector<Run> runs;  // all are computed before the first one replaces a curve
  for (const fs::path& file : files) {
    CheckedScenario scenario = read_scenario(file);
    const bool has_direct = has_direct_form(scenario);
    if (!has_direct) {
      scenario.numerics.rtol *= k_tighter;
      scenario.numerics.atol *= k_tighter;
    }
    Run run = run_with(scenario, has_direct ? integrators::k_direct : integrators::k_cvode_bdf);
    results.push_back(compare(run, curves));
    if (run.record.status != RunStatus::complete) {
      throw std::runtime_error(fmt::format("{}: does not run to its end: {}", file.string(), run.record.message));
    }
    const std::pair<std::string, std::string> claim{
        "accuracy", has_direct ? "direct solution, 1e-12 of each column's largest magnitude"
                               : fmt::format("integrated, {:g} of each column's largest magnitude",
                                             k_rtol_multiple * scenario.numerics.rtol)};
    for (Table* table : {&run.record.history, &run.record.events}) table->header.push_back(claim);
    runs.push_back(std::move(run));
  }
  fs::create_directories(curves);
  for (const Run& run : runs) {
    write_csv(curves / (run.scenario.name + ".csv"), run.record.history);
    write_csv(curves / (run.scenario.name + std::string(k_events_suffix)), run.record.events);
  }
  return results;
}

}  // namespace monograin
