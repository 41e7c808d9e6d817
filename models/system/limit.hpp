/// Limits of the models: states beyond which the equations have no solution.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "system/resolution.hpp"

namespace monograin {

/// Cause that ends a run before its program ends. A cause has one value, whether a guard or a trial step has met it.
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
  no_solution,       ///< the solver found no state, and no limit of the model explains it
  unequal_durations  ///< the program gives walls different times for one step
};

/// Name of a limit in run.json, e.g. "walls-meet".
[[nodiscard]] std::string_view code(Limit limit) noexcept;

/// The message for a limit; no full stop.
[[nodiscard]] std::string_view sentence(Limit limit) noexcept;

/// A limit that a run has met, with the value of the quantity that shows it.
struct LimitPoint {
  Limit limit = Limit::no_solution;
  int contact_class = -1;       ///< -1: the particle
  std::string_view quantity{};  ///< name of the quantity, e.g. "displacement/R0"; empty: the limit has no value
  double value = k_nan;
};

/// Message for a limit point: the sentence of the limit, a remark if there is one, and the value if there is one, such
/// as "the walls meet (displacement/R0 = 1)".
[[nodiscard]] std::string text_of(const LimitPoint& point, std::string_view remark = {});

/// Thrown if the equations are evaluated beyond a limit, in a trial step as well as in an accepted state. The caller
/// approaches the limit with smaller steps, or ends the run.
class DomainError : public std::domain_error {
 public:
  explicit DomainError(const LimitPoint& point);
  explicit DomainError(Limit limit) : DomainError(LimitPoint{.limit = limit}) {}
  /// @param remark  advice for the user that follows the sentence of the limit
  DomainError(const LimitPoint& point, std::string_view remark);
  /// @param message  replaces sentence(limit) with a more precise text
  DomainError(Limit limit, const std::string& message);

  [[nodiscard]] const LimitPoint& point() const noexcept { return point_; }

 private:
  LimitPoint point_;
};

/// Returns a DomainError as it is, and wraps any other std::domain_error as Limit::no_solution with its message.
[[nodiscard]] DomainError as_domain_error(const std::domain_error& error);

}  // namespace monograin
