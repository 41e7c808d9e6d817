/// MDR particles between single walls at an instant, without an integrator. Lengths over R0, forces over Y R0^2.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mdr/particle.hpp"

namespace monograin::mdr {

/// A wall, and its program in the present step.
struct DrivenWall {
  Eigen::Vector3d normal;
  Ramp ramp;
  double gap = 0.0;
};

/// A wall that rests at a displacement.
inline DrivenWall resting(const Eigen::Vector3d& normal, double displacement) {
  return {normal, {displacement, displacement}};
}

/// A wall that rests at a distance from the particle.
inline DrivenWall away(const Eigen::Vector3d& normal, double gap) { return {normal, {-gap, -gap}, gap}; }

/// A wall that presses with a force.
inline DrivenWall pressing(const Eigen::Vector3d& normal, double force) {
  return {normal, {force, force, Control::force}};
}

/// State of a particle at the start of its step: R = R0, the centre at its initial position.
inline std::vector<double> initial_state(const Particle& p) {
  return std::vector<double>(p.setup().unknown_count(), 0.0);
}

/// A particle with E/Y = 50 whose contacts with all walls without a gap are made.
inline Particle particle_between(const std::vector<DrivenWall>& walls, bool is_free = true) {
  const Settings settings{.initial_radius = 1.0,
                          .youngs_modulus = 50.0,
                          .poisson_ratio = 0.3,
                          .yield_stress = 1.0,
                          .centre_is_free = is_free};
  std::vector<ContactClass> classes;
  std::vector<Ramp> ramps;
  for (const DrivenWall& wall : walls) {
    classes.push_back({.name = "w" + std::to_string(classes.size()),
                       .normals = {wall.normal},
                       .gap = wall.gap,
                       .takes_force = wall.ramp.is_force_controlled()});
    ramps.push_back(wall.ramp);
  }
  Particle p(std::make_shared<const Setup>(settings, classes));
  p.start();
  p.set_drives(ramps);
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (walls[i].gap == 0.0) p.set_branch(i, ContactBranch{}.made());
  }
  p.evaluate(0.0, initial_state(p));
  return p;
}

}  // namespace monograin::mdr
