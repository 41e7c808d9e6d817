/// Paths that name several keys at once.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace monograin {

/// Takes an index from the begin of a text; none, and the text as it was, if there is no number.
[[nodiscard]] std::optional<std::size_t> take_index(std::string_view& text);

/// The paths that a path with ranges of indices names: `loading.wall[2-5].gap` names the gaps of four walls. A path
/// without a range names itself.
/// @return the path itself where a range is none: not two indices in rising order, or of more than 1000 entries in all
[[nodiscard]] std::vector<std::string> plain_paths(std::string_view path);

}  // namespace monograin
