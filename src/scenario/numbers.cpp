#include "scenario/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "scenario/language.hpp"
#include "scenario/plain_paths.hpp"

namespace monograin {
namespace {

constexpr std::string_view k_angle = "loading.angle";

void append_quantities(std::vector<NumberKey>& numbers, std::string_view table, std::span<const KeySpec> keys) {
  for (const KeySpec& key : keys) {
    if (key.kind != KeySpec::Kind::quantity) continue;
    numbers.push_back({fmt::format("{}.{}", table, key.name), key.meaning, key.dimension, finite_range(key)});
  }
}

}  // namespace

std::vector<NumberKey> number_keys(const CheckedScenario& scenario) {
  const Language& language = language_of(scenario.model);
  std::vector<NumberKey> numbers;
  append_quantities(numbers, "material", language.material);
  append_quantities(numbers, scenario.model, language.options);
  if (scenario.loading.configuration == Loading::Configuration::oblique_die) {
    const KeySpec* angle = find_key(language.loading, "angle");
    if (angle != nullptr) append_quantities(numbers, "loading", std::span(angle, 1));
  }
  const KeySpec* gap = find_key(language.wall, "gap");
  for (std::size_t wall = 0; gap != nullptr && wall < scenario.loading.walls.size(); ++wall) {
    numbers.push_back({gap_path(wall), gap->meaning, gap->dimension, finite_range(*gap)});
  }
  append_quantities(numbers, "particle", language.particle);
  return numbers;
}

std::string gap_path(std::size_t wall) { return fmt::format("loading.wall[{}].gap", wall); }

void set_number(CheckedScenario& scenario, std::string_view path, double value) {
  if (path == k_angle) {
    scenario.loading.oblique_angle = value;
  } else if (path.starts_with(k_of_material)) {
    scenario.material.insert_or_assign(std::string(path.substr(k_of_material.size())), value);
  } else if (path.starts_with(scenario.model + '.')) {
    scenario.options.insert_or_assign(std::string(path.substr(scenario.model.size() + 1)), value);
  } else {
    for (const std::string& plain : plain_paths(path)) {
      std::size_t wall = 0;
      while (wall < scenario.loading.walls.size() && plain != gap_path(wall)) ++wall;
      if (wall == scenario.loading.walls.size()) {
        throw std::logic_error(fmt::format("'{}' is no number that can be set on its own", path));
      }
      scenario.loading.walls[wall].gap = value;
    }
  }
}

std::optional<NumberKey> number_of_range(const std::vector<NumberKey>& numbers, std::string_view path) {
  const std::vector<std::string> paths = plain_paths(path);
  std::optional<NumberKey> number;
  for (const std::string& plain : paths) {
    const auto known = std::ranges::find(numbers, plain, &NumberKey::path);
    if (paths.size() == 1 || known == numbers.end()) return std::nullopt;
    number = *known;
  }
  number->path = path;
  return number;
}

}  // namespace monograin
