#include "verify/stress/shrink/shrink.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "scenario/integrators.hpp"

namespace monograin {
namespace {

constexpr int k_most_digits = 3;

using Candidates = std::vector<StressScene>;

double rounded(double value, int digits) {
  if (value == 0.0 || !std::isfinite(value)) return value;
  return std::stod(fmt::format("{:.{}e}", value, digits - 1));
}

/// Every program of a scene.
std::vector<std::vector<StressStep>*> programs_of(StressScene& scene) {
  std::vector<std::vector<StressStep>*> programs{&scene.steps};
  for (StressWall& wall : scene.walls) programs.push_back(&wall.steps);
  return programs;
}

std::size_t step_count(StressScene scene) {
  std::size_t count = 0;
  for (const auto* program : programs_of(scene)) count = std::max(count, program->size());
  return count;
}

/// Every number of a scene that can be rounded.
std::vector<double*> numbers_of(StressScene& scene) {
  std::vector<double*> numbers;
  for (auto& [key, value] : scene.material) numbers.push_back(&value);
  for (auto& [key, value] : scene.options) {
    if (auto* number = std::get_if<double>(&value)) numbers.push_back(number);
  }
  if (scene.oblique_angle) numbers.push_back(&*scene.oblique_angle);
  for (StressWall& wall : scene.walls) {
    numbers.push_back(&wall.gap);
    for (double& component : wall.normal) numbers.push_back(&component);
  }
  for (auto* program : programs_of(scene)) {
    for (StressStep& step : *program) {
      numbers.push_back(&step.target);
      if (step.lateral) numbers.push_back(&*step.lateral);
      numbers.push_back(&step.pace);
      numbers.push_back(&step.until_value);
    }
  }
  return numbers;
}

/// Collects candidates for a smaller scene, each of which differs from the scene by one change.
class Smaller {
 public:
  explicit Smaller(const StressScene& scene) : scene_(scene) {}

  void add(const auto& change) {
    StressScene other = scene_;
    change(other);
    if (other != scene_) candidates_.push_back(std::move(other));
  }
  /// Adds a scene with one step of one program changed; none if that program has no such step.
  void add_step(std::size_t program, std::size_t step, const auto& change) {
    add([&](StressScene& s) {
      std::vector<StressStep>& changed = *programs_of(s)[program];
      if (step < changed.size()) change(changed[step]);
    });
  }

  [[nodiscard]] Candidates& candidates() noexcept { return candidates_; }

