#include "study/calibrate/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "catalogue.hpp"
#include "engine/drive.hpp"
#include "history/branches.hpp"
#include "scenario/numbers.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

constexpr double k_same_force = 1e-6;  // deviation from a prescribed force that counts as none, over the largest

constexpr std::size_t k_no_class = std::numeric_limits<std::size_t>::max();

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

/// A program that passes the values of branches, one after the other.
class ProgramOfBranches {
 public:
  ProgramOfBranches(std::span<const double> values, Step::Kind kind, double start) : kind_(kind), at_(start) {
    program_.rows.resize(values.size());
    program_.values.assign(values.begin(), values.end());
    double largest = std::abs(start);
    for (const double value : values) largest = std::max(largest, std::abs(value));
    same_ = k_same_value * largest;
  }

  [[nodiscard]] DataProgram take() && { return std::move(program_); }

  /// Appends a branch.
  /// @param first, last  its rows
  /// @param begin, end   its turning points; infinite: its values have no bound on this side
  void pass(std::size_t first, std::size_t last, double begin, double end) {
    const bool rises = begin < end;
    std::vector<std::size_t> rows(last + 1 - first);  // in the order in which the branch passes their values
    std::iota(rows.begin(), rows.end(), first);
    // Noise of the rows next to a turn goes beyond it.
    for (const std::size_t row : rows)
      program_.values[row] = std::clamp(program_.values[row], std::min(begin, end), std::max(begin, end));
    const auto is_before = [rises](double a, double b) { return rises ? a < b : a > b; };
    std::ranges::stable_sort(rows, is_before, [this](std::size_t row) { return program_.values[row]; });
    // Where the first branch begins behind the start, because of noise or after a load that is not in the data.
    if (const double nearest = program_.values[rows.front()]; is_before(nearest, at_) && !is_same(nearest, at_)) {
      go_to(nearest);
      program_.times.push_back(static_cast<double>(program_.steps.size()));
    }
    const double target = std::isfinite(end) ? end : program_.values[rows.back()];
    const auto steps_before = static_cast<double>(program_.steps.size());
    double passed = at_;
    for (const std::size_t row : rows) {
      if (!is_same(program_.values[row], passed)) {
        passed = program_.values[row];
        program_.times.push_back(steps_before + (passed - at_) / (target - at_));
      }
      program_.rows[row] = program_.times.size();
    }
    if (!is_same(target, at_)) go_to(target);
  }

 private:
  [[nodiscard]] bool is_same(double a, double b) const noexcept { return !(std::abs(a - b) > same_); }
  void go_to(double target) {
    program_.steps.push_back({.kind = kind_, .target = target, .duration = 1.0});
    at_ = target;
  }

  DataProgram program_;
  Step::Kind kind_;
  double at_;          ///< value that the program has reached
  double same_ = 0.0;  ///< difference of equal values
};

}  // namespace

DataProgram program_through(std::span<const double> values, Step::Kind kind, double start,
                            std::span<const double> measured) {
  ProgramOfBranches program(values, kind, start);
  const std::vector<Turn> turns = turns_of(values, turning_points(values), measured);
  if (turns.size() == 1) program.pass(0, 0, start < values[0] ? -k_infinity : k_infinity, values[0]);
  for (std::size_t k = 1; k < turns.size(); ++k) {
    // The first and the last turn do not bound the values beside them.
    const Turn& from = turns[k - 1];
    const Turn& to = turns[k];
    const double away = to.x > from.x ? k_infinity : -k_infinity;
    const bool is_first = k == 1;
    const bool is_last = k + 1 == turns.size();
    program.pass(is_first ? 0 : from.last_row + 1, to.last_row, is_first ? -away : from.x, is_last ? away : to.x);
  }
  return std::move(program).take();
}

const Measurable::Column* Measurable::find(std::string_view name) const noexcept {
  const auto found = std::ranges::find(columns, name, &Column::name);
  return found == columns.end() ? nullptr : &*found;
}

Measurable measurable_in(const CheckedScenario& scenario) {
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

Replay::Replay(CheckedScenario scenario, ReplayColumns columns, std::vector<double> values)
    : scenario_(std::move(scenario)),
      integrator_(choose_integrator(scenario_.numerics.integrator, *make_scene(scenario_).system).used),
      columns_(std::move(columns)),
      measured_(std::move(values)) {
  follow(measured_);
}

void Replay::follow(std::vector<double> values) {
  values_ = std::move(values);
  DataProgram program = program_through(values_, columns_.control, columns_.start, measured_);
  scenario_.loading.steps = std::move(program.steps);
  scenario_.output.times = std::move(program.times);
  rows_ = std::move(program.rows);
  prescribed_ = std::move(program.values);
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
  const std::size_t c = columns_.control == Step::Kind::displacement ? class_of(scene, columns_.driven) : k_no_class;
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
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    failed_at_ = i;
    if (rows_[i] >= seen_.size()) return false;
    const auto [driven, watched] = seen_[rows_[i]];
    if (std::abs(driven - prescribed_[i]) > resolution_) {
      problem_ = fmt::format("{} is {:.6g} where {:.6g} is prescribed", columns_.driven, driven, prescribed_[i]);
      return false;
    }
    if (!std::isfinite(watched)) {
      problem_ = fmt::format("{} has no value there", columns_.watched);
      return false;
    }
    response[i] = watched;
  }
  return true;
}

}  // namespace monograin
