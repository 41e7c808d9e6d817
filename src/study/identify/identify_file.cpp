#include "study/identify/identify_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "scenario/document.hpp"
#include "scenario/section.hpp"
#include "scenario/text_file.hpp"
#include "scenario/units.hpp"
#include "scenario/words.hpp"
#include "study/calibrate/calibration_language.hpp"
#include "study/calibrate/data_section.hpp"
#include "study/calibrate/parameter_section.hpp"
#include "study/calibrate/replay.hpp"
#include "study/calibrate/scenario_section.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;
using calibration::Keys;
using calibration::NamedScenario;
using Kind = KeySpec::Kind;

constexpr double k_most_instants = 1e5;

/// Keys of a plan: those of a calibration file, with programs in place of data.
Keys plan_keys(bool scenario_is_table) {
  Keys keys;
  for (KeySpec& key : calibration::root_keys(scenario_is_table, false)) {
    if (key.name == "scenario" || key.name == "free" || key.name == "prior") keys.push_back(std::move(key));
  }
  keys.push_back(key_of(Kind::text, "title", "what is planned", "\"granules, batch 12\""));
  keys.push_back(key_of(Kind::table, "data", "the testing machine: its true offsets and compliance", "[data]"));
  keys.push_back(required(key_of(Kind::tables, "program", "programs of loads that could be measured", "[[program]]")));
  return keys;
}

/// Keys of the machine: those of measured data that no measurement gives.
Keys plan_machine_keys(const calibration::DataKinds& kinds) {
  Keys keys = calibration::data_keys(kinds);
  std::erase_if(keys, [](const KeySpec& key) {
    return key.name != "offset" && key.name != "force_offset" && key.name != "compliance";
  });
  return keys;
}

std::vector<ForeignKey> keys_of_calibrations() { return {{"fit", "belongs to a calibration file"}}; }

/// Keys of measured data, which a plan does not have.
std::vector<ForeignKey> keys_of_measured_data(const Keys& of_machine) {
  std::vector<ForeignKey> foreign;
  for (const KeySpec& key : calibration::data_keys({})) {
    if (find_key(of_machine, key.name) != nullptr) continue;
    foreign.push_back({key.name, "belongs to a calibration file; expected offset, force_offset or compliance"});
  }
  return foreign;
}

Keys program_keys() {
  return {
      required(key_of(Kind::identifier, "name", "of the program, in tables and figures", "\"unloading\"")),
      key_of(Kind::texts, "set", "overrides of the scenario for this program",
             "[\"loading.steps[0].displacement=0.2 R0\"]"),
      {.name = "y",
       .meaning = "what is measured: a number of the history",
       .kind = Kind::text,
       .default_value = std::string_view("axial.force"),
       .example = "\"axial.force\""},
      {.name = "points",
       .meaning = "rows that are measured, evenly in time",
       .kind = Kind::integer,
       .range = {.lower = 1.0, .upper = k_most_instants},
       .default_value = 100.0,
       .example = "100"},
      {.name = calibration::k_noise,
       .meaning = "standard deviation of y",
       .kind = Kind::table,
       .is_required = true,
       .may_be_empty = false,
       .example = "{ absolute = \"2 N\", relative = 0.01 }"},
      {.name = "planned",
       .meaning = "whether it is measured in any case; the others are candidates",
       .kind = Kind::toggle,
       .default_value = false},
  };
}

std::string override_of_keys(const std::vector<std::string>& paths) {
  std::vector<std::string> quoted;
  for (const std::string& path : paths) quoted.push_back('"' + path + '"');
  return fmt::format("sensitivities.keys=[{}]", fmt::join(quoted, ", "));
}

class PlanReader {
 public:
  explicit PlanReader(NamedText source) : file_(std::move(source.file)), reading_{faults_} {
    made_.text = std::move(source.text);
  }

