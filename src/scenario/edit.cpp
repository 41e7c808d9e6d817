#include "scenario/edit.hpp"

#include <fmt/format.h>

#include <sstream>
#include <stdexcept>

#include "scenario/cells.hpp"
#include "scenario/document.hpp"
#include "scenario/faults.hpp"
#include "scenario/overrides.hpp"
#include "scenario/plain_paths.hpp"

namespace monograin {
namespace {

/// Byte offset of a parser's position, whose columns count characters.
std::size_t offset_of(std::string_view text, const toml::source_position& position) {
  std::size_t at = text.size() - without_byte_order_mark(text).size();
  for (toml::source_index line = 1; line < position.line; ++line) at = text.find('\n', at) + 1;
  const auto continues_character = [&] {
    return at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U;
  };
  for (toml::source_index column = 1; column < position.column; ++column) {
    ++at;
    while (continues_character()) ++at;
  }
  return at;
}

/// @param path  without a range
void apply(std::string& text, std::string_view path, const std::string& new_value) {
  const std::size_t dot = path.rfind('.');
  const std::string_view key = path.substr(dot + 1);
  const toml::table root = parse_document(text, "text");
  const toml::table* table = dot == std::string_view::npos ? &root : root.at_path(path.substr(0, dot)).as_table();
  if (const toml::node* value = table == nullptr ? nullptr : table->get(key)) {
    const std::size_t begin = offset_of(text, value->source().begin);
    text.replace(begin, offset_of(text, value->source().end) - begin, new_value);
    return;
  }
  const bool is_named = table != nullptr && table != &root && !table->is_inline();
  const std::size_t begin = is_named ? offset_of(text, table->source().begin) : text.size();
  const bool has_header = begin < text.size() && text[begin] == '[';
  if (!has_header || path.ends_with(']')) throw std::runtime_error(fmt::format("there is no place for '{}'", path));
  const std::string line = fmt::format("{} = {}\n", key, new_value);
  const std::size_t end = text.find('\n', begin);
  if (end == std::string::npos) {
    text += '\n' + line;
  } else {
    text.insert(end + 1, line);
  }
}

std::string text_of(const toml::table& table) {
  std::ostringstream text;
  text.exceptions(std::ios::badbit);  // an allocation that fails must not cut the text
  text << toml::toml_formatter{table} << '\n';
  return text.str();
}

}  // namespace

std::string with_values(std::string text, const std::vector<TextEdit>& edits) {
  for (const TextEdit& edit : edits) {
    for (const std::string& path : plain_paths(edit.path)) apply(text, path, edit.value);
  }
  return text;
}

std::string with_override(const std::string& text, const std::string& key_and_value) {
  FaultList faults;
  const std::optional<TextEdit> edit = edit_of(key_and_value, faults);
  if (!edit) throw std::runtime_error(fmt::format("there is no value in '{}'", key_and_value));
  return with_values(text, {*edit});
}

std::string text_of_table(std::string_view document, std::string_view key, const std::string& origin) {
  const toml::table root = parse_document(document, origin);
  const toml::table* table = root[key].as_table();
  if (table == nullptr) throw_fault({origin}, fmt::format("there is no table [{}]", key));
  return text_of(*table);
}

std::string text_with_overrides(const std::string& text, std::span<const std::string> overrides) {
  if (overrides.empty()) return text;
  toml::table root = parse_document(text, {});
  FaultList faults;
  for (const std::string& change : overrides) apply_override(root, change, faults);
  faults.throw_if_any();
  return text_of(root);
}

}  // namespace monograin
