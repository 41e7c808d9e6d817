/// JSON Schema of single keys.
#pragma once

#include <nlohmann/json.hpp>

#include "scenario/language.hpp"

namespace monograin {

/// Schema of the values that a key accepts, with its description and default. The caller gives the `content` of tables:
/// the schema is `content` for a table, an array of `content` for tables.
[[nodiscard]] nlohmann::json value_schema(const KeySpec& spec,
                                          const nlohmann::json& content = nlohmann::json::object());

/// An object with these properties and no others.
[[nodiscard]] nlohmann::json object_schema(nlohmann::json properties, nlohmann::json required);

}  // namespace monograin
