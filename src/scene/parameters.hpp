/// What a model makes of a scenario's material before anything moves.
#pragma once

#include <string_view>
#include <vector>

#include "scenario/scenario.hpp"

namespace monograin {

struct DerivedParameter {
  std::string_view name;
  double value = 0.0;
  std::string_view unit;
  std::string_view symbol{};  ///< in the source; empty: none
};

/// Particle, material and the constants that follow from them.
[[nodiscard]] std::vector<DerivedParameter> derived_parameters(const Scenario& scenario);

}  // namespace monograin