  ExperimentPlan read() {
    made_.name = file_.stem().string();
    const toml::table tree = parse_document(made_.text, file_.string());
    expect_type(tree, file_.string(), DocumentType::experiment_plan);
    const bool scenario_is_table = tree["scenario"].is_table();
    const Keys keys = plan_keys(scenario_is_table);
    const std::vector<ForeignKey> foreign = keys_of_calibrations();
    const SourceLocation top{file_.string()};
    const Section root(reading_, {&tree, top, "the plan"}, keys, foreign);
    made_.title = root.text("title");
    auto found = calibration::scenario_in(reading_, root, scenario_is_table, made_.text, file_.string());
    if (!found) faults_.throw_if_any();
    scenario_ = std::move(*found);
    made_.scenario = scenario_.checked;
    reading_.initial_radius = made_.scenario.radius;
    if (root.has("free")) {
      made_.free = calibration::free_in(reading_, root, {scenario_.checked, scenario_.text, scenario_.file});
    }
    if (root.has("prior") && !made_.free.empty()) {
      calibration::read_priors(reading_, root, made_.scenario, made_.free);
    }
    read_machine(root);
    faults_.throw_if_any();
    take_values(root);
    for (const Section::Origin& origin : root.tables("program", "[[program]]")) read_program(origin);
    faults_.throw_if_any();
    return std::move(made_);
  }

 private:
  void read_machine(const Section& root) {
    if (!root.has("data")) return;
    const Section::Origin origin = root.table("data", "[data]");
    const calibration::DataKinds kinds = calibration::kinds_of(*origin.table);
    const Keys keys = plan_machine_keys(kinds);
    const std::vector<ForeignKey> foreign = keys_of_measured_data(keys);
    const Section data(reading_, origin, keys, foreign);
    made_.machine = calibration::machine_in(reading_, data, kinds.compliance, file_.parent_path());
  }

  /// True value of a free number. @throws ScenarioError if the number cannot differentiate a history
  [[nodiscard]] double value_of(const std::string& path) const {
    if (path == calibration::k_offset) return made_.machine.offset;
    if (path == calibration::k_force_offset) return made_.machine.force_offset;
    if (path == calibration::k_compliance) return made_.machine.compliance;
    return scenario_.with({override_of_keys({path})}).sensitivities.front().value;
  }

  /// Takes the values of the free numbers from the scenario and the machine.
  void take_values(const Section& root) {
    const Section::Origin free = root.table("free", "[free]");
    for (const FreeParameter& parameter : made_.free) {
      const std::string& path = parameter.key.path;
      const SourceLocation place = place_of(free.table->find(path)->first.source(), free.place);
      if (path == calibration::k_compliance && !made_.machine.forces.empty()) {
        faults_.add(place,
                    fmt::format("'{}' is free, and [data] has a table of deflections; expected one of them", path));
      }
      try {
        const double value = value_of(path);
        made_.values.push_back(value);
        if (value >= parameter.lower && value <= parameter.upper) continue;
        faults_.add(place, fmt::format("'{}' is {:.6g}{}{} in {}, which is not between the bounds", path,
                                       value / parameter.unit_factor, parameter.unit.empty() ? "" : " ", parameter.unit,
                                       parameter.is_of_machine() ? "[data]" : "the scenario"));
      } catch (const ScenarioError& error) {
        faults_.add(place, on_one_line(error.faults().front().message));
      }
    }
    faults_.throw_if_any();
    for (std::size_t k = 0; k < made_.free.size(); ++k) {
      if (made_.free[k].is_of_machine()) continue;
      paths_.push_back(made_.free[k].key.path);
      values_.push_back(made_.values[k]);
    }
    if (paths_.empty()) faults_.add(free.place, "expected at least one free number of the scenario");
    faults_.throw_if_any();
  }

