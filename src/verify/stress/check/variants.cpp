#include "verify/stress/check/variants.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "catalogue.hpp"
#include "scenario/integrators.hpp"
#include "scenario/model_input.hpp"
#include "scene/scene.hpp"
#include "stress_test/dice.hpp"
#include "verify/stress/check/rules.hpp"

namespace monograin {
namespace {

constexpr std::uint64_t k_of_steps = 1000;  // added to the seeds for the changes of steps

void for_each_program(CheckedScenario& scenario, const std::function<void(std::vector<Step>&, double gap)>& change) {
  change(scenario.loading.steps, 0.0);
  for (WallSpec& wall : scenario.loading.walls) change(wall.steps, wall.gap);
}

double factor_of(Step::Kind kind, const Magnification& by) {
  switch (kind) {
    case Step::Kind::displacement:
    case Step::Kind::detach:
      return by.length;
    case Step::Kind::force:
      return by.stress * by.length * by.length;
    case Step::Kind::stress:
      return by.stress;
    case Step::Kind::strain:
    case Step::Kind::packing_fraction:
    case Step::Kind::hold:
      break;
  }
  return 1.0;
}

double factor_of(const Until& until, const Magnification& by) {
  if (until.is_event()) return 1.0;
  switch (until.quantity) {
    case Quantity::force:
      return by.stress * by.length * by.length;
    case Quantity::displacement:
    case Quantity::contact_radius:
    case Quantity::apparent_radius:
      return by.length;
    case Quantity::pressure:
    case Quantity::stress_axial:
    case Quantity::stress_lateral:
      return by.stress;
    case Quantity::relative_density:
      break;
  }
  return 1.0;
}

double factor_of(Dimension dimension, const Magnification& by) {
  if (dimension == Dimension::stress) return by.stress;
  const bool is_per_length = dimension == Dimension::surface_energy || dimension == Dimension::stiffness;
  return is_per_length ? by.stress * by.length : 1.0;
}

/// True if walls that start at different gaps share one program: the start of its first ramp then depends on the wall.
bool starts_anywhere(const CheckedScenario& scenario) {
  return std::ranges::any_of(scenario.loading.walls, [](const WallSpec& wall) {
    return wall.steps.empty() && !wall.is_fixed && wall.gap > 0.0;
  });
}

using Target = std::pair<Step::Kind, double>;  ///< of a ramp

/// Target at which a step leaves the program: a ramp leaves the quantity that it controls at its target, a hold changes
/// nothing.
std::optional<Target> after(std::optional<Target> before, Step::Kind kind, double target) {
  return control_of(kind) ? Target{kind, target} : before;
}

/// Quantities and values from which a step's ramps start; nothing if an earlier step leaves them open.
struct Start {
  std::optional<Target> first;
  std::optional<Target> lateral{};
};

/// True if a condition or a withdrawal of any wall may end a step of the program, which then ends for all walls.
bool may_end_early(const CheckedScenario& scenario, std::size_t index) {
  const auto ends = [index](const std::vector<Step>& steps) {
    return index < steps.size() && (!steps[index].until.empty() || steps[index].kind == Step::Kind::detach);
  };
  return ends(scenario.loading.steps) ||
         std::ranges::any_of(scenario.loading.walls, [&](const WallSpec& wall) { return ends(wall.steps); });
}

Start start_of(const CheckedScenario& scenario, const std::vector<Step>& steps, std::size_t index,
               const Start& at_rest) {
  Start start = at_rest;
  for (std::size_t i = 0; i < index; ++i) {
    const Step& step = steps[i];
    const bool is_open = may_end_early(scenario, i);
    // A wall whose contact does not bear the pull goes on from zero force.
    const bool is_pull = step.kind == Step::Kind::force && step.target < 0.0;
    const bool is_unknown = (is_open && step.kind != Step::Kind::hold) || is_pull;
    start.first = is_unknown ? std::nullopt : after(start.first, step.kind, step.target);
    if (!step.lateral) continue;
    start.lateral = is_open ? std::nullopt : after(start.lateral, step.lateral->kind, step.lateral->target);
  }
  return start;
}

/// Start of the first step: a wall starts at its gap, a channel of a model without walls at its value at rest.
Start rest_of(const CheckedScenario& scenario, const Step& first, double gap) {
  const Model& model = *find_model(scenario.model);
  if (model.has_walls()) return {.first = Target{Step::Kind::displacement, -gap}};
  const auto known = [](const RestingChannel& rest, Step::Kind kind) -> std::optional<Target> {
    if (control_of(kind) == rest.at_rest.control) return Target{kind, rest.at_rest.start};
    return rest.is_unloaded_at_rest ? std::optional(Target{kind, 0.0}) : std::nullopt;
  };
  Start start;
  for (const RestingChannel& rest : model.channels(model_input(scenario))) {
    if (!rest.is_lateral) start.first = known(rest, first.kind);
    if (rest.is_lateral && first.lateral) start.lateral = known(rest, first.lateral->kind);
  }
  return start;
}

/// Moves a target half the distance towards the start of its ramp; false if the start is not known.
bool halve(const std::optional<Target>& start, Step::Kind kind, double& target) {
  if (!start || start->first != kind) return false;
  target = std::midpoint(start->second, target);
  return true;
}

/// The first half of a step; nothing if the step cannot be cut.
std::optional<Step> first_half(const CheckedScenario& scenario, const std::vector<Step>& steps, std::size_t index,
                               double gap) {
  Step half = steps[index];
  if (!half.until.empty() || half.kind == Step::Kind::detach || !half.leg.is_whole()) return {};
  const Start start = start_of(scenario, steps, index, rest_of(scenario, steps.front(), gap));
  if (control_of(half.kind) && !halve(start.first, half.kind, half.target)) return {};
  if (half.lateral && !halve(start.lateral, half.lateral->kind, half.lateral->target)) return {};
  if (half.duration) *half.duration *= 0.5;
  return half;
}

/// Moves the start and all targets of a wall outwards by a distance [m].
/// @param common  program of walls without one of their own
void move_out(WallSpec& wall, double distance, const std::vector<Step>& common) {
  wall.gap += distance;
  if (wall.is_fixed) return;
  if (wall.steps.empty()) wall.steps = common;
  for (Step& step : wall.steps) {
    if (step.kind == Step::Kind::displacement) {
      step.target -= distance;
      if (step.start) *step.start -= distance;
    }
    for (Until& until : step.until) {
      if (until.is_of(Quantity::displacement)) until.value -= distance;
    }
  }
}

/// Changes the value of a condition. Overlaps are differences of lengths of the order of R0, and contact areas are
/// proportional to them. A negative area is never met; nor is an area that a contact has passed by round-off when it is
/// made.
void change(Until& until, double share, double radius) {
  double& value = until.value;
  value *= 1.0 + share;
  if (until.is_of(Quantity::displacement)) value += share * radius;
  if (!until.is_of(Quantity::contact_radius)) return;
  const double area = value * value + share * radius * radius;
  value = std::copysign(std::sqrt(std::abs(area)), area);
}

}  // namespace

CheckedScenario with_integrator(CheckedScenario scenario, std::string integrator) {
  scenario.numerics.integrator = std::move(integrator);
  return scenario;
}

CheckedScenario as_reference(CheckedScenario scenario) {
  const bool is_solvable = make_scene(scenario).system->is_solvable();
  scenario.numerics = {.integrator = is_solvable ? integrators::k_direct : integrators::k_cvode_bdf,
                       .rtol = k_finest_rtol,
                       .atol = 1e-4 * k_finest_rtol};
  return scenario;
}

CheckedScenario slower(CheckedScenario scenario, double factor) {
  for_each_program(scenario, [&](std::vector<Step>& steps, double) {
    for (Step& step : steps) {
      if (step.duration) *step.duration *= factor;
      step.leg.begin_time *= factor;
      step.leg.end_time *= factor;
      if (step.rate) *step.rate /= factor;
    }
  });
  return scenario;
}

CheckedScenario magnified(CheckedScenario scenario, const Magnification& by) {
  scenario.radius *= by.length;
  for (const QuantityKey& key : find_model(scenario.model)->material) {
    const auto found = scenario.material.find(std::string(key.name));
    if (found != scenario.material.end()) found->second *= factor_of(key.dimension, by);
  }
  for (WallSpec& wall : scenario.loading.walls) wall.gap *= by.length;
  for_each_program(scenario, [&](std::vector<Step>& steps, double) {
    for (Step& step : steps) {
      step.target *= factor_of(step.kind, by);
      if (step.start) *step.start *= factor_of(step.kind, by);
      if (step.rate) *step.rate *= factor_of(step.kind, by);
      if (step.lateral) step.lateral->target *= factor_of(step.lateral->kind, by);
      for (Until& until : step.until) until.value *= factor_of(until, by);
    }
  });
  return scenario;
}

std::optional<CheckedScenario> halved(CheckedScenario scenario, std::size_t& cut) {
  if (starts_anywhere(scenario)) return {};
  for (cut = step_count(scenario); cut-- > 0;) {
    bool is_possible = true;
    CheckedScenario halves = scenario;
    for_each_program(halves, [&](std::vector<Step>& steps, double gap) {
      if (cut >= steps.size()) return;
      const std::optional<Step> half = first_half(scenario, steps, cut, gap);
      is_possible = is_possible && half;
      if (!half) return;
      steps[cut].duration = half->duration;
      steps.insert(steps.begin() + static_cast<std::ptrdiff_t>(cut), *half);
    });
    if (is_possible) return halves;
  }
  return {};
}

std::optional<CheckedScenario> forth_and_back(CheckedScenario scenario) {
  bool is_possible = !starts_anywhere(scenario) && scenario.output.points > 0;
  const CheckedScenario given = scenario;
  for_each_program(scenario, [&](std::vector<Step>& steps, double gap) {
    if (steps.empty()) return;
    const Step& first = steps.front();
    const Start start = rest_of(given, first, gap);
    const auto knows = [](const std::optional<Target>& target, Step::Kind kind) {
      return target && target->first == kind;
    };
    is_possible = is_possible && first.until.empty() && first.leg.is_whole() && knows(start.first, first.kind) &&
                  (!first.lateral || knows(start.lateral, first.lateral->kind));
    if (!is_possible) return;
    Step back = first;
    back.target = start.first->second;
    if (back.lateral) back.lateral->target = start.lateral->second;
    steps = {first, back};
  });
  return is_possible ? std::optional(scenario) : std::nullopt;
}

CheckedScenario changed(CheckedScenario scenario, double share, std::uint64_t sample) {
  // In pairs of opposite sign: changes of one sign may be harmless.
  const std::uint64_t pair = sample / 2;
  const double side = sample % 2 == 0 ? share : -share;
  Dice dice(pair);
  const std::span<const QuantityKey> keys = find_model(scenario.model)->material;
  for (auto& [key, value] : scenario.material) {
    const double factor = side * dice.uniform(-1.0, 1.0);
    // The opposite change if the value would leave its admissible range.
    const Range& range = std::ranges::find(keys, std::string_view(key), &QuantityKey::name)->range;
    value *= range.contains(value * (1.0 + factor)) ? 1.0 + factor : 1.0 - factor;
  }
  const double radius = scenario.radius;
  // Walls of one class stay in one class: round-off does not break a symmetry of the scene. A free centre is different:
  // it depends on the walls on all sides, and errors need not be symmetric.
  const bool is_skewed = scenario.loading.centre_is_free && sample % 4 < 2;
  for (WallSpec& wall : scenario.loading.walls) {
    wall.gap *= 1.0 + share;
    if (is_skewed) move_out(wall, share * radius * dice.uniform(0.0, 1.0), scenario.loading.steps);
  }
  for_each_program(scenario, [&](std::vector<Step>& steps, double) {
    Dice of_steps(pair + k_of_steps);
    // Equal targets get equal changes: a step between them stays without motion.
    std::map<Target, double> factors;
    for (Step& step : steps) {
      const double drawn = of_steps.uniform(-1.0, 1.0);
      const double factor = factors.try_emplace({step.kind, step.target}, drawn).first->second;
      step.target *= 1.0 + side * factor;
      // Overlaps are differences of lengths of the order of R0, strains are differences of logarithms of order 1.
      if (step.kind == Step::Kind::displacement) step.target += side * factor * radius;
      if (step.kind == Step::Kind::strain) step.target += side * factor;
      if (step.lateral) step.lateral->target *= 1.0 + side * factor;
      for (Until& until : step.until) change(until, side * of_steps.uniform(-1.0, 1.0), radius);
    }
  });
  return scenario;
}

}  // namespace monograin
