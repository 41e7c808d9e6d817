#include "scene/packing_law.hpp"

#include "packing/info.hpp"

namespace monograin {

packing::Law packing_law_of(const Scenario& scenario) {
  const auto value = [&scenario](const char* key) -> std::optional<double> {
    if (const auto found = scenario.material.find(key); found != scenario.material.end()) return found->second;
    const auto found = scenario.options.find(key);
    return found == scenario.options.end() ? std::nullopt : std::optional(std::get<double>(found->second));
  };
  return packing::make_law(packing::parameters_from(value, std::get<std::string>(scenario.options.at("coupling")),
                                                    std::get<bool>(scenario.options.at("continuous_jamming"))));
}

double initial_packing_fraction_of(const Scenario& scenario, const packing::Law& law) {
  const auto found = scenario.options.find("initial_packing_fraction");
  return found == scenario.options.end() ? law.jamming : std::get<double>(found->second);
}

}  // namespace monograin
