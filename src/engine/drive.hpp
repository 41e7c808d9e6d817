/// Drives a scene through its program: steps, segments, events, output points.
#pragma once

#include <string>
#include <vector>

#include "engine/integrator.hpp"
#include "history/table.hpp"
#include "scenario/scenario.hpp"
#include "scene/scene.hpp"

namespace monograin {

enum class RunStatus {
  complete,
  stopped,  ///< left the model's domain
  failed    ///< the solver gave up
};

[[nodiscard]] std::string_view to_string(RunStatus status) noexcept;

/// What a run leaves behind. The history goes up to where the run ended, however it ended.
struct RunRecord {
  RunStatus status = RunStatus::complete;
  std::string message;  ///< why it stopped or failed
  Table history;
  Table events;
  Statistics statistics;
  std::vector<std::string> warnings;
};

/// Integrates a scene.
///
/// @param integrator  direct, cvode-bdf, cvode-adams or ida
/// @param output      output points of every step, or instants of the whole run
/// Never throws for what the model or the solver cannot do: that is the record's status.
[[nodiscard]] RunRecord drive(Scene& scene, std::string_view integrator, const Tolerances& tolerances,
                              const Output& output);

}  // namespace monograin
