#include "verify/bench/bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numeric>
#include <optional>
#include <random>
#include <utility>

#include "engine/linear_algebra_clock.hpp"
#include "history/recorder.hpp"
#include "history/run.hpp"
#include "scenario/document.hpp"
#include "scenario/integrators.hpp"
#include "scenario/section.hpp"
#include "scenario/text_file.hpp"
#include "scene/scene.hpp"
#include "system/resolution.hpp"
#include "verify/probe/profiled_system.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::array k_reference_tolerances{1e-11, 1e-12, 1e-13};
constexpr int k_rounds = 50;             ///< rounds in which all runs take turns
constexpr double k_long_repeats = 0.25;  ///< time after which a run is not repeated for its number of runs [s]
constexpr double k_too_long = 1.0;       ///< time of a run after which tighter tolerances are left out [s]
constexpr int k_profiled_runs = 20;      ///< of which the fastest counts: other load has disturbed it least
constexpr int k_evaluations = 16;        ///< timed evaluations of the law at each output point

double absolute_tolerance(const CheckedScenario& scenario, double rtol) {
  return rtol * scenario.numerics.atol / scenario.numerics.rtol;
}

RunRecord run_once(const CheckedScenario& scenario, const std::string& integrator, double rtol,
                   double* seconds = nullptr) {
  Scene scene = make_scene(scenario);
  const double start = thread_seconds();
  RunRecord record = record_run(scene, integrator, {rtol, absolute_tolerance(scenario, rtol)}, scenario.output);
  if (seconds != nullptr) *seconds = thread_seconds() - start;
  return record;
}

/// Processor time of one run [s], with recording, without set-up of the scene.
double time_once(const CheckedScenario& scenario, const std::string& integrator, double rtol) {
  double seconds = 0.0;
  static_cast<void>(run_once(scenario, integrator, rtol, &seconds));
  return seconds;
}

// --- errors

bool is_state(const Column& column) {
  return column.name.ends_with(".force") || column.name.ends_with(".displacement") ||
         column.name.starts_with("stress") || column.name.starts_with("strain") || column.name == "apparent_radius" ||
         column.name == "packing_fraction" || column.name == "work";
}

/// Rows at the output points of a history, by step of the program. Rows around events are left out: their positions
/// differ from run to run.
std::vector<std::vector<std::size_t>> rows_of_steps(const Table& history) {
  const std::size_t step = *history.find("step");
  std::vector<std::vector<std::size_t>> rows;
  for (const std::size_t row : output_rows(history)) {
    rows.resize(static_cast<std::size_t>(history.at(row, step)));
    rows.back().push_back(row);
  }
  return rows;
}

struct CurveError {
  double whole = 0.0;
  double end = 0.0;
};

/// Difference of two values of a column: none where both are undefined, infinite where one is.
double difference_of(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b) ? 0.0 : k_infinity;
  return std::abs(a - b);
}

/// Largest difference of any column of the state, over the column's largest value. A step that a condition ends may
/// have an output point more or less.
CurveError curve_error(const Table& reference, const Table& other) {
  const auto rows = rows_of_steps(reference);
  const auto others = rows_of_steps(other);
  CurveError error;
  if (rows.size() != others.size()) return {k_nan, k_nan};
  for (std::size_t c = 0; c < reference.columns().size(); ++c) {
    if (!is_state(reference.columns()[c])) continue;
    const auto other_c = other.find(reference.columns()[c].name);
    if (!other_c) continue;
    double largest = 0.0;
    double worst = 0.0;
    for (std::size_t i = 0; i < reference.row_count(); ++i) {
      if (std::isfinite(reference.at(i, c))) largest = std::max(largest, std::abs(reference.at(i, c)));
    }
    if (largest == 0.0) continue;
    for (std::size_t step = 0; step < rows.size(); ++step) {
      for (std::size_t j = 0; j < std::min(rows[step].size(), others[step].size()); ++j) {
        worst = std::max(worst, difference_of(reference.at(rows[step][j], c), other.at(others[step][j], *other_c)));
      }
    }
    const double last =
        difference_of(reference.at(reference.row_count() - 1, c), other.at(other.row_count() - 1, *other_c));
    error.whole = std::max(error.whole, std::max(worst, last) / largest);
    error.end = std::max(error.end, last / largest);
  }
  return error;
}

