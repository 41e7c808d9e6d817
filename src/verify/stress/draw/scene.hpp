/// A scene of the stress test: dimensionless, so that it can be shrunk, and written out as the text of a scenario.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "catalogue.hpp"
#include "scenario/integrators.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

/// One step of a program. Lengths are in units of R0, forces of S R0^2, stresses of S, the scene's unit of stress.
struct StressStep {
  Step::Kind kind = Step::Kind::displacement;
  double target = 0.0;
  std::optional<double> lateral{};  ///< target of lateral_kind, in the second channel of a material point
  Step::Kind lateral_kind = Step::Kind::strain;
  double pace = 1.0;  ///< duration [s]; if has_rate, the rate in units of the target per second
  bool has_rate = false;
  std::string until;  ///< key of a condition; empty: none
  double until_value = 0.0;
  std::string until_event;

  bool operator==(const StressStep&) const = default;
};

/// A wall of a free set.
struct StressWall {
  std::string name;
  std::array<double, 3> normal{};
  double gap = 0.0;  ///< in R0
  bool is_fixed = false;
  std::vector<StressStep> steps{};  ///< empty: the steps of the scene (unless fixed)

  bool operator==(const StressWall&) const = default;
};

/// A scene with dimensionless numbers, and the units R0 and S that make them physical.
struct StressScene {
  const Model* model = nullptr;
  double radius = 1.0;                         ///< R0 [m], if there is a particle
  double stress = 1.0;                         ///< S [Pa]
  std::map<std::string, double> material;      ///< stresses in S, surface energies in S R0
  std::map<std::string, OptionValue> options;  ///< those that differ from their defaults, `[material]` ones included
  std::string configuration = "simple";        ///< empty where the model has none
  bool centre_is_free = false;
  std::optional<double> oblique_angle;  ///< [rad]
  std::optional<int> oblique_walls;
  std::vector<StressStep> steps;
  int cycles = 1;  ///< number of times that the steps are repeated
  std::vector<StressWall> walls;
  std::string integrator = integrators::k_direct;
  double rtol = integrators::k_default_rtol;
  int points = 12;

  bool operator==(const StressScene&) const = default;
};

/// The scene as a scenario file.
[[nodiscard]] std::string scenario_text(const StressScene& scene);

/// Writes the tables to which options of drawn scenes refer.
void write_stress_tables(const std::filesystem::path& folder);

/// The checked scenario of a text that refers to tables in a folder.
/// @throws ScenarioError if the text is no admissible scenario
[[nodiscard]] CheckedScenario parse_stress_text(std::string_view text, const std::filesystem::path& tables);

}  // namespace monograin
