#include "scenario/program_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "system/resolution.hpp"

namespace monograin {
namespace {

constexpr double k_unknown = std::numeric_limits<double>::quiet_NaN();  // only a run shows it

constexpr std::string_view k_together = "steps end together";

bool is_same(double a, double b) { return std::abs(a - b) <= k_same_number * std::max(std::abs(a), std::abs(b)); }

/// For each step: true if a condition of any wall may end it, for all walls.
std::vector<bool> may_end_early(std::span<const WallProgram> programs) {
  std::vector<bool> may(programs.front().steps.size());
  for (const WallProgram& program : programs) {
    for (std::size_t k = 0; k < may.size(); ++k) may[k] = may[k] || !program.steps[k].until.empty();
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
  for (std::size_t k = 0; k < program.steps.size(); ++k) {
    const Step& step = program.steps[k];
    const bool is_detaching = step.kind == Step::Kind::detach;
    const Control next = is_detaching ? Control::displacement : control_of(step.kind).value_or(control);
    if (next != control) present = k == 0 ? 0.0 : k_unknown;
    control = next;
    if (step.start && !std::isnan(present))
      check_start(program, step, present, control == Control::force ? "N" : "m", faults);
    durations.push_back(step.duration.value_or(k_unknown));
    if (step.rate && !is_detaching) durations.back() = std::abs(step.target - present) / *step.rate;
    if (step.kind == Step::Kind::hold) continue;
    // A contact that is lost under a tension leaves its force at zero.
    const bool may_be_lost = control == Control::force && !(step.target > 0.0);
    present = is_detaching || may_be_lost || may_end_early[k] ? k_unknown : step.target;
  }
  return durations;
}

/// What a step does, where another one withdraws its wall.
std::string pace_of(const Step& step) {
  if (step.kind == Step::Kind::detach) return "is withdrawn until its contact is lost (detach)";
  const std::string_view verb = step.kind == Step::Kind::hold ? "is held" : "moves";
  return step.duration ? fmt::format("{} for {:.9g} s", verb, *step.duration) : fmt::format("{} at its rate", verb);
}

/// Compares the programs of two walls, of which the first one is of the first wall.
class Comparison {
 public:
  Comparison(const WallProgram& first, const WallProgram& other, FaultList& faults)
      : first_(first), other_(other), faults_(faults) {}

  /// True if the programs have equally many steps, divided at the same times.
  bool check_steps() {
    if (const auto [a, b] = std::pair(count_steps(other_.steps), count_steps(first_.steps)); a != b) {
      faults_.add(other_.where, fmt::format("wall '{}' has {} steps where wall '{}' has {}; expected equal numbers",
                                            other_.wall, a, first_.wall, b));
      return false;
    }
    const auto same_leg = [](const Step& a, const Step& b) {
      return is_same(a.leg.begin, b.leg.begin) && is_same(a.leg.end, b.leg.end);
    };
    const auto [a, b] = std::ranges::mismatch(other_.steps, first_.steps, same_leg);
    if (a == other_.steps.end() && b == first_.steps.end()) return true;
    const auto step = a == other_.steps.end() ? a - 1 : a;
    faults_.add(
        step->where,
        fmt::format("step {} of wall '{}' and that of wall '{}' do not have the same times: one of them follows "
                    "a table or a sine; expected tables of the same times, or one program for both walls",
                    number_of(step - other_.steps.begin()), other_.wall, first_.wall));
    return false;
  }

  void check_durations(const std::vector<double>& of_first, const std::vector<double>& of_other) {
    for (std::size_t k = 0; k < of_other.size(); ++k) {
      const std::string fault = fault_at(k, of_first[k], of_other[k]);
      if (fault.empty()) continue;
      faults_.add(other_.steps[k].where, fault);
      return;
    }
  }

 private:
  [[nodiscard]] std::size_t number_of(std::ptrdiff_t k) const {
    return count_steps(other_.steps.first(static_cast<std::size_t>(k) + 1));
  }

  [[nodiscard]] std::string fault_at(std::size_t k, double of_first, double of_other) const {
    const Step& first = first_.steps[k];
    const Step& other = other_.steps[k];
    const std::size_t number = number_of(static_cast<std::ptrdiff_t>(k));
    const bool is_detaching = other.kind == Step::Kind::detach;
    if (is_detaching != (first.kind == Step::Kind::detach)) {
      return fmt::format(
          "in step {} wall '{}' {} where wall '{}' {}; {}, so expected detach for both, or a displacement with a "
          "duration and until = {{ event = \"contact-lost\" }} in its place",
          number, other_.wall, pace_of(other), first_.wall, pace_of(first), k_together);
    }
    if (is_detaching && !is_same(*first.rate, *other.rate)) {
      return fmt::format(
          "step {} withdraws wall '{}' at {:.9g} m/s and wall '{}' at {:.9g} m/s; {}, so expected equal rates", number,
          other_.wall, *other.rate, first_.wall, *first.rate, k_together);
    }
    if (std::isnan(of_first) || std::isnan(of_other) || is_same(of_first, of_other)) return {};
    return fmt::format(
        "step {} of wall '{}' takes {:.9g} s where that of wall '{}' takes {:.9g} s; {}, so expected equal durations",
        number, other_.wall, of_other, first_.wall, of_first, k_together);
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
    if (!Comparison(first, other, faults).check_steps()) return;
  }
  const std::vector<bool> may_end = may_end_early(programs);
  const std::vector<double> of_first = durations_of(first, may_end, faults);
  for (const WallProgram& other : programs.subspan(1)) {
    Comparison(first, other, faults).check_durations(of_first, durations_of(other, may_end, faults));
  }
}

}  // namespace monograin
