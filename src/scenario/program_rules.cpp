#include "scenario/program_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "system/resolution.hpp"

namespace monograin {
namespace {

constexpr double k_unknown = k_nan;  // only a run shows it

constexpr std::string_view k_together = "steps end together";

bool is_same(double a, double b) { return std::abs(a - b) <= k_same_number * std::max(std::abs(a), std::abs(b)); }

using Legs = std::span<const Step>;  // of one step

/// For each step: true if a condition of any wall may end it, for all walls.
std::vector<bool> may_end_early(std::span<const WallProgram> programs) {
  std::vector<bool> may(count_steps(programs.front().steps));
  for (const WallProgram& program : programs) {
    const std::vector<Legs> steps = steps_with_legs(program.steps);
    for (std::size_t k = 0; k < may.size(); ++k) may[k] = may[k] || !steps[k].front().until.empty();
  }
  return may;
}

void check_start(const WallProgram& program, const Step& step, double present, std::string_view unit,
                 FaultList& faults) {
  if (is_same(*step.start, present)) return;
  faults.add(
      step.where,
      fmt::format("the table or sine begins at {:.9g} {}, where the wall is at {:.9g} {}{}; expected a step before "
                  "it that leads there, or a first row of the table at a later time",
                  *step.start, unit, present, unit,
                  program.wall.empty() ? "" : fmt::format(" (wall '{}')", program.wall)));
}

/// Durations of the steps of a program. Reports tables that begin elsewhere than their wall is.
std::vector<double> durations_of(const WallProgram& program, const std::vector<bool>& may_end_early,
                                 FaultList& faults) {
  Control control = Control::displacement;
  double present = 0.0 - program.gap;  // value of the controlled quantity
  std::vector<double> durations;
  for (const Legs legs : steps_with_legs(program.steps)) {
    const std::size_t k = durations.size();
    const Step& step = legs.front();
    const bool is_detaching = step.kind == Step::Kind::detach;
    const Control next = is_detaching ? Control::displacement : control_of(step.kind).value_or(control);
    if (next != control) present = k == 0 ? 0.0 : k_unknown;
    control = next;
    if (step.start && !std::isnan(present))
      check_start(program, step, present, control == Control::force ? "N" : "m", faults);
    durations.push_back(step.leg.is_whole() ? step.duration.value_or(k_unknown) : legs.back().leg.end_time);
    if (step.rate && !is_detaching) durations.back() = std::abs(step.target - present) / *step.rate;
    if (step.kind == Step::Kind::hold) continue;
    // A contact that is lost under a tension leaves its force at zero.
    const double target = legs.back().target;
    const bool may_be_lost = control == Control::force && !(target > 0.0);
    present = is_detaching || may_be_lost || may_end_early[k] ? k_unknown : target;
  }
  return durations;
}

/// Describes a step beside one that withdraws its wall: "is held".
std::string pace_of(const Step& step, double duration) {
  if (step.kind == Step::Kind::detach) return "is withdrawn until its contact is lost (detach)";
  const std::string_view verb = step.kind == Step::Kind::hold ? "is held" : "moves";
  return step.rate ? fmt::format("{} at its rate", verb) : fmt::format("{} for {:.9g} s", verb, duration);
}

/// Compares the programs of two walls, of which the first one is of the first wall.
class Comparison {
 public:
  Comparison(const WallProgram& first, const WallProgram& other, FaultList& faults)
      : first_(first), other_(other), faults_(faults) {}

  /// True if the programs have equally many steps.
  bool check_numbers() {
    const auto [a, b] = std::pair(count_steps(other_.steps), count_steps(first_.steps));
    if (a == b) return true;
    faults_.add(other_.where, fmt::format("wall '{}' has {} steps where wall '{}' has {}; expected equal numbers",
                                          other_.wall, a, first_.wall, b));
    return false;
  }

  void check_durations(const std::vector<double>& of_first, const std::vector<double>& of_other) {
    const std::vector<Legs> steps_of_first = steps_with_legs(first_.steps);
    const std::vector<Legs> steps_of_other = steps_with_legs(other_.steps);
    for (std::size_t k = 0; k < of_other.size(); ++k) {
      const Step& other = steps_of_other[k].front();
      const std::string fault = fault_at(k + 1, {steps_of_first[k].front(), of_first[k]}, {other, of_other[k]});
      if (fault.empty()) continue;
      faults_.add(other.where, fault);
      return;
    }
  }

 private:
  struct TimedStep {
    const Step& step;
    double duration;  ///< [s]; nan: unknown
  };

  [[nodiscard]] std::string fault_at(std::size_t number, TimedStep first, TimedStep other) const {
    const bool is_detaching = other.step.kind == Step::Kind::detach;
    if (is_detaching != (first.step.kind == Step::Kind::detach)) {
      return fmt::format(
          "in step {} wall '{}' {} where wall '{}' {}; {}, so expected detach for both, or a displacement with a "
          "duration and until = {{ event = \"contact-lost\" }} in its place",
          number, other_.wall, pace_of(other.step, other.duration), first_.wall, pace_of(first.step, first.duration),
          k_together);
    }
    if (is_detaching && !is_same(*first.step.rate, *other.step.rate)) {
      return fmt::format(
          "step {} withdraws wall '{}' at {:.9g} m/s and wall '{}' at {:.9g} m/s; {}, so expected equal rates", number,
          other_.wall, *other.step.rate, first_.wall, *first.step.rate, k_together);
    }
    if (std::isnan(first.duration) || std::isnan(other.duration) || is_same(first.duration, other.duration)) return {};
    return fmt::format(
        "step {} of wall '{}' takes {:.9g} s where that of wall '{}' takes {:.9g} s; {}, so expected equal durations",
        number, other_.wall, other.duration, first_.wall, first.duration, k_together);
  }

  const WallProgram& first_;
  const WallProgram& other_;
  FaultList& faults_;
};

}  // namespace

void check_programs(std::span<const WallProgram> programs, FaultList& faults) {
  if (programs.empty()) return;
  const WallProgram& first = programs.front();
  for (const WallProgram& other : programs) {
    if (!Comparison(first, other, faults).check_numbers()) return;
  }
  const std::vector<bool> may_end = may_end_early(programs);
  const std::vector<double> of_first = durations_of(first, may_end, faults);
  for (const WallProgram& other : programs.subspan(1)) {
    Comparison(first, other, faults).check_durations(of_first, durations_of(other, may_end, faults));
  }
}

}  // namespace monograin
