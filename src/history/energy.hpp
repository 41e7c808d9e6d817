/// Whether a run gives back energy that was never put in.
#pragma once

#include <optional>
#include <string>

#include "history/table.hpp"

namespace monograin {

/// The largest fall of the dissipation, work less stored energy, between two rows of a history. The second law allows
/// none.
struct DissipationFall {
  double from = 0.0;    ///< time of the largest dissipation before the fall [s]
  double to = 0.0;      ///< time of the least dissipation after it [s]
  double amount = 0.0;  ///< by how much the dissipation falls [J], > 0
  double scale = 0.0;   ///< largest magnitude of work and stored energy in the history [J]

  [[nodiscard]] double share() const noexcept { return amount / scale; }
};

/// Finds the largest fall of the dissipation in a history with columns `work` and `stored_energy`.
///
/// @param radius  initial radius R0 [m], >= 0: contacts are rounded as lengths of the order of R0 are, and the energy
///                that this makes is no fall
/// @return empty where the dissipation never falls, or where the history has no such columns
[[nodiscard]] std::optional<DissipationFall> largest_dissipation_fall(const Table& history, double radius);

/// The warning for a history whose dissipation falls by more than 1e-6 of its scale: when, and by how much.
///
/// @param model  whose page says where its law may do so
/// @param rtol   relative tolerance of the integration; 0 where the states were solved for
[[nodiscard]] std::optional<std::string> energy_warning(const Table& history, double radius, const std::string& model,
                                                        double rtol);

}  // namespace monograin
