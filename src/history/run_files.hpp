/// Files of a run: history.csv, events.csv, run.json, and a figure if requested.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "history/run.hpp"
#include "history/staged_folder.hpp"

namespace monograin {

/// Files that the folder of every run has beside k_run_marker.
inline constexpr std::array<std::string_view, 2> k_run_tables{"history.csv", "events.csv"};

/// Restores the scenario of a run from its folder. Overrides and tables come from run.json, so that the run can be
/// repeated after their files have changed.
/// @throws std::runtime_error if run.json is missing, too large, of a later format, or holds no scenario
[[nodiscard]] CheckedScenario scenario_of_run(const std::filesystem::path& folder);

/// What results record of their scenario, so that it can be repeated without any file: name, model, digest, overrides,
/// text, the content of the files that its options and steps name; and in SI every value of particle, material and
/// model.
[[nodiscard]] nlohmann::ordered_json scenario_json(const CheckedScenario& scenario);

/// Versions of the program, of SUNDIALS and of the compiler.
[[nodiscard]] nlohmann::ordered_json versions_json();

/// Text of a file that records a result.
[[nodiscard]] std::string record_text(const nlohmann::ordered_json& record);

/// Text of run.json.
[[nodiscard]] std::string run_json(const Run& run);

/// Writes the files of a run into a staged folder and publishes it: either all files are written or none.
/// @param run   its timings get the time of writing
/// @param draw  called with the staged folder before it is published, to draw figures; may be empty
/// @throws std::runtime_error that names the file that could not be written
void write_run(Run& run, StagedFolder& folder, const std::function<void(const std::filesystem::path&)>& draw = {});

}  // namespace monograin
