#include "history/run.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <iterator>
#include <span>

#include "catalogue.hpp"
#include "history/energy.hpp"
#include "history/recorder.hpp"
#include "history/sensitivities.hpp"
#include "history/wall_checks.hpp"
#include "scenario/faults.hpp"
#include "scenario/integrators.hpp"
#include "scenario/remarks.hpp"
#include "system/wrapped_system.hpp"

namespace monograin {
namespace {

// Rows reserved for events in addition to the output points, so that recording rarely allocates.
constexpr std::size_t k_event_rows = 64;

class Stopwatch {
 public:
  /// Seconds since construction or the last lap.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - start_).count();
    start_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Keys of `[material]` that the header of a history names by their symbols. They come before the others.
constexpr std::pair<std::string_view, std::string_view> k_symbols[] = {
    {"youngs_modulus", "E"},
    {"poisson_ratio", "nu"},
    {"yield_stress", "Y"},
};

std::vector<std::pair<std::string, std::string>> header_of(const Run& run) {
  const CheckedScenario& scenario = run.scenario;
  const Model& model = *find_model(scenario.model);
  std::vector<std::pair<std::string, std::string>> header;
  const auto add = [&header](std::string_view key, std::string value) { header.emplace_back(key, std::move(value)); };
  add("program", fmt::format("monograin {}", version()));
  if (!scenario.title.empty()) add("title", scenario.title);
  add("scenario", scenario.name);
  add("scenario_digest", scenario_digest(scenario));
  add("status", std::string(to_string(run.record.status)));
  if (!run.record.message.empty()) add("message", run.record.message);
  add("model", scenario.model);
  add("integrator", run.integrator.used);
  add("rtol", fmt::format("{}", scenario.numerics.rtol));
  add("atol", fmt::format("{}", scenario.numerics.atol));
  if (scenario.radius > 0.0) add("R0", fmt::format("{}", scenario.radius));
  if (!model.sign.empty()) add("sign", std::string(model.sign));
  for (const auto& [key, symbol] : k_symbols) {
    const auto found = scenario.material.find(std::string(key));
    if (found != scenario.material.end()) add(symbol, fmt::format("{}", found->second));
  }
  for (const auto& [key, value] : scenario.material) {
    if (std::ranges::find(k_symbols, key, [](const auto& symbol) { return symbol.first; }) == std::end(k_symbols))
      add(key, fmt::format("{}", value));
  }
  for (std::string& reference : reference_texts(model)) add("reference", std::move(reference));
  return header;
}

RunRecord record_with(Recorder& recorder, Scene& scene, std::string_view integrator, const Tolerances& tolerances,
                      const Output& output, ForwardSensitivities* sensitivities) {
  const std::size_t rows = output.times.empty()
                               ? static_cast<std::size_t>(output.points) * count_steps(scene.longest_program())
                               : output.times.size();
  recorder.reserve_rows(rows + k_event_rows);
  RunRecord record;
  static_cast<DriveResult&>(record) = drive(scene, integrator, tolerances, output, recorder, sensitivities);
  record.history = recorder.take_history();
  record.events = recorder.take_events();
  return record;
}

/// @throws ScenarioError if the scenario asks for a direct solution, and the scene has none
IntegratorChoice integrator_of(const CheckedScenario& scenario, const HybridSystem& system) {
  if (scenario.numerics.integrator == integrators::k_direct && !system.is_solvable()) {
    throw_fault(scenario.numerics.integrator_place,
                "integrator = \"direct\": the state of this scene depends on the path to it, which no "
                "equation replaces; expected auto, or an integrator that follows the path");
  }
  return choose_integrator(scenario.numerics.integrator, system);
}

/// Adds what the walls of a history show of a scene that its law does not describe.
void warn_of_walls(Run& run, std::span<const ContactClass> classes) {
  const CheckedScenario& scenario = run.scenario;
  const Model& model = *find_model(scenario.model);
  if (!model.has_walls()) return;
  const auto add = [&](std::optional<std::string> warning) {
    if (warning) run.record.warnings.push_back(*std::move(warning));
  };
  if (!model.has_pores) add(space_warning(run.record.history, classes, scenario.radius));
  add(escape_warning(run.record.history, classes, scenario.radius));
  if (model.has_free_centre && !scenario.loading.centre_is_free) add(balance_warning(run.record.history, classes));
}

}  // namespace

std::string_view version() noexcept { return MONOGRAIN_VERSION; }

std::string text_digest(std::string_view text) {
  const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
  return fmt::format("xxh128:{:016x}{:016x}", hash.high64, hash.low64);
}

std::string scenario_digest(const CheckedScenario& scenario) {
  std::string text = scenario.text;
  for (const std::string& override_text : scenario.overrides) text += "\n--set " + override_text;
  for (const auto& [option, curve] : scenario.curves) text += "\n--file " + option + '\n' + curve.text;
  for (const auto& [name, content] : scenario.loading.files) text += "\n--program " + name + '\n' + content;
  return text_digest(text);
}

void check_integrator(const CheckedScenario& scenario) {
  // Any other integrator suits every scene.
  if (scenario.numerics.integrator == integrators::k_direct) integrator_of(scenario, *make_scene(scenario).system);
}

RunRecord record_run(Scene& scene, std::string_view integrator, const Tolerances& tolerances, const Output& output) {
  Recorder recorder(*scene.system);
  return record_with(recorder, scene, integrator, tolerances, output, nullptr);
}

RunRecord record_run(const CheckedScenario& scenario, const LeftOut& left_out) {
  Scene scene = make_scene(scenario);
  if (left_out.energies) scene.system->leave_out_energies();
  Output output = scenario.output;
  if (left_out.rows) output.points = 1;
  const IntegratorChoice integrator = integrator_of(scenario, *scene.system);
  return record_run(scene, integrator.used, {scenario.numerics.rtol, scenario.numerics.atol}, output);
}

RunRecord record_run(Scene& scene, std::string_view integrator, const Tolerances& tolerances, const Output& output,
                     ForwardSensitivities& sensitivities, const std::vector<Column>& columns) {
  Recorder recorder(*scene.system, columns);
  return record_with(recorder, scene, integrator, tolerances, output, &sensitivities);
}

SystemWrapper interruptible(const std::function<bool()>& stop) {
  if (!stop) return {};
  return [stop](std::unique_ptr<HybridSystem> system) -> std::unique_ptr<HybridSystem> {
    return std::make_unique<WatchedSystem>(std::move(system), [stop, evaluations = 0]() mutable {
      constexpr int k_between = 64;  // evaluations, so that asking takes no time
      if (++evaluations % k_between == 0 && stop()) throw RunInterrupted();
    });
  };
}

Run run_scenario(const CheckedScenario& scenario, const SystemWrapper& wrapped) {
  Run run;
  run.scenario = scenario;
  Stopwatch watch;
  const auto scene_of = [&](const CheckedScenario& variant) {
    Scene scene = make_scene(variant);
    if (wrapped) scene.system = wrapped(std::move(scene.system));
    return scene;
  };
  const auto new_scene = [&] { return scene_of(scenario); };
  Scene scene = new_scene();
  run.integrator = integrator_of(scenario, *scene.system);
  run.timings.setup = watch.lap();
  const bool is_plain = scenario.sensitivities.empty();
  const auto why_differences = is_plain ? std::nullopt : record_with_sensitivities(run, scene, new_scene);
  if (is_plain || why_differences) {
    const long of_attempt = run.record.statistics.rhs_evaluations;
    run.record =
        record_run(scene, run.integrator.used, {scenario.numerics.rtol, scenario.numerics.atol}, scenario.output);
    run.record.statistics.rhs_evaluations += of_attempt;
  }
  run.timings.integration = watch.lap();
  std::ranges::move(remarks_on(scenario), std::back_inserter(run.record.warnings));

  for (std::size_t c = 0; c < scene.classes.size(); ++c) {
    run.classes.push_back({scene.classes[c].name, scene.walls[c], {}});
    for (const Eigen::Vector3d& normal : scene.classes[c].normals) {
      const Eigen::Vector3d n = normal.array() + 0.0;  // not -0
      run.classes.back().normals.push_back({n[0], n[1], n[2]});
    }
  }
  run.skipped = std::move(scene.skipped);
  if (run.integrator.is_direct()) run.skipped.emplace_back("time integration: every state is solved for directly");
  const double rtol = run.integrator.is_direct() ? 0.0 : scenario.numerics.rtol;
  if (auto warning = energy_warning(run.record.history, scenario.radius, scenario.model, rtol)) {
    run.record.warnings.push_back(std::move(*warning));
    run.record.creates_energy = true;
  }
  warn_of_walls(run, scene.classes);
  if (why_differences) add_sensitivities(run, *why_differences, scene_of);
  run.record.history.header = header_of(run);
  run.record.events.header = run.record.history.header;
  return run;
}

}  // namespace monograin
