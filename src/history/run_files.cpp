#include "history/run_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace monograin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void write_file(const fs::path& file, const std::function<void(std::ostream&)>& write) {
  std::ofstream out(file, std::ios::binary);
  if (out) write(out);
  out.close();
  if (!out) throw std::runtime_error(fmt::format("{}: cannot be written: {}", file.string(), std::strerror(errno)));
}

Json versions() { return {{"monograin", version()}, {"sundials", sundials_version()}, {"compiler", __VERSION__}}; }

/// What the files hold that options name, so that the run can be repeated without them.
Json files_of(const Scenario& scenario) {
  Json files = Json::object();
  for (const auto& [option, curve] : scenario.curves) {
    files[scenario.model + '.' + option] = {{"name", std::get<std::string>(scenario.options.at(option))},
                                            {"text", curve.text}};
  }
  return files;
}

Json to_json(const Run& run) {
  const Scenario& scenario = run.scenario;
  const RunRecord& record = run.record;
  const Statistics& s = record.statistics;
  Json classes = Json::array();
  for (const ClassSummary& c : run.classes) {
    classes.push_back({{"name", c.name}, {"multiplicity", c.walls.size()}, {"walls", c.walls}});
  }
  return {{"status", to_string(record.status)},
          {"message", record.message},
          {"model", scenario.model},
          {"classes", classes},
          {"skipped", run.skipped},
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
          {"versions", versions()},
          {"scenario",
           {{"name", scenario.name},
            {"digest", scenario_digest(scenario)},
            {"overrides", scenario.overrides},
            {"text", scenario.text},
            {"files", files_of(scenario)}}}};
}

/// Puts a staged folder where the target is. The exchange is one step for everybody who looks.
void exchange(const fs::path& staged, const fs::path& target) {
  if (!fs::exists(target)) {
    fs::rename(staged, target);
  } else if (renameat2(AT_FDCWD, staged.c_str(), AT_FDCWD, target.c_str(), RENAME_EXCHANGE) != 0) {
    // A file system without exchange: the old result steps aside for an instant.
    const fs::path aside = staged.string() + ".old";
    fs::rename(target, aside);
    fs::rename(staged, target);
    fs::remove_all(aside);
  }
}

}  // namespace

void check_run_folder(const fs::path& target, std::string_view marker) {
  if (!fs::exists(target)) return;
  if (!fs::is_directory(target)) {
    throw std::runtime_error(fmt::format("{}: is a file; expected a folder for the result", target.string()));
  }
  if (!fs::is_empty(target) && !fs::exists(target / marker)) {
    throw std::runtime_error(
        fmt::format("{}: holds files but no earlier result of this kind (no {}), and a result replaces its folder; "
                    "choose another folder with -o",
                    target.string(), marker));
  }
}

StagedFolder::StagedFolder(fs::path target, std::string_view marker)
    : target_(fs::absolute(std::move(target)).lexically_normal()) {
  if (!target_.has_filename()) target_ = target_.parent_path();
  check_run_folder(target_, marker);
  fs::create_directories(target_.parent_path());
  std::string pattern = (target_.parent_path() / ("." + target_.filename().string() + ".XXXXXX")).string();
  if (mkdtemp(pattern.data()) == nullptr) {
    throw std::runtime_error(fmt::format("{}: cannot be created: {}", pattern, std::strerror(errno)));
  }
  staged_ = pattern;
  fs::permissions(staged_, fs::perms::owner_all | fs::perms::group_read | fs::perms::group_exec |
                               fs::perms::others_read | fs::perms::others_exec);
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;  // what cannot be removed stays hidden beside the result
  fs::remove_all(staged_, ignored);
}

void StagedFolder::publish() { exchange(staged_, target_); }

void write_run(Run& run, const fs::path& folder, const std::function<void(const fs::path&)>& draw) {
  const auto start = std::chrono::steady_clock::now();
  StagedFolder staged(folder);
  write_file(staged.path() / "history.csv", [&](std::ostream& out) { write_csv(run.record.history, out); });
  write_file(staged.path() / "events.csv", [&](std::ostream& out) { write_csv(run.record.events, out); });
  run.timings.output = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  write_file(staged.path() / "run.json", [&](std::ostream& out) {
    // Nobody checks that the comments in a table are UTF-8.
    out << to_json(run).dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  });
  if (draw) draw(staged.path());
  staged.publish();
}

Scenario scenario_of_run(const fs::path& folder) {
  const fs::path file = folder / "run.json";
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error(fmt::format("{}: cannot be read; expected the folder of a run", file.string()));
  try {
    const Json scenario = Json::parse(in).at("scenario");
    // The tables are laid beside the scenario as they were. The depth is for those in folders further up.
    const StagedFolder staged(fs::temp_directory_path() / "monograin-scenario");
    const fs::path place = staged.path() / "a" / "b" / "c" / "d";
    const Json files = scenario.value("files", Json::object());
    for (const Json& table : files) {
      const fs::path name = table.at("name").get<std::string>();
      if (name.is_absolute()) continue;
      fs::create_directories((place / name).parent_path());
      write_file(place / name, [&](std::ostream& out) { out << table.at("text").get<std::string>(); });
    }
    return parse_scenario(scenario.at("text").get<std::string>(),
                          (place / (scenario.at("name").get<std::string>() + ".toml")).string(),
                          scenario.at("overrides").get<std::vector<std::string>>());
  } catch (const Json::exception& error) {
    throw std::runtime_error(fmt::format("{}: is not what a run leaves ({})", file.string(), error.what()));
  }
}

}  // namespace monograin
