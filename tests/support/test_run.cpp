#include "support/test_run.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "engine/integrator.hpp"
#include "support/deviation.hpp"

namespace monograin {
namespace {

CheckedScenario unit_scenario(const std::string& model, Configuration configuration, std::vector<Step> steps) {
  CheckedScenario scenario;
  scenario.name = "test";
  scenario.model = model;
  scenario.radius = 1.0;
  scenario.material = {{"youngs_modulus", 1.0}, {"poisson_ratio", 0.3}};
  scenario.loading.configuration = configuration;
  scenario.loading.steps = std::move(steps);
  scenario.output.points = 50;
  return scenario;
}

Step timed(Step::Kind kind, double target, std::optional<double> duration) {
  Step step;
  step.kind = kind;
  step.target = target;
  step.duration = duration;
  return step;
}

bool ends_with_class_column(const std::string& column, std::string_view name) {
  return column.size() > name.size() + 1 && column.ends_with(name) && column[column.size() - name.size() - 1] == '.';
}

}  // namespace

Step ramp(double displacement, double duration) { return timed(Step::Kind::displacement, displacement, duration); }

Step force_ramp(double force, double duration) { return timed(Step::Kind::force, force, duration); }

Step ramp_at(double displacement, double rate) {
  Step step = timed(Step::Kind::displacement, displacement, {});
  step.rate = rate;
  return step;
}

Step hold(double duration) { return timed(Step::Kind::hold, 0.0, duration); }

Step detach(double rate) {
  Step step = timed(Step::Kind::detach, 0.0, {});
  step.rate = rate;
  return step;
}

Step until(Step step, Quantity quantity, double value) {
  step.until.push_back({.quantity = quantity, .value = value});
  return step;
}

Step until_event(Step step, const std::string& event) {
  step.until.push_back({.event = event});
  return step;
}

std::vector<Step> path(const std::vector<double>& displacements) {
  std::vector<Step> steps;
  for (const double displacement : displacements) steps.push_back(ramp(displacement));
  return steps;
}

CheckedScenario hertz_scenario(Configuration configuration, std::vector<Step> steps) {
  return unit_scenario("hertz", configuration, std::move(steps));
}

CheckedScenario mdr_scenario(Configuration configuration, double modulus_over_yield, double poisson_ratio,
                             std::vector<Step> steps) {
  CheckedScenario scenario = unit_scenario("mdr", configuration, std::move(steps));
  scenario.material["poisson_ratio"] = poisson_ratio;
  scenario.material["yield_stress"] = 1.0 / modulus_over_yield;
  scenario.material["surface_energy"] = 0.0;
  scenario.options = {{"radius_rule", std::string("gated")},
                      {"elastic_profile", std::string("ellipse")},
                      {"delta_max_rule", std::string("running-maximum")},
                      {"strict", false},
                      {"pressure_table", std::string()}};
  return scenario;
}

CheckedScenario with(CheckedScenario scenario, const std::string& option, const std::string& word) {
  scenario.options.at(option) = word;
  return scenario;
}

CheckedScenario with_points(CheckedScenario scenario, int points) {
  scenario.output.points = points;
  return scenario;
}

WallSpec wall(const std::string& name, const Eigen::Vector3d& normal, std::vector<Step> steps, double gap) {
  return {.name = name,
          .normal = {normal.x(), normal.y(), normal.z()},
          .gap = gap,
          .is_fixed = steps.empty(),
          .steps = std::move(steps),
          .where = {}};
}

CheckedScenario between(CheckedScenario scenario, std::vector<WallSpec> walls) {
  scenario.loading.configuration = Configuration::walls;
  scenario.loading.steps.clear();
  scenario.loading.walls = std::move(walls);
  return scenario;
}

std::vector<WallSpec> written_out(const CheckedScenario& scenario) {
  std::vector<WallSpec> walls;
  for (const Wall& w : make_walls(scenario)) walls.push_back(wall(w.name, w.normal, w.steps, w.gap));
  return walls;
}

std::string describe(const CheckedScenario& scenario) {
  std::string text = scenario.model;
  for (const Wall& w : make_walls(scenario)) {
    if (w.steps.empty()) continue;
    text += fmt::format(" {} walls,", make_walls(scenario).size());
    for (const Step& step : w.steps) text += fmt::format(" {}", step.target);
    break;
  }
  for (const auto& [key, value] : scenario.material) text += fmt::format(" {}={}", key, value);
  for (const char* key : {"radius_rule", "elastic_profile", "delta_max_rule"}) {
    const auto found = scenario.options.find(key);
    if (found != scenario.options.end()) text += " " + std::get<std::string>(found->second);
  }
  return text;
}

std::vector<double> TestRun::outputs(std::string_view name) const {
  const std::vector<double> rows = record.history.column("row");
  const std::vector<double> all = record.history.column(name);
  std::vector<double> result;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] == 0.0) result.push_back(all[i]);
  }
  return result;
}

