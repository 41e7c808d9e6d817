#include "scenario/rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <span>

#include "scenario/document.hpp"
#include "scenario/model_input.hpp"

namespace monograin {
namespace {

/// Position of a key, in any table that may contain it, or of the preset that gives it.
SourceLocation place_of_key(const toml::table& tree, const std::string& origin, std::string_view model,
                            std::string_view key) {
  for (const std::string_view name :
       {std::string_view("material"), model, std::string_view("loading"), std::string_view("numerics")}) {
    const toml::table* table = tree[name].as_table();
    if (table == nullptr) continue;
    if (const auto found = table->find(key); found != table->end()) return place_of(found->second.source(), {origin});
  }
  if (const toml::node* preset = tree["material"]["preset"].node()) return place_of(preset->source(), {origin});
  return {origin};
}

void check_objections(Reading& reading, const toml::table& tree, const std::string& origin, const Model& model,
                      const CheckedScenario& scenario) {
  for (const Objection& objection : model.objections(model_input(scenario))) {
    reading.faults.add(objection.step ? scenario.loading.steps[*objection.step].where
                                      : place_of_key(tree, origin, model.name, objection.key),
                       objection.message);
  }
}

/// Reports walls that are closer to each other than the model allows.
void check_wall_angles(Reading& reading, const toml::table& tree, const std::string& origin, const Model& model,
                       const Loading& loading) {
  const auto expectation = [&](double angle) {
    return fmt::format("are {:.4g} rad apart; model '{}' expects at least {:.4g} rad", angle, model.name,
                       model.least_wall_angle);
  };
  for (std::size_t i = 0; i < loading.walls.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double angle = angle_between(loading.walls[i].normal, loading.walls[j].normal);
      if (angle >= model.least_wall_angle) continue;
      reading.faults.add(loading.walls[i].where, fmt::format("walls '{}' and '{}' {}", loading.walls[j].name,
                                                             loading.walls[i].name, expectation(angle)));
    }
  }
  if (loading.configuration != Loading::Configuration::oblique_die) return;
  // Oblique walls have angles with the lateral walls, with the axial ones, and four of them with each other.
  double angle = std::min(loading.oblique_angle, std::numbers::pi / 2.0 - loading.oblique_angle);
  if (angle < model.least_wall_angle) {
    reading.faults.add(place_of_key(tree, origin, model.name, "angle"),
                       fmt::format("oblique walls and their neighbours {}", expectation(angle)));
  }
}

/// Reports steps that go back, for a law without unloading; the run checks steps that depend on its course.
void check_only_loading(Reading& reading, std::span<const Step> program, double gap, const std::string& model) {
  double least_displacement = -gap;
  double least_force = 0.0;
  for (const Step& step : program) {
    std::string fault;
    if (step.kind == Step::Kind::detach) fault = "detach withdraws the wall";
    if (step.kind == Step::Kind::displacement && step.target < least_displacement) {
      fault = fmt::format("the wall goes back from {:.6g} m to {:.6g} m", least_displacement, step.target);
    }
    if (step.kind == Step::Kind::force && step.target < least_force) {
      fault = fmt::format("the force goes back from {:.6g} N to {:.6g} N", least_force, step.target);
    }
    if (!fault.empty()) {
      reading.faults.add(step.where, fmt::format("{}, and model '{}' has no unloading of its own; expected growing "
                                                 "targets, or unloading = \"mdr\" in [{}]",
                                                 fault, model, model));
      return;
    }
    if (!step.until.empty()) continue;
    if (step.kind == Step::Kind::displacement) least_displacement = step.target;
    if (step.kind == Step::Kind::force) least_force = step.target;
  }
}

}  // namespace

void check_rules(Reading& reading, const toml::table& tree, const std::string& origin, const Language& language,
                 const CheckedScenario& scenario) {
  if (language.model->objections != nullptr) check_objections(reading, tree, origin, *language.model, scenario);
  if (language.model->least_wall_angle > 0.0) {
    check_wall_angles(reading, tree, origin, *language.model, scenario.loading);
  }
  const auto can_unload = language.model->can_unload;
  if (can_unload == nullptr || can_unload(model_input(scenario))) return;
  check_only_loading(reading, scenario.loading.steps, 0.0, scenario.model);
  for (const WallSpec& wall : scenario.loading.walls) check_only_loading(reading, wall.steps, wall.gap, scenario.model);
}

}  // namespace monograin
