/// Readers of text that a user wrote, fed with any bytes.
#pragma once

#include <string_view>

namespace monograin {

/// Reads a scenario, or what its first line "# csv" says: a history, a curve, a table of columns and measured data of
/// the rest. Faults of the text are expected.
/// @throws nothing that a reader does not promise; anything else is a bug
void read_any(std::string_view text);

}  // namespace monograin
