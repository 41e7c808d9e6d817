/// Differences between the events of two runs of a program.
#pragma once

#include <string>
#include <vector>

#include "history/run.hpp"

namespace monograin {

using EventNames = std::vector<std::string>;

/// Events as "class name", sorted by these words: events at one instant may happen in any order.
[[nodiscard]] EventNames sorted_events(const Run& run);

/// Events of `names` that `other` does not have.
[[nodiscard]] EventNames missing_from(const EventNames& other, const EventNames& names);

/// True if every named event coincides, to within a share of its step, with another event or with a corner of the
/// program, so that round-off decides their order. If contacts open together and one of them is late, it may keep a
/// force of the size of round-off; and a program may nearly reach an event at a corner.
[[nodiscard]] bool coincide_with_others(const Run& run, const EventNames& names, double share);

/// The first event that only one of two lists has, in words.
[[nodiscard]] std::string first_difference(const EventNames& a, const EventNames& b);

}  // namespace monograin
