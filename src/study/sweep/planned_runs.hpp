/// Makes the runs of a sweep from its factors, by a design. For readers of TOML files: includes the library.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/section.hpp"
#include "study/sweep/constraint_section.hpp"
#include "study/sweep/design.hpp"
#include "study/sweep/design_table.hpp"
#include "study/sweep/factor.hpp"
#include "study/sweep/joint_normal.hpp"
#include "study/sweep/sweep_runs.hpp"

namespace monograin::sweep {

/// Numbers of a calibration that are varied jointly: the last factors of a sweep.
struct JointFactors {
  JointNormal distribution;
  std::size_t first = 0;  ///< index of the first one among the factors
};

class PlannedRuns {
 public:
  /// @param root         of the sweep file
  /// @param factors      of the sweep; designs turn ranges into lists where they need that
  /// @param radius       of the scenario [m]
  PlannedRuns(FaultList& faults, const Section& root, std::vector<Factor>& factors,
              std::span<const PlacedConstraint> constraints, double radius)
      : faults_(faults), root_(root), factors_(factors), constraints_(constraints), radius_(radius) {}

  // Each makes all runs, or adds faults.

  /// All combinations.
  void make_grid();
  void make_maxpro(std::uint64_t seed);
  /// @param joint  none: all factors are independent
  void make_samples(std::string_view design, std::uint64_t seed, const std::optional<JointFactors>& joint);
  /// The rows of a table.
  /// @param units  of its columns, which are those of the factors
  void make_rows(const DesignTable& table, std::span<const std::string> units);

  [[nodiscard]] SweepRuns& runs() noexcept { return runs_; }
  /// The runs as points of a cube.
  [[nodiscard]] Design& points() noexcept { return points_; }
  /// Number of points that the constraints exclude.
  [[nodiscard]] std::size_t left_out() const noexcept { return left_out_; }

 private:
  [[nodiscard]] std::vector<SweepValue> resolved(std::span<const FactorValue> values) const;
  [[nodiscard]] std::vector<FactorValue> values_at(std::span<const double> point, std::size_t level) const;
  [[nodiscard]] std::size_t count_of(std::string_view key) const {
    return static_cast<std::size_t>(root_.number(key).value_or(0.0));
  }
  void add_if_allowed(std::span<const FactorValue> values);
  [[nodiscard]] std::optional<std::vector<FactorValue>> values_of_row(const std::vector<DesignTable::Cell>& row,
                                                                      std::span<const std::string> units);
  [[nodiscard]] Design points_of(const std::vector<std::vector<FactorValue>>& rows) const;

  FaultList& faults_;
  const Section& root_;
  std::vector<Factor>& factors_;
  std::span<const PlacedConstraint> constraints_;
  double radius_;
  SweepRuns runs_;
  Design points_;
  std::size_t left_out_ = 0;
};

}  // namespace monograin::sweep
