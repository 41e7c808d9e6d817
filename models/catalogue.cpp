#include "catalogue.hpp"

#include <algorithm>
#include <array>

#include "compressible/contact_info.hpp"
#include "elastic/nonlocal_info.hpp"
#include "mdr/info.hpp"
#include "packing/info.hpp"
#include "plastic/info.hpp"

namespace monograin {
namespace {

using std::string_view;

constexpr std::array<string_view, 1> k_reserved{"material-point"};

}  // namespace

std::span<const ModelInfo> model_catalogue() noexcept {
  static const std::array k_models{
      mdr::hertz_info(),         mdr::mdr_info(),           plastic::similarity_info(),   plastic::semimech_info(),
      plastic::hardening_info(), nonlocal::nonlocal_info(), compressible::contact_info(), packing::packing_info(),
  };
  return k_models;
}

std::span<const std::string_view> reserved_models() noexcept { return k_reserved; }

const ModelInfo* find_model(std::string_view name) noexcept {
  const auto models = model_catalogue();
  const auto found = std::ranges::find(models, name, &ModelInfo::name);
  return found == models.end() ? nullptr : &*found;
}

}  // namespace monograin