/// Largest difference of an event's time, over the whole time; nan if the events or their order differ.
double event_error(const RunRecord& reference, const RunRecord& other) {
  const Table& a = reference.events;
  const Table& b = other.events;
  const double whole = reference.history.at(reference.history.row_count() - 1, *reference.history.find("time"));
  if (a.row_count() != b.row_count()) return k_nan;
  double largest = 0.0;
  for (std::size_t i = 0; i < a.row_count(); ++i) {
    for (const char* name : {"event", "class"}) {
      if (a.word(i, *a.find(name)) != b.word(i, *b.find(name))) return k_nan;
    }
    largest = std::max(largest, std::abs(a.at(i, *a.find("time")) - b.at(i, *b.find("time"))));
  }
  return whole > 0.0 ? largest / whole : largest;
}

// --- times

/// Times one evaluation of the law wherever a row is recorded.
class EvaluationTimer final : public HistorySink {
 public:
  explicit EvaluationTimer(HybridSystem& system)
      : system_(system), state_(system.unknowns().size()), rates_(system.unknowns().size()) {}

  void observe(double, int, double xi, std::span<const double> y) override {
    const auto start = Clock::now();
    for (int k = 0; k < k_evaluations; ++k) {
      std::ranges::copy(y, state_.begin());
      // Every second state differs by round-off: a system may have cached its results for the last state.
      if (k % 2 == 1) state_.front() = std::nextafter(state_.front(), 0.0);
      if (system_.is_solvable())
        system_.solve(xi, state_);
      else
        system_.rates(xi, state_, rates_);
    }
    seconds_ += seconds_since(start);
    count_ += k_evaluations;
  }
  void append(RowSide) override {}
  void event(const Event&) override {}

  [[nodiscard]] double mean() const { return seconds_ / static_cast<double>(std::max(1L, count_)); }

 private:
  HybridSystem& system_;
  std::vector<double> state_, rates_;
  double seconds_ = 0.0;
  long count_ = 0;
};

double time_evaluation(const CheckedScenario& scenario, const std::string& integrator) {
  double best = k_nan;
  for (int i = 0; i < k_rounds; ++i) {
    Scene scene = make_scene(scenario);
    EvaluationTimer timer(*scene.system);
    const Tolerances tolerances{scenario.numerics.rtol, scenario.numerics.atol};
    static_cast<void>(drive(scene, integrator, tolerances, scenario.output, timer));
    best = std::fmin(best, timer.mean());
  }
  return best;
}

/// Times of repeated runs [s].
struct Timing {
  double fastest = 0.0;
  double median = 0.0;
};

/// Repeats a run and collects its times.
class Stopwatch {
 public:
  /// @param run  makes one run and returns its time [s]
  explicit Stopwatch(std::function<double()> run) : run_(std::move(run)) {}

  /// Makes at least one run, and repeats it until a share of what the settings demand is done: their time and their
  /// number of runs, which counts only as long as the runs take less than k_long_repeats together.
  void run_for(const BenchSettings& settings, double share) {
    const double least_runs = share * static_cast<double>(settings.least_runs);
    const auto is_short = [&] {
      return total_ < share * settings.least_time ||
             (static_cast<double>(times_.size()) < least_runs && total_ < share * k_long_repeats);
    };
    while (times_.empty() || is_short()) {
      times_.push_back(run_());
      total_ += times_.back();
    }
  }

  [[nodiscard]] Timing timing() const {
    std::vector<double> times = times_;
    std::ranges::sort(times);
    return {times.front(), times[times.size() / 2]};
  }

