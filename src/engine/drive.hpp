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

/// Takes what a drive comes by. Rows are first observed, then appended, once or more often.
class HistorySink {
 public:
  virtual ~HistorySink() = default;
  /// Evaluates the observables. @param step  number of the program's step, from 1
  virtual void observe(double time, int step, double xi, std::span<const double> y) = 0;
  /// Takes the derivatives of what was observed last: one row of ForwardSensitivities.
  virtual void differentiate(std::span<const double> /*derivatives*/) {}
  /// Appends what was observed last as a row of the history.
  virtual void append(RowSide side) = 0;
  /// An event, with the state observed last.
  virtual void event(const Event& event) = 0;
};

/// How a drive has ended, and what it took.
struct DriveResult {
  RunStatus status = RunStatus::complete;
  std::string message;                     ///< why it stopped or failed
  std::optional<Limit> limit{};            ///< of a stopped run
  std::optional<Failure> failure{};        ///< of a failed run
  std::optional<Difficulty> difficulty{};  ///< of a failed run, where the model knows one
  Statistics statistics;
  std::vector<std::string> warnings;
};

/// Integrates a scene; its history, up to where the run ended however it ended, goes to the sink.
///
/// @param integrator  one of integrator_names(), or as choose_integrator() has chosen it
/// @param output      output points of every step, or instants of the whole run
/// @param sensitivities  of this scene, carried along by an integrator that has_forward_sensitivities(); null: none.
///   Throws LostSensitivities where they cannot be carried on.
/// Never throws for what the model or the solver cannot do: that is the result's status.
[[nodiscard]] DriveResult drive(Scene& scene, std::string_view integrator, const Tolerances& tolerances,
                                const Output& output, HistorySink& sink, ForwardSensitivities* sensitivities = nullptr);

}  // namespace monograin
