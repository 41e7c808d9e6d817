/// What the language says of the key that a path leads to. Internal to readers of TOML files: includes the library.
#pragma once

#include <toml++/toml.h>

#include <optional>
#include <string>
#include <string_view>

#include "scenario/language.hpp"

namespace monograin {

/// The key, or why no scenario of that model can have one there.
struct KeyAnswer {
  std::optional<KeySpec> spec;
  std::string problem;  ///< empty: there is a spec
};

/// @param path   as in overrides: `material.yield_stress`, `loading.steps[0].displacement`
/// @param root   the scenario: its steps and walls say what keys they can have
/// @param model  name of the model whose language counts
[[nodiscard]] KeyAnswer key_at(std::string_view path, const toml::table& root, std::string_view model);

}  // namespace monograin
