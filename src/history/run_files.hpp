/// The files a run leaves: history.csv, events.csv, run.json, and a figure if asked for.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "history/run.hpp"
#include "history/staged_folder.hpp"

namespace monograin {

/// The scenario of a run, from its folder: with the overrides and the tables it had then, wherever those are now.
/// @throws std::runtime_error where there is no run.json, or none that holds a scenario
[[nodiscard]] Scenario scenario_of_run(const std::filesystem::path& folder);

/// What run.json holds: how the run ended, what it took, and the scenario with all that it needs to be repeated.
[[nodiscard]] std::string run_json(const Run& run);

/// Writes a run into its folder, whole or not at all.
/// @param draw  called with the folder before it is published, for figures; may be empty
/// @throws std::runtime_error naming the file that could not be written
void write_run(Run& run, StagedFolder& folder, const std::function<void(const std::filesystem::path&)>& draw = {});

}  // namespace monograin
