/// The numbers of a scenario that can be set anew, as often as wanted, without reading its file again.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "catalogue.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

/// A number that stands on its own: no other value of the scenario is given in terms of it, as lengths are in R0.
struct NumberKey {
  std::string path;  ///< as of `--set`: "material.yield_stress"
  std::string_view meaning;
  Dimension dimension = Dimension::none;
  Range range;  ///< of admissible values [SI], finite
};

/// Those of a checked scenario: the constants of its material, the numbers among its model's options, and what its
/// configuration adds to them.
[[nodiscard]] std::vector<NumberKey> number_keys(const CheckedScenario& scenario);

/// Sets one of them. What it accepts is not checked again: see the key's range.
/// @param value  [SI]
/// @throws std::logic_error for another path
void set_number(CheckedScenario& scenario, std::string_view path, double value);

}  // namespace monograin
