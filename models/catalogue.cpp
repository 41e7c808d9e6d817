#include "catalogue.hpp"

#include <algorithm>
#include <array>

#include "compressible/contact_info.hpp"
#include "compressible/material_point_info.hpp"
#include "elastic/nonlocal_info.hpp"
#include "mdr/info.hpp"
#include "packing/info.hpp"
#include "plastic/info.hpp"

namespace monograin {
std::span<const ModelInfo> model_catalogue() noexcept {
  static const std::array k_models{
      mdr::hertz_info(),
      mdr::mdr_info(),
      plastic::similarity_info(),
      plastic::semimech_info(),
      plastic::hardening_info(),
      nonlocal::nonlocal_info(),
      compressible::contact_info(),
      packing::packing_info(),
      compressible::material_point_info(),
  };
  return k_models;
}

const ModelInfo* find_model(std::string_view name) noexcept {
  const auto models = model_catalogue();
  const auto found = std::ranges::find(models, name, &ModelInfo::name);
  return found == models.end() ? nullptr : &*found;
}

}  // namespace monograin
