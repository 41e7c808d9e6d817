#include "scenario/plain_paths.hpp"

#include <charconv>
#include <cstddef>
#include <optional>
#include <system_error>
#include <utility>

namespace monograin {
namespace {

constexpr std::size_t k_most_paths = 1000;

/// An index at the begin of a text, which is then removed.
std::optional<std::size_t> take_index(std::string_view& text) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error != std::errc{}) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return index;
}

/// First and last index of a range: the text between two brackets.
std::optional<std::pair<std::size_t, std::size_t>> range_in(std::string_view text) {
  const auto first = take_index(text);
  if (!first || !text.starts_with('-')) return std::nullopt;
  text.remove_prefix(1);
  const auto last = take_index(text);
  if (!last || !text.empty() || *last <= *first || *last - *first >= k_most_paths) return std::nullopt;
  return std::pair(*first, *last);
}

}  // namespace

std::vector<std::string> plain_paths(std::string_view path) {
  const std::vector<std::string> itself{std::string(path)};
  for (std::size_t open = path.find('['); open != std::string_view::npos; open = path.find('[', open + 1)) {
    const std::size_t close = path.find(']', open);
    if (close == std::string_view::npos) break;
    const auto range = range_in(path.substr(open + 1, close - open - 1));
    if (!range) continue;
    std::vector<std::string> paths;
    const std::vector<std::string> ends = plain_paths(path.substr(close));
    for (std::size_t index = range->first; index <= range->second; ++index) {
      for (const std::string& end : ends) {
        paths.push_back(std::string(path.substr(0, open + 1)).append(std::to_string(index)).append(end));
      }
    }
    return paths.size() <= k_most_paths ? paths : itself;
  }
  return itself;
}

}  // namespace monograin
