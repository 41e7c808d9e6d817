#include "models/material-point/cases.hpp"

#include <fmt/format.h>

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "support/deviation.hpp"
#include "support/reference_case.hpp"

namespace monograin::material_point {
namespace {

// Distance of an event from a row, over the run's length, within which the row may have either regime.
constexpr double k_near_event = 1e-6;

const std::map<std::string, std::string> k_event_names{
    {"yield", "yield"},
    {"to-cap", "segment-change"},
    {"to-shear", "segment-change"},
    {"to-tension", "segment-change"},
    {"to-transition", "segment-change"},
    {"cap-centre-tensile", "cap-centre-tensile"},
    {"stop", "until-met"},
};

/// Pairs `key=value` of a header line.
std::map<std::string, std::string> fields_of(std::string_view line) {
  std::map<std::string, std::string> fields;
  std::istringstream words{std::string(line)};
  for (std::string word; words >> word;) {
    const auto equals = word.find('=');
    fields.emplace(word.substr(0, equals), word.substr(equals + 1));
  }
  return fields;
}

Parameters parameters_of(std::string_view line) {
  const auto fields = fields_of(line);
  const auto number = [&](const char* key) { return std::stod(fields.at(key)); };
  Parameters m;
  const std::string& model = fields.at("model");
  m.model = model == "VM" ? YieldModel::vm : model == "DPC" ? YieldModel::dpc : YieldModel::vmdc;
  m.stiffness_ratio = number("E0");
  m.nu0 = number("nu0");
  m.shear_ratio = number("Gamma0");
  m.tensile_ratio = number("Lambda0");
  m.eps0 = number("eps0");
  m.eta = number("eta");
  m.xi = number("xi");
  m.zeta = number("zeta");
  m.omega = number("omega");
  m.xi1 = number("xi1");
  m.xi2 = number("xi2");
  m.reference_density = number("reference_density");
  m.relative_density = number("initial_density");
  m.transition_width = number("pi8");
  return m;
}

Step back_to(double axial, double rate, double stress) {
  Step step = strain(axial);
  step.duration.reset();
  step.rate = rate;
  return until(step, Quantity::stress_axial, stress);
}

/// Configuration and program in the line `path` of a reference file.
std::pair<Configuration, std::vector<Step>> program_of(const std::string& name) {
  const std::string number = name.substr(0, 4);
  if (number == "mp01") return {Configuration::hydrostatic, {strain(-0.08), back_to(0.0, 0.08, 0.0)}};
  if (number == "mp02") return {Configuration::die, {strain(-0.25), back_to(0.0, 0.25, 0.0)}};
  if (number == "mp03") return {Configuration::simple, {strain(-0.3), back_to(0.0, 0.3, 0.0)}};
  if (number == "mp04") {
    const double before = -0.6 * 0.4 / 100.0;  // of the hydrostatic step: p/(3K)
    return {Configuration::triaxial, {stresses(-0.6, -0.6), strain(before - 0.25), back_to(0.0, 0.25, -0.6)}};
  }
  if (number == "mp05") return {Configuration::hydrostatic, {strain(0.03), strain(-0.03)}};
  if (number == "mp06") return {Configuration::die, {strain(-0.35), back_to(0.0, 0.35, 0.0)}};
  if (number == "mp07") return {Configuration::simple, {strain(-0.2), strain(-0.1, 0.5)}};
  if (number == "mp08") return {Configuration::die, {strain(-0.4)}};
  if (number == "mp09") {
    return {Configuration::die,
            {strain(-0.06), strain(-0.05), strain(-0.13), strain(-0.118), strain(-0.218), strain(-0.203)}};
  }
  if (number == "mp10") return {Configuration::strain_path, {strains(-0.12, 0.02), strains(-0.17, 0.05)}};
  throw std::logic_error("no program for " + name);
}

}  // namespace

Parameters base_case() { return base_case(100.0, 1.0, 0.01); }

Parameters base_case(double stiffness_ratio, double shear_ratio, double tensile_ratio) {
  Parameters m;
  m.stiffness_ratio = stiffness_ratio;
  m.shear_ratio = shear_ratio;
  m.tensile_ratio = tensile_ratio;
  m.nu0 = 0.3;
  m.eps0 = 0.7;
  m.eta = 10.0;
  m.xi = 7.5;
  m.zeta = 10.0;
  m.omega = 10.0;
  m.xi1 = 0.4;
  m.xi2 = 1.5;
  m.reference_density = 0.7;
  m.relative_density = 0.7;
  return m;
}

Parameters lactose(double transition_width) {
  Parameters m;
  m.model = YieldModel::dpc;
  m.stiffness_ratio = 436.0;
  m.shear_ratio = 1.141;
  m.tensile_ratio = 0.0925;
  m.nu0 = 0.172;
  m.eps0 = 0.304;
  m.eta = 12.01;
  m.xi = 8.39;
  m.zeta = 8.66;
  m.omega = 9.45;
  m.xi1 = 0.123;
  m.xi2 = 1.006;
  m.reference_density = 0.4;
  m.relative_density = 0.5;
  m.transition_width = transition_width;
  return m;
}

Parameters von_mises(double eta) {
  Parameters m;
  m.model = YieldModel::vm;
  m.eta = eta;
  return m;
}

Step strain(double axial, double duration) {
  Step step;
  step.kind = Step::Kind::strain;
  step.target = axial;
  step.duration = duration;
  return step;
}

Step strains(double axial, double lateral, double duration) {
  Step step = strain(axial, duration);
  step.lateral = {.kind = Step::Kind::strain, .target = lateral};
  return step;
}

Step stress(double axial, double duration) {
  Step step = strain(axial, duration);
  step.kind = Step::Kind::stress;
  return step;
}

Step stresses(double axial, double lateral, double duration) {
  Step step = stress(axial, duration);
  step.lateral = {.kind = Step::Kind::stress, .target = lateral};
  return step;
}

Step strain_and_stress(double axial_strain, double lateral_stress, double duration) {
  Step step = strain(axial_strain, duration);
  step.lateral = {.kind = Step::Kind::stress, .target = lateral_stress};
  return step;
}

CheckedScenario point(const Parameters& m, Configuration configuration, std::vector<Step> steps) {
  CheckedScenario scenario;
  scenario.name = "point";
  scenario.model = "material-point";
  scenario.material = {{"yield_pressure", 1.0},
                       {"stiffness_ratio", m.stiffness_ratio},
                       {"shear_ratio", m.shear_ratio},
                       {"tensile_ratio", m.tensile_ratio},
                       {"nu0", m.nu0},
                       {"eps0", m.eps0},
                       {"eta", m.eta},
                       {"xi", m.xi},
                       {"zeta", m.zeta},
                       {"omega", m.omega},
                       {"xi1", m.xi1},
                       {"xi2", m.xi2},
                       {"reference_density", m.reference_density},
                       {"relative_density", m.relative_density},
                       {"transition_width", m.transition_width}};
  const char* words[] = {"vm", "dpc", "vmdc"};
  scenario.options.emplace("yield_model", std::string(words[static_cast<int>(m.model)]));
  scenario.loading.configuration = configuration;
  scenario.loading.steps = std::move(steps);
  return scenario;
}

PointReference load_point(const std::string& name) {
  PointReference reference;
  reference.table = read_csv(test_file("models/material-point/reference/" + name + ".csv"));
  auto [configuration, steps] = program_of(name);
  reference.scenario = point(parameters_of(reference.table.header_value("material")), configuration, std::move(steps));
  const std::size_t event = *reference.table.find("event");
  const std::vector<double> times = reference.table.column("time");
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (times[i] > 0.0 && reference.table.word(i, event).empty()) reference.scenario.output.times.push_back(times[i]);
  }
  return reference;
}

