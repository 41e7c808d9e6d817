/// A scenario that follows measured data instead of its own program, repeatedly, with its response at every datum.
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

/// A program that passes given values, with one step of one second for each branch on which they rise or fall.
struct DataProgram {
  std::vector<Step> steps;
  std::vector<double> times;      ///< [s], ascending: instants at which the program passes the values, after its start
  std::vector<std::size_t> rows;  ///< for each value the index of its instant: 0 for the start, k for times[k - 1]
  std::vector<double> values;     ///< that the program passes; where noise goes beyond a turn, the value of the turn
};

/// Makes a program from values, with a branch between any two of their turning_points(). Noise does not turn a branch:
/// it passes its values in rising or falling order, whatever their order in the data, and turns at turns_of().
/// Values of a branch that differ by less than 1e-12 of the largest share an instant.
/// @param kind      kind of the steps: a ramp
/// @param start     value of the quantity before the first step
/// @param measured  the values before corrections, see turns_of()
[[nodiscard]] DataProgram program_through(std::span<const double> values, Step::Kind kind, double start,
                                          std::span<const double> measured);

/// Quantities that can be measured on a scenario.
struct Measurable {
  struct Column {
    std::string name;  ///< of an observable that is a number: "axial.force"
    std::string unit;  ///< SI
  };
  /// A column that a program can prescribe.
  struct Drive {
    std::string column;  ///< "axial.displacement"
    Step::Kind kind = Step::Kind::displacement;
    double start = 0.0;  ///< its value before the first step [SI]
  };
  std::vector<std::string> driven;  ///< contact classes whose walls move
  std::vector<Drive> drives;
  std::vector<Column> columns;

  /// The column with a name, or nullptr.
  [[nodiscard]] const Column* find(std::string_view name) const noexcept;
  /// Prefix of columns, the first driven class with a full stop; empty if there are no walls.
  [[nodiscard]] std::string prefix() const { return driven.empty() ? std::string() : driven.front() + '.'; }
};

/// @throws ScenarioError if the programs of the walls are incompatible
[[nodiscard]] Measurable measurable_in(const CheckedScenario& scenario);

/// Columns that drive a scenario and that are observed. Columns are observables: "axial.force".
struct ReplayColumns {
  std::string driven;
  std::string watched;
  Step::Kind control = Step::Kind::displacement;  ///< control of the driven column
  double start = 0.0;                             ///< its value before the first step, with the scenario's own numbers
};

/// Runs a scenario repeatedly with different numbers, through given values instead of its own steps.
class Replay {
 public:
  /// @param values  of the driven column
  Replay(CheckedScenario scenario, ReplayColumns columns, std::vector<double> values);

  /// Sets one of the scenario's numbers (see number_keys). Set the radius before all others, because lengths given in
  /// R0 follow it. @param value  [SI]
  /// @return false if no scenario can have a particle of that radius; problem() gives the reason
  [[nodiscard]] bool set(std::string_view path, double value);

  /// Replaces the values that the scenario follows. @param values  of the driven column, as many as before
  void follow(std::vector<double> values);

  /// Runs the scenario and gives the observed column at each of the values.
  /// @return false if the run ends before the last value, a force cannot be applied, or the column is undefined;
  /// problem() and failed_at() give the reason and the position
  [[nodiscard]] bool run(std::span<double> response);

  [[nodiscard]] const std::string& problem() const noexcept { return problem_; }
  /// Index of the first value that was not reached, from 0.
  [[nodiscard]] std::size_t failed_at() const noexcept { return failed_at_; }
  [[nodiscard]] const CheckedScenario& scenario() const noexcept { return scenario_; }

 private:
  [[nodiscard]] Scene scene_from_start();

  CheckedScenario scenario_;
  std::string integrator_;
  ReplayColumns columns_;
  std::vector<double> measured_;  ///< the first values
  std::vector<double> values_;
  std::vector<double> prescribed_;           ///< values that the program passes
  double resolution_ = 0.0;                  ///< of the driven column
  std::vector<std::size_t> rows_;            ///< for each value the index of its instant
  std::vector<std::array<double, 2>> seen_;  ///< driven and observed column, instant by instant
  std::string problem_;
  std::size_t failed_at_ = 0;
};

}  // namespace monograin
