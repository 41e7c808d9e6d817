#include "scenario/plain_paths.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>
#include <utility>

namespace monograin {
namespace {

constexpr std::size_t k_most_paths = 1000;

/// First and last index of a range: the text between two brackets.
std::optional<std::pair<std::size_t, std::size_t>> range_in(std::string_view text) {
  const auto first = take_index(text);
  if (!first || !text.starts_with('-')) return std::nullopt;
  text.remove_prefix(1);
  const auto last = take_index(text);
  if (!last || !text.empty() || *last <= *first) return std::nullopt;
  return std::pair(*first, *last);
}

}  // namespace

std::optional<std::size_t> take_index(std::string_view& text) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error != std::errc{}) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return index;
}

std::vector<std::string> plain_paths(std::string_view path) {
  std::vector<std::string> paths{std::string()};
  for (std::string_view rest = path; !rest.empty();) {
    const std::size_t open = rest.find('[');
    const std::size_t close = std::min(open == rest.npos ? rest.size() : rest.find(']', open), rest.size());
    const auto range = close < rest.size() ? range_in(rest.substr(open + 1, close - open - 1)) : std::nullopt;
    const auto [first, last] = range.value_or(std::pair<std::size_t, std::size_t>(0, 0));
    if (last - first >= k_most_paths / paths.size()) return {std::string(path)};
    std::vector<std::string> longer;
    for (const std::string& before : paths) {
      for (std::size_t index = first; index <= last; ++index) {
        longer.push_back(before + std::string(rest.substr(0, range ? open + 1 : close)));
        if (range) longer.back() += std::to_string(index);
      }
    }
    paths = std::move(longer);
    rest.remove_prefix(close);
    if (rest.starts_with(']')) {
      for (std::string& before : paths) before += ']';
      rest.remove_prefix(1);
    }
  }
  return paths;
}

}  // namespace monograin
