/// In which events two runs of a program differ.
#pragma once

#include <string>
#include <vector>

#include "history/run.hpp"

namespace monograin {

using EventNames = std::vector<std::string>;

/// Names of events and their classes, in no order: events at one instant may come in any.
[[nodiscard]] EventNames sorted_events(const Run& run);

/// Events of one list that the other does not have.
[[nodiscard]] EventNames missing_from(const EventNames& other, const EventNames& names);

/// True if every named event coincides, to within a share of its step, with another event or with a corner of the
/// program, so that round-off decides their order. Contacts that open together may keep the force of a round-off where
/// one of them is late, and a program may nearly reach an event at a corner.
[[nodiscard]] bool coincide_with_others(const Run& run, const EventNames& names, double share);

/// In words.
[[nodiscard]] std::string first_difference(const EventNames& a, const EventNames& b);

}  // namespace monograin
