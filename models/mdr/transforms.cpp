#include "mdr/transforms.hpp"

#include <boost/math/special_functions/gamma.hpp>
#include <stdexcept>

namespace monograin::mdr {

double power_ratio(double exponent) {
  if (!(exponent >= 0.0)) throw std::domain_error("the exponent of a profile is negative");
  // The quotient of the gammas is formed as one, so that large exponents do not overflow.
  return std::sqrt(std::numbers::pi) / boost::math::tgamma_delta_ratio(0.5 * (exponent + 1.0), 0.5);
}

double power_profile_1d(double coefficient, double exponent, double x) {
  return coefficient * power_ratio(exponent) * std::pow(x, exponent);
}

double power_profile_3d(double coefficient, double exponent, double r) {
  return coefficient / power_ratio(exponent) * std::pow(r, exponent);
}

}  // namespace monograin::mdr
