/// Which guards fire at the instant of an event.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/guard_set.hpp"
#include "engine/integrator.hpp"

namespace monograin {

/// True if there are guards, and all of them mark an instant and change nothing.
[[nodiscard]] bool are_marks(const GuardSet& guard_set, std::span<const std::size_t> guards);

/// Guards that fire at xi, in ascending order: those the integrator found, and those that reach zero within its
/// accuracy at the same instant.
/// @param last  step coordinate where the integrator's last step began
/// @param y     state at xi
[[nodiscard]] std::vector<std::size_t> fired_guards(GuardSet& guard_set, Integrator& integrator, double last, double xi,
                                                    std::span<const double> y);

}  // namespace monograin
