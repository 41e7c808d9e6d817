#include "scenario/overrides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "scenario/document.hpp"
#include "scenario/plain_paths.hpp"
#include "scenario/words.hpp"

namespace monograin {
namespace {

constexpr std::string_view k_prefix = "override '";

std::string origin_of(const std::string& text) { return fmt::format("{}{}'", k_prefix, on_one_line(text)); }

bool is_key_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

class PathParser {
 public:
  explicit PathParser(std::string_view text) : text_(text) {}

  std::optional<std::vector<PathPart>> parse() {
    std::vector<PathPart> path;
    do {
      const std::string_view key = take_key();
      if (key.empty()) return std::nullopt;
      path.emplace_back(std::string(key));
      while (take('[')) {
        const std::optional<std::size_t> index = take_index(text_);
        if (!index || !take(']')) return std::nullopt;
        path.emplace_back(*index);
      }
      if (path.size() > k_most_key_parts) return std::nullopt;
    } while (take('.'));
    if (!text_.empty()) return std::nullopt;
    return path;
  }

 private:
  bool take(char c) {
    if (text_.empty() || text_.front() != c) return false;
    text_.remove_prefix(1);
    return true;
  }

  std::string_view take_key() {
    const auto end = std::ranges::find_if_not(text_, is_key_character);
    const std::string_view key = text_.substr(0, static_cast<std::size_t>(end - text_.begin()));
    text_.remove_prefix(key.size());
    return key;
  }

  std::string_view text_;
};

bool begins_like_a_bare_text(std::string_view value) {
  const auto first = value.find_first_not_of(" \t");
  return first == std::string_view::npos || std::string_view("[{\"'").find(value[first]) == std::string_view::npos;
}

/// An override while it is applied.
class Override {
 public:
  Override(const std::string& text, FaultList& faults) : text_(text), here_{origin_of(text)}, faults_(faults) {}

  /// @param number  the value, if it is known; none: the text is parsed
  void apply(toml::table& root, std::optional<double> number = {}) {
    const std::size_t equals = find_equals();
    if (equals == std::string::npos) return;
    for (const std::string& plain : plain_paths(trimmed_key(equals))) {
      const auto path = parse_key_path(plain);
      if (!path) {
        return fault(fmt::format("'{}' is not the path of a key; expected for example loading.steps[0].rate",
                                 shown(std::string_view(text_).substr(0, equals))));
      }
      std::optional<toml::table> holder = number ? holder_of(*number) : parse_value(equals);
      if (!holder) return;
      put(root, *path, *holder);
    }
  }

  std::optional<TextEdit> as_edit() {
    const std::size_t equals = find_equals();
    if (equals == std::string::npos) return std::nullopt;
    const std::optional<toml::table> holder = parse_value(equals);
    if (!holder) return std::nullopt;
    const std::string value(trimmed(std::string_view(text_).substr(equals + 1)));
    const bool is_bare_text = holder->begin()->second.is_string() && begins_like_a_bare_text(value);
    return TextEdit{std::string(trimmed_key(equals)), is_bare_text ? in_quotes(value) : value};
  }

 private:
  /// Position of the sign between key and value; a fault if there is none.
  [[nodiscard]] std::size_t find_equals() {
    const std::size_t equals = text_.find('=');
    if (equals == std::string::npos) fault("expected key=value");
    return equals;
  }

  [[nodiscard]] std::string_view trimmed_key(std::size_t equals) const {
    return trimmed(std::string_view(text_).substr(0, equals));
  }

  /// A table with the value as its only entry. A key of the same length replaces the path, so that positions in the
  /// tree are those in the override.
  std::optional<toml::table> parse_value(std::size_t equals) {
    const std::string_view value = std::string_view(text_).substr(equals + 1);
    const std::string key(equals, 'x');
    try {
      toml::table holder = parse_document(key + "=" + std::string(value), here_.file);
      if (holder.size() == 1) return holder;
    } catch (const ScenarioError& error) {
      if (!begins_like_a_bare_text(value)) return report(error);
    }
    try {
      return parse_document(key + "=" + in_quotes(value), here_.file);
    } catch (const ScenarioError& error) {
      return report(error);
    }
  }

