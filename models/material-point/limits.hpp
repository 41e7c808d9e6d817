/// Limits of a material point's equations.
#pragma once

#include <string_view>
#include <vector>

#include "material-point/plastic_flow.hpp"
#include "system/regimes.hpp"

namespace monograin::material_point {

/// Limits that plastic flow of the phase can meet.
[[nodiscard]] std::vector<Limit> limits_of(const Phase& phase);

/// Distance of a state from a limit of its plastic phase, with the quantity that shows it.
struct LimitDistance {
  std::string_view event;  ///< that ends a run at the limit
  double margin = 0.0;     ///< over its usual size; negative beyond the limit
  std::string_view quantity;
  double value = 0.0;
};
[[nodiscard]] LimitDistance distance_to(Limit limit, const Phase& phase, const Response& now);

/// End of a run at the limit.
[[nodiscard]] DomainEnd domain_end(Limit limit, const Phase& phase, const Response& now);

}  // namespace monograin::material_point
