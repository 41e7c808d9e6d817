#include "support/reference_case.hpp"
#include "support/deviation.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <stdexcept>

namespace monograin {
namespace {

double number(const std::string& text) {
  double value = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

std::string event_name(const std::string& kind) {
  static const std::map<std::string, std::string> names{
      {"yield", "yield"},       {"growth_on", "growth-on"}, {"growth_off", "growth-off"},
      {"make", "contact-made"}, {"break", "contact-lost"},  {"remake", "dent-touched"},
      {"passmax", "reload"},    {"peel", "peel"},           {"pulloff", "pull-off"}};
  return names.at(kind);
}

std::string field(const std::string& line, const std::string& key) {
  const auto begin = line.find(key + "=") + key.size() + 1;
  return line.substr(begin, line.find(' ', begin) - begin);
}

std::vector<Step> wall_program(const nlohmann::json& program, std::size_t wall) {
  std::vector<Step> steps;
  bool is_fixed = true;
  for (const auto& segment : program) {
    const auto& control = segment["controls"][wall];
    Step step;
    step.duration = segment["duration"].get<double>();
    if (control.is_object()) {
      const bool is_force = control.contains("force_to");
      step.kind = is_force ? Step::Kind::force : Step::Kind::displacement;
      step.target = number(control[is_force ? "force_to" : "displacement_to"].get<std::string>());
      is_fixed = false;
    }
    steps.push_back(step);
  }
  return is_fixed ? std::vector<Step>{} : steps;
}

CheckedScenario scenario_of(const nlohmann::json& json) {
  CheckedScenario scenario;
  scenario.name = "reference";
  scenario.model = "mdr";
  scenario.radius = 1.0;
  scenario.material = {{"youngs_modulus", 1.0},
                       {"poisson_ratio", number(json["nu"])},
                       {"yield_stress", 1.0 / number(json["E_over_Y"])},
                       {"surface_energy", number(json["dgamma_over_ER0"])}};
  scenario.options = {{"radius_rule", json["radius_rule"].get<std::string>()},
                      {"elastic_profile", json["elastic_profile"].get<std::string>()},
                      {"delta_max_rule", std::string("running-maximum")},
                      {"strict", false},
                      {"pressure_table", std::string()}};
  scenario.loading.configuration = Loading::Configuration::walls;
  for (std::size_t i = 0; i < json["walls"].size(); ++i) {
    WallSpec wall;
    wall.name = "w" + std::to_string(i);
    for (std::size_t k = 0; k < 3; ++k) wall.normal[k] = json["walls"][i]["normal"][k].get<double>();
    wall.gap = -number(json["walls"][i]["delta_o0"].get<std::string>());
    wall.steps = wall_program(json["program"], i);
    wall.is_fixed = wall.steps.empty();
    scenario.loading.walls.push_back(wall);
  }
  return scenario;
}

/// Rows of a table by instant and side. At an instant with several events, the first row before and the last one after
/// them.
std::map<std::pair<int, double>, std::size_t> rows_by_instant(const Table& table, const std::string& time) {
  const std::vector<double> times = table.column(time);
  const std::vector<double> sides = table.column("row");
  std::map<std::pair<int, double>, std::size_t> rows;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto key = std::pair(static_cast<int>(sides[i]), times[i]);
    if (sides[i] < 0.0)
      rows.emplace(key, i);
    else
      rows.insert_or_assign(key, i);
  }
  return rows;
}

}  // namespace

std::string test_file(const std::string& relative) { return std::string(MONOGRAIN_SOURCE_DIR "/tests/") + relative; }

ReferenceCase load_reference(const std::string& name) {
  ReferenceCase result;
  result.table = read_csv(test_file("models/mdr/reference/" + name + ".csv"));
  result.scenario = scenario_of(nlohmann::json::parse(result.table.header_value("scenario")));
  for (const auto& [key, value] : result.table.header) {
    if (key != "event") continue;
    const std::string wall = field(value, "wall");
    result.events.push_back({number(field(value, "t")), event_name(field(value, "kind")),
                             wall == "None" ? -1 : static_cast<int>(number(wall))});
  }
  std::set<double> times;
  for (const auto& [key, row] : rows_by_instant(result.table, "t")) {
    if (key.first == 0 && key.second > 0.0) times.insert(key.second);
  }
  result.scenario.output.times.assign(times.begin(), times.end());
  for (const Column& column : result.table.columns()) {
    if (column.name.starts_with("F_")) result.walls.push_back(static_cast<int>(number(column.name.substr(2, 1))));
  }
  return result;
}

CurveErrors errors_against(const ReferenceCase& reference, const RunRecord& run, const Scene& scene) {
  CurveErrors errors;
  const double length = reference.scenario.output.times.back();
  const double yield_stress = reference.scenario.material.at("yield_stress");

  std::vector<std::string> class_of_wall;
  for (const WallSpec& wall : reference.scenario.loading.walls) {
    for (std::size_t c = 0; c < scene.classes.size(); ++c) {
      if (std::ranges::find(scene.walls[c], wall.name) != scene.walls[c].end())
        class_of_wall.push_back(scene.classes[c].name);
    }
  }
  struct Pair {
    std::string reference, ours;
    double scale;
  };
  std::vector<Pair> pairs{{"R_over_R0", "apparent_radius", 1.0},
                          {"V_over_V0", "volume", 3.0 / (4.0 * std::numbers::pi)},
                          {"work_over_ER03", "work", 1.0},
                          {"stored_over_ER03", "stored_energy", 1.0},
                          {"dissipation_over_ER03", "dissipation", 1.0}};
  for (const int wall : reference.walls) {
    const std::string w = std::to_string(wall);
    const std::string& c = class_of_wall[static_cast<std::size_t>(wall)];
    pairs.push_back({"F_" + w + "_over_ER02", c + ".force", 1.0});
    pairs.push_back({"delta_" + w + "_over_R0", c + ".overlap", 1.0});
    pairs.push_back({"delta_o_" + w + "_over_R0", c + ".displacement", 1.0});
    pairs.push_back({"a_" + w + "_over_R0", c + ".contact_radius", 1.0});
    pairs.push_back({"pmean_" + w + "_over_Y", c + ".pressure", 1.0 / yield_stress});
  }

  const auto ours = rows_by_instant(run.history, "time");
  const auto theirs = rows_by_instant(reference.table, "t");
  /// Magnitude of the force of the wall that a column belongs to.
  const auto force_of = [&](const std::string& column, std::size_t row) {
    const std::string wall = column.substr(column.find('_') + 1, 1);
    return std::abs(reference.table.column("F_" + wall + "_over_ER02")[row]);
  };
  // At a yield under force, the reference has a row before the wall moves on, in which its contact carries too much.
  const auto yields_under_force = [&](double instant) {
    return std::ranges::any_of(reference.events, [&](const ReferenceEvent& e) {
      if (e.name != "yield" || std::abs(e.time - instant) > 1e-5 * length) return false;
      const WallSpec& wall = reference.scenario.loading.walls[static_cast<std::size_t>(e.wall)];
      return std::ranges::any_of(wall.steps, [](const Step& step) { return step.kind == Step::Kind::force; });
    });
  };
  for (const Pair& pair : pairs) {
    const std::vector<double> expected = reference.table.column(pair.reference);
    const std::vector<double> actual = run.history.column(pair.ours);
    double peak = 0.0;
    for (const double value : expected) peak = std::max(peak, std::abs(value));
    double worst = 0.0;
    for (const auto& [key, row] : theirs) {
      if (key.first > 0 && yields_under_force(key.second)) continue;
      auto found = ours.lower_bound({key.first, key.second - 1e-5 * length});
      // The nearest row of the run on that side.
      auto best = found;
      while (found != ours.end() && found->first.first == key.first &&
             found->first.second < key.second + 1e-5 * length) {
        if (std::abs(found->first.second - key.second) < std::abs(best->first.second - key.second)) best = found;
        ++found;
      }
      if (best == ours.end() || best->first.first != key.first ||
          std::abs(best->first.second - key.second) > 1e-5 * length) {
        if (key.first == 0 && errors.mismatch.empty())
          errors.mismatch = "no row at t = " + std::to_string(key.second) + "; ";
        continue;
      }
      // Contact radius and pressure go like a square root where contact is lost: the error of the event's time is no
      // error of theirs, nor is round-off where the force vanishes.
      const bool is_root = pair.reference.starts_with("a_") || pair.reference.starts_with("pmean_");
      if (is_root && (key.first != 0 || force_of(pair.reference, row) < 1e-20)) continue;
      worst = std::max(worst, deviation(actual[best->second] * pair.scale, expected[row]));
    }
    const double relative = peak > 0.0 ? worst / peak : worst;
    errors.by_quantity[pair.reference] = relative;
    errors.largest = std::max(errors.largest, relative);
  }

  // The reference does not list events of the program, reversals, edges that come to rest and extrema of forces. It
  // lists one event per wall.
  std::vector<std::pair<std::string, double>> actual;
  const auto time = *run.events.find("time");
  const auto class_column = *run.events.find("class");
  const auto event = *run.events.find("event");
  for (std::size_t i = 0; i < run.events.row_count(); ++i) {
    const std::string name(run.events.word(i, event));
    if (name == "step-end" || name == "load-reversal" || name == "retreat" || name == "stick" ||
        name == "force-extremum") {
      continue;
    }
    actual.emplace_back(std::string(run.events.word(i, class_column)) + ":" + name, run.events.at(i, time));
  }
  std::vector<std::pair<std::string, double>> expected;
  for (const ReferenceEvent& e : reference.events) {
    const std::string name = (e.wall < 0 ? "" : class_of_wall[static_cast<std::size_t>(e.wall)]) + ":" + e.name;
    if (expected.empty() || expected.back() != std::pair(name, e.time)) expected.emplace_back(name, e.time);
  }
  const auto list = [](const std::vector<std::pair<std::string, double>>& events) {
    std::string text;
    for (const auto& [name, at] : events) text += name + "@" + std::to_string(at) + " ";
    return text;
  };
  bool same = actual.size() == expected.size();
  for (std::size_t i = 0; same && i < actual.size(); ++i) {
    same = actual[i].first == expected[i].first;
    errors.event_time = std::max(errors.event_time, std::abs(actual[i].second - expected[i].second) / length);
  }
  if (!same) errors.mismatch += "events are " + list(actual) + "instead of " + list(expected);
  return errors;
}

}  // namespace monograin
