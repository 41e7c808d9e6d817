/// Search for the equilibrium of a free centre at a given radius, and whether the contacts can hold it there.
#pragma once

#include <optional>

#include "mdr/particle.hpp"

namespace monograin::mdr {

/// Stiffness of a free centre that is so small that it is at a fold: a search for the balance of forces ends there with
/// a force that is least, and not zero, and rates of the centre change sign through infinity.
inline constexpr double k_at_fold = 1e-2;

/// True if an edge peels whose stiffness holds a free centre: that stiffness may come to an end.
[[nodiscard]] bool may_peel_off(const Particle& p) noexcept;
/// The contact that gives way where several of them cannot hold a free centre between them any more. The centre leaves
/// along its softest direction, to the side where it becomes softer still. Of the contacts whose edges peel, that one
/// gives way whose stiffness falls most on that path; where several are alike, the one whose wall withdraws fastest.
[[nodiscard]] std::optional<std::size_t> weakest_contact(Particle& p);
/// True if a plastic contact is softened past its peak so far that it may no longer constrain a free centre.
[[nodiscard]] bool is_any_softened(const Particle& p) noexcept;
/// Tangent stiffness of the centre in its softest direction, over what it would be if no edge peeled and no contact
/// were softened past its peak. Zero where the equilibrium turns back.
[[nodiscard]] CentreStiffness centre_stiffness(Particle& p);
/// Distance of that stiffness from the fold.
[[nodiscard]] double centre_stiffness_guard(Particle& p);

/// Beyond its greatest force a plastic contact that gives way bears less: where several do, one of them may go in while
/// the others unload, and the centre has other equilibria beside the one where all go in.
/// @throws std::domain_error there
void check_softening(const Particle& p);

/// Moves the centre to the balance of forces at a given radius. On the way there the volume need not be defined: where
/// the radius has grown, walls that the centre gives way to would press it by as much.
/// @throws std::domain_error where no balance is found
void move_centre(Particle& p, double xi, std::span<double> y);

/// Next to a fold there is, beside the equilibrium that holds the centre, another one that does not, to which a search
/// from afar may lead, and others beyond pull-off. Between them the contacts hold the centre neither way; the
/// equilibrium sought is about as far beyond that state.
/// @param is_balanced  whether y is such an equilibrium, and not merely where a search has got stuck
/// @return whether it has found the equilibrium sought
bool leave_saddle(Particle& p, double xi, std::span<double> y, bool is_balanced);

/// Moves the centre towards the balance of forces, as far as the present branches of the contacts lead.
/// @return false where they do not lead anywhere
[[nodiscard]] bool approach_balance(Particle& p, double xi, std::span<double> y);

}  // namespace monograin::mdr