PointErrors errors_against(const PointReference& reference, const RunRecord& run) {
  PointErrors errors;
  const Table& theirs = reference.table;
  const Table& ours = run.history;
  const std::vector<double> times = theirs.column("time");
  const std::vector<double> our_times = ours.column("time");
  const std::vector<double> our_sides = ours.column("row");
  const std::size_t event = *theirs.find("event");
  const double length = times.back();

  std::vector<double> event_times;
  std::vector<std::pair<std::string, double>> expected;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const std::string name(theirs.word(i, event));
    if (name.empty()) continue;
    event_times.push_back(times[i]);
    expected.emplace_back(k_event_names.at(name), times[i]);
  }

  /// Our row at an instant: at an output point, or just before the event there.
  const auto row_at = [&](double time, bool is_event) -> std::optional<std::size_t> {
    std::optional<std::size_t> best;
    for (std::size_t j = 0; j < our_times.size(); ++j) {
      if ((our_sides[j] == 0.0) == is_event || our_sides[j] > 0.0) continue;
      if (!best || std::abs(our_times[j] - time) < std::abs(our_times[*best] - time)) best = j;
    }
    if (!best || std::abs(our_times[*best] - time) > 1e-5 * length) return std::nullopt;
    return best;
  };

  for (const Column& column : theirs.columns()) {
    const auto our_column = ours.find(column.name);
    if (!our_column || column.name == "step" || column.holds_words()) continue;
    const std::vector<double> values = theirs.column(column.name);
    // A material whose yield does not depend on it needs no initial density.
    if (column.name == "relative_density" && std::isnan(ours.at(0, *our_column))) continue;
    // A prescribed zero stress is the round-off of the other stresses.
    const bool is_stress = column.name == "stress_axial" || column.name == "stress_lateral";
    const double scale = column.name == "time" ? length
                         : is_stress           ? std::max(largest(theirs.column("p")), largest(theirs.column("s")))
                                               : largest(values);
    for (std::size_t i = 0; i < times.size(); ++i) {
      const bool is_event = !theirs.word(i, event).empty();
      const auto row = row_at(times[i], is_event);
      if (!row) {
        if (errors.mismatch.empty()) errors.mismatch = fmt::format("no row at t = {}; ", times[i]);
        continue;
      }
      const double error = deviation(ours.at(*row, *our_column), values[i]) / (scale > 0.0 ? scale : 1.0);
      if (error > errors.largest) {
        errors.largest = error;
        errors.column = column.name;
        errors.time = times[i];
      }
    }
  }

  const std::size_t regime = *theirs.find("regime");
  const std::size_t our_regime = *ours.find("regime");
  for (std::size_t i = 0; i < times.size(); ++i) {
    const bool is_near =
        std::ranges::any_of(event_times, [&](double t) { return std::abs(t - times[i]) < k_near_event * length; });
    const auto row = is_near ? std::nullopt : row_at(times[i], false);
    if (row && ours.word(*row, our_regime) != theirs.word(i, regime)) {
      errors.mismatch += fmt::format("regime {} instead of {} at t = {}; ", ours.word(*row, our_regime),
                                     theirs.word(i, regime), times[i]);
    }
  }

  // The files do not list events at corners of the program.
  std::vector<std::pair<std::string, double>> actual;
  for (std::size_t i = 0; i < run.events.row_count(); ++i) {
    const std::string name(run.events.word(i, *run.events.find("event")));
    if (name == "step-end" || name == "plastic-off") continue;
    actual.emplace_back(name, run.events.at(i, *run.events.find("time")));
  }
  bool is_same = actual.size() == expected.size();
  for (std::size_t i = 0; is_same && i < actual.size(); ++i) {
    is_same = actual[i].first == expected[i].first;
    errors.event_time = std::max(errors.event_time, std::abs(actual[i].second - expected[i].second) / length);
  }
  if (!is_same) {
    errors.mismatch += "events are";
    for (const auto& [name, time] : actual) errors.mismatch += fmt::format(" {}@{}", name, time);
  }
  return errors;
}

bool is_offered(std::string_view integrator, const CheckedScenario& scenario) {
  return integrator != "direct" || make_scene(scenario).system->is_solvable();
}

}  // namespace monograin::material_point
