/// Scenarios of a unit particle (R0 = 1, E = 1) written in code, and queries of their runs.
#pragma once

#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "history/run.hpp"
#include "scenario/scenario.hpp"
#include "scene/scene.hpp"

namespace monograin {

using Configuration = Loading::Configuration;

/// All forms of the equations: solved at every instant, explicit (two methods), implicit.
inline constexpr const char* k_integrators[] = {"direct", "cvode-adams", "cvode-bdf", "ida"};

// --- programs

[[nodiscard]] Step ramp(double displacement, double duration = 1.0);
[[nodiscard]] Step force_ramp(double force, double duration = 1.0);
[[nodiscard]] Step ramp_at(double displacement, double rate);
[[nodiscard]] Step hold(double duration = 1.0);
[[nodiscard]] Step detach(double rate = 1.0);
/// A step with a condition that ends it.
[[nodiscard]] Step until(Step step, Quantity quantity, double value);
[[nodiscard]] Step until_event(Step step, const std::string& event);
/// One ramp of unit duration to each displacement.
[[nodiscard]] std::vector<Step> path(const std::vector<double>& displacements);

// --- scenarios

[[nodiscard]] CheckedScenario hertz_scenario(Configuration configuration, std::vector<Step> steps);
[[nodiscard]] CheckedScenario mdr_scenario(Configuration configuration, double modulus_over_yield, double poisson_ratio,
                                           std::vector<Step> steps);
/// A scenario with another option of the model, e.g. radius_rule = yielded.
[[nodiscard]] CheckedScenario with(CheckedScenario scenario, const std::string& option, const std::string& word);
[[nodiscard]] CheckedScenario with_points(CheckedScenario scenario, int points);

/// A wall of a free set; no steps: fixed.
[[nodiscard]] WallSpec wall(const std::string& name, const Eigen::Vector3d& normal, std::vector<Step> steps = {},
                            double gap = 0.0);
/// The particle of a scenario between free walls.
[[nodiscard]] CheckedScenario between(CheckedScenario scenario, std::vector<WallSpec> walls);
/// The walls of a scenario written out as a free set.
[[nodiscard]] std::vector<WallSpec> written_out(const CheckedScenario& scenario);

/// One line that identifies a scenario in a failure message.
[[nodiscard]] std::string describe(const CheckedScenario& scenario);

// --- runs

struct TestRun {
  Scene scene;
  RunRecord record;

  /// A column at all rows; outputs() gives it at output points only.
  [[nodiscard]] std::vector<double> column(std::string_view name) const { return record.history.column(name); }
  [[nodiscard]] std::vector<double> outputs(std::string_view name) const;
  [[nodiscard]] double last(std::string_view name) const { return column(name).back(); }
  /// Columns `<class>.<name>` at output points, one per class.
  [[nodiscard]] std::vector<std::vector<double>> outputs_by_class(std::string_view name) const;

  /// Events "class:event" in order ("event" without a class), except the ends of steps.
  [[nodiscard]] std::vector<std::string> events() const;
  [[nodiscard]] bool has_event(std::string_view name) const;
  /// Time of the first event with that name; NaN without one.
  [[nodiscard]] double time_of(std::string_view name) const;
  /// A column of the events table at the first event with that name.
  [[nodiscard]] double at_event(std::string_view name, std::string_view column) const;
};

/// @param integrator  as a scenario file names it, "auto" included
[[nodiscard]] TestRun run(const CheckedScenario& scenario, std::string_view integrator = "direct",
                          const Tolerances& tolerances = {}, bool merges_walls = true);
/// Tolerances with atol far below rtol, so that only rtol has an effect.
[[nodiscard]] inline Tolerances relative(double rtol) { return {.rtol = rtol, .atol = 1e-4 * rtol}; }

[[nodiscard]] double largest(const std::vector<double>& values);
/// Largest difference over the largest magnitude of `expected`; infinity for different lengths.
[[nodiscard]] double difference(const std::vector<double>& actual, const std::vector<double>& expected);

/// Difference of two runs at their output points: forces, overlaps, radius, volume, each over its largest value, and
/// energies over the largest work. Classes are compared in order, whatever their names.
[[nodiscard]] double difference(const TestRun& actual, const TestRun& expected);

/// Rows just after a change of a contact's regime. Expects each of these rows, and the row before it, to be marked as
/// the two sides of an event.
[[nodiscard]] std::vector<std::size_t> regime_changes(const TestRun& run, const std::string& contact_class);

/// Least dissipation over the largest work; lost_dissipation() gives the sum of its decreases over the largest work.
[[nodiscard]] double least_dissipation(const TestRun& run);
[[nodiscard]] double lost_dissipation(const TestRun& run);

}  // namespace monograin
