/// Scenarios of the law of coupled elastic-plastic contacts, and its reference curves.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "history/run.hpp"
#include "history/table.hpp"
#include "support/test_run.hpp"

namespace monograin::cel {

/// A unit particle (R0 = 1, E = 1).
inline CheckedScenario cel_scenario(Configuration configuration, double modulus_over_yield, double poisson_ratio,
                                    std::vector<Step> steps) {
  CheckedScenario scenario = hertz_scenario(configuration, std::move(steps));
  scenario.model = "cel";
  scenario.material["poisson_ratio"] = poisson_ratio;
  scenario.material["yield_stress"] = 1.0 / modulus_over_yield;
  return scenario;
}

inline CheckedScenario with_free_centre(CheckedScenario scenario) {
  scenario.loading.centre_is_free = true;
  return scenario;
}

/// A unit particle between walls, each with a ramp of unit duration to each of its displacements.
inline CheckedScenario cel_walls(double modulus_over_yield, double poisson_ratio,
                                 const std::vector<Eigen::Vector3d>& normals,
                                 const std::vector<std::vector<double>>& corners) {
  std::vector<WallSpec> walls;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    std::vector<double> displacements;
    for (const std::vector<double>& corner : corners) displacements.push_back(corner[i]);
    walls.push_back(wall("w" + std::to_string(i), normals[i], path(displacements)));
  }
  return between(cel_scenario(Configuration::walls, modulus_over_yield, poisson_ratio, {}), std::move(walls));
}

/// Begin or end of a dent's growth.
struct FlowEvent {
  double time = 0.0;
  std::string name;
  std::size_t wall = 0;
};

/// A reference curve computed by another program, with the scenario of its header and one output point for each row.
struct ReferenceCurve {
  Table table;
  CheckedScenario scenario;
  std::vector<FlowEvent> events;
  std::size_t walls = 0;
};

/// True if every wall has an opposite one with the same program, so that the centre stays.
inline bool is_inversion_symmetric(const std::vector<WallSpec>& walls) {
  return std::ranges::all_of(walls, [&](const WallSpec& w) {
    return std::ranges::any_of(walls, [&](const WallSpec& other) {
      double sum = 0.0;
      for (std::size_t k = 0; k < 3; ++k) sum += std::abs(w.normal[k] + other.normal[k]);
      return sum < 1e-12 && std::ranges::equal(w.steps, other.steps, {}, &Step::target, &Step::target);
    });
  });
}

inline ReferenceCurve load_curve(const std::string& name) {
  ReferenceCurve curve;
  curve.table = read_csv(MONOGRAIN_SOURCE_DIR "/tests/models/cel/reference/" + name + ".csv");
  const auto json = [&](const char* key) { return nlohmann::json::parse(curve.table.header_value(key)); };
  std::vector<Eigen::Vector3d> normals;
  for (const auto& normal : json("wall normals")) normals.emplace_back(normal[0], normal[1], normal[2]);
  curve.walls = normals.size();
  curve.scenario =
      cel_walls(curve.table.header_number("E_over_Y").value(), curve.table.header_number("poisson_ratio").value(),
                normals, json("program").get<std::vector<std::vector<double>>>());
  curve.scenario.loading.centre_is_free = !is_inversion_symmetric(curve.scenario.loading.walls);
  const auto segment = curve.table.column("segment");
  const auto t = curve.table.column("t");
  for (std::size_t row = 0; row < t.size(); ++row) curve.scenario.output.times.push_back(segment[row] + t[row]);
  for (const auto& [key, value] : curve.table.header) {
    if (key != "event") continue;
    FlowEvent event;
    double step = 0.0;
    char word[16] = "";
    if (std::sscanf(value.c_str(), "segment %lf t %lf %15s wall %zu", &step, &event.time, word, &event.wall) != 4)
      throw std::runtime_error("not an event: " + value);
    event.time += step;
    event.name = std::string_view(word) == "unload" ? "load-reversal" : word;
    curve.events.push_back(event);
  }
  return curve;
}

