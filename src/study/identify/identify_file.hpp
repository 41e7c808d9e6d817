/// Plans of experiments: programs of loads that could be measured, their noise, and the parameters to be identified.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenario/scenario.hpp"
#include "scenario/text_file.hpp"
#include "study/calibrate/calibration.hpp"
#include "study/calibrate/machine.hpp"
#include "study/calibrate/replay.hpp"

namespace monograin {

/// A program of loads that could be measured.
struct ExperimentProgram {
  std::string name;
  std::vector<std::string> overrides;  ///< of the scenario, for this program
  CheckedScenario scenario;            ///< overridden; differentiates its history by the free numbers
  std::string observable;              ///< measured quantity y: "axial.force"
  Measurable::Drive driven;            ///< quantity along which a fit goes; set with a machine or noise of x
  int points = 100;                    ///< measured rows, evenly in time
  double absolute_noise = 0.0;         ///< constant part of the standard deviation of y [SI of y]
  double relative_noise = 0.0;         ///< part in proportion to |y|; the squares of both parts add
  double noise_of_x = 0.0;             ///< standard deviation of the driven quantity [SI]
  bool is_planned = false;             ///< measured in any case; other programs are candidates
  SourceLocation noise_at;
};

/// A checked plan.
struct ExperimentPlan {
  std::string name;  ///< of the file, without folder and extension
  std::string title;
  std::string text;  ///< of the file
  CheckedScenario scenario;
  std::vector<FreeParameter> free;          ///< parameters whose errors are asked for
  std::vector<double> values;               ///< their true values [SI]: those of the scenario, none of which is zero,
                                            ///< and those of the machine
  Machine machine;                          ///< with which all programs are measured
  std::vector<ExperimentProgram> programs;  ///< at least one

  /// True if the machine adds, or may add, to what is measured.
  [[nodiscard]] bool has_machine() const noexcept;
};

/// Reads and checks a plan and its scenario.
/// @throws ScenarioError with all faults
[[nodiscard]] ExperimentPlan read_experiment_plan(const std::filesystem::path& file);
[[nodiscard]] ExperimentPlan parse_experiment_plan(NamedText source);

}  // namespace monograin
