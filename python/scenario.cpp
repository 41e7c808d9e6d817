// Scenarios and their runs.

#include "scenario.hpp"

#include <pybind11/stl.h>

#include <chrono>
#include <filesystem>
#include <map>

#include "api/checked.hpp"
#include "bindings.hpp"
#include "history/profile.hpp"
#include "history/run.hpp"
#include "history/staged_folder.hpp"
#include "interruptible.hpp"
#include "monograin/run.hpp"
#include "scenario/edit.hpp"
#include "scenario/file_keys.hpp"
#include "scenario/text_file.hpp"
#include "scene/scene.hpp"

namespace monograin::python {
namespace {

/// Checks a scenario and measures the time. @throws ScenarioError with every fault that it finds
SoundScenario checked_scenario(Scenario source) {
  const auto start = std::chrono::steady_clock::now();
  SoundScenario made{.source = std::move(source), .checked = {}};
  made.checked = checked(made.source);
  made.parse_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return made;
}

SoundScenario parse_sound(std::string text, std::string origin, std::vector<std::string> overrides,
                          std::optional<FileTexts> files) {
  return checked_scenario(Scenario::parse(std::move(text), std::move(origin), std::move(overrides), std::move(files)));
}

/// The scenario with another name of its file, in whose folder the files that it names are.
SoundScenario with_origin(const SoundScenario& scenario, std::string origin) {
  SoundScenario placed = scenario;
  placed.source =
      Scenario::parse(scenario.source.text(), std::move(origin), scenario.source.overrides(), scenario.source.files());
  return placed;
}

/// The scenario as text, with its overrides.
/// @param value_of  FileKey -> what stands for the name of the file
template <class ValueOf>
std::string text_of(const SoundScenario& scenario, ValueOf&& value_of) {
  Scenario placed = scenario.source;
  for (const FileKey& key : file_keys(scenario.checked)) placed.set(key.path, value_of(key));
  return text_with_overrides(placed.text(), placed.overrides());
}

/// The scenario as text, with its overrides, and with absolute names of the files that it names. Names of files in
/// memory stay as they are.
std::string toml_of(const SoundScenario& scenario) {
  const bool is_in_memory = scenario.source.files().has_value();
  const std::filesystem::path folder = std::filesystem::path(scenario.source.origin()).parent_path();
  return text_of(scenario, [&](const FileKey& key) { return is_in_memory ? key.name : (folder / key.name).string(); });
}

/// The scenario as text, with its overrides, and with the digest of each file's text in the place of its name.
std::string content_of(const SoundScenario& scenario) {
  return text_of(scenario, [](const FileKey& key) { return text_digest(key.text); });
}

SoundScenario read_sound(const std::string& file) {
  // The type selects the overload of the public header; the room `scenario` also has a function read_scenario.
  Scenario (*const read)(const std::filesystem::path&) = read_scenario;
  return checked_scenario(read(file));
}

RunResult run_sound(const SoundScenario& scenario) {
  return run_watched([&](const RunOptions& options) {
    Run run = run_scenario(scenario.checked, interruptible(options.stop));
    run.timings.parse = scenario.parse_time;
    return RunResult(std::make_shared<const Run>(std::move(run)));
  });
}

py::list parameters_of(const SoundScenario& scenario) {
  py::list list;
  for (const auto& [name, value, unit, symbol] : derived_parameters(scenario.checked)) {
    list.append(py::make_tuple(name, value, unit, symbol));
  }
  return list;
}

/// Writes the files of a run from their texts, all or none.
void save_texts(const std::string& folder, const std::map<std::string, std::string>& texts) {
  const Unlocked unlocked;
  StagedFolder staged(folder);
  for (const auto& [name, text] : texts) write_text_file(staged.path() / name, text);
  staged.publish(0.0);  // the run is elsewhere as well
}

History profile_of(const SoundScenario& scenario, double time) {
  return run_watched([&](const RunOptions& options) {
    return history_of(contact_profiles(scenario.checked, time, interruptible(options.stop)));
  });
}

}  // namespace

void add_scenario(py::module_& module) {
  py::class_<SoundScenario>(module, "Scenario")
      .def_static("parse", &parse_sound)
      .def_static("read", &read_sound)
      .def_property_readonly("text", [](const SoundScenario& scenario) { return scenario.source.text(); })
      .def_property_readonly("origin", [](const SoundScenario& scenario) { return scenario.source.origin(); })
      .def_property_readonly("overrides", [](const SoundScenario& scenario) { return scenario.source.overrides(); })
      .def_property_readonly("files", [](const SoundScenario& scenario) { return scenario.source.files(); })
      .def_property_readonly("name", [](const SoundScenario& scenario) { return scenario.checked.name; })
      .def_property_readonly("title", [](const SoundScenario& scenario) { return scenario.checked.title; })
      .def_property_readonly("model", [](const SoundScenario& scenario) { return scenario.checked.model; })
      .def("with_origin", &with_origin)
      .def("to_toml", &toml_of)
      .def("content", &content_of)
      .def("run", &run_sound)
      .def("parameters", &parameters_of)
      .def("profile", &profile_of);
  module.def("with_override", [](std::vector<std::string> overrides, std::string text) {
    set_override(overrides, std::move(text));
    return overrides;
  });
  module.def("save_run", &save_texts);
  py::class_<RunResult>(module, "Run")
      .def_property_readonly("status", [](const RunResult& run) { return to_string(run.status); })
      .def_readonly("message", &RunResult::message)
      .def_readonly("limit", &RunResult::limit)
      .def_readonly("warnings", &RunResult::warnings)
      .def_readonly("history", &RunResult::history)
      .def_readonly("events", &RunResult::events)
      .def("json", &RunResult::json)
      .def("save", [](const RunResult& run, const std::string& folder) {
        const Unlocked unlocked;
        run.save(folder);
      });
}

}  // namespace monograin::python
