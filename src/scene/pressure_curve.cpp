#include "scene/pressure_curve.hpp"

namespace monograin {

std::shared_ptr<const mdr::PressureCurve> pressure_curve_of(const Scenario& scenario) {
  const auto samples = scenario.curves.find("pressure_table");
  if (samples == scenario.curves.end()) return nullptr;
  return std::make_shared<const mdr::PressureCurve>(samples->second.x, samples->second.y);
}

}  // namespace monograin
