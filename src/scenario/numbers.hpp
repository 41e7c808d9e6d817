/// Numbers of a scenario that can be changed repeatedly without reading its file again.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "catalogue.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

/// Path of the initial radius. set_number() cannot change it, because lengths may be given in R0; ScenarioTemplate can.
inline constexpr std::string_view k_radius_key = "particle.radius";
/// Beginning of the paths of the material's numbers.
inline constexpr std::string_view k_of_material = "material.";

/// A number of a scenario that can be fitted or varied.
struct NumberKey {
  std::string path;  ///< as of `--set`: "material.yield_stress"
  std::string_view meaning;
  Dimension dimension = Dimension::none;
  Range range;  ///< of admissible values [SI], finite
};

/// Numbers of a checked scenario: the constants of its material, the numbers among its model's options and those of its
/// configuration, the gaps of its walls, and the radius of its particle.
[[nodiscard]] std::vector<NumberKey> number_keys(const CheckedScenario& scenario);

/// Path of the gap of a wall, counted from 0: "loading.wall[1].gap".
[[nodiscard]] std::string gap_path(std::size_t wall);

/// One number for all keys that a path with a range names, such as "loading.wall[2-5].gap"; none without a range, or if
/// one of the keys is not among the given numbers.
[[nodiscard]] std::optional<NumberKey> number_of_range(const std::vector<NumberKey>& numbers, std::string_view path);

/// Sets a number other than the radius, without checking the range of its key.
/// @param value  [SI]
/// @throws std::logic_error for another path
void set_number(CheckedScenario& scenario, std::string_view path, double value);

}  // namespace monograin
