/// Equations of an integrated packing: eq. 21, and the prescribed value of the controlled quantity.
#pragma once

#include <array>

#include "packing/controlled_branch.hpp"

namespace monograin::packing {

/// Unknowns of an integrated packing.
struct IntegratedState {
  double particle_strain = 0.0;  ///< v
  double packing_fraction = 0.0;
};

class IntegratedEquations {
 public:
  /// @param piece           of eq. 11
  /// @param particle_scale  typical strain of the particles
  /// @param value           prescribed value
  IntegratedEquations(const ControlledBranch& branch, Piece piece, double particle_scale, double value)
      : branch_(branch), law_(branch.law()), piece_(piece), particle_scale_(particle_scale), value_(value) {}

  /// Strain of the packing: the total strain without the particles' share.
  [[nodiscard]] double strain(const IntegratedState& y) const noexcept;

  /// Distance from the prescribed value; over E for a stress. A trial may go beyond the stress of a full packing, where
  /// a guard fires.
  [[nodiscard]] double excess(const IntegratedState& y) const;
  /// Derivatives of excess() with respect to the unknowns over their scales.
  [[nodiscard]] std::array<double, 2> excess_slopes(const IntegratedState& y) const;

  /// State with a Phi that is inside the branch. Within an integrator's tolerance a state may reach down into the
  /// closed start, below jamming, or beyond the minimum of the controlled quantity. From inside the closed start
  /// downwards the equations go on along their tangent.
  [[nodiscard]] IntegratedState within_branch(const IntegratedState& y) const noexcept;

  /// Rates of a state within the branch, for a rate of the controlled quantity.
  /// @throws DomainError beyond the end of the branch
  [[nodiscard]] IntegratedState rates(const IntegratedState& y, double rate) const;

  /// State with the prescribed value, next to a guess. @throws std::domain_error if there is none
  [[nodiscard]] IntegratedState completed(const IntegratedState& guess) const;

 private:
  [[nodiscard]] IntegratedState nearest(IntegratedState y) const;

  const ControlledBranch& branch_;
  const Law& law_;
  Piece piece_;
  double particle_scale_;
  double value_;
};

}  // namespace monograin::packing
