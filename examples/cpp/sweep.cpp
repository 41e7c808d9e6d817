// Runs a scenario for many yield stresses on all cores, and prints two numbers of each
// run.
#include <monograin/monograin.hpp>

#include <cstdio>
#include <string>
#include <vector>

namespace mg = monograin;

int main(int argc, char** argv) {
  const mg::Scenario scenario =
      mg::read_scenario(argc > 1 ? argv[1] : "scenarios/die.toml");
  const mg::PreparedScenario prepared(scenario, {"material.yield_stress"});

  std::vector<double> yield_stresses;
  for (int i = 0; i < 9; ++i) yield_stresses.push_back((30.0 + 5.0 * i) * 1e6);
  const std::vector<std::string> formulas{"max(axial.force)",
                                          "end(apparent_radius) / 1e-3"};
  const mg::MapResult table = prepared.map(yield_stresses, formulas);

  std::printf("%14s %18s %22s  %s\n", "yield stress", "largest force [N]",
              "apparent radius [mm]", "status");
  for (std::size_t i = 0; i < yield_stresses.size(); ++i) {
    std::printf("%14.3g %18.6g %22.6g  %s\n", yield_stresses[i], table.values[2 * i],
                table.values[2 * i + 1], table.status[i].c_str());
  }
}
