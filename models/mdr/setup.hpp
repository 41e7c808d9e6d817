/// Constants of a run of the MDR particle: settings, law and units, contact classes, and the unknowns in y.
///
/// Unknowns: growth = (R - R0)/R0, the work of the walls, the displacement of a free centre along the directions in
/// which walls can move it, and the approach delta_o of every wall whose force is prescribed at some time. Where a
/// force is prescribed, the unknown is the work less force times displacement, -int delta_o dF: unlike int F
/// d(delta_o), this has no singularity where a contact is made or snaps off. System::begin_step() changes from one to
/// the other. Lengths in R0; stresses in Y.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "mdr/apparent_radius.hpp"
#include "mdr/contact_branch.hpp"
#include "mdr/free_centre.hpp"
#include "system/equations.hpp"
#include "system/resolution.hpp"
#include "system/walls.hpp"

namespace monograin::mdr {

struct Settings {
  double initial_radius = 0.0;  ///< R0 [m], > 0
  double youngs_modulus = 0.0;  ///< E [Pa], > 0
  double poisson_ratio = 0.0;   ///< in (-1, 0.5]
  double yield_stress = 0.0;    ///< Y [Pa], > 0
  double surface_energy = 0.0;  ///< dg of the particle-wall contact [J/m2], >= 0
  ElasticProfile elastic_profile = ElasticProfile::ellipse;
  RadiusRule radius_rule = RadiusRule::yielded;
  DeltaMaxRule delta_max_rule = DeltaMaxRule::running_maximum;
  std::shared_ptr<const PressureCurve> pressure_curve{};  ///< p_Y/Y over delta/R; null: the source's exponential
  bool stops_at_cap_intersection = false;
  bool centre_is_free = false;  ///< the centre moves so that the wall forces balance
  /// Gives the scales of the unknowns, to which absolute tolerances are relative. 0: unknown.
  Reach reach{};
};

/// Indices of the unknowns in y.
enum UnknownIndex : std::size_t {
  k_growth,  ///< (R - R0)/R0
  k_work,
  k_centre  ///< first free direction of the centre; the others follow
};
[[nodiscard]] constexpr std::size_t centre_index(int k) noexcept { return k_centre + static_cast<std::size_t>(k); }
/// Displacement of the centre in a state.
[[nodiscard]] CentreVector centre_of(std::span<const double> y, int free_directions) noexcept;
void set_centre(std::span<double> y, int free_directions, const CentreVector& centre) noexcept;

/// Constants of a run.
struct Setup {
  Setup(const Settings& given, std::vector<ContactClass> contact_classes);

  Settings settings;
  ContactLaw law;  ///< stresses over Y, lengths over R0
  std::vector<ContactClass> classes;
  std::vector<double> counts;  ///< walls of each class
  bool takes_forces = false;   ///< whether any class is ever under force control
  FreeCentre centre;           ///< without loads
  std::vector<std::size_t>
      wall_index;  ///< index in y of the approach of each class that takes a force; not used (0) for others

  [[nodiscard]] double length_unit() const noexcept { return settings.initial_radius; }
  [[nodiscard]] double stress_unit() const noexcept { return settings.yield_stress; }
  [[nodiscard]] double force_unit() const noexcept { return stress_unit() * length_unit() * length_unit(); }
  [[nodiscard]] std::vector<Unknown> unknowns() const;
  [[nodiscard]] std::size_t unknown_count() const noexcept {
    return centre_index(centre.free_directions()) +
           static_cast<std::size_t>(std::ranges::count_if(classes, &ContactClass::takes_force));
  }
  /// Largest displacement that the program leads to at any wall, over R0 and at most 1; 1 where it is not known.
  [[nodiscard]] double largest_displacement_expected() const;
  /// Typical growth of the radius up to a displacement of the walls, both over R0.
  [[nodiscard]] double growth_scale(double displacement) const noexcept;
  /// Typical work of one wall up to a displacement over R0: the smaller one of an elastic and a fully plastic contact.
  [[nodiscard]] double work_scale(double displacement) const noexcept;
};

}  // namespace monograin::mdr
