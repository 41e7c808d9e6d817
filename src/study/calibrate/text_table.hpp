/// Tables for a terminal.
#pragma once

#include <string>
#include <vector>

namespace monograin {

using TextRow = std::vector<std::string>;

/// Rows with their cells below each other, the first column to the left and the others to the right. Rows may be
/// shorter than the first one.
[[nodiscard]] std::string aligned(const std::vector<TextRow>& rows);

}  // namespace monograin
