/// Drives a scene through its program: steps, segments, events, output points.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/forward_sensitivities.hpp"
#include "engine/integrator.hpp"
#include "monograin/status.hpp"
#include "scenario/scenario.hpp"
#include "scene/scene.hpp"

namespace monograin {

/// Where a row of the history stands: at an output point, or just before or after an event or corner.
enum class RowSide : signed char { before = -1, output = 0, after = 1 };

/// Receives the history of a drive. A row is first observed, then appended once or several times.
class HistorySink {
 public:
  virtual ~HistorySink() = default;
  /// Evaluates the observables. @param step  number of the program's step, from 1
  virtual void observe(double time, int step, double xi, std::span<const double> y) = 0;
  /// Takes the derivatives of the row observed last: one row of ForwardSensitivities.
  virtual void take_derivatives(std::span<const double> /*derivatives*/) {}
  /// Appends the row observed last to the history.
  virtual void append(RowSide side) = 0;
  /// Records an event with the state observed last.
  virtual void event(const Event& event) = 0;
};

/// How a drive has ended, and its statistics.
struct DriveResult {
  RunStatus status = RunStatus::complete;
  std::string message;                     ///< why it stopped or failed
  std::optional<Limit> limit{};            ///< limit of the model that stopped the run
  std::optional<Failure> failure{};        ///< why the integrator gave up, in a failed run
  std::optional<Difficulty> difficulty{};  ///< what makes a failed run hard, if the model knows it
  Statistics statistics;
  std::vector<std::string> warnings;
};

/// Integrates a scene. The sink receives its history up to the end of the run, also of a stopped or failed run.
///
/// @param integrator     one of integrator_names(), or IntegratorChoice::used of choose_integrator()
/// @param output         output points of every step, or instants of the whole run
/// @param sensitivities  derivatives of this scene, for an integrator that has_forward_sensitivities(); null: none
/// @return limits of the model and failures of the integrator are in the status; they do not throw
/// @throws LostSensitivities where the derivatives cannot be carried on
[[nodiscard]] DriveResult drive(Scene& scene, std::string_view integrator, const Tolerances& tolerances,
                                const Output& output, HistorySink& sink, ForwardSensitivities* sensitivities = nullptr);

}  // namespace monograin
