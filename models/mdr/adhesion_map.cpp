#include "mdr/adhesion_map.hpp"

#include <algorithm>
#include <array>

namespace monograin::mdr {
namespace {

// Largest E/Y of a run. Apparent radius and contact area of a stiffer particle differ by less than 1e-6, while its
// overlap at first yield is lost in round-off.
constexpr double k_stiffest_run = 1e6;

// Options that this scenario does not name have their defaults.
constexpr std::string_view k_flattening = R"(
model = "mdr"
[particle]
radius = "1 m"
[material]
youngs_modulus = "1 Pa"
poisson_ratio = 0.3
yield_stress = "1 Pa"
[mdr]
radius_rule = "gated"  # as the source draws its map
[loading]
configuration = "simple"
[[loading.steps]]
displacement = "0.1 R0"
duration = "1 s"
)";

// In the order of AdhesionValidity.
constexpr std::array<std::string_view, 3> k_validity_names{"valid", "peak failure", "small-scale yielding failure"};

double run_modulus(const FlattenedContact& contact) { return std::min(contact.modulus_over_yield, k_stiffest_run); }

Material run_material(const FlattenedContact& contact) {
  return make_material(1.0, contact.poisson_ratio, 1.0 / run_modulus(contact));
}

std::size_t classify(const FlattenedContact& contact, double modulus, double yield_stress, Control control) {
  // In units of dg and R0.
  const double critical = critical_radius(flattened_indenter(contact), {modulus, 1.0}, control);
  return static_cast<std::size_t>(
      adhesion_validity(critical, flattened_peak_radius(contact), plastic_zone_size(modulus, 1.0, yield_stress)));
}

}  // namespace

const AdhesionMap k_adhesion_map{.scenario = k_flattening,
                                 .stiffest_run = k_stiffest_run,
                                 .yielded = "fully-plastic",
                                 .classes = k_validity_names,
                                 .classify = classify};

Indenter flattened_indenter(const FlattenedContact& contact) {
  if (!contact.has_yielded) return elastic_indenter(ElasticProfile::ellipse, contact.apparent_radius);
  const Material material = run_material(contact);
  // eq. 28 for the height, which is proportional to the yield stress
  const double pressure = plastic_pressure(material, contact.overlap / contact.apparent_radius).pressure;
  const double height = 4.0 * pressure * contact.contact_radius / material.composite_modulus;
  return {ElasticProfile::ellipse, height * (run_modulus(contact) / contact.modulus_over_yield),
          contact.contact_radius};
}

double flattened_peak_radius(const FlattenedContact& contact) {
  return peak_radius_over_initial_radius(contact.displacement, run_material(contact).yield_overlap_ratio);
}

}  // namespace monograin::mdr
