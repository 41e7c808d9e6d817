// Fits two material parameters to a measured curve, and runs the scenario with the fitted
// values.
#include <monograin/monograin.hpp>
#include <monograin/study.hpp>

#include <algorithm>
#include <cstdio>
#include <span>

namespace mg = monograin;

int main(int argc, char** argv) {
  const char* const file = argc > 1 ? argv[1] : "scenarios/calibrate/uniaxial.toml";
  const mg::study::CalibrationResult fit =
      mg::study::calibrate({.file = file}, {.folder = "runs/fit-from-cpp"});
  for (const mg::study::FittedParameter& p : fit.parameters) {
    std::printf("%-26s %10.5g %s, 95 %% in [%.5g, %.5g]\n", p.key.c_str(), p.value,
                p.unit.c_str(), p.lower, p.upper);
  }
  for (const std::string& warning : fit.warnings)
    std::printf("warning: %s\n", warning.c_str());

  const mg::RunResult run = mg::run(fit.scenario);
  const std::span<const double> force = run.history["axial.force"];
  std::printf("largest force of the fitted scenario: %.5g N\n",
              *std::max_element(force.begin(), force.end()));
}
