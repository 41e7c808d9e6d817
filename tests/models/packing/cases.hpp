/// Parameter sets, reference data and an independent evaluation of the equations for the tests of the packing.
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <numeric>
#include <optional>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "history/table.hpp"
#include "packing/law.hpp"

namespace monograin::packing {

using Precise = boost::multiprecision::cpp_bin_float_50;

inline Table reference(const std::string& file) {
  return read_csv(MONOGRAIN_SOURCE_DIR "/tests/models/packing/reference/" + file + ".csv");
}

constexpr double k_mega = 1e6;

/// Published parameters; H in MPa, none: elastic.
inline Parameters published(std::optional<double> hardening = std::nullopt) {
  Parameters p;
  if (hardening) p.plasticity = {0.4 * k_mega, *hardening * k_mega};
  return p;
}

inline std::ostream& operator<<(std::ostream& out, const Parameters& p) {
  out << "E " << p.youngs_modulus << ", nu " << p.poisson_ratio << ", f_E " << p.stretch_exponent << ", f_G "
      << p.shear_exponent << ", p_c " << p.critical_porosity << ", c1 " << p.coupling_factor << ", c2 "
      << p.strain_offset << ", alpha " << p.plastic_growth << ", Phi_c " << p.jamming_fraction << ", Z "
      << p.coordination_at_jamming << " to " << p.coordination_at_reference << " at " << p.reference_fraction << ", s "
      << (p.coupling == Coupling::published ? 1 : -1);
  if (p.plasticity) out << ", sigma_y " << p.plasticity->yield_stress << ", H " << p.plasticity->hardening_modulus;
  return out;
}

/// A reference file, with the parameters of its computation.
struct Curve {
  const char* file;
  Parameters parameters;
};

inline std::vector<Curve> curves() {
  Parameters consistent = published(1.0);
  consistent.coupling = Coupling::consistent;
  Parameters continuous = published(1.0);
  continuous.has_continuous_jamming = true;
  return {{"pack01_published_elastic", published()},     {"pack01_published_H0", published(0.0)},
          {"pack01_published_H1", published(1.0)},       {"pack01_published_H3", published(3.0)},
          {"pack02_consistent_coupling_H1", consistent}, {"pack03_continuous_jamming_H1", continuous}};
}

/// The equations as printed, with 50 digits: the general form of the plastic packing, all moduli separately, stress
/// positive in compression.
struct Printed {
  Parameters p;

  struct Moduli {
    Precise stretch, shear, bulk;
  };
  /// E, G, K of the elastic material, or of the hardening one.
  [[nodiscard]] Moduli moduli(bool of_hardening) const {
    Precise e = p.youngs_modulus;
    if (of_hardening) {
      const Precise h = p.plasticity->hardening_modulus;
      e = e * h / (e + h);
    }
    const Precise nu = p.poisson_ratio;
    const Precise g = e / (2 * (1 + nu));
    return {e, g, e * nu / ((1 + nu) * (1 - 2 * nu)) + g};
  }
  [[nodiscard]] Precise effective(const Moduli& m, const Precise& phi) const {
    const Precise x = 1 - (1 - phi) / Precise(p.critical_porosity);
    const Precise e = m.stretch * pow(x, Precise(p.stretch_exponent));
    const Precise g = m.shear * pow(x, Precise(p.shear_exponent));
    return g * (4 * g - e) / (3 * g - e);
  }
  [[nodiscard]] Precise coordination(const Precise& phi) const {
    const Precise z = p.coordination_at_jamming;
    const Precise begin = p.jamming_fraction;
    return z +
           (Precise(p.coordination_at_reference) - z) * sqrt((phi - begin) / (Precise(p.reference_fraction) - begin));
  }
  [[nodiscard]] Precise compressed(const Moduli& m, const Precise& phi) const {
    const Precise modulus = effective(m, phi);
    const Precise share = modulus / (Precise(p.coupling_factor) * m.bulk * coordination(phi) * phi);
    return modulus / (p.coupling == Coupling::published ? 1 + share : 1 - share) *
           (log(phi) + Precise(p.strain_offset));
  }
  [[nodiscard]] Precise elastic(const Precise& phi) const { return compressed(moduli(false), phi); }
  [[nodiscard]] Precise strain(const Precise& phi) const { return elastic(phi) / effective(moduli(false), phi); }
  [[nodiscard]] Precise plastic_share(const Precise& phi) const {
    if (!p.plasticity) return 0;
    const Precise f = Precise(p.plastic_growth) * log(phi / Precise(p.jamming_fraction));
    return f < 0 ? Precise(0) : f > 1 ? Precise(1) : f;
  }
  [[nodiscard]] Precise stress(const Precise& phi) const {
    if (!p.plasticity) return elastic(phi);
    const Precise f = plastic_share(phi);
    const bool is_ideal = p.plasticity->hardening_modulus == 0.0;
    const Precise plastic = p.plasticity->yield_stress + (is_ideal ? Precise(0) : compressed(moduli(true), phi));
    return (1 - f) * elastic(phi) + f * plastic;
  }
};

/// Random parameters over the whole domain, with the three marks of jamming in any order.
inline std::vector<Parameters> random_parameters(int count) {
  std::mt19937 random(4);
  const auto between = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  std::vector<Parameters> sets;
  for (int k = 0; k < count; ++k) {
    Parameters p;
    p.youngs_modulus = std::pow(10.0, between(4.0, 11.0));
    p.poisson_ratio = between(-0.4, 0.49);
    p.shear_exponent = between(0.05, 1.5);
    p.stretch_exponent = p.shear_exponent + (k % 5 == 0 ? 0.0 : between(0.0, 2.0));
    p.jamming_fraction = between(0.5, 0.9);
    p.critical_porosity = (1.0 - p.jamming_fraction) * between(0.9, 1.4);
    if (p.critical_porosity >= 1.0) p.critical_porosity = 0.9;
    p.strain_offset = -std::log(p.jamming_fraction) * between(0.9, 1.4);
    p.coupling_factor = between(0.8, 4.0);
    p.plastic_growth = between(0.5, 8.0);
    p.coordination_at_jamming = between(3.0, 6.0);
    p.coordination_at_reference = p.coordination_at_jamming + between(0.0, 6.0);
    p.reference_fraction = std::midpoint(p.jamming_fraction, 1.0) + between(0.0, 0.4) * (1.0 - p.jamming_fraction);
    p.coupling = k % 3 == 2 ? Coupling::consistent : Coupling::published;
    if (k % 4 != 0) {
      p.plasticity = {p.youngs_modulus * std::pow(10.0, between(-3.0, -1.0)),
                      k % 4 == 1 ? 0.0 : p.youngs_modulus * between(0.0, 1.0)};
    }
    sets.push_back(p);
  }
  return sets;
}

}  // namespace monograin::packing
