#include "study/regress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "history/compare.hpp"
#include "history/run.hpp"
#include "scenario/text_file.hpp"
#include "scene/scene.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

// The direct form reproduces a stored curve but for the rounding of another compiler or library.
constexpr double k_direct_tolerance = 1e-10;
// Integrated curves: so many times their rtol.
constexpr double k_rtol_multiple = 50.0;
// Of that, what a stored curve may be wrong that had to be integrated itself.
constexpr double k_tighter = 1e-2;

// Share of a curve that has to be there; events at its ends may be a rounding error apart.
constexpr double k_whole = 0.999;

constexpr std::array<std::string_view, 4> k_integrators{"direct", "cvode-adams", "cvode-bdf", "ida"};

bool has_direct_form(const Scenario& scenario) { return make_scene(scenario).system->is_solvable(); }

std::vector<fs::path> scenario_files(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw std::runtime_error(
        fmt::format("{}: no such folder; run this in the project's folder, or name it", folder.string()));
  }
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

Run run_with(Scenario scenario, std::string_view integrator) {
  scenario.numerics.integrator = integrator;
  return run_scenario(scenario);
}

/// Names of the events in their order; event tables of different runs number their words differently.
std::vector<std::string> event_names(const Table& events) {
  std::vector<std::string> names;
  const auto class_column = *events.find("class");
  const auto event = *events.find("event");
  for (std::size_t i = 0; i < events.row_count(); ++i) {
    names.push_back(fmt::format("{} {}", events.word(i, event), events.word(i, class_column)));
  }
  return names;
}

double event_time_difference(const Table& stored, const Table& now) {
  const std::vector<double> a = stored.column("time");
  const std::vector<double> b = now.column("time");
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return a.empty() || a.back() == 0.0 ? largest : largest / a.back();
}

/// A history with the squares of contact radii: they begin like a root, of which an overlap that is wrong by 1e-12
/// makes a millionth where an event has just been reached.
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

void compare_with_stored(const Run& run, const fs::path& curves, RegressionResult& result) {
  const fs::path curve = curves / (run.scenario.name + ".csv");
  if (!fs::exists(curve)) {
    result.fault = fmt::format("{} is missing; 'monograin regress --accept' stores it", curve.string());
    return;
  }
  const Table history = read_csv(curve);
  const Table events = read_csv(curves / (run.scenario.name + ".events.csv"));
  if (history.header_value("scenario_digest") != scenario_digest(run.scenario)) {
    result.fault = "the scenario has changed since its curve was stored";
  } else if (run.record.status != RunStatus::complete) {
    result.fault = run.record.message;
  } else if (event_names(events) != event_names(run.record.events)) {
    result.fault = "other events, or in another order, than stored";
  }
  if (!result.fault.empty()) return;
  result.event_time = event_time_difference(events, run.record.events);
  // Some columns are blank in parts where a law says nothing.
  const Table expected = with_smooth_columns(history);
  const auto of_stored = compare_tables(expected, expected, "time", "");
  const auto differences = compare_tables(expected, with_smooth_columns(run.record.history), "time", "");
  for (std::size_t i = 0; i < differences.size(); ++i) {
    const CurveDifference& difference = differences[i];
    if (difference.coverage < k_whole * of_stored[i].coverage) {
      result.fault = fmt::format("{} is not as long as stored", difference.y);
    }
    if (!(difference.linf <= result.difference)) {
      result.difference = difference.linf;
      result.column = difference.y;
    }
  }
}

RegressionResult compare(const Run& run, const fs::path& curves) {
  RegressionResult result{.scenario = run.scenario.name, .integrator = run.integrator.used, .column = {}, .fault = {}};
  result.tolerance =
      run.integrator.used == "direct" ? k_direct_tolerance : k_rtol_multiple * run.scenario.numerics.rtol;
  try {
    compare_with_stored(run, curves, result);
  } catch (const std::runtime_error& error) {
    result.fault = error.what();
  }
  return result;
}

void store(const fs::path& file, const Table& table) {
  std::ostringstream text;
  write_csv(table, text);
  write_text_file(file, text.view());
}

}  // namespace

std::vector<RegressionResult> regress(const fs::path& scenarios, const fs::path& curves) {
  std::vector<RegressionResult> results;
  for (const fs::path& file : scenario_files(scenarios)) {
    const Scenario scenario = read_scenario(file);
    const bool has_direct = has_direct_form(scenario);
    for (const std::string_view integrator : k_integrators) {
      if (has_direct || integrator != "direct") results.push_back(compare(run_with(scenario, integrator), curves));
    }
  }
  return results;
}

std::vector<RegressionResult> accept_curves(const fs::path& scenarios, const fs::path& curves) {
  fs::create_directories(curves);
  std::vector<RegressionResult> results;
  for (const fs::path& file : scenario_files(scenarios)) {
    Scenario scenario = read_scenario(file);
    const bool has_direct = has_direct_form(scenario);
    if (!has_direct) {
      scenario.numerics.rtol *= k_tighter;
      scenario.numerics.atol *= k_tighter;
    }
    Run run = run_with(scenario, has_direct ? "direct" : "cvode-bdf");
    results.push_back(compare(run, curves));
    if (run.record.status != RunStatus::complete) {
      throw std::runtime_error(fmt::format("{}: does not run to its end: {}", file.string(), run.record.message));
    }
    const std::pair<std::string, std::string> claim{
        "accuracy", has_direct ? "direct solution, 1e-12 of each column's largest magnitude"
                               : fmt::format("integrated, {:g} of each column's largest magnitude",
                                             k_rtol_multiple * scenario.numerics.rtol)};
    for (Table* table : {&run.record.history, &run.record.events}) table->header.push_back(claim);
    store(curves / (run.scenario.name + ".csv"), run.record.history);
    store(curves / (run.scenario.name + ".events.csv"), run.record.events);
  }
  return results;
}

}  // namespace monograin