  /// A table with a number as its only entry. A whole number becomes an integer, as it would from a text.
  static toml::table holder_of(double number) {
    const bool is_integer = std::trunc(number) == number && std::abs(number) < k_end_of_integers;
    toml::table holder;
    if (is_integer) {
      holder.insert("x", static_cast<std::int64_t>(number));
    } else {
      holder.insert("x", number);
    }
    return holder;
  }

  std::nullopt_t report(const ScenarioError& error) {
    for (const Fault& problem : error.faults()) faults_.add(problem.where, problem.message);
    return std::nullopt;
  }

  void put(toml::table& root, const std::vector<PathPart>& path, toml::table& holder) {
    toml::node* node = &root;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
      const bool wants_table = std::holds_alternative<std::string>(path[i + 1]);
      node = std::visit([&](const auto& part) { return descend(*node, part, wants_table); }, path[i]);
      if (node == nullptr) return;
    }
    toml::node& value = holder.begin()->second;
    std::visit([&](const auto& part) { place(*node, part, value); }, path.back());
  }

  toml::node* descend(toml::node& node, const std::string& key, bool wants_table) {
    toml::table* table = as_table(node, key);
    if (table == nullptr) return nullptr;
    if (toml::node* next = table->get(key)) return next;
    toml::table made = made_empty(wants_table);
    insert(*table, key, made.begin()->second);
    return table->get(key);
  }

  toml::node* descend(toml::node& node, std::size_t index, bool wants_table) {
    toml::array* array = as_array(node, index);
    if (array == nullptr) return nullptr;
    if (index == array->size()) {
      toml::table made = made_empty(wants_table);
      append(*array, made.begin()->second);
    }
    return array->get(index);
  }

  /// A table with an empty table or array as its only entry.
  toml::table made_empty(bool is_table) { return parse_document(is_table ? "x={}" : "x=[]", here_.file); }

  void place(toml::node& node, const std::string& key, toml::node& value) {
    if (toml::table* table = as_table(node, key)) insert(*table, key, value);
  }

  void place(toml::node& node, std::size_t index, toml::node& value) {
    toml::array* array = as_array(node, index);
    if (array == nullptr) return;
    if (index == array->size()) return append(*array, value);
    value.visit([&](auto& concrete) {
      array->insert(array->erase(array->cbegin() + static_cast<std::ptrdiff_t>(index)), std::move(concrete));
    });
  }

  static void append(toml::array& array, toml::node& value) {
    value.visit([&](auto& concrete) { array.push_back(std::move(concrete)); });
  }

  void insert(toml::table& table, const std::string& key, toml::node& value) {
    table.erase(key);  // an assignment would keep the position of the old key
    toml::source_region region = value.source();
    region.begin = {1, 1};
    value.visit([&](auto& concrete) { table.insert(toml::key(key, region), std::move(concrete)); });
  }

  toml::table* as_table(toml::node& node, const std::string& key) {
    toml::table* table = node.as_table();
    if (table == nullptr) fault(fmt::format("'{}' cannot be set inside {}", key, shown(node)));
    return table;
  }

  /// The node as an array that contains the index, or to which the index appends.
  toml::array* as_array(toml::node& node, std::size_t index) {
    toml::array* array = node.as_array();
    if (array == nullptr) {
      fault(fmt::format("index [{}] cannot be used on {}; expected an array", index, shown(node)));
    } else if (index > array->size()) {
      fault(fmt::format("index [{}] is out of range; the array has {} entries, counted from 0", index, array->size()));
      return nullptr;
    }
    return array;
  }

  void fault(std::string message) { faults_.add(here_, std::move(message)); }

  const std::string& text_;
  SourceLocation here_;
  FaultList& faults_;
};

}  // namespace

std::optional<std::vector<PathPart>> parse_key_path(std::string_view text) { return PathParser(text).parse(); }

std::string in_quotes(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (byte < 0x20U || byte == 0x7FU) {
      quoted += fmt::format("\\u{:04X}", byte);
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

void apply_override(toml::table& root, const std::string& text, FaultList& faults) {
  Override(text, faults).apply(root);
}

void apply_number(toml::table& root, const std::string& text, double number, FaultList& faults) {
  Override(text, faults).apply(root, number);
}

std::optional<TextEdit> edit_of(const std::string& text, FaultList& faults) { return Override(text, faults).as_edit(); }

bool is_override(const SourceLocation& where) noexcept { return where.file.starts_with(k_prefix); }

}  // namespace monograin
