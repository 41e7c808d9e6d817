#include "study/stress_programs.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace monograin {
namespace {

double draw_depth(Dice& dice, const StressBounds& bounds) {
  const double what = dice.uniform(0.0, 1.0);
  if (what < 0.75) return dice.uniform(0.0, bounds.deepest);
  if (what < 0.9) return dice.log_uniform(1e-15, bounds.deepest);
  if (what < 0.97) return dice.one_of({0.0, 0.5, 0.999, 1.0});
  return dice.log_uniform(1.0, 1e3);  // right through the particle
}

double draw_force(Dice& dice, const StressBounds& bounds) {
  const double what = dice.uniform(0.0, 1.0);
  if (what < 0.6) return dice.uniform(0.0, bounds.force);
  if (what < 0.75) return 0.0;
  if (what < 0.9) return -dice.uniform(0.0, bounds.tension > 0.0 ? 2.0 * bounds.tension : 0.1 * bounds.force);
  return bounds.force * dice.log_uniform(1e-12, 1e3);
}

/// Durations of a program: alike, or up to twelve orders of magnitude from a second.
double draw_duration(Dice& dice, double usual) {
  return dice.happens(0.1) ? dice.log_uniform(1e-12, 1e12) : usual * dice.log_uniform(0.1, 10.0);
}

/// Waits for what an earlier step of the program waits for; false where none does.
bool repeat_condition(StressStep& step, const std::vector<StressStep>& program) {
  const auto earlier = std::ranges::find_if(
      program.rbegin(), program.rend(), [](const StressStep& s) { return !s.until.empty() || !s.until_event.empty(); });
  if (earlier == program.rend()) return false;
  step.until = earlier->until;
  step.until_value = earlier->until_value;
  step.until_event = earlier->until_event;
  return true;
}

/// A step with its duration, one in twelve a hold.
StressStep draw_step(Dice& dice, double usual) {
  StressStep step;
  step.pace = draw_duration(dice, usual);
  if (dice.happens(0.08)) step.kind = Step::Kind::hold;
  return step;
}

void give_rate(StressStep& step) {
  step.has_rate = true;
  step.pace = 1.0 / step.pace;
}

std::string_view draw_event(Dice& dice, const StressScene& scene) {
  return scene.model->events[dice.below(scene.model->events.size())].name;
}

}  // namespace

std::vector<StressStep> draw_program(Dice& dice, const StressScene& scene, const StressBounds& bounds,
                                     std::size_t count, double gap, bool takes_rates, bool may_detach) {
  const double usual = dice.happens(0.6) ? 1.0 : dice.log_uniform(1e-12, 1e12);
  const bool takes_forces = dice.happens(0.4);
  std::vector<StressStep> program;
  double present = -gap;
  double present_force = 0.0;
  double least_force = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    StressStep step;
    step.pace = draw_duration(dice, usual);
    const double before = present;
    const double force_before = present_force;
    const double what = dice.uniform(0.0, 1.0);
    if (what < 0.08) {
      step.kind = Step::Kind::hold;
    } else if (what < 0.14 && may_detach && !bounds.only_loads) {
      step.kind = Step::Kind::detach;
      give_rate(step);
    } else if (takes_forces && what < 0.5) {
      step.kind = Step::Kind::force;
      step.target = dice.happens(0.1) ? present_force : draw_force(dice, bounds);
      if (bounds.only_loads) step.target = least_force = std::max(least_force, step.target);
      present_force = step.target;
    } else {
      step.target = draw_depth(dice, bounds);
      const double back = dice.one_of({1e-14, 1e-9, 1e-5, 0.003, 0.03, 0.2, 1.0});
      if (i % 2 == 1) step.target = present - dice.uniform(0.0, 1.0) * back;
      if (dice.happens(0.05)) step.target = present;
      if (bounds.only_loads) step.target = std::max(step.target, present);
      present = step.target;
    }
    const bool is_ramp = step.kind == Step::Kind::displacement || step.kind == Step::Kind::force;
    if (is_ramp && takes_rates && dice.happens(0.3)) give_rate(step);
    const bool repeats = is_ramp && dice.happens(0.3) && repeat_condition(step, program);
    if (is_ramp && !repeats && dice.happens(0.12)) {
      const bool has_area = scene.model->has_contact_area;
      const std::string_view key = dice.one_of<std::string_view>(
          {"force", "displacement", "event", has_area ? "pressure" : "force", has_area ? "contact_radius" : "event"});
      if (key == "event") {
        step.until_event = draw_event(dice, scene);
      } else {
        step.until = key;
        step.until_value = key == "force" || key == "pressure" ? draw_force(dice, bounds) : draw_depth(dice, bounds);
        if (key == "contact_radius") step.until_value = std::abs(step.until_value);
        // A step may begin where its condition is met.
        if (key == "displacement" && dice.happens(0.2)) step.until_value = before;
        if (key == "force" && dice.happens(0.2)) step.until_value = force_before;
      }
    }
    program.push_back(step);
  }
  return program;
}

