/// The table [bands] of a sweep file. For readers of TOML files: includes the library.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scenario/scenario.hpp"
#include "scenario/section.hpp"
#include "study/sweep/sweep_file.hpp"

namespace monograin::sweep {

/// A request for bands, with the positions of its columns in the file.
struct PlacedBands {
  BandRequest request;
  std::vector<std::pair<std::string, SourceLocation>> columns;
};

[[nodiscard]] PlacedBands bands_in(Reading& reading, const Section& root);

/// Reports columns that histories of a scenario lack. Called before the first run, because there may be many long ones.
void check_columns(const PlacedBands& bands, const CheckedScenario& scenario, FaultList& faults);

}  // namespace monograin::sweep
