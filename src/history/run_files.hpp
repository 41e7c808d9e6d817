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
[[nodiscard]] CheckedScenario scenario_of_run(const std::filesystem::path& folder);

/// Text of run.json.
[[nodiscard]] std::string run_json(const Run& run);

/// Writes a run into its folder, whole or not at all.
/// @param draw  called with the folder before it is published, for figures; may be empty
/// @throws std::runtime_error naming the file that could not be written
void write_run(Run& run, StagedFolder& folder, const std::function<void(const std::filesystem::path&)>& draw = {});

}  // namespace monograin
