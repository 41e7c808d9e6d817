#include "verify/stress/draw/programs.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace monograin {
namespace {

double draw_depth(Dice& dice, const ProgramBounds& bounds) {
  const double what = dice.uniform(0.0, 1.0);
  if (what < 0.75) return dice.uniform(0.0, bounds.deepest);
  if (what < 0.9) return dice.log_uniform(1e-15, bounds.deepest);
  if (what < 0.97) return dice.one_of({0.0, 0.5, 0.999, 1.0});
  return dice.log_uniform(1.0, 1e3);  // right through the particle
}

double draw_force(Dice& dice, const ProgramBounds& bounds) {
  const double what = dice.uniform(0.0, 1.0);
  if (what < 0.6) return dice.uniform(0.0, bounds.force);
  if (what < 0.75) return 0.0;
  if (what < 0.9) return -dice.uniform(0.0, bounds.tension > 0.0 ? 2.0 * bounds.tension : 0.1 * bounds.force);
  return bounds.force * dice.log_uniform(1e-12, 1e3);
}

/// Gives a step the condition of the last earlier step that has one; false if there is none.
bool repeat_condition(StressStep& step, const std::vector<StressStep>& program) {
  const auto earlier = std::ranges::find_if(
      program.rbegin(), program.rend(), [](const StressStep& s) { return !s.until.empty() || !s.until_event.empty(); });
  if (earlier == program.rend()) return false;
  step.until = earlier->until;
  step.until_value = earlier->until_value;
  step.until_event = earlier->until_event;
  return true;
}

void give_rate(StressStep& step) {
  step.has_rate = true;
  step.pace = 1.0 / step.pace;
}

/// Values to which the steps drawn so far lead.
struct Standing {
  double displacement = 0.0;
  double force = 0.0;
  double least_force = 0.0;  ///< least next force of a law without unloading
};

/// Draws the target of a displacement; some steps stay at the present one.
/// @param goes_back  the step unloads
double draw_target(Dice& dice, const ProgramBounds& bounds, double present, bool goes_back) {
  double target = draw_depth(dice, bounds);
  const double back = dice.one_of({1e-14, 1e-9, 1e-5, 0.003, 0.03, 0.2, 1.0});
  if (goes_back) target = present - dice.uniform(0.0, 1.0) * back;
  if (dice.happens(0.05)) target = present;
  return bounds.only_loads ? std::max(target, present) : target;
}

/// Draws the kind and the target of a step.
void draw_kind(Dice& dice, const ProgramBounds& bounds, bool takes_forces, bool may_detach, bool goes_back,
               StressStep& step, Standing& present) {
  const double what = dice.uniform(0.0, 1.0);
  if (what < 0.08) {
    step.kind = Step::Kind::hold;
  } else if (what < 0.14 && may_detach && !bounds.only_loads) {
    step.kind = Step::Kind::detach;
    give_rate(step);
  } else if (takes_forces && what < 0.5) {
    step.kind = Step::Kind::force;
    step.target = dice.happens(0.1) ? present.force : draw_force(dice, bounds);
    if (bounds.only_loads) step.target = present.least_force = std::max(present.least_force, step.target);
    present.force = step.target;
  } else {
    step.target = present.displacement = draw_target(dice, bounds, present.displacement, goes_back);
  }
}

/// Draws a condition that ends a ramp.
/// @param before  values where the ramp begins
void draw_condition(Dice& dice, const Model& model, const ProgramBounds& bounds, const Standing& before,
                    StressStep& step) {
  const bool has_area = model.has_contact_area;
  const std::string_view key = dice.one_of<std::string_view>(
      {"force", "displacement", "event", has_area ? "pressure" : "force", has_area ? "contact_radius" : "event"});
  if (key == "event") {
    step.until_event = draw_event(dice, model.events);
    return;
  }
  step.until = key;
  step.until_value = key == "force" || key == "pressure" ? draw_force(dice, bounds) : draw_depth(dice, bounds);
  if (key == "contact_radius") step.until_value = std::abs(step.until_value);
  // The condition of a step may already hold where the step begins.
  if (key == "displacement" && dice.happens(0.2)) step.until_value = before.displacement;
  if (key == "force" && dice.happens(0.2)) step.until_value = before.force;
}

}  // namespace

std::vector<StressStep> draw_program(Dice& dice, const StressScene& scene, const ProgramBounds& bounds,
                                     std::size_t count, double gap, bool takes_rates, bool may_detach) {
  const double usual = dice.happens(0.6) ? 1.0 : dice.log_uniform(1e-12, 1e12);
  const bool takes_forces = dice.happens(0.4);
  std::vector<StressStep> program;
  Standing present{.displacement = -gap};
  for (std::size_t i = 0; i < count; ++i) {
    StressStep step;
    step.pace = draw_duration(dice, usual);
    const Standing before = present;
    draw_kind(dice, bounds, takes_forces, may_detach, i % 2 == 1, step, present);
    const bool is_ramp = step.kind == Step::Kind::displacement || step.kind == Step::Kind::force;
    if (is_ramp && takes_rates && dice.happens(0.3)) give_rate(step);
    const bool repeats = is_ramp && dice.happens(0.3) && repeat_condition(step, program);
    if (is_ramp && !repeats && dice.happens(0.12)) draw_condition(dice, *scene.model, bounds, before, step);
    program.push_back(step);
  }
  return program;
}

std::vector<StressStep> stress_steps(const std::vector<DrawnStep>& program) {
  std::vector<StressStep> steps;
  for (const DrawnStep& drawn : program) {
    StressStep step{.kind = drawn.control ? ramp_of(*drawn.control) : Step::Kind::hold,
                    .target = drawn.target,
                    .pace = drawn.pace,
                    .has_rate = drawn.has_rate,
                    .until = drawn.until,
                    .until_value = drawn.until_value,
                    .until_event = drawn.until_event};
    if (drawn.lateral) {
      step.lateral = drawn.lateral->target;
      step.lateral_kind = ramp_of(drawn.lateral->control);
    }
    steps.push_back(std::move(step));
  }
  return steps;
}

}  // namespace monograin
