/// Search for the equilibrium of a free centre at a given radius, and whether the contacts can hold it there.
#pragma once

#include <optional>

#include "mdr/particle.hpp"

namespace monograin::mdr {

/// Tangent stiffness of a free centre (CentreStiffness::value) below which the centre is at a fold. A search for the
/// balance may end there at a nonzero minimum of the net force, and rates of the centre change sign through infinity.
inline constexpr double k_at_fold = 1e-2;

/// True if the edge of a contact that acts on a free centre peels under displacement control: the stiffness with which
/// it holds the centre may vanish.
[[nodiscard]] bool may_peel_off(const Particle& p) noexcept;
/// The contact that gives way when the contacts together no longer hold a free centre; none if no edge peels. The
/// centre leaves along its softest direction, to the side where it becomes softer still. The peeling contact whose
/// stiffness falls most on that path gives way; among equal ones, the contact whose wall withdraws fastest.
[[nodiscard]] std::optional<std::size_t> weakest_contact(Particle& p);
/// True if a plastic contact is softened past its peak so far that it may no longer constrain a free centre.
[[nodiscard]] bool is_any_softened(const Particle& p) noexcept;
/// Stiffness of the centre in its softest direction over its reference, as CentreStiffness says. Zero at a fold of the
/// equilibrium.
[[nodiscard]] CentreStiffness centre_stiffness(Particle& p);
/// Guard of a fold: centre_stiffness() less the value at which the fold counts as reached; negative beyond.
[[nodiscard]] double centre_stiffness_guard(Particle& p);

/// Checks that contacts softened past their peak leave the equilibrium of a free centre unique. The force of such a
/// contact falls with its overlap. With several of them, one may soften further while the others unload, and the
/// equilibrium is not unique. Does nothing while an edge peels.
/// @throws std::domain_error if the stiffness of the centre is negative in some direction
void check_softening(const Particle& p);

/// Moves the centre to the balance of forces at a given radius. In trial states the volume need not be defined: before
/// the centre gives way, overlaps include all that the radius has grown.
/// @throws std::domain_error if no balance is found, it is not unique (check_softening()), or its volume is not defined
void move_centre(Particle& p, double xi, std::span<double> y);

/// Leaves a state that does not hold the centre for the equilibrium that does. Next to a fold there are two equilibria,
/// a stable one and a saddle, and others beyond pull-off; Newton's method from afar may find the wrong one. About
/// half-way from the saddle to the stable equilibrium, the stiffness of the centre vanishes.
/// @param is_balanced  true: y is an equilibrium; false: a search for the balance got stuck there
/// @return true if y is now the equilibrium that holds the centre
/// @throws std::domain_error if y was balanced and no equilibrium short of pull-off is found
bool leave_saddle(Particle& p, double xi, std::span<double> y, bool is_balanced);

/// Moves the centre by a Newton step towards the balance of forces, halved until the present branches of all contacts
/// are defined at its end.
/// @return false if no such step exists
[[nodiscard]] bool approach_balance(Particle& p, double xi, std::span<double> y);

}  // namespace monograin::mdr
