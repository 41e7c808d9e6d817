#include "packing/mode.hpp"

#include <algorithm>
#include <cmath>

namespace monograin::packing {

bool is_jammed_at(const ControlledBranch& branch, double value, int direction, bool was_jammed) {
  if (branch.control() == Control::stress) return was_jammed || value > 0.0 || direction > 0;
  const double jamming = branch.value_at_jamming();
  if (value > jamming || (value == jamming && (direction > 0 || (direction == 0 && was_jammed)))) return true;
  // Where the strain falls at first, a packing that is not unloaded stays jammed below the strain at jamming.
  return was_jammed && direction >= 0 && value >= branch.range().least;
}

Mode mode_of_jammed(const ControlledBranch& branch, double value, int direction) {
  const double least = branch.range().least;
  if (branch.control() == Control::stress && (value < least || (value == least && direction <= 0))) return Mode::held;
  const double end_of_start = branch.value_at(branch.end_of_start());
  return value < end_of_start || (value == end_of_start && direction < 0) ? Mode::starting : Mode::jammed;
}

PackingState closed_form(const ControlledBranch& branch, Mode mode, double value, double at_rest) {
  const Law& law = branch.law();
  const Branch& range = branch.range();
  const Control control = branch.control();
  if (mode == Mode::unjammed) {
    double phi = at_rest;
    if (control == Control::packing_fraction) phi = value;
    if (control == Control::strain) phi = law.jamming * std::exp(value - branch.strain_at_jamming());
    return {.packing_fraction = phi, .strain = branch.strain_at_jamming() + std::log(phi / law.jamming)};
  }
  if (mode == Mode::held) {
    const State s = state(law, range.begin);
    return {range.begin, s.stress_elastic, s.strain, value};
  }
  const double inside = std::clamp(value, range.least, range.greatest);
  const double phi = branch.packing_fraction_at(inside);
  const State s = state(law, phi);
  // Next to jamming, strain and stress may pass through a whole program within the round-off of Phi.
  if (control == Control::stress) return {phi, stress_elastic_at(law, phi, inside), s.strain, inside};
  return {phi, s.stress_elastic, control == Control::strain ? inside : s.strain, s.stress};
}

double particle_strain(const ControlledBranch& branch, const PackingState& now) {
  const Law& law = branch.law();
  const double phi = now.packing_fraction;
  const double by_law = state(law, phi).particle_strain;
  if (branch.control() == Control::packing_fraction) return by_law;
  // Elsewhere the difference would lose digits: beside a greater strain, or in a stress that is mostly plastic.
  const bool is_prescribed = branch.control() == Control::strain;
  const bool is_mostly_of_particles = by_law > 0.5 * now.strain;
  const double elastic_part = now.stress_elastic * total_stress_slope(law, phi);
  if (!is_mostly_of_particles || (!is_prescribed && elastic_part < 0.5 * now.stress)) return by_law;
  const double strain = is_prescribed ? now.strain : now.stress_elastic / effective_modulus(law, phi);
  return law.sign * (total_strain(law, phi) - strain);
}

}  // namespace monograin::packing
