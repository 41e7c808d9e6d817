#include "study/calibrate/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "catalogue.hpp"
#include "engine/drive.hpp"
#include "history/run.hpp"
#include "history/turns.hpp"
#include "scenario/numbers.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

constexpr double k_same_force = 1e-6;  // deviation from a prescribed force that counts as none, over the largest

/// Index of the contact class to which a column belongs; the number of classes if there is none.
std::size_t class_of(const Scene& scene, std::string_view column) {
  const std::string_view name = column.substr(0, column.rfind('.'));
  const auto named = std::ranges::find(scene.classes, name, &ContactClass::name);
  if (named != scene.classes.end()) return static_cast<std::size_t>(named - scene.classes.begin());
  const auto holding = std::ranges::find_if(
      scene.walls, [&](const auto& walls) { return std::ranges::find(walls, name) != walls.end(); });
  return static_cast<std::size_t>(holding - scene.walls.begin());
}

/// Index of a column among the observables. Gaps determine which walls are one class by symmetry: if a wall joins
/// another one's class, its columns have that class's name.
std::size_t place_of(const Scene& scene, std::string_view column) {
  const std::span<const Observable> all = scene.system->observables();
  auto found = std::ranges::find(all, column, &Observable::name);
  if (const std::size_t c = class_of(scene, column); found == all.end() && c < scene.classes.size()) {
    found = std::ranges::find(all, scene.classes[c].name + std::string(column.substr(column.rfind('.'))),
                              &Observable::name);
  }
  if (found == all.end()) throw std::logic_error(fmt::format("no observable '{}'", column));
  return static_cast<std::size_t>(found - all.begin());
}

/// Keeps two columns at the output points.
class ColumnSink final : public HistorySink {
 public:
  using Rows = std::vector<std::array<double, 2>>;

  ColumnSink(const Scene& scene, const ReplayColumns& columns, Rows& rows)
      : system_(*scene.system),
        observed_(system_.observables().size()),
        places_{place_of(scene, columns.driven), place_of(scene, columns.watched)},
        rows_(rows) {
    if (!is_energy(columns.driven) && !is_energy(columns.watched)) scene.system->leave_out_energies();
  }

  void observe(double /*time*/, int /*step*/, double xi, std::span<const double> y) override {
    system_.observe(xi, y, observed_);
  }
  void append(RowSide side) override {
    if (side == RowSide::output) rows_.push_back({observed_[places_[0]], observed_[places_[1]]});
  }
  void event(const Event& /*event*/) override {}

 private:
  HybridSystem& system_;
  std::vector<double> observed_;
  std::array<std::size_t, 2> places_;
  Rows& rows_;
};

/// Largest difference of equal values.
double same_among(std::span<const double> values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return k_same_value * largest;
}

/// Builds a path, branch by branch.
class PathBuilder {
 public:
  explicit PathBuilder(std::span<const double> x) : x_(x), same_(same_among(x)) { path_.point_of.resize(x.size()); }

  /// Appends a branch from one turn to the next one. The first and the last turn do not bound the values beside them.
  void pass(const Turn& from, const Turn& to, bool is_first, bool is_last) {
    const bool rises = to.x > from.x;
    const double away = rises ? k_infinity : -k_infinity;
    const double begin = is_first ? -away : from.x;
    const double end = is_last ? away : to.x;
    std::vector<std::pair<double, std::size_t>> rows;  // in the order in which the branch passes them
    for (std::size_t row = is_first ? 0 : from.last_row + 1; row <= to.last_row; ++row) {
      const bool is_held = row >= to.held_begin && row < to.held_end;
      rows.emplace_back(is_held ? to.x : std::clamp(x_[row], std::min(begin, end), std::max(begin, end)), row);
    }
    const auto along = [rises](const auto& pair) { return rises ? pair.first : -pair.first; };
    std::ranges::stable_sort(rows, {}, along);
    for (const auto& [x, row] : rows) path_.point_of[row] = point_at(x);
    path_.ends.push_back(is_last ? path_.x.size() - 1 : point_at(to.x));
  }

  [[nodiscard]] DataPath take() && { return std::move(path_); }

 private:
  std::size_t point_at(double x) {
    if (path_.x.empty() || std::abs(x - path_.x.back()) > same_) path_.x.push_back(x);
    return path_.x.size() - 1;
  }

