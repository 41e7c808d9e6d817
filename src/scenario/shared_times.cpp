#include "scenario/shared_times.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "system/resolution.hpp"

namespace monograin {
namespace {

using LegsOfStep = std::span<const Step>;

bool is_same_time(double a, double b) { return std::abs(a - b) <= k_same_number * std::max(a, b); }

/// Times [s] from the beginning of a step at which the parts of its legs end, ascending, and for each program the part
/// with which each of its legs ends. None where all programs have one leg.
struct Division {
  std::vector<double> ends;
  std::vector<std::vector<std::size_t>> parts;

  /// Number of the parts of a program.
  [[nodiscard]] std::size_t count(LegsOfStep legs) const { return ends.empty() ? legs.size() : ends.size(); }
};

/// A leg that another one of its program follows.
struct InnerEnd {
  double time = 0.0;
  std::size_t program = 0;
};

/// Ends of different programs count as one where round-off is all that divides them, but never those of one program.
Division division_of(std::span<const LegsOfStep> of_programs) {
  Division division;
  division.parts.resize(of_programs.size());
  std::vector<InnerEnd> inner;
  std::optional<double> total;
  for (std::size_t i = 0; i < of_programs.size(); ++i) {
    const LegsOfStep legs = of_programs[i];
    if (legs.size() < 2) continue;
    for (const Step& step : legs.first(legs.size() - 1)) inner.push_back({step.leg.end_time, i});
    total = std::max(total.value_or(0.0), legs.back().leg.end_time);
  }
  if (!total) return division;
  std::ranges::stable_sort(inner, {}, &InnerEnd::time);
  std::vector<double>& ends = division.ends;
  for (const InnerEnd& end : inner) {
    std::vector<std::size_t>& parts = division.parts[end.program];
    const bool has_ended_there = !parts.empty() && parts.back() + 1 == ends.size();
    if (ends.empty() || has_ended_there || !is_same_time(ends.back(), end.time)) ends.push_back(end.time);
    parts.push_back(ends.size() - 1);
  }
  ends.push_back(*total);
  for (std::vector<std::size_t>& parts : division.parts) parts.push_back(ends.size() - 1);
  return division;
}

/// Divides the legs of one program.
/// @param last_parts  the part with which each leg ends
void divide(LegsOfStep legs, std::span<const double> ends, std::span<const std::size_t> last_parts,
            std::vector<Step>& divided) {
  if (ends.empty()) {
    divided.insert(divided.end(), legs.begin(), legs.end());
    return;
  }
  const double total = ends.back();
  double begin = 0.0;
  std::size_t part = 0;
  for (std::size_t k = 0; k < legs.size(); ++k) {
    const std::size_t first = part;
    const double end_of_leg = ends[last_parts[k]];
    for (; part <= last_parts[k]; ++part) {
      const double end = ends[part];
      Step& step = divided.emplace_back(legs[k]);
      step.leg = {.begin = begin / total,
                  .end = end / total,
                  .is_corner = part == first && legs[k].leg.is_corner,
                  .begin_time = begin,
                  .end_time = end};
      if (step.duration) step.duration = end - begin;
      if (part > first) step.start.reset();
      step.share = part == last_parts[k] ? 1.0 : (end - begin) / (end_of_leg - begin);
      begin = end;
    }
  }
}

}  // namespace

std::size_t share_times(std::span<std::vector<Step>* const> programs, std::size_t most) {
  std::vector<std::vector<LegsOfStep>> steps;
  for (const std::vector<Step>* program : programs) steps.push_back(steps_with_legs(*program));
  std::vector<Division> divisions;
  std::size_t count = 0;
  for (std::size_t k = 0; !steps.empty() && k < steps.front().size(); ++k) {
    std::vector<LegsOfStep> of_programs;
    for (const std::vector<LegsOfStep>& of_program : steps) of_programs.push_back(of_program[k]);
    const Division& division = divisions.emplace_back(division_of(of_programs));
    for (const LegsOfStep legs : of_programs) count += division.count(legs);
  }
  if (count > most) return count;
  for (std::size_t i = 0; i < programs.size(); ++i) {
    std::vector<Step> divided;
    for (std::size_t k = 0; k < divisions.size(); ++k) {
      divide(steps[i][k], divisions[k].ends, divisions[k].parts[i], divided);
    }
    *programs[i] = std::move(divided);
  }
  return count;
}

}  // namespace monograin
