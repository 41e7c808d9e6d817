#include "scene/program_reach.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "system/resolution.hpp"

namespace monograin {
namespace {

/// Share of a withdrawal that counts as depth. The whole distance would make the absolute tolerances of the contacts as
/// large as their forces. Also used for a wall that is pulled without adhesion.
constexpr double k_share_of_withdrawal = 1e-4;

/// Factor within which laws predict displacement or force at a condition on another quantity. A condition that the last
/// ramp may already have met, within that factor, need not end the next ramp.
constexpr double k_known_within = 3.0;

/// Relative accuracy with which models predict the depth of a contact under a force or at a condition.
constexpr double k_same_depth = 1e-6;

/// Model, scenario and centre, from which the reach of a program is predicted.
struct Predictor {
  const Model& model;
  const ModelInput& input;
  bool moves_centre = false;
};

/// True if a model may predict where a condition ends the ramp of its wall: a loading from the undeformed particle
/// reaches a value above zero once, but begins at zero, and may return there in many ways.
bool is_foreseen(const Until& until) { return until.wall.empty() && (until.value > 0.0 || until.is_event()); }

/// Displacement and force at which a condition ends a ramp; infinity if only a run of the model can show it.
Reach condition_bound(const Predictor& predictor, const Until& until) {
  Reach bound{.displacement = k_infinity, .force = k_infinity};
  if (!is_foreseen(until)) return bound;
  if (predictor.model.reach != nullptr) bound = predictor.model.reach(predictor.input, until);
  // A centre that moves follows the walls: they move farther than their contacts are deep.
  if (predictor.moves_centre) bound.displacement = k_infinity;
  if (until.is_of(Quantity::displacement)) bound.displacement = until.value;
  if (until.is_of(Quantity::force)) bound.force = until.value;
  return bound;
}

/// Number of legs up to and including the first one that ends every run, because walls of the model cannot pull.
std::size_t legs_until_pull(const Model& model, const std::vector<Channel>& channels) {
  std::size_t count = 0;
  for (const Channel& channel : channels) count = std::max(count, channel.program.size());
  if (!model.stops_when_pulled) return count;
  for (std::size_t k = 0; k < count; ++k) {
    bool pulls = false;
    bool may_end_before = false;  // a condition on one wall ends the step of all
    for (const Channel& channel : channels) {
      if (k >= channel.program.size()) continue;
      const Step& step = channel.program[k];
      pulls = pulls || (step.kind == Step::Kind::force && step.target < 0.0 && step.share == 1.0);
      may_end_before = may_end_before || !step.until.empty();
    }
    if (pulls && !may_end_before) return k + 1;
  }
  return count;
}

/// Index of the first leg in which a wall unloads, if the model has no law for unloading; else the number of legs.
std::size_t first_unloading_leg(const Predictor& predictor, std::span<const Step> steps) {
  const auto can_unload = predictor.model.can_unload;
  if (steps.size() < 2 || can_unload == nullptr || can_unload(predictor.input)) return steps.size();
  double deepest = 0.0;  // lower bound of the depth so far
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const Step& step = steps[k];
    double depth = step.kind == Step::Kind::detach ? 0.0 : deepest;
    if (step.kind == Step::Kind::displacement) depth = step.target;
    if (step.kind == Step::Kind::force) {
      depth = step.target > 0.0
                  ? condition_bound(predictor, {.quantity = Quantity::force, .value = step.target}).displacement
                  : 0.0;
    }
    if (!std::isfinite(depth)) continue;  // ends at a limit of the law
    if (deepest > k_resolution * predictor.input.radius && depth < (1.0 - k_same_depth) * deepest) return k;
    for (const Until& until : step.until) {
      depth = is_foreseen(until)
                  ? std::min(depth, (1.0 - k_same_depth) * condition_bound(predictor, until).displacement)
                  : 0.0;
    }
    deepest = std::max(deepest, depth);
  }
  return steps.size();
}

/// Number of legs that a run reaches. Targets of later legs must not count: tolerances could become as large as what is
/// reached.
std::size_t legs_run(const Predictor& predictor, const std::vector<Channel>& channels) {
  std::size_t count = legs_until_pull(predictor.model, channels);
  for (const Channel& channel : channels) {
    const std::size_t first = first_unloading_leg(predictor, channel.program);
    if (first < channel.program.size()) count = std::min(count, first);
  }
  return count;
}

/// Upper bound of the value to which a ramp leads before a condition ends it.
/// @param reach     that value without conditions
/// @param is_first  the leg is the first of its program
/// @param before    upper bound of the value to which the last ramp of this kind has led
double ramp_bound(const Predictor& predictor, const Step& step, double reach, bool is_first, double before) {
  const bool is_displacement = step.kind == Step::Kind::displacement;
  for (const Until& until : step.until) {
    // Later steps may begin beyond an event, or beyond a value, which then does not end them.
    if (until.is_event() && !is_first) continue;
    const Reach end = condition_bound(predictor, until);
    const double place = is_displacement ? end.displacement : end.force;
    const bool is_exact = until.is_of(is_displacement ? Quantity::displacement : Quantity::force);
    if (place > (is_exact ? 1.0 : k_known_within) * before) reach = std::min(reach, place);
  }
  return reach;
}

/// Largest displacement [m] or force [N] to which the programs lead.
double program_bound(const Predictor& predictor, const std::vector<Channel>& channels, Step::Kind kind) {
  double largest = 0.0;
  const bool adheres = predictor.model.adheres(predictor.input.values);
  const std::size_t count = legs_run(predictor, channels);
  for (const Channel& channel : channels) {
    double before = 0.0;  // upper bound of the value to which the last ramp of this kind has led
    for (const Step& step : std::span(channel.program).first(std::min(count, channel.program.size()))) {
      if (step.kind == Step::Kind::hold) continue;
      if (step.kind != kind) {
        before = 0.0;
        continue;
      }
      const bool is_withdrawal = step.target < 0.0 && (kind == Step::Kind::displacement || !adheres);
      const double target = (is_withdrawal ? k_share_of_withdrawal : 1.0) * std::abs(step.target);
      const double reach = ramp_bound(predictor, step, target, &step == &channel.program.front(), before);
      before = is_withdrawal ? 0.0 : reach;
      largest = std::max(largest, reach);
    }
  }
  return largest;
}

}  // namespace

Reach program_reach(const Model& model, const ModelInput& input, const std::vector<Channel>& channels,
                    bool moves_centre) {
  const Predictor predictor{model, input, moves_centre};
  return {.displacement = program_bound(predictor, channels, Step::Kind::displacement),
          .force = program_bound(predictor, channels, Step::Kind::force)};
}

}  // namespace monograin