/// Name of the class of a wall of a reference curve.
inline std::string class_of(const TestRun& run, std::size_t wall) {
  for (std::size_t c = 0; c < run.scene.classes.size(); ++c) {
    const auto& names = run.scene.walls[c];
    if (std::ranges::find(names, "w" + std::to_string(wall)) != names.end()) return run.scene.classes[c].name;
  }
  throw std::out_of_range("no class has wall " + std::to_string(wall));
}

/// Largest error of a run against a curve for each kind of column, over the largest magnitude of that kind; infinity if
/// rows are missing.
struct CurveError {
  double force = 0.0, area = 0.0, energy = 0.0, core = 0.0, centre = 0.0;
  double event_time = 0.0;  ///< over the length of the run
  std::string mismatch;     ///< what is wrong with the events; empty: all there, no others
};

inline CurveError error_of(const TestRun& run, const ReferenceCurve& curve) {
  CurveError error;
  const std::size_t rows = curve.table.row_count();
  const auto compare = [&](const std::string& ours, const std::string& theirs, double scale, bool is_radius = false) {
    std::vector<double> actual = run.outputs(ours);
    const std::vector<double> expected = curve.table.column(theirs);
    // A run begins with a row at its start, which a curve has not.
    if (actual.size() == rows + 1) actual.erase(actual.begin());
    if (actual.size() != rows) return std::numeric_limits<double>::infinity();
    double worst = 0.0;
    for (std::size_t row = 0; row < rows; ++row) {
      const double value = is_radius ? actual[row] * actual[row] : actual[row];
      if (const double off = std::abs(value - expected[row]) / scale; !(off <= worst)) worst = off;
    }
    return worst;
  };
  const auto largest_of = [&](const std::string& kind) {
    double value = 0.0;
    for (std::size_t i = 0; i < curve.walls; ++i)
      value = std::max(value, largest(curve.table.column(kind + std::to_string(i))));
    return value;
  };
  const double force = largest_of("F");
  const double area = largest_of("area_over_pi");
  for (std::size_t i = 0; i < curve.walls; ++i) {
    const std::string name = class_of(run, i);
    const std::string number = std::to_string(i);
    error.force = std::max(error.force, compare(name + ".force", "F" + number, force));
    error.area = std::max(error.area, compare(name + ".contact_radius", "area_over_pi" + number, area, true));
  }
  const double work = largest(curve.table.column("work"));
  error.energy = std::max(compare("work", "work", work), compare("stored_energy", "stored", work));
  error.core = compare("core_strain", "e", std::max(1e-3, largest(curve.table.column("e"))));
  if (curve.scenario.loading.centre_is_free) {
    for (const char* axis : {"x", "y", "z"})
      error.centre = std::max(error.centre, compare(std::string("centre_") + axis, axis, 1.0));
  }

  const Table& events = run.record.events;
  std::vector<FlowEvent> open;
  for (std::size_t k = 0; k < events.row_count(); ++k) {
    const std::string word(events.word(k, *events.find("event")));
    if (word == "yield" || word == "load-reversal") open.push_back({events.at(k, *events.find("time")), word, k});
  }
  std::vector<bool> is_met(open.size(), false);
  const double length = curve.scenario.output.times.back();
  for (const FlowEvent& expected : curve.events) {
    const std::string contact_class = class_of(run, expected.wall);
    double nearest = std::numeric_limits<double>::infinity();
    std::size_t at = 0;
    for (std::size_t k = 0; k < open.size(); ++k) {
      if (open[k].name != expected.name || events.word(open[k].wall, *events.find("class")) != contact_class) continue;
      if (const double off = std::abs(open[k].time - expected.time); off < nearest) {
        nearest = off;
        at = k;
      }
    }
    if (!(nearest <= 1e-3)) {
      error.mismatch += "no " + expected.name + " of " + contact_class + " at " + std::to_string(expected.time) + "; ";
      continue;
    }
    is_met[at] = true;
    error.event_time = std::max(error.event_time, nearest / length);
  }
  for (std::size_t k = 0; k < open.size(); ++k) {
    if (!is_met[k]) error.mismatch += open[k].name + " at " + std::to_string(open[k].time) + " is no event; ";
  }
  return error;
}

}  // namespace monograin::cel
