#include "engine/sundials.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace monograin::sundials_boundary {

std::string worst_components(std::span<const Unknown> unknowns, std::span<const double> weights,
                             std::span<const double> errors) {
  std::vector<std::pair<double, std::string_view>> ranking;
  for (std::size_t k = 0; k < weights.size(); ++k)
    ranking.emplace_back(std::abs(weights[k] * errors[k]), unknowns[k].name);
  std::ranges::sort(ranking, std::greater<>{});
  std::string text;
  for (std::size_t k = 0; k < std::min<std::size_t>(3, ranking.size()); ++k) {
    text +=
        fmt::format("{}{} ({:.2g})", k == 0 ? "; largest local errors: " : ", ", ranking[k].second, ranking[k].first);
  }
  return text;
}

}  // namespace monograin::sundials_boundary