std::vector<std::vector<double>> TestRun::outputs_by_class(std::string_view name) const {
  std::vector<std::vector<double>> result;
  for (const Column& c : record.history.columns()) {
    if (ends_with_class_column(c.name, name)) result.push_back(outputs(c.name));
  }
  return result;
}

std::vector<std::string> TestRun::events() const {
  const Table& table = record.events;
  std::vector<std::string> result;
  for (std::size_t i = 0; i < table.row_count(); ++i) {
    const std::string event(table.word(i, *table.find("event")));
    const std::string contact_class(table.word(i, *table.find("class")));
    if (event != "step-end") result.push_back(contact_class.empty() ? event : contact_class + ":" + event);
  }
  return result;
}

bool TestRun::has_event(std::string_view name) const { return !std::isnan(time_of(name)); }

double TestRun::time_of(std::string_view name) const { return at_event(name, "time"); }

double TestRun::at_event(std::string_view name, std::string_view column) const {
  const Table& table = record.events;
  for (std::size_t i = 0; i < table.row_count(); ++i) {
    if (table.word(i, *table.find("event")) == name) return table.at(i, *table.find(column));
  }
  return std::nan("");
}

TestRun run(const CheckedScenario& scenario, std::string_view integrator, const Tolerances& tolerances,
            bool merges_walls) {
  TestRun result{make_scene(scenario, merges_walls), {}};
  const std::string used = choose_integrator(std::string(integrator), *result.scene.system).used;
  result.record = record_run(result.scene, used, tolerances, scenario.output);
  return result;
}

double largest(const std::vector<double>& values) {
  double result = 0.0;
  for (const double value : values) result = std::max(result, std::abs(value));
  return result;
}

double difference(const std::vector<double>& actual, const std::vector<double>& expected) {
  if (actual.size() != expected.size()) return std::numeric_limits<double>::infinity();
  double worst = 0.0;
  for (std::size_t i = 0; i < actual.size(); ++i) worst = std::max(worst, deviation(actual[i], expected[i]));
  const double scale = largest(expected);
  return scale > 0.0 ? worst / scale : worst;
}

double difference(const TestRun& actual, const TestRun& expected) {
  double worst = 0.0;
  const auto take = [&worst](double value) {
    worst = std::isnan(value) ? std::numeric_limits<double>::infinity() : std::max(worst, value);
  };
  for (const char* name : {"apparent_radius", "volume", "work", "stored_energy", "dissipation"}) {
    if (!expected.record.history.find(name)) continue;
    const std::vector<double> reference = expected.outputs(name);
    const bool is_energy = std::string_view(name) == "stored_energy" || std::string_view(name) == "dissipation";
    const double scale = is_energy ? largest(expected.outputs("work")) : largest(reference);
    take(difference(actual.outputs(name), reference) * (scale > 0.0 ? largest(reference) / scale : 1.0));
  }
  for (const char* name : {"force", "overlap"}) {
    const auto a = actual.outputs_by_class(name);
    const auto b = expected.outputs_by_class(name);
    if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < a.size(); ++c) take(difference(a[c], b[c]));
  }
  return worst;
}

std::vector<std::size_t> regime_changes(const TestRun& run, const std::string& contact_class) {
  const auto row = run.column("row");
  const auto regime = run.column(contact_class + ".regime");
  std::vector<std::size_t> changes;
  for (std::size_t k = 1; k < row.size(); ++k) {
    if (regime[k] == regime[k - 1]) continue;
    changes.push_back(k);
    EXPECT_EQ(row[k - 1], static_cast<double>(RowSide::before)) << contact_class << ", row " << k - 1;
    EXPECT_EQ(row[k], static_cast<double>(RowSide::after)) << contact_class << ", row " << k;
  }
  return changes;
}

double least_dissipation(const TestRun& run) {
  const std::vector<double> dissipation = run.column("dissipation");
  return *std::ranges::min_element(dissipation) / largest(run.column("work"));
}

double lost_dissipation(const TestRun& run) {
  const std::vector<double> dissipation = run.column("dissipation");
  double sum = 0.0;
  for (std::size_t i = 1; i < dissipation.size(); ++i) sum += std::min(0.0, dissipation[i] - dissipation[i - 1]);
  return sum / largest(run.column("work"));
}

}  // namespace monograin
