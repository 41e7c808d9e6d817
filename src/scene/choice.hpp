/// Options of a checked scenario as a model's own types.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

#include "scenario/scenario.hpp"

namespace monograin {

/// One of an option's words as the enumerator at the same place.
template <class Enum, std::size_t N>
Enum choice(const Scenario& scenario, const char* key, const std::pair<const char*, Enum> (&table)[N]) {
  const std::string& word = std::get<std::string>(scenario.options.at(key));
  for (const auto& [name, value] : table) {
    if (word == name) return value;
  }
  throw std::logic_error(fmt::format("option {} = '{}' was checked but is not bound", key, word));
}

}  // namespace monograin
