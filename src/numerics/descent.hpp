/// Ways downhill from a place in the box of a least-squares problem to its nearest minimum.
#pragma once

#include <cstddef>
#include <span>

#include "numerics/search_box.hpp"

namespace monograin {

/// Distance in z within which two short descents approach the same minimum.
inline constexpr double k_near_place = 0.02;

/// How far a descent goes.
struct Effort {
  std::size_t iterations;
  double step;              ///< estimated distance to the minimum, in z, that ends it
  bool is_central = false;  ///< central differences in every iteration; otherwise one-sided ones, updated by secants
};
inline constexpr Effort k_short_descent{7, 1e-3};  // enough to leave a slice for its valley
inline constexpr Effort k_rough_descent{20, 1e-5};
inline constexpr Effort k_long_descent{40, 1e-7};

/// Goes downhill by GSL's multifit_nlinear (Levenberg-Marquardt in a trust region) until the effort is used up, the
/// minimum is reached, or a known place is near.
/// @return the start if no lower cost is found
[[nodiscard]] Place descend(SearchBox& box, const Place& start, const Effort& effort,
                            std::span<const Place> known = {});

/// Goes on from a place near a minimum, until its parameters have the accuracy of the residuals.
[[nodiscard]] Place descend_to_round_off(SearchBox& box, Place place);

/// Finds the minimum near a place at which derivatives predict a lower cost that does not exist. GSL's simplex method
/// of Nelder and Mead (1965) goes downhill without derivatives; the sides of the first simplex are scaled so that the
/// predicted cost rises equally along them.
/// @return the place itself if the cost is smooth there
[[nodiscard]] Place descend_over_kinks(SearchBox& box, const Place& place);

}  // namespace monograin
