#include "monograin/continuum.hpp"

#include <memory>
#include <stdexcept>
#include <utility>

#include "api/checked.hpp"
#include "api/untrapped.hpp"
#include "continuum/continuum.hpp"
#include "continuum/continuum_folder.hpp"
#include "history/run.hpp"

namespace monograin {

ContinuumResult continuum(const RunResult& law, const ContinuumOptions& options) {
  const Untrapped untrapped;
  if (options.keeps_files && options.folder.empty()) {
    throw std::invalid_argument("there is no folder for the files of CalculiX to keep");
  }
  const auto end_if_asked = [&options] {
    if (options.stop && options.stop()) throw RunInterrupted();
  };
  ElementOptions elements{
      .mesh = options.mesh, .estimates_error = options.estimates_error, .ccx = find_calculix(), .folder = {}};
  if (options.stop) elements.progress = [&](std::size_t, std::size_t) { end_if_asked(); };
  ContinuumFolder folder(options.folder, options.keeps_files);
  elements.folder = folder.path();
  auto run = std::make_shared<Run>(run_continuum(*law.run_, elements));
  // Ctrl-C on a terminal ends CalculiX, too.
  end_if_asked();
  folder.publish(*run);
  const RunElements& found = *run->elements;
  return {.run = RunResult(run),
          .law = law,
          .solver = found.solver,
          .elements = found.count,
          .differences = found.differences};
}

ContinuumResult continuum(const Scenario& scenario, const ContinuumOptions& options) {
  const Untrapped untrapped;
  const CheckedScenario sound = checked(scenario);
  static_cast<void>(continuum_material_of(sound));
  return continuum(RunResult(std::make_shared<const Run>(run_scenario(sound, interruptible(options.stop)))), options);
}

}  // namespace monograin