 private:
  const StressScene& scene_;
  Candidates candidates_;
};

void keep_steps(StressScene& scene, std::size_t from, std::size_t count) {
  for (auto* program : programs_of(scene)) {
    const std::size_t begin = std::min(from, program->size());
    const std::size_t end = std::min(begin + count, program->size());
    *program = std::vector<StressStep>(program->begin() + static_cast<std::ptrdiff_t>(begin),
                                       program->begin() + static_cast<std::ptrdiff_t>(end));
  }
}

void erase_step(StressScene& scene, std::size_t step) {
  for (auto* program : programs_of(scene)) {
    if (step < program->size()) program->erase(program->begin() + static_cast<std::ptrdiff_t>(step));
  }
}

/// Adds scenes with fewer steps, walls and cycles.
void add_fewer(const StressScene& scene, Smaller& smaller) {
  const std::size_t steps = step_count(scene);
  if (steps > 2) smaller.add([&](StressScene& s) { keep_steps(s, 0, steps / 2); });
  for (std::size_t wall = scene.walls.size(); wall-- > 0 && scene.walls.size() > 1;) {
    smaller.add([&](StressScene& s) { s.walls.erase(s.walls.begin() + static_cast<std::ptrdiff_t>(wall)); });
  }
  smaller.add([](StressScene& s) { s.cycles = 1; });
  smaller.add([](StressScene& s) { s.cycles = std::max(1, s.cycles / 2); });
  smaller.add([](StressScene& s) { s.cycles = std::max(1, s.cycles - 1); });
  for (std::size_t step = steps; step-- > 0 && steps > 1;) {
    smaller.add([&](StressScene& s) { erase_step(s, step); });
  }
}

/// Adds scenes with plainer configurations, options, materials, units and numerics.
void add_plainer(const StressScene& scene, Smaller& smaller) {
  smaller.add([](StressScene& s) {
    if (!s.configuration.empty()) s.configuration = "simple";
    s.walls.clear();
    s.oblique_angle.reset();
    s.oblique_walls.reset();
  });
  smaller.add([](StressScene& s) { s.centre_is_free = false; });
  smaller.add([](StressScene& s) { s.oblique_angle.reset(); });
  smaller.add([](StressScene& s) { s.oblique_walls.reset(); });
  for (const auto& option : scene.options) smaller.add([&](StressScene& s) { s.options.erase(option.first); });
  for (const QuantityKey& key : scene.model->material) {
    if (!key.default_value && !key.is_optional) continue;
    smaller.add([&](StressScene& s) { s.material.erase(std::string(key.name)); });
  }
  smaller.add([](StressScene& s) { s.integrator = integrators::k_direct; });
  smaller.add([](StressScene& s) { s.rtol = integrators::k_default_rtol; });
  smaller.add([](StressScene& s) { s.radius = 1.0; });
  smaller.add([](StressScene& s) { s.stress = 1.0; });
}

/// Adds scenes whose steps have no conditions, lateral parts or rates, or whose walls have no gaps or are fixed.
void add_plainer_programs(const StressScene& scene, Smaller& smaller) {
  const std::size_t steps = step_count(scene);
  for (std::size_t program = 0; program <= scene.walls.size(); ++program) {
    for (std::size_t step = 0; step < steps; ++step) {
      smaller.add_step(program, step, [](StressStep& s) {
        s.until.clear();
        s.until_event.clear();
        s.until_value = 0.0;
      });
      smaller.add_step(program, step, [](StressStep& s) { s.lateral.reset(); });
      smaller.add_step(program, step, [](StressStep& s) { s.has_rate = s.kind == Step::Kind::detach; });
    }
  }
  // All durations change together, because walls have to end their steps together.
  smaller.add([](StressScene& s) {
    for (auto* program : programs_of(s)) {
      for (StressStep& step : *program) step.pace = 1.0;
    }
  });
  for (std::size_t wall = 0; wall < scene.walls.size(); ++wall) {
    smaller.add([&](StressScene& s) { s.walls[wall].gap = 0.0; });
    smaller.add([&](StressScene& s) { s.walls[wall].is_fixed = wall > 0; });
  }
}

void add_rounder_numbers(const StressScene& scene, Smaller& smaller) {
  StressScene counted = scene;
  const std::size_t numbers = numbers_of(counted).size();
  for (int digits = 1; digits <= k_most_digits; ++digits) {
    smaller.add([&](StressScene& s) {
      for (double* number : numbers_of(s)) *number = rounded(*number, digits);
    });
    for (std::size_t i = 0; i < numbers; ++i) {
      smaller.add([&](StressScene& s) { *numbers_of(s)[i] = rounded(*numbers_of(s)[i], digits); });
    }
  }
}

/// Candidates for a smaller scene; those that leave out most come first.
Candidates smaller_than(const StressScene& scene) {
  Smaller smaller(scene);
  add_fewer(scene, smaller);
  add_plainer(scene, smaller);
  add_plainer_programs(scene, smaller);
  add_rounder_numbers(scene, smaller);
  return std::move(smaller.candidates());
}

/// Size of a scene: the characters of its text, so that rounder numbers make it smaller.
std::size_t size_of(const StressScene& scene) { return scenario_text(scene).size(); }

}  // namespace

StressScene shrink(StressScene scene, const std::function<bool(const StressScene&)>& is_faulty) {
  for (bool has_changed = true; has_changed;) {
    has_changed = false;
    for (const StressScene& candidate : smaller_than(scene)) {
      if (size_of(candidate) >= size_of(scene) || !is_faulty(candidate)) continue;
      scene = candidate;
      has_changed = true;
      break;
    }
  }
  return scene;
}

}  // namespace monograin
