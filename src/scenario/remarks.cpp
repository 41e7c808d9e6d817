#include "scenario/remarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "catalogue.hpp"
#include "scenario/model_input.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

/// Programs of all walls, or the one of a model without walls.
std::vector<std::vector<Step>> programs_of(const CheckedScenario& scenario) {
  std::vector<std::vector<Step>> programs{scenario.loading.steps};
  for (const WallSpec& wall : scenario.loading.walls) programs.push_back(wall.steps);
  return programs;
}

/// Duration of a step [s] that no condition ends early; none if it depends on the run.
std::optional<double> duration_of(const std::vector<Step>& program, std::size_t index) {
  const Step& step = program[index];
  if (step.duration || !step.rate) return step.duration;
  // A ramp with a rate begins at the target of the step before, if that step reaches its target for certain.
  if (index == 0 || program[index - 1].kind != step.kind || !program[index - 1].until.empty()) return std::nullopt;
  if (!control_of(step.kind) || !step.leg.is_whole()) return std::nullopt;
  return std::abs(step.target - program[index - 1].target) / *step.rate;
}

/// Latest end of a program [s]; conditions may end steps earlier. None if it depends on the run.
std::optional<double> latest_end(const CheckedScenario& scenario) {
  const auto programs = programs_of(scenario);
  std::size_t count = 0;
  for (const auto& program : programs) count = std::max(count, program.size());
  double end = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    std::optional<double> duration;
    for (const auto& program : programs) {
      if (k < program.size() && !duration) duration = duration_of(program, k);
    }
    if (!duration) return std::nullopt;
    end += *duration;
  }
  return end;
}

/// True if some wall moves outwards or pulls, and none moves inwards or is pressed on the particle.
bool only_withdraws(const CheckedScenario& scenario) {
  std::vector<double> targets;
  for (const std::vector<Step>& program : programs_of(scenario)) {
    for (const Step& step : program) targets.push_back(control_of(step.kind) ? step.target : 0.0);
  }
  return !targets.empty() && std::ranges::max(targets) <= 0.0 && std::ranges::min(targets) < 0.0;
}

/// True if every step holds what is there, or ends at zero, where walls without a gap and materials begin.
bool does_nothing(const CheckedScenario& scenario) {
  const auto is_idle = [](const Step& step) {
    if (step.kind == Step::Kind::hold) return true;
    const auto control = control_of(step.kind);
    const bool begins_at_zero = control && *control != Control::packing_fraction;
    return begins_at_zero && step.target == 0.0 && (!step.lateral || step.lateral->target == 0.0);
  };
  const auto is_all_idle = [&](const std::vector<Step>& program) { return std::ranges::all_of(program, is_idle); };
  const auto has_gap = [](const WallSpec& wall) { return wall.gap > 0.0; };
  return std::ranges::all_of(programs_of(scenario), is_all_idle) &&
         std::ranges::none_of(scenario.loading.walls, has_gap);
}

}  // namespace

std::vector<std::string> remarks_on(const CheckedScenario& scenario) {
  std::vector<std::string> remarks = scenario.doubts;
  const Model& model = *find_model(scenario.model);
  if (model.has_walls() && !model.adheres(scenario.material) && only_withdraws(scenario)) {
    remarks.emplace_back(
        "no wall moves towards the particle or is pressed on it: displacements are positive inwards, forces in "
        "compression");
  }
  if (!model.adheres(scenario.material) && does_nothing(scenario)) {
    remarks.emplace_back(
        "the program does nothing: its steps hold what is there, or end at zero, where they begin; expected a step "
        "with another target");
  }
  if (model.reservations != nullptr)
    std::ranges::move(model.reservations(model_input(scenario)), std::back_inserter(remarks));
  if (!scenario.output.times.empty() && scenario.output.points != 0) {
    remarks.push_back(
        fmt::format("[output] points = {} is ignored: times say where the rows are", scenario.output.points));
  }
  return remarks;
}

std::optional<std::string> remark_on_times(const CheckedScenario& scenario) {
  const std::vector<double>& times = scenario.output.times;
  const std::optional<double> end = latest_end(scenario);
  if (!end) return std::nullopt;
  const auto count = std::ranges::count_if(times, [&](double t) { return t > *end * (1.0 + k_same_value); });
  if (count == 0) return std::nullopt;
  return fmt::format("{} of {} output times lie{} beyond the end of the program, t = {:.9g} s: no rows there", count,
                     times.size(), count == 1 ? "s" : "", *end);
}

}  // namespace monograin
