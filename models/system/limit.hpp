/// Where the equations of a model end.
#pragma once

#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>

namespace monograin {

/// Why a run ends before its program does: one value for each cause, whatever has found it, a guard or a trial.
enum class Limit {
  // particle and walls
  free_surface_used_up,
  half_volume,
  wall_at_centre,
  walls_meet,
  cell_filled,
  contact_as_wide_as_particle,
  surface_covered,
  overlap_of_diameter,
  caps_intersect,
  greatest_force,
  wall_would_pull,
  no_unloading_law,
  applicability,
  source_data_end,
  pressure_table_end,
  no_consistent_regimes,
  // free centre
  centre_not_held,
  centre_driven_away,
  centre_fold,
  centre_softening,
  // material point and packing
  pores_closed,
  cap_centre_at_zero_pressure,
  cap_axis_ratio_zero,
  cap_arc_too_wide,
  poisson_half,
  too_stiff,
  loss_of_uniqueness,
  greatest_strain,
  greatest_stress,
  infinite_stress,
  // any model
  no_solution,       ///< a state was not found, though no limit of the model is known there
  unequal_durations  ///< the program gives walls different times for one step
};

/// Name of a limit in run.json, e.g. "walls-meet".
[[nodiscard]] std::string_view code(Limit limit) noexcept;

/// The message for a limit; no full stop.
[[nodiscard]] std::string_view sentence(Limit limit) noexcept;

/// A limit of a model, and the number that shows that it is met.
struct LimitPoint {
  Limit limit = Limit::no_solution;
  int contact_class = -1;       ///< -1: the particle
  std::string_view quantity{};  ///< what the value is, e.g. "displacement/R0"; empty: there is none
  double value = std::numeric_limits<double>::quiet_NaN();
};

/// The sentence of a limit, with a remark and its value where there are such, e.g. "the walls meet (displacement/R0 =
/// 1)".
[[nodiscard]] std::string text_of(const LimitPoint& point, std::string_view remark = {});

/// The equations have no value beyond a limit. Thrown by trials as well as by states; a caller comes nearer by smaller
/// steps, or ends.
class DomainError : public std::domain_error {
 public:
  explicit DomainError(const LimitPoint& point);
  explicit DomainError(Limit limit) : DomainError(LimitPoint{.limit = limit}) {}
  /// @param remark  stands behind the sentence of the limit: what to do
  DomainError(const LimitPoint& point, std::string_view remark);
  /// @param message  says more than sentence(limit) does
  DomainError(Limit limit, const std::string& message);

  [[nodiscard]] const LimitPoint& point() const noexcept { return point_; }

 private:
  LimitPoint point_;
};

/// The error itself, or one of Limit::no_solution with its message.
[[nodiscard]] DomainError as_domain_error(const std::domain_error& error);

}  // namespace monograin
