/// Reads tables in the place of a step's target: values over time from a file, or a sine. Internal: includes the TOML
/// library.
#pragma once

#include <vector>

#include "scenario/language.hpp"
#include "scenario/scenario.hpp"
#include "scenario/section.hpp"

namespace monograin {

/// Reads the table below the key of a form, and writes it out as ramps, each with its leg and its duration. Empty if
/// the table has faults.
/// @param files  takes the text of a file that the table names
[[nodiscard]] std::vector<Step> read_course(Reading& reading, const Section& step, const StepForm& form,
                                            FileTexts& files);

}  // namespace monograin
