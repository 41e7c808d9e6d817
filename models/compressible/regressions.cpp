#include "compressible/regressions.hpp"

#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace monograin::compressible {
namespace {

/// Coefficients of eqs. A.2 and A.3, in the order of the source.
struct Biquadratic {
  double a1, a2, a3, a4, a5, a6;

  [[nodiscard]] double operator()(double stiffness_ratio, double shear_ratio) const noexcept {
    const double softness = 1.0 / stiffness_ratio;
    return shear_ratio * (a1 * shear_ratio + a2 * softness + a4) + softness * (a3 * softness + a5) + a6;
  }
};

// As printed, with five digits, but for a6 of A.2 (corrected; printed 4.3846e-1).
constexpr Biquadratic k_transition{-6.4872e-2, 6.2711e-1, -1.9770, 1.1830e-1, 9.8478e-1, 4.3846e-2};
constexpr Biquadratic k_exponent{4.8807, -3.5557, 1.5682e1, -3.9942, -8.9363e-1, 2.8104};

std::string text(double value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.6g", value);
  return digits;
}

void check(const char* key, double value, double least, double greatest, std::vector<Objection>& found) {
  if (value >= least && value <= greatest) return;
  found.push_back({key, std::string(key) + " = " + text(value) + " is outside " + text(least) + " to " +
                            text(greatest) +
                            ", where k, delta_t and a follow from the material; expected a value in there, or k, "
                            "delta_t and a in [compressible]"});
}

}  // namespace

double regressed_stiffness(double stiffness_ratio, double shear_ratio) noexcept {
  // a1 corrected; printed 7.4613e-4.
  const double logarithm = std::log(stiffness_ratio);
  return shear_ratio * (7.4613e-1 * logarithm - 4.6910e-2) + 1.8243e-2 * logarithm + 0.4262;
}

double regressed_transition(double stiffness_ratio, double shear_ratio) noexcept {
  return k_transition(stiffness_ratio, shear_ratio);
}

double regressed_exponent(double stiffness_ratio, double shear_ratio) noexcept {
  return k_exponent(stiffness_ratio, shear_ratio);
}

std::vector<Objection> regression_objections(const GivenLaw& given, double stiffness_ratio,
                                             std::optional<double> shear_ratio) {
  std::vector<Objection> found;
  if (given.is_complete()) return found;
  check("stiffness_ratio", stiffness_ratio, k_least_stiffness_ratio, k_greatest_stiffness_ratio, found);
  if (!shear_ratio) {
    found.push_back(
        {"shear_ratio",
         "k, delta_t and a follow from stiffness_ratio and shear_ratio; expected shear_ratio in [material], "
         "or all three in [compressible]"});
  } else {
    check("shear_ratio", *shear_ratio, k_least_shear_ratio, k_greatest_shear_ratio, found);
  }
  return found;
}

LoadingLaw loading_law_of(const GivenLaw& given, double stiffness_ratio, std::optional<double> shear_ratio) {
  const std::vector<Objection> objections = regression_objections(given, stiffness_ratio, shear_ratio);
  if (!objections.empty()) throw std::invalid_argument(objections.front().message);
  if (given.is_complete()) return make_loading_law(*given.stiffness, *given.transition, *given.exponent);
  return make_loading_law(given.stiffness.value_or(regressed_stiffness(stiffness_ratio, *shear_ratio)),
                          given.transition.value_or(regressed_transition(stiffness_ratio, *shear_ratio)),
                          given.exponent.value_or(regressed_exponent(stiffness_ratio, *shear_ratio)));
}

bool is_extrapolated(const GivenLaw& given, double stiffness_ratio) noexcept {
  return stiffness_ratio < k_least_fitted_stiffness_ratio && (!given.transition || !given.exponent);
}

}  // namespace monograin::compressible
