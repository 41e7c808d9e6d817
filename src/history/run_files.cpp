#include "history/run_files.hpp"

#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "catalogue.hpp"
#include "scenario/file_keys.hpp"
#include "scenario/text_file.hpp"
#include "scenario/words.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int k_run_format = 1;  ///< format number of run.json; files of a later format are refused
/// Largest run.json that is read [bytes].
constexpr std::size_t k_largest_run = std::size_t{256} << 20U;

Json files_json(const CheckedScenario& scenario) {
  Json files = Json::object();
  for (const auto& [key, name, text] : named_files(scenario)) files[key] = {{"name", name}, {"text", text}};
  return files;
}

/// Values by the paths of their keys.
Json values_json(const CheckedScenario& scenario) {
  Json values = Json::object();
  if (scenario.radius > 0.0) values["particle.radius"] = scenario.radius;
  for (const auto& [key, value] : scenario.material) values["material." + key] = value;
  for (const auto& option : scenario.options) {
    Json& value = values[scenario.model + '.' + option.first];
    std::visit([&value](const auto& own) { value = own; }, option.second);
  }
  return values;
}

Json to_json(const Run& run) {
  const CheckedScenario& scenario = run.scenario;
  const RunRecord& record = run.record;
  const Statistics& s = record.statistics;
  Json classes = Json::array();
  for (const ClassSummary& c : run.classes) {
    classes.push_back({{"name", c.name}, {"multiplicity", c.walls.size()}, {"walls", c.walls}, {"normals", c.normals}});
  }
  Json sensitivities = Json::array();
  for (const auto& [key, value, step, error, is_forward, why] : run.sensitivities) {
    sensitivities.push_back({{"key", key},
                             {"value", value},
                             {"method", is_forward ? "forward" : "differences"},
                             {"why", why},
                             {"step", step},
                             {"error", error}});
  }
  return {{"program", "monograin"},
          {"format", k_run_format},
          {"status", to_string(record.status)},
          {"message", record.message},
          {"limit", record.limit ? Json(code(*record.limit)) : Json()},
          {"model", scenario.model},
          {"citation", reference_texts(*find_model(scenario.model))},
          {"classes", classes},
          {"skipped", run.skipped},
          {"sensitivities", std::move(sensitivities)},
          {"integrator", {{"asked", run.integrator.asked}, {"used", run.integrator.used}, {"why", run.integrator.why}}},
          {"tolerances", {{"rtol", scenario.numerics.rtol}, {"atol", scenario.numerics.atol}}},
          {"statistics",
           {{"segments", s.segments},
            {"events", s.events},
            {"steps", s.steps},
            {"rhs_evaluations", s.rhs_evaluations},
            {"jacobian_evaluations", s.jacobian_evaluations},
            {"guard_evaluations", s.guard_evaluations},
            {"error_test_failures", s.error_test_failures},
            {"convergence_failures", s.convergence_failures},
            {"last_order", s.last_order}}},
          {"timings_s",
           {{"parse", run.timings.parse},
            {"setup", run.timings.setup},
            {"integration", run.timings.integration},
            {"output", run.timings.output}}},
          {"warnings", record.warnings},
          {"versions", versions_json()},
          {"scenario", scenario_json(scenario)}};
}

/// States finite elements in the place of the law and its integrator.
void set_elements(Json& json, const RunElements& elements) {
  const Json law = json["model"];
  json["model"] = "continuum";
  json["citation"] = {
      "G. Dhondt (2004), The Finite Element Method for Three-Dimensional Thermomechanical Applications, "
      "Wiley, doi:10.1002/0470021217"};
  for (const char* key : {"skipped", "sensitivities", "integrator", "tolerances", "statistics", "timings_s"}) {
    json.erase(key);
  }
  Json differences = Json::array();
  for (const auto& [column, loading, unloading, mesh_error] : elements.differences) {
    differences.push_back(
        {{"column", column}, {"loading", loading}, {"unloading", unloading}, {"mesh_error", mesh_error}});
  }
  json["elements"] = {{"solver", elements.solver},
                      {"mesh", elements.mesh},
                      {"count", elements.count},
                      {"law_of", law},
                      {"differences", differences}};
}

}  // namespace

nlohmann::ordered_json scenario_json(const CheckedScenario& scenario) {
  return {{"name", scenario.name},           {"model", scenario.model}, {"digest", scenario_digest(scenario)},
          {"overrides", scenario.overrides}, {"text", scenario.text},   {"files", files_json(scenario)},
          {"values", values_json(scenario)}};
}

nlohmann::ordered_json versions_json() {
  return {{"monograin", version()}, {"sundials", sundials_version()}, {"compiler", __VERSION__}};
}

std::string record_text(const nlohmann::ordered_json& record) {
  // Comments in a table need not be UTF-8: invalid bytes are replaced.
  return record.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::string run_json(const Run& run) {
  Json json = to_json(run);
  if (run.elements) set_elements(json, *run.elements);
  return record_text(json);
}

void write_run(Run& run, StagedFolder& folder, const std::function<void(const fs::path&)>& draw) {
  const auto start = std::chrono::steady_clock::now();
  write_csv(folder.path() / k_run_tables[0], run.record.history);
  write_csv(folder.path() / k_run_tables[1], run.record.events);
  run.timings.output = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  write_text_file(folder.path() / k_run_marker, run_json(run));
  if (draw) draw(folder.path());
  const Timings& timings = run.timings;
  folder.publish(timings.setup + timings.integration + timings.output);
}

CheckedScenario scenario_of_run(const fs::path& folder) {
  const fs::path file = folder / k_run_marker;
  const auto [text, problem] = read_text_file(file, k_largest_run);
  if (!problem.empty() || text.size() > k_largest_run) {
    throw std::runtime_error(fmt::format("{}: {}; expected the folder of a run", file.string(),
                                         problem.empty() ? "the file is too large" : problem));
  }
  try {
    const Json run = Json::parse(text);
    if (const int format = run.value("format", k_run_format); format > k_run_format) {
      throw std::runtime_error(fmt::format("{}: has format {}, of a later version of the program; this one knows {}",
                                           file.string(), format, k_run_format));
    }
    const Json& scenario = run.at("scenario");
    FileTexts files;
    for (const Json& table : scenario.value("files", Json::object())) {
      files.emplace(table.at("name").get<std::string>(), table.at("text").get<std::string>());
    }
    const std::string name = fs::path(scenario.at("name").get<std::string>()).filename().string();
    return parse_recorded_scenario(scenario.at("text").get<std::string>(), on_one_line(name) + ".toml",
                                   scenario.at("overrides").get<std::vector<std::string>>(), files);
  } catch (const Json::exception&) {
    throw std::runtime_error(
        fmt::format("{}: is incomplete or damaged; expected a scenario with name, text and overrides: run it again",
                    file.string()));
  }
}

}  // namespace monograin
