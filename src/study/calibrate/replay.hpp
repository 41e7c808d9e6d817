/// A scenario whose walls, or whatever its program drives, follow measured data: its response at every datum, as often
/// as wanted.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/scenario.hpp"
#include "scene/scene.hpp"

namespace monograin {

/// A program that goes through given values: one step of one second for each stretch in which they rise or fall.
struct DataProgram {
  std::vector<Step> steps;
  std::vector<double> times;      ///< [s], ascending: where the program passes the values, after its start
  std::vector<std::size_t> rows;  ///< for each value: the place of its instant, 0 for the start, k for times[k - 1]
};

/// Values that follow each other without any change (relative to the largest: 1e-12) share an instant.
/// @param kind   a ramp
/// @param start  where the program begins: the same quantity before the first step
[[nodiscard]] DataProgram program_through(std::span<const double> values, Step::Kind kind, double start);

/// What can be measured on a scenario.
struct Measurable {
  struct Column {
    std::string name;  ///< of an observable that is a number: "axial.force"
    std::string unit;  ///< SI
  };
  /// A column that a program can go through.
  struct Drive {
    std::string column;  ///< "axial.displacement"
    Step::Kind kind = Step::Kind::displacement;
    double start = 0.0;  ///< its value before the first step [SI]
  };
  std::vector<std::string> driven;  ///< contact classes whose walls move
  std::vector<Drive> drives;
  std::vector<Column> columns;

  /// The column of that name, or nullptr.
  [[nodiscard]] const Column* find(std::string_view name) const noexcept;
  /// The first driven class with a full stop, as columns begin; empty where there are no walls.
  [[nodiscard]] std::string prefix() const { return driven.empty() ? std::string() : driven.front() + '.'; }
};

/// @throws ScenarioError where the walls' programs do not go together
[[nodiscard]] Measurable measurable_in(const CheckedScenario& scenario);

/// What drives a scenario, and what is looked at. Columns are observables: "axial.force".
struct ReplayColumns {
  std::string driven;
  std::string watched;
  Step::Kind control = Step::Kind::displacement;  ///< that of the driven column
  double start = 0.0;                             ///< its value before the first step, with the scenario's own numbers
};

/// Runs a scenario again and again, with other numbers and one program: through given values instead of its own steps.
class Replay {
 public:
  /// @param values  of the driven column
  Replay(CheckedScenario scenario, ReplayColumns columns, std::vector<double> values);

  /// Sets one of the scenario's numbers, see number_keys. The radius is to be set before all others: lengths that are
  /// given in R0 follow it. @param value  [SI]
  /// @return false where no scenario has a particle of that radius; problem() tells why
  [[nodiscard]] bool set(std::string_view path, double value);

  /// Goes through these values from now on. @param values  of the driven column, as many as before
  void follow(std::vector<double> values);

  /// The watched column at each of the values.
  /// @return false where the run ends before the last of them, a force cannot be put on, or the column is undefined;
  /// problem() and failed_at() tell why and where
  [[nodiscard]] bool run(std::span<double> response);

  [[nodiscard]] const std::string& problem() const noexcept { return problem_; }
  /// The first of the values, counted from 0, that was not reached.
  [[nodiscard]] std::size_t failed_at() const noexcept { return failed_at_; }
  [[nodiscard]] const CheckedScenario& scenario() const noexcept { return scenario_; }

 private:
  [[nodiscard]] Scene scene_from_start();

  CheckedScenario scenario_;
  std::string integrator_;
  ReplayColumns columns_;
  std::vector<double> values_;
  double resolution_ = 0.0;                  ///< of the driven column
  std::vector<std::size_t> rows_;            ///< for each value: its instant
  std::vector<std::array<double, 2>> seen_;  ///< driven and watched column, instant by instant
  std::string problem_;
  std::size_t failed_at_ = 0;
};

}  // namespace monograin