  std::span<const double> x_;
  double same_;
  DataPath path_;
};

}  // namespace

std::vector<double> DataPath::at_rows(std::span<const double> of_points) const {
  std::vector<double> values;
  for (const std::size_t point : point_of) values.push_back(of_points[point]);
  return values;
}

std::vector<double> DataPath::at_points(std::span<const double> of_rows) const {
  std::vector<double> values(x.size(), 0.0);
  std::vector<double> counts(x.size(), 0.0);
  for (const std::size_t point : point_of) counts[point] += 1.0;
  for (std::size_t row = 0; row < point_of.size(); ++row) {
    values[point_of[row]] += of_rows[row] / counts[point_of[row]];
  }
  for (std::size_t point = 1; point < values.size(); ++point) {
    if (counts[point] == 0.0) values[point] = values[point - 1];
  }
  return values;
}

DataPath path_through(std::span<const double> x) {
  if (x.size() < 2)
    return {{x.begin(), x.end()}, std::vector<std::size_t>(x.size()), std::vector<std::size_t>(x.size())};
  PathBuilder builder(x);
  const std::vector<Turn> turns = turns_of(x, turning_points(x));
  for (std::size_t k = 1; k < turns.size(); ++k) builder.pass(turns[k - 1], turns[k], k == 1, k + 1 == turns.size());
  return std::move(builder).take();
}

std::vector<double> refined(std::span<const double> values, std::size_t parts) {
  std::vector<double> result{values.front()};
  for (std::size_t i = 1; i < values.size(); ++i) {
    for (std::size_t k = 1; k < parts; ++k) {
      result.push_back(std::lerp(values[i - 1], values[i], static_cast<double>(k) / static_cast<double>(parts)));
    }
    result.push_back(values[i]);
  }
  return result;
}

DataPath refined(const DataPath& path, std::size_t parts) {
  DataPath result{refined(path.x, parts), path.ends, {}};
  for (std::size_t& end : result.ends) end *= parts;
  result.point_of.resize(result.x.size());
  std::iota(result.point_of.begin(), result.point_of.end(), std::size_t{0});
  return result;
}

DataProgram program_along(const DataPath& path, std::span<const double> values, Step::Kind kind, double start) {
  DataProgram program;
  const double same = std::max(same_among(values), k_same_value * std::abs(start));
  const auto is_same = [same](double a, double b) { return !(std::abs(a - b) > same); };
  double at = start;  // value that the program has reached
  const auto go_to = [&](double target) {
    program.steps.push_back({.kind = kind, .target = target, .duration = 1.0, .rate = {}, .until = {}, .where = {}});
    at = target;
  };
  std::size_t first = 0;
  for (const std::size_t end : path.ends) {
    const double target = values[end];
    // Where the first branch begins behind the start, because of noise or after a load that is not in the data.
    const double nearest = values[first];
    const bool is_behind = target > nearest ? nearest < at : nearest > at;
    if (first == 0 && end > 0 && is_behind && !is_same(nearest, at)) {
      go_to(nearest);
      program.times.push_back(static_cast<double>(program.steps.size()));
    }
    const auto steps_before = static_cast<double>(program.steps.size());
    double passed = at;
    for (; first <= end; ++first) {
      if (!is_same(values[first], passed)) {
        passed = values[first];
        // The target differs from `at`: rows of a branch without a way to go are the same as its beginning.
        program.times.push_back(steps_before + (passed - at) / (target - at));
      }
      program.instants.push_back(program.times.size());
    }
    if (!is_same(target, at)) go_to(target);
  }
  return program;
}

const Measurable::Column* Measurable::find(std::string_view name) const noexcept {
  const auto found = std::ranges::find(columns, name, &Column::name);
  return found == columns.end() ? nullptr : &*found;
}

Measurable measurable_in(const CheckedScenario& scenario) {
  check_integrator(scenario);
  const Scene scene = make_scene(scenario);
  Measurable measurable;
  for (std::size_t c = 0; c < scene.classes.size(); ++c) {
    if (scene.channels[c].program.empty()) continue;
    const std::string& name = scene.classes[c].name;
    measurable.driven.push_back(name);
    measurable.drives.push_back({name + ".displacement", Step::Kind::displacement, scene.channels[c].at_rest.start});
    measurable.drives.push_back({name + ".force", Step::Kind::force, 0.0});
  }
  if (scene.classes.empty()) {
    std::vector<double> y(scene.system->unknowns().size());
    scene.system->start(y);
    for (const DriveKey& drive : find_model(scenario.model)->drives) {
      measurable.drives.push_back({std::string(drive.column.empty() ? drive.name : drive.column),
                                   ramp_of(drive.control), scene.system->controlled(drive.control, 0, 0.0, y)});
    }
  }
  for (const Observable& observable : scene.system->observables()) {
    if (observable.words.empty()) measurable.columns.push_back({observable.name, observable.unit});
  }
  return measurable;
}

