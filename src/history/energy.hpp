/// Check of the second law: a run must not release energy that was never put in.
#pragma once

#include <optional>
#include <string>

#include "history/table.hpp"

namespace monograin {

/// Least fall of the dissipation that gets a warning, over the scale; laws make smaller corrections at their
/// transitions.
inline constexpr double k_least_noted_fall = 1e-6;

/// Largest fall of the dissipation (work minus stored energy) between two rows of a history. The second law forbids any
/// fall.
struct DissipationFall {
  double from = 0.0;    ///< time of the largest dissipation before the fall [s]
  double to = 0.0;      ///< time of the least dissipation after it [s]
  double amount = 0.0;  ///< fall of the dissipation [J], > 0
  double scale = 0.0;   ///< largest magnitude of work and stored energy in the history [J]

  /// The fall over the scale.
  [[nodiscard]] double share() const noexcept { return amount / scale; }
};

/// Finds the largest fall of the dissipation in a history with columns `work` and `stored_energy`.
///
/// @param radius  initial radius R0 [m], >= 0: overlaps have the round-off of lengths of the order of R0, and a fall
///                within the energy of that round-off does not count
/// @return empty if the dissipation never falls, or the history lacks these columns
[[nodiscard]] std::optional<DissipationFall> largest_dissipation_fall(const Table& history, double radius);

/// Warning with time and amount if the dissipation of a history falls by more than 1e-6 of its scale; empty if not.
///
/// @param radius  initial radius R0 [m], >= 0
/// @param model   name of the model, whose page says where its law may create energy
/// @param rtol    relative tolerance of the integration; 0 with the direct form
[[nodiscard]] std::optional<std::string> energy_warning(const Table& history, double radius, const std::string& model,
                                                        double rtol);

}  // namespace monograin
