/// JSON Schema (draft 7) of the scenario language, for editors.
#pragma once

#include <string>

namespace monograin {

/// The schema as formatted JSON text, made from the model catalogue and the language tables, so that it agrees with
/// them.
[[nodiscard]] std::string scenario_schema();

}  // namespace monograin
