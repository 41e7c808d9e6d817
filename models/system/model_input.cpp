#include "system/model_input.hpp"

namespace monograin {

std::vector<DerivedParameter> material_parameters(
    const ModelInput& input, std::initializer_list<std::pair<const char*, std::string_view>> keys) {
  std::vector<DerivedParameter> list;
  for (const auto& [key, unit] : keys) {
    if (const auto value = input.optional_material(key)) list.push_back({key, *value, unit});
  }
  return list;
}

}  // namespace monograin