Replay::Replay(CheckedScenario scenario, ReplayColumns columns, DataPath path)
    : scenario_(std::move(scenario)),
      integrator_(choose_integrator(scenario_.numerics.integrator, *make_scene(scenario_).system).used),
      columns_(std::move(columns)),
      path_(std::move(path)) {
  follow(path_.x);
}

void Replay::follow(std::vector<double> values) {
  values_ = std::move(values);
  DataProgram program = program_along(path_, values_, columns_.control, columns_.start);
  scenario_.loading.steps = std::move(program.steps);
  scenario_.output.times = std::move(program.times);
  instants_ = std::move(program.instants);
  resolution_ = 0.0;
  // Prescribed quantities follow the program exactly, except a force on a contact that has been lost.
  for (const double value : values_) resolution_ = std::max(resolution_, k_same_force * std::abs(value));
  if (columns_.control != Step::Kind::force) resolution_ = k_infinity;
}

bool Replay::set(std::string_view path, double value) {
  if (path != k_radius_key) {
    set_number(scenario_, path, value);
    return true;
  }
  if (value == scenario_.radius) return true;
  try {
    CheckedScenario sized = scenario_.variants->with({}, std::array{std::string(path)}, std::array{value});
    sized.variants = scenario_.variants;
    sized.loading.steps = std::move(scenario_.loading.steps);
    sized.output = std::move(scenario_.output);
    scenario_ = std::move(sized);
  } catch (const ScenarioError& error) {
    problem_ = error.faults().front().message;
    failed_at_ = 0;
    return false;
  }
  return true;
}

/// Makes the scene. A changed gap changes the displacement from which the program begins.
Scene Replay::scene_from_start() {
  Scene scene = make_scene(scenario_);
  if (columns_.control != Step::Kind::displacement) return scene;
  const std::size_t c = class_of(scene, columns_.driven);
  if (c >= scene.classes.size() || scene.channels[c].at_rest.start == columns_.start) return scene;
  columns_.start = scene.channels[c].at_rest.start;
  follow(std::move(values_));
  return make_scene(scenario_);
}

bool Replay::run(std::span<double> response) {
  seen_.clear();
  try {
    Scene scene = scene_from_start();
    ColumnSink sink(scene, columns_, seen_);
    const Tolerances tolerances{scenario_.numerics.rtol, scenario_.numerics.atol};
    problem_ = drive(scene, integrator_, tolerances, scenario_.output, sink).message;
  } catch (const std::domain_error& error) {
    problem_ = error.what();
  } catch (const std::invalid_argument& error) {  // the model has no law for these constants
    problem_ = error.what();
  }
  for (std::size_t point = 0; point < instants_.size(); ++point) {
    const bool is_reached = instants_[point] < seen_.size();
    std::string problem = is_reached ? problem_at(point) : problem_;
    if (!is_reached || !problem.empty()) {
      problem_ = std::move(problem);
      failed_at_ = first_row_from(point);
      return false;
    }
    response[point] = seen_[instants_[point]][1];
  }
  return true;
}

/// Why there is no response at a point; empty if there is one.
std::string Replay::problem_at(std::size_t point) const {
  const auto [driven, watched] = seen_[instants_[point]];
  if (std::abs(driven - values_[point]) > resolution_) {
    return fmt::format("{} is {:.6g} where {:.6g} is prescribed", columns_.driven, driven, values_[point]);
  }
  return std::isfinite(watched) ? std::string() : fmt::format("{} has no value there", columns_.watched);
}

/// The first row in the data that lies at a point or after it.
std::size_t Replay::first_row_from(std::size_t point) const {
  const auto found = std::ranges::find_if(path_.point_of, [point](std::size_t at) { return at >= point; });
  return static_cast<std::size_t>(std::min(found, path_.point_of.end() - 1) - path_.point_of.begin());
}

}  // namespace monograin