  void read_program(const Section::Origin& origin) {
    const Keys keys = program_keys();
    const std::size_t before = faults_.size();
    const Section section(reading_, origin, keys);
    if (faults_.size() > before) return;
    ExperimentProgram program;
    program.name = section.text("name");
    program.overrides = section.texts("set");
    program.points = static_cast<int>(section.number("points").value_or(0.0));
    program.is_planned = section.toggle("planned").value_or(false);
    program.noise_at = section.value_place(calibration::k_noise);
    if (std::ranges::find(made_.programs, program.name, &ExperimentProgram::name) != made_.programs.end()) {
      faults_.add(section.value_place("name"), fmt::format("two programs are named '{}'", program.name));
    }
    if (!take_scenario(section, program)) return;
    const Measurable::Column* y = column_of(section, program.scenario);
    if (y == nullptr) return;
    program.observable = y->name;
    const Section::Origin noise = section.table(calibration::k_noise, std::string(calibration::k_noise));
    if (noise.table->contains("column")) {
      return faults_.add(program.noise_at, "key 'column' is for data; expected absolute, relative or both");
    }
    const bool needs_drive = made_.has_machine() || noise.table->contains("x");
    if (needs_drive && !take_drive(section, program)) return;
    const Dimension of_x = program.driven.kind == Step::Kind::force ? Dimension::force : Dimension::length;
    const auto parts =
        calibration::read_noise(reading_, section, of_x, calibration::dimension_of(y->unit).value_or(Dimension::none));
    program.absolute_noise = parts.absolute;
    program.relative_noise = parts.relative;
    program.noise_of_x = parts.x;
    made_.programs.push_back(std::move(program));
  }

  /// Applies the overrides of a program. @return false, with a fault, where they are wrong or change a free number
  bool take_scenario(const Section& section, ExperimentProgram& program) {
    std::vector<std::string> overrides = program.overrides;
    overrides.push_back(override_of_keys(paths_));
    const SourceLocation place = section.has("set") ? section.value_place("set") : section.place();
    try {
      program.scenario = scenario_.with(overrides);
      measurable_ = measurable_in(program.scenario);
    } catch (const ScenarioError& error) {
      for (const Fault& fault : error.faults()) faults_.add(place, fault.message);
      return false;
    }
    for (std::size_t k = 0; k < paths_.size(); ++k) {
      if (program.scenario.sensitivities[k].value == values_[k]) continue;
      faults_.add(place, fmt::format("'{}' is free; expected its one value in the scenario", paths_[k]));
      return false;
    }
    return take_lengths(program.scenario, place);
  }

  /// Takes the quantity along which a fit goes: the force if a displacement is measured, else the displacement.
  /// @return false, with a fault, where no machine can measure y so
  bool take_drive(const Section& section, ExperimentProgram& program) {
    const SourceLocation place = section.has("y") ? section.value_place("y") : section.place();
    const std::string& y = program.observable;
    const bool is_displacement = y.ends_with(".displacement");
    const bool is_force = y.ends_with(".force");
    const std::string contact_class = is_displacement || is_force ? y.substr(0, y.rfind('.')) : std::string();
    const bool is_driven = std::ranges::find(measurable_.driven, contact_class) != measurable_.driven.end();
    const std::string column = is_driven ? contact_class + (is_displacement ? ".force" : ".displacement")
                                         : measurable_.prefix() + "displacement";
    const auto drive = std::ranges::find(measurable_.drives, column, &Measurable::Drive::column);
    const bool has_own_steps = std::ranges::any_of(
        program.scenario.loading.walls, [](const WallSpec& wall) { return !wall.is_fixed && !wall.steps.empty(); });
    if (measurable_.driven.empty()) {
      faults_.add(place, "a testing machine moves walls; this scenario has none that move");
    } else if (has_own_steps) {
      faults_.add(place, "a testing machine moves all walls alike; expected walls that are fixed or follow the steps");
    } else if (adds_to_force() && !is_driven) {
      faults_.add(
          place,
          fmt::format("compliance and force_offset take force and displacement of the same walls; y is '{}'", y));
    } else {
      program.driven = *drive;
      return true;
    }
    return false;
  }

