#include "scene/mdr_law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "elastic/hertz.hpp"

namespace monograin {
namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();

}  // namespace

std::shared_ptr<const mdr::PressureCurve> pressure_curve_of(const Scenario& scenario) {
  const auto samples = scenario.curves.find("pressure_table");
  if (samples == scenario.curves.end()) return nullptr;
  return std::make_shared<const mdr::PressureCurve>(samples->second.x, samples->second.y);
}

mdr::Material mdr_material_of(const Scenario& scenario) {
  const auto yield_stress = scenario.material.find("yield_stress");
  return mdr::make_material(scenario.material.at("youngs_modulus"), scenario.material.at("poisson_ratio"),
                            yield_stress == scenario.material.end() ? k_infinity : yield_stress->second,
                            pressure_curve_of(scenario));
}

Reach mdr_reach(const Scenario& scenario, const Until& until) {
  const double radius = scenario.radius;
  const mdr::Material law = mdr_material_of(scenario);
  const bool yields = std::isfinite(law.yield_stress);
  const double modulus = law.composite_modulus;
  const double circumference = 2.0 * std::numbers::pi * radius;
  const auto up_to_radius = [&](double contact_radius) { return contact_radius * contact_radius / radius; };
  Reach reach{.displacement = k_infinity, .force = k_infinity};
  switch (until.quantity) {
    case Until::Quantity::force: {
      const double plastic = yields ? until.value / (circumference * law.yield_stress) : 0.0;
      const double elastic = mdr::elastic_overlap(mdr::ElasticProfile::parabola, modulus, radius, until.value);
      return {.displacement = std::max(elastic, plastic), .force = until.value};
    }
    case Until::Quantity::displacement:
      reach.displacement = until.value;
      break;
    case Until::Quantity::contact_radius:
      reach.displacement = up_to_radius(until.value);
      break;
    case Until::Quantity::pressure: {
      const double elastic = up_to_radius(0.75 * std::numbers::pi * radius * until.value / modulus);
      if (elastic < law.yield_overlap_ratio * radius) reach.displacement = elastic;
      break;
    }
    case Until::Quantity::event:
      if (until.event == "yield" && yields) reach.displacement = law.yield_overlap_ratio * radius;
      break;
    default:
      break;
  }
  if (reach.displacement < radius) {
    const double plastic =
        yields ? mdr::plastic_pressure(law, 0.0).pressure * circumference * reach.displacement : k_infinity;
    reach.force = std::min(hertz_force(modulus, radius, reach.displacement), plastic);
  }
  return reach;
}

}  // namespace monograin
