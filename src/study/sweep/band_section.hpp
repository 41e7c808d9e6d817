/// The table [bands] of a sweep file. For readers of TOML files: includes the library.
#pragma once

#include <vector>

#include "scenario/section.hpp"
#include "study/sweep/column_section.hpp"
#include "study/sweep/sweep_file.hpp"

namespace monograin::sweep {

/// A request for bands, with the positions of its columns in the file.
struct PlacedBands {
  BandRequest request;
  std::vector<PlacedColumn> columns{};
};

[[nodiscard]] PlacedBands bands_in(Reading& reading, const Section& root);

}  // namespace monograin::sweep
