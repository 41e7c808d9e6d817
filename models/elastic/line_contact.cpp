#include "elastic/line_contact.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "system/resolution.hpp"

namespace monograin {
namespace {

using std::numbers::pi;

/// delta/D over (b/R)^2, as a function of ln(b/R).
double slenderness(double log_width) noexcept { return 0.25 * (2.0 * (std::log(4.0) - log_width) - 1.0); }

LineContact of_width(double composite_modulus, double width) {
  if (!(width <= k_widest_line_contact)) {
    throw std::domain_error("the contact of the cylinder is wider than its radius");
  }
  if (width == 0.0) return {};
  const double log_width = std::log(width);
  return {.strain = width * width * slenderness(log_width),
          .stress = pi * composite_modulus / 8.0 * width * width,
          .half_width = width,
          // d(delta/D)/dS = (2/(pi E*)) (2 ln(4 R/b) - 2)
          .tangent = pi * composite_modulus / (4.0 * (std::log(4.0) - log_width - 1.0))};
}

}  // namespace

LineContact line_contact_under_stress(double composite_modulus, double stress) {
  return of_width(composite_modulus, std::sqrt(8.0 * stress / (pi * composite_modulus)));
}

LineContact line_contact_at_strain(double composite_modulus, double strain) {
  if (strain == 0.0) return {};
  const double widest = slenderness(std::log(k_widest_line_contact)) * k_widest_line_contact * k_widest_line_contact;
  if (!(strain > 0.0 && strain <= widest)) {
    throw std::domain_error("the contact of the cylinder is wider than its radius");
  }
  // ln(delta/D) increases with ln b and is concave: Newton's method converges monotonically from the left.
  const double target = std::log(strain);
  double log_width = 0.5 * (target - std::log(slenderness(0.5 * target)));
  for (int k = 0; k < 50; ++k) {
    const double s = slenderness(log_width);
    const double step = (target - 2.0 * log_width - std::log(s)) / (2.0 - 0.5 / s);
    log_width += step;
    if (std::abs(step) <= k_round_off * (1.0 + std::abs(log_width))) break;
  }
  return of_width(composite_modulus, std::exp(std::fmin(log_width, std::log(k_widest_line_contact))));
}

}  // namespace monograin
