#include "scenario/document.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scenario/faults.hpp"
#include "scenario/words.hpp"

namespace monograin {
namespace {

constexpr std::size_t k_most_key_parts = 32;
constexpr std::size_t k_longest_description = 200;

/// Finds keys of very many parts. The parser makes one table per part, and tables nested without bound would overflow
/// the stack when they are destroyed; for values it has a limit of its own.
class KeyScanner {
 public:
  explicit KeyScanner(std::string_view text) : text_(text) {}

  /// Throws at the first key that has too many parts.
  void scan(const std::string& origin) {
    while (at_ < text_.size()) {
      step_over_token();
      if (dots_ >= k_most_key_parts) {
        throw_fault({origin, line_, at_ - line_start_ + 1},
                    fmt::format("the key has too many parts; expected at most {}", k_most_key_parts));
      }
    }
  }

 private:
  void step_over_token() {
    const char c = text_[at_];
    if (c == '"' || c == '\'') return skip_string(c);
    if (c == '#') return skip_to(text_.find('\n', at_));
    if (c == '.') ++dots_;
    if (c == '\n' || c == '=' || c == ',' || c == '{' || c == '[') dots_ = 0;
    advance();
  }

  void skip_string(char quote) {
    const std::string long_quote(3, quote);
    const bool is_long = text_.substr(at_, 3) == long_quote;
    const std::string_view end = is_long ? std::string_view(long_quote) : std::string_view(long_quote).substr(0, 1);
    for (std::size_t i = 0; i < end.size(); ++i) advance();
    while (at_ < text_.size() && text_.substr(at_, end.size()) != end) {
      // A short string that is still open at the end of its line is an error, which the parser will report.
      if (!is_long && text_[at_] == '\n') return;
      if (quote == '"' && text_[at_] == '\\') advance();
      advance();
    }
    for (std::size_t i = 0; i < end.size(); ++i) advance();
  }

  void skip_to(std::size_t position) {
    const std::size_t end = std::min(position, text_.size());
    while (at_ < end) advance();
  }

  void advance() {
    if (at_ >= text_.size()) return;
    if (text_[at_] == '\n') {
      ++line_;
      line_start_ = at_ + 1;
    }
    ++at_;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
  std::size_t line_start_ = 0;
  std::size_t dots_ = 0;
};

/// The parser's description without its own preamble and the names of its macros.
std::string tidy(std::string_view description) {
  constexpr std::string_view preamble = "Error while parsing ";
  std::string context;
  if (description.starts_with(preamble)) {
    const std::size_t colon = description.find(": ");
    if (colon != std::string_view::npos) {
      context = fmt::format(" (reading {})", description.substr(preamble.size(), colon - preamble.size()));
      description.remove_prefix(colon + 2);
    }
  }
  if (const auto macro = description.find(" (TOML_"); macro != std::string_view::npos) {
    description = description.substr(0, macro);
  }
  return on_one_line(description.substr(0, k_longest_description)) + context;
}

}  // namespace

toml::table parse_document(std::string_view text, const std::string& origin) {
  if (text.size() > k_largest_text) {
    throw_fault({origin}, fmt::format("the file is too large; expected at most {} MiB", k_largest_text >> 20U));
  }
  KeyScanner(text).scan(origin);
  try {
    return toml::parse(text, std::string_view(origin));
  } catch (const toml::parse_error& error) {
    throw_fault(place_of(error.source(), {origin}), "not valid TOML: " + tidy(error.description()));
  }
}

SourceLocation place_of(const toml::source_region& region, const SourceLocation& fallback) {
  if (region.begin.line == 0) return fallback;
  return {region.path ? *region.path : fallback.file, region.begin.line, region.begin.column};
}

std::string shown(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::none:
      return "nothing";
    case toml::node_type::table:
      return node.as_table()->empty() ? "an empty table" : "a table";
    case toml::node_type::array:
      return node.as_array()->empty() ? "an empty array" : "an array";
    case toml::node_type::string:
      return fmt::format("\"{}\"", shown(std::string_view(node.as_string()->get())));
    case toml::node_type::integer:
      return fmt::format("{}", node.as_integer()->get());
    case toml::node_type::floating_point:
      return fmt::format("{}", node.as_floating_point()->get());
    case toml::node_type::boolean:
      return node.as_boolean()->get() ? "true" : "false";
    case toml::node_type::date:
    case toml::node_type::time:
    case toml::node_type::date_time:
      return "a date or time";
  }
  return {};
}

}  // namespace monograin
