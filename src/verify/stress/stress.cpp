#include "verify/stress/stress.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <set>
#include <string_view>

#include "history/staged_folder.hpp"
#include "numerics/parallel.hpp"
#include "scenario/text_file.hpp"
#include "scenario/words.hpp"
#include "verify/probe/profiled_system.hpp"
#include "verify/stress/check/checks.hpp"
#include "verify/stress/draw/generator.hpp"
#include "verify/stress/draw/scene.hpp"
#include "verify/stress/shrink/shrink.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr const char* k_report = "report.txt";
constexpr const char* k_generator_rule = "generator";
// Share of the time for drawing and checking, if there are failures to shrink.
constexpr double k_share_of_drawing = 0.75;

// --- checking scenes

/// The verdict on a scene; nothing if the scene is not admissible.
std::optional<StressVerdict> verdict_of(const StressScene& scene, const fs::path& tables, double seconds) {
  try {
    const CheckedScenario scenario = parse_stress_text(scenario_text(scene), tables);
    return check_scene(scenario, {.seconds = std::min(seconds, most_seconds_of(scenario))});
  } catch (const ScenarioError&) {
    return std::nullopt;
  }
}

struct CheckedScene {
  StressScene scene;
  StressVerdict verdict;
  double seconds = 0.0;
};

CheckedScene check_drawn(const StressOptions& options, std::uint64_t index, const fs::path& tables) {
  CheckedScene checked;
  const Clock::time_point start = Clock::now();
  try {
    checked.scene = draw_stress_scene(options.seed, index, tables, options.models);
    const CheckedScenario scenario = parse_stress_text(scenario_text(checked.scene), tables);
    checked.verdict = check_scene(scenario, {.seconds = most_seconds_of(scenario), .copies = index});
  } catch (const std::exception& error) {  // the generator has made a scene that is not admissible
    checked.verdict.violations.push_back({k_generator_rule, error.what()});
  }
  checked.seconds = seconds_since(start);
  return checked;
}

std::string names_of(const DrawnModels& models) {
  std::vector<std::string_view> names;
  for (const Model* model : models) names.push_back(model->name);
  return fmt::format("{}", fmt::join(names, ","));
}

/// Name of a sequence of scenes, for readers.
std::string sequence_name(std::uint64_t seed, const DrawnModels& models) {
  return models.empty() ? fmt::format("seed {}", seed) : fmt::format("seed {} of {}", seed, names_of(models));
}

/// Options with which the command draws the sequence.
std::string sequence_options(std::uint64_t seed, const DrawnModels& models) {
  return models.empty() ? fmt::format("--seed {}", seed) : fmt::format("--model {} --seed {}", names_of(models), seed);
}

std::string file_text(const StressFailure& failure, const StressOptions& options, const std::string& text) {
  return fmt::format("# Scene {} of {}: {}: {}\n{}", failure.index, sequence_name(options.seed, options.models),
                     failure.check, failure.detail, text);
}

class StressTest {
 public:
  StressTest(const StressOptions& options, const fs::path& tables) : options_(options), tables_(tables) {
    report_.seed = options.seed;
    report_.drawn_from = options.models;
    next_ = options.first;
  }

  StressReport run() {
    const std::size_t threads = thread_count(options_.threads);
    for_each_index(threads, threads, [&](std::size_t, std::size_t) { draw_until_done(); });
    std::ranges::sort(report_.failures, {}, [](const StressFailure& f) { return std::pair(f.index, f.check); });
    for (StressFailure& failure : report_.failures) {
      failure.file = fmt::format("{}-{}.toml", failure.index, failure.check);
      make_smaller(failure);
    }
    return std::move(report_);
  }

 private:
  [[nodiscard]] double time_left() const { return options_.seconds - seconds_since(start_); }

  [[nodiscard]] bool is_done() {
    const std::lock_guard lock(mutex_);
    const double share = report_.failures.empty() ? 1.0 : k_share_of_drawing;
    return seconds_since(start_) > share * options_.seconds;
  }

  void draw_until_done() {
    while (!is_done()) {
      const std::uint64_t index = next_++;
      if (options_.scenes > 0 && index >= options_.first + options_.scenes) return;
      const CheckedScene checked = check_drawn(options_, index, tables_);
      const std::lock_guard lock(mutex_);
      add(index, checked);
    }
  }

