#include "verify/stress/draw/walls.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "scenario/scenario.hpp"

namespace monograin {
namespace {

constexpr std::size_t k_most_drawn_walls = 6;

std::array<double, 3> draw_direction(Dice& dice) {
  const double z = dice.uniform(-1.0, 1.0);
  const double angle = dice.uniform(0.0, 2.0 * std::numbers::pi);
  const double rho = std::sqrt(1.0 - z * z);
  return {rho * std::cos(angle), rho * std::sin(angle), z};
}

/// A direction at a small angle [rad] from another, for nearly parallel walls.
std::array<double, 3> beside(const std::array<double, 3>& normal, double angle) {
  const double rho = std::hypot(normal[0], normal[1]);
  if (rho == 0.0) return {std::sin(angle), 0.0, std::cos(angle) * normal[2]};
  const double polar = std::atan2(rho, normal[2]) + angle;
  return {std::sin(polar) * normal[0] / rho, std::sin(polar) * normal[1] / rho, std::cos(polar)};
}

}  // namespace

std::vector<std::array<double, 3>> draw_cell(Dice& dice) {
  std::vector<std::array<double, 3>> normals{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {-1.0, 0.0, 0.0}, {0.0, -1.0, 0.0}};
  if (dice.happens(0.5)) normals.insert(normals.end(), {{0.0, 0.0, 1.0}, {0.0, 0.0, -1.0}});
  if (dice.happens(0.2)) normals.erase(normals.begin() + static_cast<std::ptrdiff_t>(dice.below(normals.size())));
  return normals;
}

std::vector<std::array<double, 3>> draw_normals(Dice& dice, double least_angle) {
  const std::size_t count = 2 + dice.below(k_most_drawn_walls - 1);
  const double apart = dice.happens(0.7) ? 0.6 : std::max(least_angle, 1e-3);
  std::vector<std::array<double, 3>> normals{draw_direction(dice)};
  while (normals.size() < count) {
    const double what = dice.uniform(0.0, 1.0);
    std::array<double, 3> normal = draw_direction(dice);
    const std::array<double, 3>& other = normals[dice.below(normals.size())];
    if (what < 0.25) normal = {-other[0], -other[1], -other[2]};
    if (what > 0.9) normal = beside(other, std::max(1.01 * least_angle, dice.log_uniform(1e-9, 0.2)));
    const double least = what > 0.9 ? std::max(least_angle, 1e-10) : apart;
    const auto is_apart = [&](const std::array<double, 3>& n) { return angle_between(n, normal) >= least; };
    if (std::ranges::all_of(normals, is_apart)) normals.push_back(normal);
  }
  return normals;
}

}  // namespace monograin
