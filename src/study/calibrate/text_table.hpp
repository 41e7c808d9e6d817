/// Tables for a terminal.
#pragma once

#include <string>
#include <vector>

namespace monograin {

using TextRow = std::vector<std::string>;

/// Aligns the cells of rows in columns, the first one on the left and the others on the right. Rows may be shorter than
/// the first one.
[[nodiscard]] std::string aligned(const std::vector<TextRow>& rows);

}  // namespace monograin