  void add(std::uint64_t index, const CheckedScene& checked) {
    const std::string model = checked.scene.model == nullptr ? "none" : std::string(checked.scene.model->name);
    ++report_.scenes;
    report_.runs += checked.verdict.runs;
    report_.ill_conditioned += checked.verdict.is_ill_conditioned ? 1U : 0U;
    report_.cut_short += checked.verdict.is_cut_short ? 1U : 0U;
    ++report_.by_model_and_integrator[{model, checked.scene.integrator}];
    if (checked.seconds > report_.slowest_seconds) {
      report_.slowest = index;
      report_.slowest_seconds = checked.seconds;
    }
    if (!checked.verdict.end.empty()) ++report_.ends[{model, checked.verdict.end}];
    for (const Violation& violation : checked.verdict.violations) {
      report_.failures.push_back({.index = index,
                                  .model = model,
                                  .integrator = checked.scene.integrator,
                                  .check = violation.check,
                                  .detail = on_one_line(violation.detail)});
    }
    if (!options_.progress) return;
    const double share = std::min(1.0, seconds_since(start_) / options_.seconds);
    const auto by_time = static_cast<std::size_t>(static_cast<double>(report_.scenes) / std::max(share, 1e-6));
    options_.progress(report_.scenes, options_.scenes > 0 ? std::min(options_.scenes, by_time) : by_time);
  }

  /// Shrinks the scene of a failure if it is the first one of its model and rule, and stores the scene's text.
  void make_smaller(StressFailure& failure) {
    if (failure.check == k_generator_rule) return;
    StressScene scene = draw_stress_scene(options_.seed, failure.index, tables_, options_.models);
    // A scene that takes too long would take as long for every candidate.
    if (failure.check != k_time_rule && time_left() > 0.0 && shrunk_.insert({failure.model, failure.check}).second) {
      scene = shrink(std::move(scene), [&](const StressScene& candidate) {
        if (!(time_left() > 0.0)) return false;
        const auto verdict = verdict_of(candidate, tables_, time_left());
        return verdict && std::ranges::any_of(verdict->violations, [&](const Violation& violation) {
                 return violation.check == failure.check;
               });
      });
    }
    failure.text = file_text(failure, options_, scenario_text(scene));
  }

  const StressOptions& options_;
  const fs::path& tables_;
  Clock::time_point start_ = Clock::now();
  std::atomic<std::uint64_t> next_{0};
  std::mutex mutex_;
  StressReport report_;
  std::set<std::pair<std::string, std::string>> shrunk_;
};

}  // namespace

std::string StressReport::text() const {
  std::string text =
      fmt::format("{}: {} scenes, {} runs, {} ill-conditioned, {} too slow to compare, {} failures\n\n",
                  sequence_name(seed, drawn_from), scenes, runs, ill_conditioned, cut_short, failures.size());
  std::set<std::string> integrators;
  for (const auto& [key, count] : by_model_and_integrator) integrators.insert(key.second);
  std::set<std::string> models;
  for (const auto& [key, count] : by_model_and_integrator) models.insert(key.first);
  text += fmt::format("{:<22}", "scenes");
  for (const std::string& model : models) text += fmt::format(" {:>12}", model);
  text += '\n';
  for (const std::string& integrator : integrators) {
    text += fmt::format("{:<22}", integrator);
    for (const std::string& model : models) {
      const auto found = by_model_and_integrator.find({model, integrator});
      text += fmt::format(" {:>12}", found == by_model_and_integrator.end() ? 0 : found->second);
    }
    text += '\n';
  }
  text += "\nhow they ended\n";
  for (const auto& [key, count] : ends) text += fmt::format("{:>8}  {:<12} {}\n", count, key.first, key.second);
  if (failures.empty()) return text;
  std::map<std::pair<std::string, std::string>, std::size_t> kinds;
  for (const StressFailure& failure : failures) ++kinds[{failure.model, failure.check}];
  text += "\nfailures\n";
  for (const auto& [key, count] : kinds) text += fmt::format("{:>8}  {:<12} {}\n", count, key.first, key.second);
  text += '\n';
  for (const StressFailure& failure : failures) {
    text += fmt::format("{}: {}, {}: {}: {} -> {}\n", failure.index, failure.model, failure.integrator, failure.check,
                        failure.detail, failure.file);
    text += fmt::format("    monograin stress {} --first {} --scenes 1\n", sequence_options(seed, drawn_from),
                        failure.index);
  }
  return text;
}

StressReport run_stress(const StressOptions& options) {
  StagedFolder folder(options.folder, k_report);
  write_stress_tables(folder.path());
  StressReport report = StressTest(options, folder.path()).run();
  for (const StressFailure& failure : report.failures) {
    if (!failure.text.empty()) write_text_file(folder.path() / failure.file, failure.text);
  }
  write_text_file(folder.path() / k_report, report.text());
  folder.publish(folder.age());
  return report;
}

}  // namespace monograin
