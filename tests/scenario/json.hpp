/// TOML as JSON values, as an editor would show it to a schema validator.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace monograin {

/// None where the text is not TOML. NaN and infinity stay what they are.
[[nodiscard]] std::optional<nlohmann::json> toml_as_json(std::string_view text);

/// True if the schema of scenarios accepts the value.
[[nodiscard]] bool schema_accepts(const nlohmann::json& value);

}  // namespace monograin
