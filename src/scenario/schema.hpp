/// JSON Schema (draft 7) of the scenario language, for editors.
#pragma once

#include <string>

namespace monograin {

/// The schema as formatted JSON text. Made from the model catalogue and the language tables, so it cannot fall behind
/// them.
[[nodiscard]] std::string scenario_schema();

}  // namespace monograin
