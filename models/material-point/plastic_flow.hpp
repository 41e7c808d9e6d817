/// Plastic flow of a material point, with the consistency condition that determines the plastic multiplier.
///
/// Source: Edmans and Sinka (n.d.), section 2 (eqs. 1, 2), with total moduli.
#pragma once

#include "material-point/elastic_response.hpp"
#include "material-point/yield_surface.hpp"

namespace monograin::material_point {

/// Constants of the equations between two events: material, boundary conditions, and formula of the yield surface.
struct Phase {
  Parameters parameters;
  BoundaryConditions conditions{};
  bool has_straight_flow = false;  ///< the flow keeps its direction: f = 0 along it is one equation
  bool is_plastic = false;
  Branch branch{};  ///< while plastic
};

[[nodiscard]] inline Response response(const Phase& phase, double xi, const PlasticStrains& plastic) {
  return elastic_response(phase.parameters, phase.conditions, xi, plastic);
}

/// Direction of the flow, and what determines the plastic multiplier l': N - D l' = 0 is the derivative of f = 0.
struct PlasticFlow {
  Yield yield;
  PlasticStrains direction;  ///< derivative of the plastic strains by l
  PlasticStrains gradient;   ///< derivatives of f by the plastic strains, including the change of stress
  double loading = 0.0;      ///< N
  double stiffness = 0.0;    ///< D
  double p_by_flow = 0.0;    ///< dp/dl by the flow alone
  StressChange elastic;      ///< rate per xi, without flow

  /// Cosine between the surface's normal and the elastic rate of stress; 0 if nothing is prescribed to move.
  [[nodiscard]] double cosine() const noexcept;
  /// @throws DomainError where the stiffness is not positive: the plastic multiplier is then not unique
  void require_unique() const;
};

[[nodiscard]] PlasticFlow plastic_flow(const Phase& phase, const Response& now);
/// Flow with another yield function than that of the phase's branch.
[[nodiscard]] PlasticFlow plastic_flow(const Phase& phase, const Response& now, const Yield& yield);

/// Contributions of the flow to the balance of energy, over the strength and the magnitude of the flow's strains.
struct FlowEnergy {
  double work = 0.0;         ///< rate of the plastic work
  double dissipation = 0.0;  ///< the part of it that stiffening does not store
};

[[nodiscard]] FlowEnergy flow_energy(const Phase& phase, const Response& now, const Yield& yield) noexcept;

/// True if plastic flow continues over a corner of the program: if the program stands still, if it leads outwards, or
/// if it leaves along the tangent of a curved surface.
[[nodiscard]] bool continues(const Phase& phase, const Response& now);

}  // namespace monograin::material_point
