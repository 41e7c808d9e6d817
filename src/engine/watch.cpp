#include "engine/watch.hpp"

#include <algorithm>
#include <cmath>

namespace monograin {

void Watch::begin_step(std::span<const Condition> conditions, double xi, std::span<const double> y) {
  conditions_.clear();
  for (const Condition& condition : conditions) {
    Watched watched{.condition = condition};
    const double distance = excess(watched, xi, y);
    // The larger of target and starting distance makes the root function of order one.
    const double scale = std::max(std::abs(condition.target), std::abs(distance));
    if (scale > 0.0) watched.scale = scale;
    watched.direction = distance < 0.0 ? 1 : distance > 0.0 ? -1 : 0;
    conditions_.push_back(watched);
  }
  renew(xi, y);
}

void Watch::renew(double xi, std::span<const double> y) {
  directions_.clear();
  rooted_.clear();
  for (const Guard& guard : system_.guards()) directions_.push_back(guard.direction);
  system_count_ = directions_.size();
  for (std::size_t i = 0; i < conditions_.size(); ++i) {
    Watched& watched = conditions_[i];
    if (watched.direction == 0) {
      const double distance = excess(watched, xi, y);
      watched.direction = distance < 0.0 ? 1 : distance > 0.0 ? -1 : 0;
    }
    // Force, pressure and contact radius reach zero where the contact is lost and stay there: no root function, but an
    // event of the system, after which is_met() finds them.
    const Quantity quantity = watched.condition.quantity;
    const bool vanishes =
        watched.condition.target == 0.0 &&
        (quantity == Quantity::force || quantity == Quantity::pressure || quantity == Quantity::contact_radius);
    if (vanishes) continue;
    rooted_.push_back(i);
    directions_.push_back(watched.direction);
  }
  is_monotone_ = rooted_.empty() && std::ranges::all_of(system_.guards(), &Guard::is_monotone);
}

std::string Watch::name(std::size_t guard) const {
  if (guard >= system_count_) return "until";
  const Guard& of_system = system_.guards()[guard];
  std::string result(of_system.name);
  if (of_system.index >= 0 && static_cast<std::size_t>(of_system.index) < system_.classes().size()) {
    result += " of " + system_.classes()[static_cast<std::size_t>(of_system.index)].name;
  }
  return result;
}

double Watch::excess(const Watched& watched, double xi, std::span<const double> y) {
  const Condition& c = watched.condition;
  return (system_.quantity(c.quantity, c.channel, xi, y) - c.target) / watched.scale;
}

void Watch::values(double xi, std::span<const double> y, std::span<double> out) {
  system_.guard_values(xi, y, out.first(system_count_));
  for (std::size_t i = 0; i < rooted_.size(); ++i) out[system_count_ + i] = excess(conditions_[rooted_[i]], xi, y);
}

bool Watch::is_met(double xi, std::span<const double> y) {
  return std::ranges::any_of(conditions_, [&](const Watched& watched) {
    return watched.direction != 0 && watched.direction * excess(watched, xi, y) >= 0.0;
  });
}

}  // namespace monograin
