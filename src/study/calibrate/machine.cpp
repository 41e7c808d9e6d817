#include "study/calibrate/machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenario/units.hpp"

namespace monograin {

double Machine::addition(double force) const noexcept {
  double sum = offset + compliance * force;
  if (forces.size() < 2) return sum;
  const auto next = std::upper_bound(forces.begin() + 1, forces.end() - 1, force);
  const auto k = static_cast<std::size_t>(next - forces.begin());
  sum += std::lerp(deflections[k - 1], deflections[k], (force - forces[k - 1]) / (forces[k] - forces[k - 1]));
  return sum;
}

ParsedCompliance parse_compliance(std::string_view text) {
  const std::size_t slash = text.rfind('/');
  if (slash == std::string_view::npos) return {};
  const ParsedQuantity length = parse_quantity(text.substr(0, slash), Dimension::length, std::nullopt);
  const std::string force_unit(text.substr(slash + 1));
  const ParsedQuantity force = parse_quantity("1 " + force_unit, Dimension::force, std::nullopt);
  if (!length.value || !force.value) return {};
  const double length_factor = parse_quantity("1 " + length.unit, Dimension::length, std::nullopt).value.value_or(1.0);
  return {.value = *length.value / *force.value,
          .unit = fmt::format("{}/{}", length.unit, force.unit),
          .unit_factor = length_factor / *force.value};
}

}  // namespace monograin
