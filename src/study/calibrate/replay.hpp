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

/// The path on which data lead a scenario: points between which x rises or falls. Noise does not make turns: the rows
/// between two turning_points() are passed in rising or falling order, whatever their order in the data, and x turns at
/// turns_of(). Rows of a hold lie at the turn, and so do those that noise puts beyond it.
struct DataPath {
  std::vector<double> x;              ///< of the points, in the order in which they are passed
  std::vector<std::size_t> ends;      ///< last points of the branches, ascending: the turns and the last point of all
  std::vector<std::size_t> point_of;  ///< for each row its point

  /// Values of the points, row by row.
  [[nodiscard]] std::vector<double> at_rows(std::span<const double> of_points) const;
  /// Means of the rows at each point; at a point without rows that of the point before.
  [[nodiscard]] std::vector<double> at_points(std::span<const double> of_rows) const;
};

/// Path through the rows of measured data. Rows of a branch share a point if their x differs by less than 1e-12 of the
/// largest.
[[nodiscard]] DataPath path_through(std::span<const double> x);

/// Values with further ones in between, which divide each piece into parts.
[[nodiscard]] std::vector<double> refined(std::span<const double> values, std::size_t parts);
/// The path with further points in between; each point counts as a row.
[[nodiscard]] DataPath refined(const DataPath& path, std::size_t parts);

/// A program that passes a path, with one step of one second for each branch.
struct DataProgram {
  std::vector<Step> steps;
  std::vector<double> times;  ///< [s], ascending: instants at which the program passes the points, after its start
  std::vector<std::size_t> instants;  ///< for each point its instant: 0 for the start, k for times[k - 1]
};

/// @param values  of the points, with the path's turns; equal ones share an instant
/// @param kind    kind of the steps: a ramp
/// @param start   value of the quantity before the first step
[[nodiscard]] DataProgram program_along(const DataPath& path, std::span<const double> values, Step::Kind kind,
                                        double start);

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

/// @throws ScenarioError if the programs of the walls are incompatible, or the integrator does not suit the scene
[[nodiscard]] Measurable measurable_in(const CheckedScenario& scenario);

/// Columns that drive a scenario and that are observed. Columns are observables: "axial.force".
struct ReplayColumns {
  std::string driven;
  std::string watched;
  Step::Kind control = Step::Kind::displacement;  ///< control of the driven column
  double start = 0.0;                             ///< its value before the first step, with the scenario's own numbers
};

/// Runs a scenario repeatedly with different numbers, along a path instead of its own steps.
class Replay {
 public:
  /// @param path  of the driven column
  Replay(CheckedScenario scenario, ReplayColumns columns, DataPath path);

  /// Sets one of the scenario's numbers (see number_keys). Set the radius before all others, because lengths given in
  /// R0 follow it. @param value  [SI]
  /// @return false if no scenario can have a particle of that radius; problem() gives the reason
  [[nodiscard]] bool set(std::string_view path, double value);

  /// Replaces the values of the path's points.
  void follow(std::vector<double> values);

  /// Runs the scenario and gives the observed column at each point of the path.
  /// @return false if the run ends before the last point, a force cannot be applied, or the column is undefined;
  /// problem() and failed_at() give the reason and the position
  [[nodiscard]] bool run(std::span<double> response);

  [[nodiscard]] const DataPath& path() const noexcept { return path_; }
  [[nodiscard]] const std::string& problem() const noexcept { return problem_; }
  /// Index of the first row that was not reached, from 0.
  [[nodiscard]] std::size_t failed_at() const noexcept { return failed_at_; }
  [[nodiscard]] const CheckedScenario& scenario() const noexcept { return scenario_; }

 private:
  [[nodiscard]] Scene scene_from_start();
  [[nodiscard]] std::string problem_at(std::size_t point) const;
  [[nodiscard]] std::size_t first_row_from(std::size_t point) const;

  CheckedScenario scenario_;
  std::string integrator_;
  ReplayColumns columns_;
  DataPath path_;
  std::vector<double> values_;               ///< of its points
  double resolution_ = 0.0;                  ///< of the driven column
  std::vector<std::size_t> instants_;        ///< of its points
  std::vector<std::array<double, 2>> seen_;  ///< driven and observed column, instant by instant
  std::string problem_;
  std::size_t failed_at_ = 0;
};

}  // namespace monograin
