/// Plastic phases of a material point at the instant when it first yields.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "material-point/plastic_flow.hpp"
#include "models/material-point/cases.hpp"

namespace monograin::material_point {

struct YieldingPoint {
  std::string name;
  Phase phase{};
  double xi = 0.0;      ///< at which it yields
  Response response{};  ///< there

  [[nodiscard]] double yield_at(double at_xi, const PlasticStrains& plastic) const {
    const Response now = material_point::response(phase, at_xi, plastic);
    return yield_on(phase.parameters, now.at, phase.branch, now.p, now.s).f;
  }
};

[[nodiscard]] inline YieldingPoint yielding_point(const Parameters& parameters, const Ramp& axial,
                                                  const Ramp& lateral) {
  YieldingPoint point{.name = std::to_string(static_cast<int>(parameters.model)) + " axial " +
                              std::to_string(axial.end) + " lateral " + std::to_string(lateral.end)};
  point.phase.parameters = parameters;
  point.phase.conditions = BoundaryConditions(std::array{axial, lateral}, 1.0);
  point.phase.has_straight_flow = parameters.model == YieldModel::vm;
  const Response start = response(point.phase, 0.0, {});
  const StressChange rate = elastic_rate(start.at, point.phase.conditions);
  const Exit exit = way_out(parameters, start.at, start.p, start.s, rate.p, rate.s).value();
  point.phase.is_plastic = true;
  point.phase.branch = exit.branch;
  point.xi = exit.t;
  point.response = response(point.phase, exit.t, {});
  return point;
}

/// Every yield model under strains, under stresses and under one of both.
[[nodiscard]] inline std::vector<YieldingPoint> yielding_points() {
  const Ramp strained{0.0, -0.2, Control::strain};
  const Ramp stressed{0.0, -4.0, Control::stress};
  const Ramp kept{0.0, 0.0, Control::strain};
  const Ramp free{0.0, 0.0, Control::stress};
  std::vector<YieldingPoint> points;
  for (const Parameters& m : {base_case(), lactose(0.03), von_mises(3.0)}) {
    for (const Ramp& axial : {strained, stressed}) {
      for (const Ramp& lateral : {kept, free}) points.push_back(yielding_point(m, axial, lateral));
    }
  }
  return points;
}

}  // namespace monograin::material_point
