/// Constants of the laws of this folder, as `monograin models` shows them.
#pragma once

#include <vector>

#include "plastic/law.hpp"
#include "system/model.hpp"

namespace monograin::plastic {

/// Appends the constants of a law, each with its symbol in the source.
void add_law_parameters(const Law& law, std::vector<DerivedParameter>& list);

}  // namespace monograin::plastic
