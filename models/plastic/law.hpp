/// One of the laws of this folder, for a contact that is loaded for the first time.
/// Conventions: plastic/compression.hpp; x is the displacement of a wall over R.
#pragma once

#include <optional>
#include <variant>
#include "plastic/hardening.hpp"
#include "plastic/semimech.hpp"
#include "plastic/similarity.hpp"

namespace monograin::plastic {

using Law = std::variant<SimilarityLaw, SemimechLaw, HardeningLaw>;

/// Regime from first touch on.
[[nodiscard]] Regime first_regime(const Law& law) noexcept;

/// Ends of a law's regimes, in ascending order. The boundary after which the regime is `undefined` ends the law.
[[nodiscard]] Boundaries boundaries(const Law& law);

/// State of a contact by the formulas of one regime, also a little outside of it, for x > 0.
/// @throws std::domain_error where they end
[[nodiscard]] ContactState state_in(const Law& law, Regime regime, double x);

/// x under a force over S R^2, whatever the regime; 0 for no force.
/// @param near  initial guess of x; 0: none is known
/// @throws std::domain_error for forces that the law does not reach
[[nodiscard]] double approach_under(const Law& law, double force, double near = 0.0);

/// int P dx of one wall over S R^3, from first touch.
/// @throws std::domain_error beyond the law's limit
[[nodiscard]] double work_per_wall(const Law& law, double x);

/// int P dx of one wall over S R^3 from the beginning of a regime to x, which may lie a little outside of it.
/// @throws std::domain_error as state_in
[[nodiscard]] double work_in(const Law& law, Regime regime, double x);

/// x at which the law ends: where the walls meet, or the pressure becomes infinite.
[[nodiscard]] double limit(const Law& law) noexcept;

/// x up to which the source compares the law with finite elements.
[[nodiscard]] double calibrated_end(const Law& law) noexcept;

/// Exponent n of the power P ~ x^n with which the force begins.
[[nodiscard]] double first_power(const Law& law) noexcept;

/// True if the contact is elastic, and gives back its work, before it yields.
[[nodiscard]] bool begins_elastic(const Law& law) noexcept;

/// x at which neighbouring contacts touch; none where the law has no neighbours.
[[nodiscard]] std::optional<double> impingement(const Law& law);

}  // namespace monograin::plastic
