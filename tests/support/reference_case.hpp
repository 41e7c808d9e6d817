/// Reference curves of the MDR model: the scenario that each file states, and the distance of a run from its rows and
/// events.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "history/run.hpp"
#include "history/table.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

struct ReferenceEvent {
  double time = 0.0;
  std::string name;  ///< as in events.csv
  int wall = -1;     ///< -1: the particle
};

struct ReferenceCase {
  Table table;
  CheckedScenario scenario;  ///< R0 = 1, E = 1; one output point per row-0 time
  std::vector<ReferenceEvent> events;
  std::vector<int> walls;  ///< walls whose columns the file has
};

/// Path of a file beside the tests.
[[nodiscard]] std::string test_file(const std::string& relative);

[[nodiscard]] ReferenceCase load_reference(const std::string& name);

/// Largest difference of each quantity over the rows at output points and around events, over its largest magnitude.
struct CurveErrors {
  std::map<std::string, double> by_quantity;
  double largest = 0.0;
  double event_time = 0.0;  ///< over the run's length
  std::string mismatch;     ///< difference between the events; empty: all are there, in order
};
[[nodiscard]] CurveErrors errors_against(const ReferenceCase& reference, const RunRecord& run, const Scene& scene);

}  // namespace monograin
