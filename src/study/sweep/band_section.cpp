#include "study/sweep/band_section.hpp"

#include <fmt/format.h>

#include <optional>

#include "scenario/cells.hpp"
#include "scenario/words.hpp"
#include "study/sweep/sweep_language.hpp"

namespace monograin::sweep {
namespace {

/// Reads the percentiles, ascending numbers from 0 to 100. Entries after a fault are left out.
std::vector<double> percentiles_in(Reading& reading, const Section& section) {
  std::vector<double> percentiles;
  const std::vector<std::string> texts = section.texts("percentiles");
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const std::optional<double> value = number_in(texts[i]);
    const bool is_percentage = value && *value >= 0.0 && *value <= 100.0;
    if (!is_percentage || (i > 0 && *value <= percentiles.back())) {
      reading.faults.add(section.value_place("percentiles", i),
                         fmt::format("percentiles: '{}': expected ascending numbers between 0 and 100, for example "
                                     "[5, 50, 95]",
                                     shown(texts[i])));
      break;
    }
    percentiles.push_back(*value);
  }
  return percentiles;
}

}  // namespace

PlacedBands bands_in(Reading& reading, const Section& root) {
  const std::vector<KeySpec> keys = band_keys();
  const Section section(reading, root.table("bands", "[bands]"), keys);
  PlacedBands bands{.request = {.x = section.text("x"), .y = section.texts("y")}};
  bands.columns.push_back({bands.request.x, section.value_place("x")});
  for (std::size_t i = 0; i < bands.request.y.size(); ++i) {
    bands.columns.push_back({bands.request.y[i], section.value_place("y", i)});
  }
  bands.request.points = static_cast<int>(section.number("points").value_or(bands.request.points));
  if (auto percentiles = percentiles_in(reading, section); !percentiles.empty()) {
    bands.request.percentiles = std::move(percentiles);
  }
  return bands;
}

}  // namespace monograin::sweep