std::vector<StressStep> draw_packing_program(Dice& dice, const StressScene& scene, const StressBounds& bounds,
                                             std::size_t count) {
  using Kind = Step::Kind;
  const double usual = dice.happens(0.6) ? 1.0 : dice.log_uniform(1e-12, 1e12);
  // Plastic packings are compacted only; targets of different kinds are in no order that is known here.
  const Kind only = dice.one_of({Kind::packing_fraction, Kind::strain, Kind::stress});
  std::vector<StressStep> program;
  double present = 0.0;  // share of the way
  for (std::size_t i = 0; i < count; ++i) {
    StressStep step = draw_step(dice, usual);
    if (step.kind == Kind::hold) {
      program.push_back(step);
      continue;
    }
    step.kind = bounds.only_loads ? only : dice.one_of({Kind::packing_fraction, Kind::strain, Kind::stress});
    const double share = dice.happens(0.9) ? dice.uniform(0.0, 1.0) : dice.one_of({0.0, 1e-12, 1.0, 1.2});
    const bool goes_back = !bounds.only_loads && i % 2 == 1;
    present = goes_back ? present * dice.uniform(0.0, 1.0)
                        : present + share * (bounds.only_loads ? std::max(0.0, 1.0 - present) : 1.0 - present);
    if (step.kind == Kind::packing_fraction) {
      step.target = std::min(1.9, bounds.start + present * (bounds.deepest - bounds.start));
    } else if (step.kind == Kind::strain) {
      step.target = -0.3 * present * std::log(bounds.start);
    } else {
      step.target = present * bounds.force * (bounds.only_loads ? 0.2 : 1.0);
    }
    if (dice.happens(0.3)) give_rate(step);
    if (dice.happens(0.1)) step.until_event = draw_event(dice, scene);
    program.push_back(step);
  }
  return program;
}

std::vector<StressStep> draw_point_program(Dice& dice, const StressScene& scene, const StressBounds& bounds,
                                           std::size_t count) {
  using Kind = Step::Kind;
  const double usual = dice.happens(0.6) ? 1.0 : dice.log_uniform(1e-12, 1e12);
  const bool is_path = scene.configuration == "strain-path";
  const bool is_triaxial = scene.configuration == "triaxial";
  const double size = dice.one_of({1e-6, 1e-2, 0.1, 1.0, 1.0});
  const auto draw_strain = [&] { return bounds.deepest * size * dice.uniform(-1.0, 0.3); };
  const auto draw_stress = [&] {
    return dice.happens(0.2) ? bounds.tension * dice.uniform(0.0, 1.0) : -bounds.force * size * dice.uniform(0.0, 1.0);
  };
  std::vector<StressStep> program;
  double present = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    StressStep step = draw_step(dice, usual);
    if (step.kind == Kind::hold) {
      program.push_back(step);
      continue;
    }
    step.kind = !is_path && dice.happens(0.3) ? Kind::stress : Kind::strain;
    step.target = step.kind == Kind::stress ? draw_stress() : draw_strain();
    if (step.kind == Kind::strain) {
      if (dice.happens(0.3)) step.target = present + dice.one_of({1e-13, 1e-8, 1e-4}) * dice.uniform(-1.0, 1.0);
      present = step.target;
    }
    if (is_path) {
      // Also straight along an axis of the stress: no deviator, or no pressure.
      const double of_axial = dice.one_of({0.0, 1.0, -0.5, dice.uniform(-1.0, 1.0)});
      if (dice.happens(0.8)) step.lateral = of_axial * step.target;
    } else if (is_triaxial && dice.happens(0.5)) {
      step.lateral_kind = Kind::stress;
      step.lateral = draw_stress();
    }
    if (!step.lateral && dice.happens(0.3)) give_rate(step);
    if (dice.happens(0.15)) {
      const std::string_view key =
          dice.one_of<std::string_view>({"stress_axial", "stress_lateral", "relative_density", "event"});
      if (key == "event") {
        step.until_event = draw_event(dice, scene);
      } else {
        step.until = key;
        step.until_value = key == "relative_density" ? dice.uniform(0.2, 0.999) : draw_stress();
      }
    }
    program.push_back(step);
  }
  return program;
}

}  // namespace monograin
