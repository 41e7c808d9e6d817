#include "verify/stress/draw/scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>

#include "scenario/text_file.hpp"
#include "stress_test/draw.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

/// Factor from a scene's units to SI for a dimension.
double unit_of(const StressScene& scene, Dimension dimension) {
  switch (dimension) {
    case Dimension::length:
      return scene.radius;
    case Dimension::stress:
      return scene.stress;
    case Dimension::surface_energy:
    case Dimension::stiffness:
      return scene.stress * scene.radius;
    case Dimension::force:
      return scene.stress * scene.radius * scene.radius;
    default:
      return 1.0;
  }
}

Dimension dimension_of_condition(const StressScene& scene, std::string_view key) {
  if (!scene.model->has_walls()) {
    return std::ranges::find(scene.model->conditions, key, &QuantityKey::name)->dimension;
  }
  if (key == "force") return Dimension::force;
  return key == "pressure" ? Dimension::stress : Dimension::length;
}

/// `key = value` of a ramp.
struct RampText {
  std::string text;
  double unit = 1.0;  ///< factor to SI, also for a rate
};

RampText ramp_text(const StressScene& scene, Step::Kind kind, double target, std::span<const DriveKey> drives) {
  std::string_view key = kind == Step::Kind::force ? "force" : "displacement";
  Dimension dimension = kind == Step::Kind::force ? Dimension::force : Dimension::length;
  if (!drives.empty()) {
    const auto drive = std::ranges::find(drives, control_of(kind).value(), &DriveKey::control);
    key = drive->name;
    dimension = drive->dimension;
  }
  const double unit = unit_of(scene, dimension);
  return {fmt::format("{} = {}", key, target * unit), unit};
}

std::string option_text(const OptionValue& value) {
  if (const auto* toggle = std::get_if<bool>(&value)) return *toggle ? "true" : "false";
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  return fmt::format("\"{}\"", std::get<std::string>(value));
}

std::string step_text(const StressScene& scene, const StressStep& step) {
  std::vector<std::string> parts;
  double unit = unit_of(scene, Dimension::length);
  if (step.kind == Step::Kind::hold) {
    parts.emplace_back("hold = true");
  } else if (step.kind == Step::Kind::detach) {
    parts.emplace_back("detach = true");
  } else {
    const RampText ramp = ramp_text(scene, step.kind, step.target, scene.model->drives);
    parts.push_back(ramp.text);
    unit = ramp.unit;
  }
  if (step.lateral) {
    parts.push_back(ramp_text(scene, step.lateral_kind, *step.lateral, scene.model->lateral_drives).text);
  }
  parts.push_back(step.has_rate ? fmt::format("rate = {}", step.pace * unit) : fmt::format("duration = {}", step.pace));
  if (!step.until_event.empty()) {
    parts.push_back(fmt::format("until = {{ event = \"{}\" }}", step.until_event));
  } else if (!step.until.empty()) {
    parts.push_back(fmt::format("until = {{ {} = {} }}", step.until,
                                step.until_value * unit_of(scene, dimension_of_condition(scene, step.until))));
  }
  return fmt::format("{{ {} }}", fmt::join(parts, ", "));
}

std::string steps_text(const StressScene& scene, const std::vector<StressStep>& steps, std::string_view indent) {
  std::string text = "[\n";
  for (const StressStep& step : steps) text += fmt::format("{}  {},\n", indent, step_text(scene, step));
  return text + fmt::format("{}]\n", indent);
}

}  // namespace

std::string scenario_text(const StressScene& scene) {
  std::string text = fmt::format("model = \"{}\"\n", scene.model->name);
  if (scene.model->has_walls()) text += fmt::format("\n[particle]\nradius = {}\n", scene.radius);
  text += "\n[material]\n";
  for (const auto& [key, value] : scene.material) {
    const auto spec = std::ranges::find(scene.model->material, key, &QuantityKey::name);
    text += fmt::format("{} = {}\n", key, value * unit_of(scene, spec->dimension));
  }
  const auto is_material = [&](const std::string& key) {
    return std::ranges::find(scene.model->material_options, key, &OptionKey::name) !=
           scene.model->material_options.end();
  };
  std::string own_table;
  for (const auto& [key, value] : scene.options) {
    (is_material(key) ? text : own_table) += fmt::format("{} = {}\n", key, option_text(value));
  }
  if (!own_table.empty()) text += fmt::format("\n[{}]\n{}", scene.model->name, own_table);

  text += "\n[loading]\n";
  if (!scene.configuration.empty()) text += fmt::format("configuration = \"{}\"\n", scene.configuration);
  if (scene.centre_is_free) text += "centre = \"equilibrium\"\n";
  if (scene.oblique_angle) text += fmt::format("angle = {}\n", *scene.oblique_angle);
  if (scene.oblique_walls) text += fmt::format("oblique_walls = {}\n", *scene.oblique_walls);
  if (scene.cycles > 1) {
    text +=
        fmt::format("\n[[loading.steps]]\ncycle = {}\nsteps = {}", scene.cycles, steps_text(scene, scene.steps, ""));
  } else if (!scene.steps.empty()) {
    text += fmt::format("steps = {}", steps_text(scene, scene.steps, ""));
  }
  for (const StressWall& wall : scene.walls) {
    text += fmt::format("\n[[loading.wall]]\nname = \"{}\"\nnormal = [{}]\n", wall.name, fmt::join(wall.normal, ", "));
    if (wall.gap > 0.0) text += fmt::format("gap = {}\n", wall.gap * scene.radius);
    if (wall.is_fixed) text += "fixed = true\n";
    if (!wall.steps.empty()) text += fmt::format("steps = {}", steps_text(scene, wall.steps, ""));
  }
  text += fmt::format("\n[output]\npoints = {}\n\n[numerics]\nintegrator = \"{}\"\nrtol = {}\natol = {}\n",
                      scene.points, scene.integrator, scene.rtol, 1e-4 * scene.rtol);
  return text;
}

void write_stress_tables(const fs::path& folder) {
  for (const Model& model : model_catalogue()) {
    for (const OptionKey& option : model.options) {
      if (option.example != nullptr) write_text_file(folder / example_file_name(option.name), option.example());
    }
  }
}

CheckedScenario parse_stress_text(std::string_view text, const fs::path& tables) {
  return parse_scenario(text, (tables / "scene.toml").string());
}

}  // namespace monograin
