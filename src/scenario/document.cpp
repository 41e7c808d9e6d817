#include "scenario/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "scenario/faults.hpp"
#include "scenario/words.hpp"

namespace monograin {
namespace {

/// Finds keys with too many parts. The parser makes one table for each part, and the destruction of deeply nested
/// tables would overflow the stack; the parser limits the nesting of values only.
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
      // A short string without an end on its line is an error that the parser reports.
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

/// A kind of syntax fault: a part of the parser's description, and the sentence shown instead.
struct SyntaxFault {
  std::string_view clue;
  std::string_view sentence;
};

constexpr std::string_view k_end_of_text = "encountered end-of-file";

/// Parts of a document that the end of the text may leave open.
constexpr SyntaxFault k_open_parts[] = {
    {"inline table", "the braces are not closed; expected '}'"},
    {"array", "the array is not closed; expected ']'"},
    {"string", "the text is not closed; expected a quote at its end"},
    {"table", "the name of the table is not closed; expected [name] or [[name]]"},
};

// The first clue that the description contains decides.
constexpr SyntaxFault k_syntax_faults[] = {
    {"nested value depth", "arrays or braces are nested too deeply; expected at most 256 levels"},
    {"into existing inline table", "a table in braces cannot be added to; expected all of its keys in the braces"},
    {"cannot insert", "this key has a value already, which is no table; expected another name"},
    {"unexpected control character", "the value is missing; expected for example 3.5, \"10 mm\" or true"},
    {"control characters other than TAB",
     "the text is not closed before a line break or a control character; expected a quote at its end"},
    {"expected a comment or whitespace",
     "there is more after the value; expected the end of the line, and quotes around a number with a unit: \"10 mm\""},
    {"dangling comma", "a comma before the closing brace; expected another key = value, or no comma"},
    {"saw comma", "a comma without an entry before it; expected one comma between two entries"},
    {"expected comma or closing", "the entries are not separated; expected ',' or a closing bracket"},
    {"expected '='", "'=' is missing after the key; expected key = value"},
    {"expected ']'", "the name of the table is not closed; expected [name] or [[name]]"},
    {"brackets must be contiguous", "there are blanks between the brackets; expected [[name]]"},
    {"bare key", "this is no key; expected key = value, [table] or # comment"},
    {"expected key", "this is no key; expected key = value, [table] or # comment"},
    {"escape sequence",
     "no such escape in quotes; expected \\n, \\t, \\\", \\\\ or \\uXXXX, or single quotes around it all"},
    {"backslashes", "a backslash in the text; expected \\\\, or single quotes around it all"},
    {"surrogates", "this is no character; expected UTF-8"},
    {"U+10FFFF", "this is no character; expected UTF-8"},
    {"utf-8", "this is no character; expected UTF-8"},
    {R"(expected value, saw '\n')", "the value is missing; expected for example 3.5, \"10 mm\" or true"},
    {"expected value", "this is no value; expected for example 3.5, \"10 mm\", true, [1, 2] or { key = 1 }"},
    {"determine value type", "this is no value; expected for example 3.5, \"10 mm\", true, [1, 2] or { key = 1 }"},
    {"interpreted as a value", "this is no value; expected for example 3.5, \"10 mm\", true, [1, 2] or { key = 1 }"},
    {"year", "this is no date; expected a number, or a text in quotes"},
    {"month", "this is no date; expected a number, or a text in quotes"},
    {"hour", "this is no time of day; expected a number, or a text in quotes"},
    {"minute", "this is no time of day; expected a number, or a text in quotes"},
    {"underscore", "this is no number; expected for example 3, 0.5 or 1e-3"},
    {"digit", "this is no number; expected for example 3, 0.5 or 1e-3"},
    {"zeroes", "a number begins with a zero; expected for example 3, 0.5 or 1e-3"},
    {"exponent", "this is no number; expected for example 3, 0.5 or 1e-3"},
    {"representable", "the number is too large; expected one that fits, for example 1e30"},
    {"length", "the number is too long; expected at most 17 digits"},
};

/// A syntax fault in the program's own words. The parser's description only determines which sentence.
std::string sentence_of(std::string_view description) {
  constexpr std::string_view k_redefined = "cannot redefine existing ";
  if (const auto at = description.find(k_redefined); at != std::string_view::npos) {
    const std::size_t open = description.find('\'', at);
    const std::size_t close = description.rfind('\'');
    const bool is_named = open != std::string_view::npos && open < close;
    return fmt::format("'{}' is there already; expected each key and table once",
                       is_named ? shown(description.substr(open + 1, close - open - 1)) : "the key");
  }
  if (description.find(k_end_of_text) != std::string_view::npos) {
    for (const auto& [clue, sentence] : k_open_parts) {
      if (description.find(clue) != std::string_view::npos) return std::string(sentence);
    }
    return "the text ends too early; expected key = value";
  }
  for (const auto& [clue, sentence] : k_syntax_faults) {
    if (description.find(clue) != std::string_view::npos) return std::string(sentence);
  }
  return "expected key = value, [table] or # comment";
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
    throw_fault(place_of(error.source(), {origin}), "not valid TOML: " + sentence_of(error.description()));
  }
}

const DocumentKind& kind_of(DocumentType type) {
  static const std::array<DocumentKind, 5> kinds{{
      {"a scenario", "run", {"model"}},
      {"a sweep", "sweep", {"vary", "design"}},
      {"a design", "design", {"program"}},
      {"a calibration", "calibrate", {"data"}},
      {"a figure definition", "atlas", {"panel", "table", "values", "adhesion_map"}},
  }};
  return kinds[static_cast<std::size_t>(type)];
}

std::optional<DocumentType> type_of(const toml::table& root) {
  using enum DocumentType;
  for (const DocumentType type : {scenario, sweep, experiment_plan, calibration, figure}) {
    // A sweep may have a key `table` as well, the name of a file.
    const auto shows_type = [&](std::string_view key) {
      return root.contains(key) && (type != figure || !root[key].is_string());
    };
    if (std::ranges::any_of(kind_of(type).keys, shows_type)) return type;
  }
  return std::nullopt;
}

void expect_type(const toml::table& root, const std::string& origin, DocumentType own) {
  const auto is_there = [&](std::string_view key) { return root.contains(key); };
  if (std::ranges::any_of(kind_of(own).keys, is_there)) return;
  const std::optional<DocumentType> type = type_of(root);
  if (!type) return;
  throw_fault({origin}, fmt::format("this is {}, for 'monograin {}'; expected {}", kind_of(*type).noun,
                                    kind_of(*type).command, kind_of(own).noun));
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
