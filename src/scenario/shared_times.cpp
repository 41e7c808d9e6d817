#include "scenario/shared_times.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "system/resolution.hpp"

namespace monograin {
namespace {

using LegsOfStep = std::span<const Step>;

bool is_same_time(double a, double b) { return std::abs(a - b) <= k_same_number * std::max(a, b); }

/// Times [s] from the beginning of a step at which legs of any program end, ascending; none where all have one leg.
std::vector<double> ends_of_legs(std::span<const LegsOfStep> of_programs) {
  std::vector<double> ends;
  for (const LegsOfStep legs : of_programs) {
    if (legs.size() < 2) continue;
    for (const Step& step : legs) ends.push_back(step.leg.end_time);
  }
  std::ranges::sort(ends);
  ends.erase(std::unique(ends.begin(), ends.end(), is_same_time), ends.end());
  return ends;
}

/// Divides the legs of one program at given times.
void divide(LegsOfStep legs, std::span<const double> ends, std::vector<Step>& divided) {
  if (ends.empty()) {
    divided.insert(divided.end(), legs.begin(), legs.end());
    return;
  }
  const double total = ends.back();
  double begin = 0.0;
  auto leg = legs.begin();
  bool is_first = true;  // part of its leg
  for (const double end : ends) {
    const double end_of_leg = leg + 1 == legs.end() ? total : leg->leg.end_time;
    const bool is_last = is_same_time(end, end_of_leg);
    Step& part = divided.emplace_back(*leg);
    part.leg = {.begin = begin / total,
                .end = end / total,
                .is_corner = is_first && leg->leg.is_corner,
                .begin_time = begin,
                .end_time = end};
    if (part.duration) part.duration = end - begin;
    if (!is_first) part.start.reset();
    part.share = is_last ? 1.0 : (end - begin) / (end_of_leg - begin);
    if (is_last && leg + 1 != legs.end()) ++leg;
    is_first = is_last;
    begin = end;
  }
}

}  // namespace

void share_times(std::span<std::vector<Step>* const> programs) {
  std::vector<std::vector<LegsOfStep>> steps;
  for (const std::vector<Step>* program : programs) steps.push_back(steps_with_legs(*program));
  std::vector<std::vector<Step>> divided(programs.size());
  for (std::size_t k = 0; !steps.empty() && k < steps.front().size(); ++k) {
    std::vector<LegsOfStep> of_programs;
    for (const std::vector<LegsOfStep>& of_program : steps) of_programs.push_back(of_program[k]);
    const std::vector<double> ends = ends_of_legs(of_programs);
    for (std::size_t i = 0; i < programs.size(); ++i) divide(of_programs[i], ends, divided[i]);
  }
  for (std::size_t i = 0; i < programs.size(); ++i) *programs[i] = std::move(divided[i]);
}

}  // namespace monograin