 private:
  std::function<double()> run_;
  std::vector<double> times_;
  double total_ = 0.0;
};

/// Times all runs that are to be compared, in rounds, each in another order: if the machine is slower for a while, it
/// is so for all of them, and none always follows another.
void time_in_turn(std::vector<Stopwatch>& watches, const BenchSettings& settings) {
  std::vector<std::size_t> order(watches.size());
  std::iota(order.begin(), order.end(), 0U);
  std::minstd_rand random;
  for (int round = 1; round <= k_rounds; ++round) {
    std::ranges::shuffle(order, random);
    for (const std::size_t i : order) watches[i].run_for(settings, static_cast<double>(round) / k_rounds);
  }
}

// --- a scene

/// A run from which errors are measured.
struct Standard {
  std::string integrator;
  RunRecord record;
};

/// Two runs by different methods that agree best: by the direct form and a one-step method or, if the model has no
/// direct form, by a one-step and a multistep method. A method is not always best at the tightest tolerance.
std::pair<Standard, Standard> standards_of(const CheckedScenario& scenario) {
  const bool is_solvable = make_scene(scenario).system->is_solvable();
  const auto runs_of = [&](const char* integrator) {
    std::vector<Standard> runs;
    for (const double rtol : k_reference_tolerances) runs.push_back({integrator, run_once(scenario, integrator, rtol)});
    return runs;
  };
  const std::vector<Standard> firsts = runs_of(is_solvable ? integrators::k_direct : integrators::k_arkode_erk);
  const std::vector<Standard> seconds = runs_of(is_solvable ? integrators::k_arkode_erk : integrators::k_cvode_adams);
  const Standard* first = &firsts.back();
  const Standard* second = &seconds.back();
  double least = k_infinity;
  for (const Standard& one : firsts) {
    for (const Standard& other : seconds) {
      const double difference = curve_error(one.record.history, other.record.history).whole;
      if (!(difference < least)) continue;
      least = difference;
      first = &one;
      second = &other;
    }
  }
  return {*first, *second};
}

/// Measures a point except for its repeated times.
BenchPoint measure_point(const CheckedScenario& scenario, const std::string& name, const std::string& integrator,
                         double rtol, const Standard& standard) {
  BenchPoint point{.integrator = name, .rtol = rtol};
  const RunRecord record = run_once(scenario, integrator, rtol, &point.fastest);
  point.statistics = record.statistics;
  point.curve_error = point.end_error = point.event_error = k_nan;
  if (record.status != standard.record.status) {
    point.fault = record.message.empty() ? "does not end where the reference does" : record.message;
    return point;
  }
  const CurveError error = curve_error(standard.record.history, record.history);
  point.curve_error = error.whole;
  point.end_error = error.end;
  point.event_error = event_error(standard.record, record);
  return point;
}

std::vector<std::string> all_integrators() {
  std::vector<std::string> names{integrators::k_auto};
  for (const std::string_view name : integrator_names()) names.emplace_back(name);
  return names;
}

std::vector<double> decades() {
  std::vector<double> tolerances;
  for (int k = 2; k <= 13; ++k) tolerances.push_back(std::pow(10.0, -k));
  return tolerances;
}

/// The two walls of simple compression, and four walls that the particle never reaches.
CheckedScenario with_walls_out_of_reach(CheckedScenario simple) {
  Loading& loading = simple.loading;
  loading.configuration = Loading::Configuration::walls;
  const double gap = 2.0 * simple.radius;
  const auto wall = [](const char* name, const std::array<double, 3>& normal, double off) {
    return WallSpec{.name = name, .normal = normal, .gap = off, .is_fixed = off > 0.0};
  };
  loading.walls = {wall("axial", {0.0, 0.0, 1.0}, 0.0),      wall("axial-", {0.0, 0.0, -1.0}, 0.0),
                   wall("lateral-x+", {1.0, 0.0, 0.0}, gap), wall("lateral-x-", {-1.0, 0.0, 0.0}, gap),
                   wall("lateral-y+", {0.0, 1.0, 0.0}, gap), wall("lateral-y-", {0.0, -1.0, 0.0}, gap)};
  return simple;
}

