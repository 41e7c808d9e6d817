#include "scene/compressible_law.hpp"

#include <optional>
#include <variant>

#include "compressible/regressions.hpp"

namespace monograin {
namespace {

using namespace compressible;

std::optional<double> option_number(const Scenario& scenario, const char* key) {
  const auto found = scenario.options.find(key);
  return found == scenario.options.end() ? std::nullopt : std::optional(std::get<double>(found->second));
}

UnloadingRule tabulated_rule(const SampledCurve& table, double stiffness_over_shear) {
  std::vector<UnloadingRow> rows;
  for (std::size_t k = 0; k < table.x.size(); ++k) {
    rows.push_back({table.x[k], {table.y[k], {table.values[0][k], table.values[1][k]}}});
  }
  return interpolated_rule(rows, stiffness_over_shear);
}

}  // namespace

CompressibleLaw compressible_law_of(const Scenario& scenario) {
  const double stiffness_ratio = scenario.material.at("stiffness_ratio");
  const auto shear = scenario.material.find("shear_ratio");
  const auto shear_ratio = shear == scenario.material.end() ? std::nullopt : std::optional(shear->second);
  const GivenLaw given{option_number(scenario, "k"), option_number(scenario, "delta_t"), option_number(scenario, "a")};
  CompressibleLaw law{.loading = loading_law_of(given, stiffness_ratio, shear_ratio),
                      .hertz_stiffness = hertz_stiffness(stiffness_ratio, scenario.material.at("nu0")),
                      .unloading = UnloadingRule(),
                      .reservations = {}};
  if (is_extrapolated(given, stiffness_ratio)) {
    law.reservations.push_back({"softer than the materials that delta_t and a were fitted to, from 4.5 on",
                                "stiffness_ratio", stiffness_ratio});
  }
  if (const auto table = scenario.curves.find("unloading_table"); table != scenario.curves.end()) {
    law.unloading = tabulated_rule(table->second, stiffness_ratio / *shear_ratio);
    return law;
  }
  const UnloadingShape hertz;
  const auto alpha = option_number(scenario, "alpha");
  const auto beta = option_number(scenario, "beta");
  law.unloading = UnloadingRule(UnloadingShape{alpha.value_or(hertz.exponent), beta.value_or(hertz.stiffness_ratio)});
  if (!alpha) {
    law.reservations.push_back(
        {"the source has no law for alpha, and it is not given; Hertz's stands in", "alpha", hertz.exponent});
  }
  if (!beta) {
    law.reservations.push_back(
        {"the source has no law for beta, and it is not given; Hertz's stands in", "beta", hertz.stiffness_ratio});
  }
  return law;
}

}  // namespace monograin