  /// True if the machine needs the force, or may need it.
  [[nodiscard]] bool adds_to_force() const {
    const Machine& machine = made_.machine;
    return machine.force_offset != 0.0 || machine.compliance > 0.0 || !machine.forces.empty() ||
           std::ranges::any_of(made_.free, [](const FreeParameter& parameter) {
             return parameter.key.path == calibration::k_force_offset ||
                    parameter.key.path == calibration::k_compliance;
           });
  }

  /// Checks lengths: a testing machine prescribes displacements from first touch, whatever the radius and the gap are.
  /// @return false, with a fault, where the steps follow a radius that is free or the first driven wall's gap is free
  bool take_lengths(const CheckedScenario& scenario, const SourceLocation& place) {
    const auto is_free = [this](std::string_view path) { return std::ranges::find(paths_, path) != paths_.end(); };
    std::string problem;
    if (is_free(k_radius_key)) {
      const CheckedScenario larger =
          scenario.variants->with({}, std::array{std::string(k_radius_key)}, std::array{2.0 * scenario.radius});
      const auto is_same = [](const Step& a, const Step& b) { return a.target == b.target && a.rate == b.rate; };
      const auto has_same = [&](const auto& a, const auto& b) { return std::ranges::equal(a.steps, b.steps, is_same); };
      if (!has_same(scenario.loading, larger.loading) ||
          !std::ranges::equal(scenario.loading.walls, larger.loading.walls, has_same)) {
        problem = fmt::format(
            "'{}' is free, and steps are given in R0; expected lengths that a machine prescribes, for "
            "example \"0.2 mm\"",
            k_radius_key);
      }
    }
    const std::vector<WallSpec>& walls = scenario.loading.walls;
    for (std::size_t wall = 0; wall < walls.size(); ++wall) {
      if (!is_free(gap_path(wall)) || measurable_.driven.empty() || walls[wall].name != measurable_.driven.front()) {
        continue;
      }
      problem = fmt::format("'{}' cannot be free: displacements of wall '{}' count from first touch", gap_path(wall),
                            walls[wall].name);
    }
    if (!problem.empty()) faults_.add(place, problem);
    return problem.empty();
  }

  /// The column of y; a fault where the scenario has none of that name.
  [[nodiscard]] const Measurable::Column* column_of(const Section& section, const CheckedScenario& scenario) {
    const std::string name = section.text("y");
    const Measurable::Column* found = measurable_.find(name);
    if (found == nullptr) found = measurable_.find(measurable_.prefix() + name);
    if (found != nullptr) return found;
    std::vector<std::string_view> names;
    for (const Measurable::Column& column : measurable_.columns) names.push_back(column.name);
    faults_.add(section.has("y") ? section.value_place("y") : section.place(),
                fmt::format("y = \"{}\" is no quantity of this scenario, whose model is '{}'; expected one of {}{}",
                            shown(name), scenario.model, listed(names), did_you_mean(name, names)));
    return nullptr;
  }

  fs::path file_;
  FaultList faults_;
  Reading reading_;
  ExperimentPlan made_;
  NamedScenario scenario_;
  std::vector<std::string> paths_;  ///< paths of the scenario's free numbers
  std::vector<double> values_;      ///< their values in the scenario
  Measurable measurable_;           ///< columns of the program being read
};

}  // namespace

bool ExperimentPlan::has_machine() const noexcept {
  return !machine.adds_nothing() || std::ranges::any_of(free, &FreeParameter::is_of_machine);
}

ExperimentPlan read_experiment_plan(const fs::path& file) {
  return parse_experiment_plan(read_named_text(file, "a plan of an experiment"));
}

ExperimentPlan parse_experiment_plan(NamedText source) { return PlanReader(std::move(source)).read(); }

}  // namespace monograin
