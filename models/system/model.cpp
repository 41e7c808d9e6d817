#include "system/model.hpp"

#include <algorithm>

namespace monograin {

bool Model::has_adhesion() const noexcept {
  return std::ranges::find(material, Dimension::surface_energy, &QuantityKey::dimension) != material.end();
}

bool Model::adheres(const std::map<std::string, double>& values) const {
  return std::ranges::any_of(material, [&](const QuantityKey& key) {
    const auto found = values.find(std::string(key.name));
    return key.dimension == Dimension::surface_energy && found != values.end() && found->second > 0.0;
  });
}

std::vector<std::string> reference_texts(const Model& model) {
  std::vector<std::string> texts;
  for (const Citation* reference : model.references) texts.push_back(citation_text(*reference));
  return texts;
}

}  // namespace monograin