/// Keys of the tables in a list of scenes.
struct BenchKeys {
  using Kind = KeySpec::Kind;
  KeySpec scenario{.name = "scenario",
                   .meaning = "scenario file, of a scene also a folder of them, sought from this file's folder",
                   .is_required = true,
                   .example = "\"../die.toml\""};
  KeySpec set = key_of(Kind::texts, "set", "overrides of the scenario", "[\"material.yield_stress=20 MPa\"]");
  std::vector<KeySpec> root{
      {.name = "scene", .meaning = "scenes to measure", .kind = Kind::tables, .is_required = true},
      {.name = "saving", .meaning = "scenes that are spared something", .kind = Kind::tables}};
  std::vector<KeySpec> scene{
      {.name = "name", .meaning = "name of the scene [that of the file]", .example = "\"die\""},
      {.name = "title", .meaning = "what it is [the scenario's title]", .example = "\"Die compaction\""},
      scenario,
      set};
  std::vector<KeySpec> saving{
      {.name = "what", .meaning = "what is not computed", .is_required = true, .example = "\"no adhesion\""},
      {.name = "name", .meaning = "name of both scenes", .is_required = true, .example = "\"simple\""},
      scenario,
      set,
      required(
          key_of(Kind::table, "without", "the scene that computes it", "without = { scenario = \"../die.toml\" }"))};
  std::vector<KeySpec> without{scenario, set};
};

/// Reads the scenarios that a list names, and collects their faults.
struct ScenariosOfList {
  fs::path folder;  ///< folder of the list, from which scenario files are sought
  FaultList& faults;

  [[nodiscard]] std::optional<CheckedScenario> read(const fs::path& file, const Section& section) const {
    try {
      return read_scenario(file, section.texts("set"));
    } catch (const ScenarioError& error) {
      for (const Fault& fault : error.faults()) faults.add(fault.where, fault.message);
      return std::nullopt;
    }
  }

  [[nodiscard]] std::optional<CheckedScenario> of(const Section& section) const {
    if (section.text("scenario").empty()) return std::nullopt;
    return read(folder / section.text("scenario"), section);
  }

  /// The scenario, or all scenarios of a folder, that a [[scene]] names; with name and title from the list.
  [[nodiscard]] std::vector<CheckedScenario> of_scene(const Section& section) const {
    if (section.text("scenario").empty()) return {};
    const fs::path named = folder / section.text("scenario");
    const bool is_folder = fs::is_directory(named);
    if (is_folder && !section.text("name").empty())
      faults.add(section.key_place("name"), "a folder of scenarios has no name of its own; remove it");
    std::vector<CheckedScenario> scenes;
    for (const fs::path& file : is_folder ? toml_files(named, "scenario", "--scenes") : std::vector{named}) {
      auto scene = read(file, section);
      if (!scene) continue;
      if (!section.text("name").empty()) scene->name = section.text("name");
      if (!section.text("title").empty()) scene->title = section.text("title");
      scenes.push_back(std::move(*scene));
    }
    return scenes;
  }
};

// --- savings

using System = std::unique_ptr<HybridSystem>;

/// One side of a comparison: how a scenario is run.
struct Variant {
  CheckedScenario scenario;
  std::string integrator = integrators::k_direct;
  std::function<System(System)> wrap{};  ///< empty: the system is run as it is
  bool merges_walls = true;              ///< walls that share a history are one class

  [[nodiscard]] RunRecord run(double& seconds) const {
    Scene scene = make_scene(scenario, merges_walls);
    if (wrap) scene.system = wrap(std::move(scene.system));
    const double start = thread_seconds();
    RunRecord record = record_run(scene, integrator, {scenario.numerics.rtol, scenario.numerics.atol}, scenario.output);
    seconds = thread_seconds() - start;
    return record;
  }
};

