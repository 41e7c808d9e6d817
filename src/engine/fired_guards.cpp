#include "engine/fired_guards.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "system/resolution.hpp"

namespace monograin {
namespace {

/// Values of the guards within the integrator's last step.
class GuardsBefore {
 public:
  GuardsBefore(GuardSet& guard_set, Integrator& integrator, std::size_t unknowns)
      : guard_set_(guard_set), integrator_(integrator), state_(unknowns), values_(guard_set.size()) {}

  std::span<const double> at(double xi) {
    integrator_.dense_output(xi, state_);
    guard_set_.values(xi, state_, values_);
    return values_;
  }

 private:
  GuardSet& guard_set_;
  Integrator& integrator_;
  std::vector<double> state_;
  std::vector<double> values_;
};

/// True if a condition of the program was nearer to being met before xi than at xi: a quantity may reverse where its
/// branch ends.
/// @param now   value of the guard at xi
/// @param from  beginning of the searched interval; the evaluations approach xi by a constant factor
[[nodiscard]] bool goes_away(GuardsBefore& guards, std::size_t guard, double now, double from, double xi) {
  double distance = xi - from;
  for (std::size_t k = 0; k < k_evaluations_before_end; ++k) {
    distance *= k_approach_to_end;
    if (std::abs(guards.at(xi - distance)[guard]) < std::abs(now) - k_zero_guard) return true;
  }
  return false;
}

}  // namespace

bool are_marks(const GuardSet& guard_set, std::span<const std::size_t> guards) {
  return !guards.empty() && std::ranges::all_of(guards, [&](std::size_t guard) {
    const Guard* const of_system = guard_set.of_system(guard);
    return of_system != nullptr && of_system->is_mark;
  });
}

// A guard fires together with those that the integrator has found if it is within its tolerance of zero at xi, and if
// the following holds. It is not short of zero by more than it has moved since the middle of the integrator's last
// step: at its mean rate it reaches zero within as long again, and a branch may be shorter than the tolerance. It was
// not zero at that middle, and moves in a direction in which it counts. If it is a condition of the program and short
// of zero, it does not go away from zero before xi.
std::vector<std::size_t> fired_guards(GuardSet& guard_set, Integrator& integrator, double last, double xi,
                                      std::span<const double> y) {
  std::vector<std::size_t> fired(integrator.fired().begin(), integrator.fired().end());
  if (are_marks(guard_set, fired)) return fired;
  std::vector<double> now(guard_set.size());
  guard_set.values(xi, y, now);
  const auto tolerance_of = [&](std::size_t g) {
    const Guard* const of_system = guard_set.of_system(g);
    return of_system != nullptr && of_system->is_exact ? k_zero_guard : integrator.guard_tolerance();
  };
  const auto may_be_met = [&](std::size_t g) {
    const int direction = guard_set.directions()[g];
    return (direction == 0 || direction * now[g] >= -tolerance_of(g)) && std::ranges::find(fired, g) == fired.end();
  };
  std::vector<std::size_t> others;
  for (std::size_t g = 0; g < guard_set.size(); ++g) {
    if (may_be_met(g)) others.push_back(g);
  }
  if (!others.empty()) {
    GuardsBefore guards(guard_set, integrator, y.size());
    const double middle = std::midpoint(last, xi);
    const std::span<const double> values = guards.at(middle);
    const std::vector<double> before(values.begin(), values.end());
    for (const std::size_t g : others) {
      const int side = before[g] < 0.0 ? 1 : -1;
      const bool counts = guard_set.directions()[g] == 0 || guard_set.directions()[g] == side;
      const double path = side * (now[g] - before[g]);
      const bool has_arrived = path > 0.0 && -side * now[g] <= std::min(tolerance_of(g), std::max(k_zero_guard, path));
      if (!counts || before[g] == 0.0 || !has_arrived) continue;
      if (guard_set.of_system(g) != nullptr || -side * now[g] <= 0.0 || !goes_away(guards, g, now[g], middle, xi))
        fired.push_back(g);
    }
  }
  std::ranges::sort(fired);
  return fired;
}

}  // namespace monograin
