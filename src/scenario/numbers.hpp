/// The numbers of a scenario that can be set anew, as often as wanted, without reading its file again.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "catalogue.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

/// The initial radius. Lengths of a scenario may be given in terms of it, so that set_number() does not take it: see
/// ScenarioTemplate.
inline constexpr std::string_view k_radius_key = "particle.radius";

/// A number that can be sought.
struct NumberKey {
  std::string path;  ///< as of `--set`: "material.yield_stress"
  std::string_view meaning;
  Dimension dimension = Dimension::none;
  Range range;  ///< of admissible values [SI], finite
};

/// Those of a checked scenario: the constants of its material, the numbers among its model's options, what its
/// configuration adds to them, gaps of its walls, and the radius of its particle.
[[nodiscard]] std::vector<NumberKey> number_keys(const CheckedScenario& scenario);

/// Path of the gap of a wall, counted from 0: "loading.wall[1].gap".
[[nodiscard]] std::string gap_path(std::size_t wall);

/// Sets one of them, other than the radius. What it accepts is not checked again: see the key's range.
/// @param value  [SI]
/// @throws std::logic_error for another path
void set_number(CheckedScenario& scenario, std::string_view path, double value);

}  // namespace monograin
