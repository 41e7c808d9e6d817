/// The spec of the key at a path, according to the language. Internal to readers of TOML files: includes the library.
#pragma once

#include <toml++/toml.h>

#include <optional>
#include <string>
#include <string_view>

#include "scenario/language.hpp"

namespace monograin {

/// The spec of a key, or the reason why no scenario of the model can have the key.
struct KeyAnswer {
  std::optional<KeySpec> spec;
  std::string problem;  ///< empty: there is a spec
};

/// @param path   as in overrides: `material.yield_stress`, `loading.steps[0].displacement`, `loading.wall[2-5].gap`
/// @param root   the scenario: its steps and walls determine which keys they can have
/// @param model  name of the model whose language is used
[[nodiscard]] KeyAnswer key_at(std::string_view path, const toml::table& root, std::string_view model);

}  // namespace monograin