/// A saving: `what` a run leaves out, and a scene to be timed with and without it.
struct Saving {
  std::string what;
  std::string scene;
  Variant saved;
  Variant undone;
};

BenchSaving measure(const Saving& saving, const BenchSettings& settings) {
  const auto timed = [](const Variant& variant) {
    return Stopwatch([&variant] {
      double seconds = 0.0;
      static_cast<void>(variant.run(seconds));
      return seconds;
    });
  };
  double unused = 0.0;
  const RunRecord saved = saving.saved.run(unused);
  const RunRecord undone = saving.undone.run(unused);
  std::vector<Stopwatch> watches{timed(saving.saved), timed(saving.undone)};
  time_in_turn(watches, settings);
  return {.what = saving.what,
          .scene = saving.scene,
          .time = watches[0].timing().fastest,
          .undone = watches[1].timing().fastest,
          .difference = curve_error(saved.history, undone.history).whole};
}

}  // namespace

BenchList read_bench_list(const fs::path& file) {
  const auto [text, problem] = read_text_file(file, k_largest_text);
  if (!problem.empty()) throw_fault({file.string()}, problem);
  const toml::table tree = parse_document(text, file.string());
  FaultList faults;
  Reading reading{faults};
  const BenchKeys keys;
  const SourceLocation top{file.string()};
  const Section root(reading, {&tree, top, "the file"}, keys.root);
  const ScenariosOfList scenarios{file.parent_path(), faults};
  BenchList list;
  for (const auto& table : root.tables("scene", "[[scene]]")) {
    for (CheckedScenario& scene : scenarios.of_scene(Section(reading, table, keys.scene))) {
      list.scenes.push_back(std::move(scene));
    }
  }
  for (const auto& table : root.tables("saving", "[[saving]]")) {
    const Section section(reading, table, keys.saving);
    const auto spared = scenarios.of(section);
    const auto without = scenarios.of(Section(reading, section.table("without", "without"), keys.without));
    if (spared && without) list.savings.push_back({section.text("what"), section.text("name"), *spared, *without});
  }
  faults.throw_if_any();
  return list;
}

BenchScene measure_scene(const CheckedScenario& scenario, const BenchSettings& settings,
                         const std::function<void()>& shown) {
  const std::vector<std::string> names = settings.integrators.empty() ? all_integrators() : settings.integrators;
  const std::vector<double> tolerances = settings.tolerances.empty() ? decades() : settings.tolerances;
  const auto [first, second] = standards_of(scenario);
  BenchScene result{.name = scenario.name,
                    .title = scenario.title,
                    .chosen = choose_integrator(integrators::k_auto, *make_scene(scenario).system).used,
                    .reference = first.integrator,
                    .check = second.integrator};
  result.agreement = curve_error(first.record.history, second.record.history).whole;
  result.rows = first.record.history.row_count();
  Stopwatch setup([&] {
    const double start = thread_seconds();
    static_cast<void>(make_scene(scenario));
    return thread_seconds() - start;
  });
  setup.run_for(settings, 1.0);
  result.setup = setup.timing().fastest;
  const Scene scene = make_scene(scenario);
  std::vector<Stopwatch> watches;
  for (const std::string& name : names) {
    for (const double rtol : tolerances) {
      const IntegratorChoice choice = choose_integrator(name, *scene.system);
      if (choice.used == integrators::k_direct && !scene.system->is_solvable()) break;
      const Standard& standard = choice.used == first.integrator ? second : first;
      result.points.push_back(measure_point(scenario, name, choice.used, rtol, standard));
      watches.emplace_back([&scenario, used = choice.used, rtol] { return time_once(scenario, used, rtol); });
      if (shown) shown();
      if (result.points.back().fastest > k_too_long) break;
    }
  }
  time_in_turn(watches, settings);
  for (std::size_t i = 0; i < watches.size(); ++i) {
    const Timing timing = watches[i].timing();
    result.points[i].fastest = timing.fastest;
    result.points[i].median = timing.median;
  }
  result.evaluation = time_evaluation(scenario, first.integrator);
  return result;
}

