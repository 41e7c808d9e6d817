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

/// Whether events of those names each have another event, or a corner of the program, within that share of their step:
/// where contacts open together, one that is a rounding error late may keep the force of a rounding error, and what a
/// program nearly reaches at a corner may be left out. A contact that was lost in company, and should not have been, is
/// made in company whenever that is.
[[nodiscard]] bool have_company(const Run& run, const EventNames& names, double share);

/// In words.
[[nodiscard]] std::string first_difference(const EventNames& a, const EventNames& b);

}  // namespace monograin
