/// Materials and sizes on which the contact law is tested, and a yielded contact of each.
#pragma once

#include <array>
#include <ostream>
#include <vector>

#include "mdr/contact.hpp"

namespace monograin::mdr {

/// A particle of unit modulus.
struct Grain {
  double modulus_over_yield;  ///< E/Y
  double poisson_ratio = 0.3;
  double radius = 1.0;

  [[nodiscard]] Material material() const { return make_material(1.0, poisson_ratio, 1.0 / modulus_over_yield); }
};

inline std::ostream& operator<<(std::ostream& out, const Grain& grain) {
  return out << "E/Y = " << grain.modulus_over_yield << ", nu = " << grain.poisson_ratio << ", R = " << grain.radius;
}

/// From strains of order one to nearly rigid-plastic, from compressible to almost incompressible.
[[nodiscard]] inline std::vector<Grain> grains() {
  std::vector<Grain> result;
  for (const double modulus_over_yield : {6.25, 20.0, 200.0, 1e4}) {
    for (const double poisson_ratio : {0.0, 0.3, 0.45, 0.499}) {
      for (const double radius : {1.0, 1.1}) result.push_back({modulus_over_yield, poisson_ratio, radius});
    }
  }
  return result;
}

/// A contact that has yielded and then been driven to its largest overlap.
struct Dent {
  Grain grain;
  double overlap_max;
  Material material = grain.material();
  double area_constant = yield_area_constant(material.yield_overlap_ratio, grain.radius);

  [[nodiscard]] UnloadingShape shape() const { return shape_of(grain.radius, overlap_max); }
  [[nodiscard]] UnloadingShape shape_of(double radius, double largest_overlap) const {
    return unloading_shape(material, radius, largest_overlap, area_constant);
  }
  [[nodiscard]] Contact plastic(double radius, double overlap) const {
    return plastic_contact(material, radius, overlap, area_constant);
  }
  [[nodiscard]] Contact unloading(double radius, double largest_overlap, double overlap) const {
    return unloading_contact(shape_of(radius, largest_overlap), material.composite_modulus, overlap);
  }
  /// Overlap at a share u of the recovery.
  [[nodiscard]] double overlap_at(double u) const { return overlap_max - u * shape().recovery; }
};

inline std::ostream& operator<<(std::ostream& out, const Dent& dent) {
  return out << dent.grain << ", largest overlap = " << dent.overlap_max;
}

/// Two contacts of every grain: one that has just yielded, and a deep one.
[[nodiscard]] inline std::vector<Dent> dents() {
  std::vector<Dent> result;
  for (const Grain& grain : grains()) {
    const double d = grain.material().yield_overlap_ratio;
    for (const double ratio : {1.1 * d, d + 0.2}) result.push_back({grain, ratio * grain.radius});
  }
  return result;
}

}  // namespace monograin::mdr
