#include "elastic/hertz.hpp"

#include <cmath>

namespace monograin {

double composite_modulus(double youngs_modulus, double poisson_ratio) noexcept {
  return youngs_modulus / ((1.0 - poisson_ratio) * (1.0 + poisson_ratio));
}

double hertz_force(double composite_modulus, double radius, double overlap) noexcept {
  return overlap <= 0.0 ? 0.0 : 4.0 / 3.0 * composite_modulus * std::sqrt(radius * overlap) * overlap;
}

double hertz_overlap(double composite_modulus, double radius, double force) noexcept {
  const double root = std::cbrt(0.75 * force / (composite_modulus * std::sqrt(radius)));
  return root * root;
}

double hertz_contact_radius(double radius, double overlap) noexcept {
  return overlap <= 0.0 ? 0.0 : std::sqrt(radius * overlap);
}

double hertz_energy(double composite_modulus, double radius, double overlap) noexcept {
  return overlap <= 0.0 ? 0.0 : 0.4 * hertz_force(composite_modulus, radius, overlap) * overlap;
}

}  // namespace monograin
