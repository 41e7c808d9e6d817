// Builds a scenario key by key, runs it, reads its curves, and compares them with those
// of a softer particle.
#include <monograin/monograin.hpp>

#include <algorithm>
#include <cstdio>
#include <span>

namespace mg = monograin;

int main() {
  mg::Scenario scenario;
  scenario.set("model", "mdr")
      .set("particle.radius", "10 mm")
      .set("material.youngs_modulus", 1e9)  // a bare number is in SI units
      .set("material.poisson_ratio", 0.3)
      .set("material.yield_stress", "50 MPa")
      .set("loading.configuration", "die")
      .set("loading.steps[0].displacement", "0.2 R0")
      .set("loading.steps[0].duration", "1 s")
      .set("loading.steps[1].force", 0.0)
      .set("loading.steps[1].duration", "1 s");
  for (const mg::Fault& fault : scenario.validate())
    std::printf("%s\n", fault.message.c_str());

  const mg::RunResult hard = mg::run(scenario);
  const std::span<const double> force = hard.history["axial.force"];
  std::printf("%s: %zu rows, %zu events, largest force %.6g N\n",
              std::string(mg::to_string(hard.status)).c_str(), hard.history.row_count(),
              hard.events.row_count(), *std::max_element(force.begin(), force.end()));

  const mg::RunResult soft = mg::run(scenario.set("material.yield_stress", "40 MPa"));
  for (const mg::CurveDifference& d :
       mg::compare(hard.history, soft.history, "time", "axial.force").curves) {
    std::printf("%s differs by %.3g of its largest value\n", d.y.c_str(), d.linf);
  }
  hard.save("runs/from-cpp");
}
