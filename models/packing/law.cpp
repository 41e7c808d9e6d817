#include "packing/law.hpp"

#include <algorithm>
#include <array>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <stdexcept>

#include "system/limit.hpp"
#include "system/resolution.hpp"

namespace monograin::packing {
namespace {

constexpr double k_least_room = 1e-5;  // least distance of Phi_J from 1
// Samples of growing_branch(): from round-off above Phi_J in equal ratios, then in equal steps; and one sample just
// before full plasticity.
constexpr int k_ratios = 60;
constexpr int k_steps = 200;

void require(bool is_met, const char* message) {
  if (!is_met) throw std::invalid_argument(message);
}

/// x = 1 - (1 - Phi)/p_c, without cancellation near x = 0.
double openness(const Law& law, double phi) noexcept { return (phi - law.rigidity) / law.given.critical_porosity; }

/// M_eff and its slope over Phi (eqs. 7-9), with E_eff/G_eff = r = 2 (1 + nu) x^n, n = f_E - f_G.
struct Modulus {
  double value = 0.0;
  double slope = 0.0;
};

Modulus modulus(const Law& law, double phi) {
  const Parameters& p = law.given;
  const double x = openness(law, phi);
  if (!(x >= 0.0)) throw std::domain_error("the porosity is above its critical value, where the moduli are undefined");
  const double n = p.stretch_exponent - p.shear_exponent;
  const double ratio = 2.0 * (1.0 + p.poisson_ratio) * std::pow(x, n);
  const double rest = 3.0 - ratio;
  if (!(rest > 0.0)) throw std::domain_error("the denominator 3 G_eff - E_eff of the modulus vanishes");
  const double shear = law.shear_modulus * std::pow(x, p.shear_exponent);
  const double by_x =
      shear / x * (p.shear_exponent * (4.0 - ratio) + n * ratio / rest) / rest;  // infinite at x = 0 for f_G < 1
  return {shear * (4.0 - ratio) / rest, by_x / p.critical_porosity};
}

/// Z'(Phi).
double coordination_slope(const Law& law, double phi) noexcept {
  const Parameters& p = law.given;
  const double gain = p.coordination_at_reference - p.coordination_at_jamming;
  if (gain == 0.0) return 0.0;
  return 0.5 * gain / std::sqrt((p.reference_fraction - p.jamming_fraction) * (phi - p.jamming_fraction));
}

/// s m by itself. In 1 + s m, the small m of nearly incompressible particles would keep few digits. Throws where that
/// sum, by which the consistent coupling divides, is not positive.
double give(const Law& law, double modulus, double coordination, double phi) {
  const double result = law.sign * modulus / (law.given.coupling_factor * law.bulk_modulus * coordination * phi);
  if (!(1.0 + result > 0.0)) {
    throw DomainError(Limit::infinite_stress);
  }
  return result;
}

double slope_of(const Law& law, Measure measure, double phi) {
  const Slopes all = slopes(law, phi, state(law, phi).strain);
  switch (measure) {
    case Measure::strain:
      return all.strain;
    case Measure::stress_elastic:
      return all.stress_elastic;
    case Measure::stress:
      return all.stress;
  }
  return 0.0;
}

/// Phi at which the consistent coupling divides by zero, or 1. The divisor need not fall monotonically, so that its
/// zero is bracketed by a scan.
double end_of_states(const Law& law) {
  if (law.sign > 0.0) return 1.0;
  const auto has_state = [&law](double phi) {
    try {
      static_cast<void>(give(law, modulus(law, phi).value, coordination_number(law, phi), phi));
      return true;
    } catch (const std::domain_error&) {
      return false;
    }
  };
  double inside = law.jamming;
  if (!has_state(inside)) return inside;
  for (int k = 1; k <= k_steps; ++k) {
    double outside = std::lerp(law.jamming, 1.0, static_cast<double>(k) / k_steps);
    if (has_state(outside)) {
      inside = outside;
      continue;
    }
    while (std::midpoint(inside, outside) > inside && std::midpoint(inside, outside) < outside) {
      const double middle = std::midpoint(inside, outside);
      (has_state(middle) ? inside : outside) = middle;
    }
    return inside;
  }
  return 1.0;
}

/// Root of a function between two bounds, to the last bit: of the final bracket's ends, the one with the smaller value.
template <class Function>
double sign_change(Function&& function, double below, double above, double at_below, double at_above) {
  std::uintmax_t iterations = 200;
  const auto [lower, upper] = boost::math::tools::toms748_solve(
      function, below, above, at_below, at_above,
      [](double a, double b) { return std::abs(b - a) <= k_epsilon * std::abs(b); }, iterations);
  return std::abs(function(lower)) < std::abs(function(upper)) ? lower : upper;
}

}  // namespace

Law make_law(const Parameters& given) {
  Law law{.given = given};
  Parameters& p = law.given;
  if (p.has_continuous_jamming) {
    p.critical_porosity = 1.0 - p.jamming_fraction;
    p.strain_offset = -std::log(p.jamming_fraction);
  }
  const auto is_positive = [](double value) { return value > 0.0 && std::isfinite(value); };
  require(is_positive(p.youngs_modulus), "Young's modulus has to be positive");
  require(p.poisson_ratio > -1.0 && p.poisson_ratio < 0.5, "Poisson's ratio has to lie between -1 and 0.5");
  require(is_positive(p.shear_exponent), "f_G has to be positive");
  require(std::isfinite(p.stretch_exponent) && p.stretch_exponent >= p.shear_exponent,
          "f_E has to be at least f_G: below it, the modulus has a pole");
  require(p.critical_porosity > 0.0 && p.critical_porosity < 1.0, "the critical porosity has to lie between 0 and 1");
  require(is_positive(p.coupling_factor), "c1 has to be positive");
  require(is_positive(p.strain_offset), "c2 has to be positive");
  require(is_positive(p.plastic_growth), "alpha has to be positive");
  require(p.jamming_fraction > 0.0 && p.jamming_fraction < 1.0, "the jamming fraction has to lie between 0 and 1");
  require(is_positive(p.coordination_at_jamming), "Z_c has to be positive");
  require(std::isfinite(p.coordination_at_reference) && p.coordination_at_reference >= p.coordination_at_jamming,
          "Z_1 is below Z_c: contacts would be lost in compaction");
  require(p.reference_fraction > p.jamming_fraction && p.reference_fraction <= 1.0,
          "Phi_1 has to lie above the jamming fraction, and not above 1");
  if (p.plasticity) {
    require(is_positive(p.plasticity->yield_stress), "the yield stress has to be positive");
    require(p.plasticity->hardening_modulus >= 0.0 && std::isfinite(p.plasticity->hardening_modulus),
            "the hardening modulus has to be zero or more");
  }

  law.shear_modulus = p.youngs_modulus / (2.0 * (1.0 + p.poisson_ratio));
  const double lame = p.youngs_modulus * p.poisson_ratio / ((1.0 + p.poisson_ratio) * (1.0 - 2.0 * p.poisson_ratio));
  law.bulk_modulus = lame + law.shear_modulus;
  law.modulus_at_one = lame + 2.0 * law.shear_modulus;
  law.rigidity = p.has_continuous_jamming ? p.jamming_fraction : 1.0 - p.critical_porosity;
  law.zero_stress = p.has_continuous_jamming ? p.jamming_fraction : std::exp(-p.strain_offset);
  law.sign = p.coupling == Coupling::published ? 1.0 : -1.0;
  law.hardening_share =
      p.plasticity ? p.plasticity->hardening_modulus / (p.youngs_modulus + p.plasticity->hardening_modulus) : 1.0;
  law.jamming = std::max({p.jamming_fraction, law.rigidity, law.zero_stress});
  require(law.jamming < 1.0 - k_least_room, "the packing jams where no pores are left: nothing remains to compact");
  law.end = end_of_states(law);
  return law;
}

double coordination_number(const Law& law, double phi) {
  const Parameters& p = law.given;
  if (!(phi >= p.jamming_fraction)) throw std::domain_error("below jamming there is no coordination number");
  return p.coordination_at_jamming +
         (p.coordination_at_reference - p.coordination_at_jamming) *
             std::sqrt((phi - p.jamming_fraction) / (p.reference_fraction - p.jamming_fraction));
}

double total_strain(const Law& law, double phi) noexcept {
  return std::log1p((phi - law.zero_stress) / law.zero_stress);
}

double plastic_fraction(const Law& law, double phi, Piece piece) noexcept {
  if (!law.given.plasticity) return 0.0;
  if (piece == Piece::full) return 1.0;
  const double growing = std::max(law.given.plastic_growth * std::log(phi / law.given.jamming_fraction), 0.0);
  return piece == Piece::growing ? growing : std::min(growing, 1.0);
}

double full_plasticity(const Law& law) noexcept {
  if (!law.given.plasticity) return k_infinity;
  return law.given.jamming_fraction * std::exp(1.0 / law.given.plastic_growth);
}

State state(const Law& law, double phi) {
  if (!(phi >= law.jamming)) throw std::domain_error("the packing is looser than where it jams");
  State result;
  result.modulus = modulus(law, phi).value;
  const double given_way = give(law, result.modulus, coordination_number(law, phi), phi);
  result.strain = total_strain(law, phi) / (1.0 + given_way);
  result.particle_strain = law.sign * given_way * result.strain;
  result.stress_elastic = result.modulus * result.strain;
  result.stress = total_stress(law, phi, result.stress_elastic);
  return result;
}

double total_stress(const Law& law, double phi, double stress_elastic, Piece piece) noexcept {
  if (!law.given.plasticity) return stress_elastic;
  return stress_elastic * total_stress_slope(law, phi, piece) +
         plastic_fraction(law, phi, piece) * law.given.plasticity->yield_stress;
}

double stress_elastic_at(const Law& law, double phi, double stress) noexcept {
  if (!law.given.plasticity) return stress;
  return (stress - plastic_fraction(law, phi) * law.given.plasticity->yield_stress) / total_stress_slope(law, phi);
}

double total_stress_slope(const Law& law, double phi, Piece piece) noexcept {
  return 1.0 - plastic_fraction(law, phi, piece) * (1.0 - law.hardening_share);
}

Slopes slopes(const Law& law, double phi, double strain, Piece piece) {
  if (!(phi >= law.jamming)) throw std::domain_error("the packing is looser than where it jams");
  const Modulus m = modulus(law, phi);
  const double coordination = coordination_number(law, phi);
  const double given_way = give(law, m.value, coordination, phi);
  // s m' = s m (M'/M - Z'/Z - 1/Phi)
  const double by_modulus = law.sign * m.slope / (law.given.coupling_factor * law.bulk_modulus * coordination * phi);
  const double give_slope = by_modulus - given_way * (coordination_slope(law, phi) / coordination + 1.0 / phi);
  Slopes result;
  result.strain = (1.0 / phi - give_slope * strain) / (1.0 + given_way);
  result.particle_strain = law.sign * (given_way / phi + give_slope * strain) / (1.0 + given_way);
  result.stress_elastic = m.value * result.strain + m.slope * strain;
  const double without_particles = m.value / phi + m.slope * strain;
  const bool is_growing = piece == Piece::growing || (piece == Piece::either && plastic_fraction(law, phi) < 1.0);
  const double softness = 1.0 - law.hardening_share;
  const double growth = law.given.plasticity && is_growing ? law.given.plastic_growth / phi : 0.0;
  const double yield_stress = law.given.plasticity ? law.given.plasticity->yield_stress : 0.0;
  const double by_growth = growth * (yield_stress - softness * m.value * strain);
  const double by_elastic = total_stress_slope(law, phi, piece);
  result.stress = result.stress_elastic * by_elastic + by_growth;
  result.at_given_particles = without_particles * by_elastic + by_growth;
  return result;
}

double effective_modulus(const Law& law, double phi) { return modulus(law, phi).value; }

double measured(const Law& law, Measure measure, double phi) {
  const State now = state(law, phi);
  switch (measure) {
    case Measure::strain:
      return now.strain;
    case Measure::stress_elastic:
      return now.stress_elastic;
    case Measure::stress:
      return now.stress;
  }
  return 0.0;
}

Branch growing_branch(const Law& law, Measure measure) {
  std::array<double, k_ratios + k_steps + 2> fractions{};
  const double room = 1.0 - law.jamming;
  // The ratios end where the equal steps begin.
  for (int k = 0; k <= k_ratios; ++k) {
    fractions[static_cast<std::size_t>(k)] =
        law.jamming + room * std::pow(k_round_off, 1.0 - static_cast<double>(k) / k_ratios) /
                          std::pow(static_cast<double>(k_steps), static_cast<double>(k) / k_ratios);
  }
  for (int k = 1; k <= k_steps; ++k) {
    fractions[static_cast<std::size_t>(k_ratios + k)] = std::lerp(law.jamming, 1.0, static_cast<double>(k) / k_steps);
  }
  // As the particles yield, the stress falls fastest just before all of them have yielded, and grows again at once.
  const double yielding = full_plasticity(law) * (1.0 - k_round_off);
  fractions.back() = std::clamp(yielding, fractions.front(), 1.0);
  std::ranges::sort(fractions);
  const auto slope = [&](double phi) {
    try {
      return slope_of(law, measure, phi);
    } catch (const std::domain_error&) {
      return -1.0;  // the equations end before Phi = 1, and the branch with them
    }
  };
  Branch branch{.measure = measure, .begin = law.jamming};
  double before = fractions.front();
  bool grows = slope(before) > 0.0;
  bool has_grown = grows;
  for (const double fraction : fractions) {
    if (!(fraction > before) || (slope(fraction) > 0.0) == grows) {
      before = std::max(before, fraction);
      continue;
    }
    // Bisection, because the slope may have a jump, and has no value where the equations end.
    double lower = before;
    double upper = fraction;
    while (std::midpoint(lower, upper) > lower && std::midpoint(lower, upper) < upper) {
      const double middle = std::midpoint(lower, upper);
      ((slope(middle) > 0.0) == grows ? lower : upper) = middle;
    }
    if (has_grown) {
      branch.end = lower;
      break;
    }
    branch.begin = upper;
    has_grown = grows = true;
    before = fraction;
  }
  if (!has_grown) branch.end = branch.begin;
  branch.least = measured(law, measure, branch.begin);
  branch.greatest = measured(law, measure, branch.end);
  return branch;
}

double softening(const Law& law) {
  if (!law.given.plasticity) return k_infinity;
  const double stress = law.given.plasticity->yield_stress / (1.0 - law.hardening_share);
  const Branch branch = growing_branch(law, Measure::stress_elastic);
  if (stress <= branch.least || stress > branch.greatest) return k_infinity;
  return packing_fraction_at(law, branch, stress);
}

double packing_fraction_at(const Law& law, const Branch& branch, double value) {
  if (!(value >= branch.least && value <= branch.greatest)) {
    throw std::domain_error(branch.measure == Measure::strain ? "no packing fraction has this strain"
                                                              : "no packing fraction has this stress");
  }
  if (value == branch.least) return branch.begin;
  if (value == branch.greatest) return branch.end;
  return sign_change([&](double phi) { return measured(law, branch.measure, phi) - value; }, branch.begin, branch.end,
                     branch.least - value, branch.greatest - value);
}

}  // namespace monograin::packing
