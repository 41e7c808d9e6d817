/// Parameters of the contact law from those of the material, by the regressions over the source's simulations.
/// Source: Edmans and Sinka (n.d.), appendix A, eqs. A.1 to A.3, two coefficients corrected.
#pragma once

#include <optional>
#include <vector>

#include "compressible/law.hpp"
#include "system/keys.hpp"
#include "system/model_input.hpp"

namespace monograin::compressible {

/// Range of the materials in the source's simulations.
inline constexpr double k_least_stiffness_ratio = 3.0;
inline constexpr double k_greatest_stiffness_ratio = 500.0;
inline constexpr double k_least_shear_ratio = 0.25;
inline constexpr double k_greatest_shear_ratio = 1.0;
/// Least stiffness ratio in the source's fits of delta_t and a, which leave out softer materials.
inline constexpr double k_least_fitted_stiffness_ratio = 4.5;

/// k of eq. A.1, a1 corrected: printed a thousandth of it, for which k would fall with the shear strength.
/// @param stiffness_ratio  E0/sigma_y0 > 0;  @param shear_ratio  Gamma0/sigma_y0. Formulas do not check their ranges.
[[nodiscard]] double regressed_stiffness(double stiffness_ratio, double shear_ratio) noexcept;
/// delta_t of eq. A.2, a6 corrected: printed ten times as large, for which there would be no exponential part.
[[nodiscard]] double regressed_transition(double stiffness_ratio, double shear_ratio) noexcept;
/// a of eq. A.3.
[[nodiscard]] double regressed_exponent(double stiffness_ratio, double shear_ratio) noexcept;

/// Parameters of the law that are given; those that are not come from the regressions.
struct GivenLaw {
  std::optional<double> stiffness;
  std::optional<double> transition;
  std::optional<double> exponent;

  [[nodiscard]] bool is_complete() const noexcept { return stiffness && transition && exponent; }
};

/// Objections if the material does not determine the parameters that are not given: it is outside of the source's
/// range, or its shear strength is missing. @param shear_ratio  may be absent where the law is given completely
[[nodiscard]] std::vector<Objection> regression_objections(const GivenLaw& given, double stiffness_ratio,
                                                           std::optional<double> shear_ratio);

/// @throws std::invalid_argument with the first of regression_objections(), or naming a parameter that is not above 0
[[nodiscard]] LoadingLaw loading_law_of(const GivenLaw& given, double stiffness_ratio,
                                        std::optional<double> shear_ratio);

/// True if delta_t or a come from a regression, and the material is softer than those of that regression.
[[nodiscard]] bool is_extrapolated(const GivenLaw& given, double stiffness_ratio) noexcept;

}  // namespace monograin::compressible