BenchProfile profile_scene(const CheckedScenario& scenario, const std::string& name) {
  const std::string integrator = choose_integrator(name, *make_scene(scenario).system).used;
  BenchProfile profile{.scene = scenario.name, .integrator = integrator, .total = k_infinity};
  for (int i = 0; i < k_profiled_runs; ++i) {
    SystemProfile system;
    const LinearAlgebraClock clock;
    Scene scene = make_scene(scenario);
    scene.system = profiled(std::move(scene.system), system);
    const auto start = Clock::now();
    static_cast<void>(record_run(scene, integrator, {scenario.numerics.rtol, scenario.numerics.atol}, scenario.output));
    const double seconds = seconds_since(start);
    if (!(seconds < profile.total)) continue;
    profile.total = seconds;
    profile.law = system.law.seconds;
    profile.law_calls = system.law.calls;
    profile.guards = system.guards.seconds;
    profile.recording = system.recording.seconds;
    profile.linear_algebra = clock.seconds();
  }
  return profile;
}

std::vector<BenchSaving> measure_savings(const BenchSettings& settings, const std::vector<BenchPair>& listed) {
  const auto scene_of = [](const std::vector<std::string>& overrides) {
    return parse_scenario(default_scenario_text(), "die.toml", overrides);
  };
  const auto beyond = [](double factor) {
    return [factor](System system) { return sampling_beyond(std::move(system), factor); };
  };
  const std::string simple = "loading.configuration=simple";
  const CheckedScenario die = scene_of({});
  const CheckedScenario plain = scene_of({simple});
  const CheckedScenario sticky = scene_of({simple, "material.surface_energy=1e-12"});
  const auto& direct = integrators::k_direct;
  const auto& bdf = integrators::k_cvode_bdf;
  const char* no_guard = "no guard that cannot fire before the end of a step";
  const char* no_observables = "observables only at output points";
  std::vector<Saving> savings{
      {"walls that share a history are one class", "die, direct", {die}, {.scenario = die, .merges_walls = false}},
      {"nothing is integrated where a state can be solved for", "die, direct / cvode-bdf", {die}, {die, bdf}},
      {"no algebraic unknowns where there is an explicit form",
       "die, cvode-bdf / ida",
       {die, bdf},
       {die, integrators::k_ida}},
      {"work in closed form where there is one", "die, direct", {die}, {die, direct, always_integrated}},
      // This saving is so small that the run with it has to be wrapped, too.
      {no_guard, "die, direct", {die, direct, beyond(1.0)}, {die, direct, beyond(10.0)}},
      {no_guard, "die, cvode-bdf", {die, bdf, beyond(1.0)}, {die, bdf, beyond(10.0)}},
      {no_observables, "die, direct", {die}, {die, direct, always_observed}},
      {no_observables, "die, cvode-bdf", {die, bdf}, {die, bdf, always_observed}},
      {"no adhesion where the surface energy is zero", "simple, direct, against 1e-12 J/m2", {plain}, {sticky}},
      {"no contacts where nothing can touch",
       "simple, direct, against 4 walls out of reach",
       {plain},
       {with_walls_out_of_reach(plain)}},
  };
  for (const BenchPair& pair : listed) savings.push_back({pair.what, pair.name, {pair.spared}, {pair.without}});
  std::vector<BenchSaving> measured;
  for (const Saving& saving : savings) measured.push_back(measure(saving, settings));
  return measured;
}

double time_to_error(const BenchScene& scene, std::string_view integrator, double error) {
  double least = k_nan;
  for (const BenchPoint& point : scene.points) {
    if (point.integrator == integrator && point.curve_error <= error) least = std::fmin(least, point.fastest);
  }
  return least;
}

}  // namespace monograin
