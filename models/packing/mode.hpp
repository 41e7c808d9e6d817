/// Modes of a packing under a prescribed value, and its state by the closed form.
#pragma once

#include "packing/controlled_branch.hpp"

namespace monograin::packing {

enum class Mode {
  unjammed,
  held,      ///< at jamming, under less stress than its branch begins with
  starting,  ///< next to the singular point: closed form
  jammed     ///< integrated where there is an integrator
};

/// True if a packing is jammed as a ramp passes a value.
/// @param direction  of the ramp
[[nodiscard]] bool is_jammed_at(const ControlledBranch& branch, double value, int direction, bool was_jammed);

/// Mode of a jammed packing at a value. If the strain falls at first, a packing jams beyond its closed start.
[[nodiscard]] Mode mode_of_jammed(const ControlledBranch& branch, double value, int direction);

/// State of a packing, jammed or loose.
struct PackingState {
  double packing_fraction = 0.0;
  double stress_elastic = 0.0;  ///< [Pa]
  double strain = 0.0;
  double stress = 0.0;  ///< [Pa]
};

/// State by the closed form. Beyond the range of a mode, at whose end a guard fires, the state at that end.
/// @param at_rest  Phi of an unjammed packing under no stress
[[nodiscard]] PackingState closed_form(const ControlledBranch& branch, Mode mode, double value, double at_rest);

/// Strain of the particles in a jammed state by the closed form. Next to a pole, the round-off of Phi shows in the
/// strain; the particles' strain is then the total strain minus that of the packing.
[[nodiscard]] double particle_strain(const ControlledBranch& branch, const PackingState& now);

}  // namespace monograin::packing
