#include "scenario/section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "scenario/cells.hpp"
#include "scenario/document.hpp"
#include "scenario/overrides.hpp"
#include "scenario/units.hpp"
#include "scenario/words.hpp"

namespace monograin {
namespace {

using Kind = KeySpec::Kind;

const toml::table k_empty_table;

constexpr double k_soft_stress = 1e3;   // [Pa]; particles are stiffer and stronger than that
constexpr double k_long_path = 10.0;    // over the radius
constexpr double k_large_radius = 1.0;  // [m]

bool is_identifier(std::string_view text) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto may_follow = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-'; };
  return !text.empty() && is_letter(text.front()) && std::ranges::all_of(text, may_follow);
}

bool is_whole(double value) { return std::trunc(value) == value; }

std::optional<double> as_number(const toml::node& node) {
  if (const auto* integer = node.as_integer()) return static_cast<double>(integer->get());
  if (const auto* floating = node.as_floating_point()) return floating->get();
  return std::nullopt;
}

/// A choice as a word. It may be written as a number if the choices are numbers: 4, inf.
std::optional<std::string> as_word(const toml::node& node) {
  if (const auto* text = node.as_string()) return text->get();
  const auto number = as_number(node);
  return number ? std::optional(fmt::format("{}", *number)) : std::nullopt;
}

}  // namespace

std::vector<std::string_view> check_names(Reading& reading, const toml::table& table, const SourceLocation& place,
                                          std::string_view label, std::span<const KeySpec> keys,
                                          std::span<const ForeignKey> foreign) {
  const std::vector<std::string_view> names = names_of(keys);
  std::vector<std::string_view> suggested;
  for (const auto& [key, value] : table) {
    if (find_key(keys, key.str()) != nullptr) continue;
    const SourceLocation where = place_of(key.source(), place);
    std::string_view reason = reason_of(foreign, key.str());
    if (reason.empty()) {
      reason = reason_of(reading.homes, key.str());
      if (!reason.empty()) reading.misplaced.push_back(key.str());
    }
    if (!reason.empty()) {
      reading.faults.add(where, fmt::format("key '{}' {}", key.str(), reason));
      continue;
    }
    const std::string_view nearest = nearest_word(key.str(), names);
    if (!nearest.empty()) suggested.push_back(nearest);
    reading.faults.add(
        where, fmt::format("unknown key '{}' in {}{}", shown(key.str()), label,
                           nearest.empty() ? "; expected one of " + listed(names) : did_you_mean(key.str(), names)));
  }
  return suggested;
}

FileText text_of_file(const Reading& reading, const std::string& name, std::size_t largest) {
  if (reading.recorded == nullptr) return read_text_file(reading.folder / name, largest);
  const auto found = reading.recorded->find(name);
  return found == reading.recorded->end() ? FileText{{}, "its text was not given"} : FileText{found->second, {}};
}

void doubt_missing_unit(Reading& reading, const KeySpec& spec, const BareNumber& number) {
  const double size = std::abs(number.value);
  const auto doubt = [&](std::vector<std::string>& doubts, std::string_view comparison, std::string_view unit) {
    doubts.push_back(fmt::format(
        "{} has no unit and is taken as {:.6g} {}{}; if another unit is meant, write it: {}{}{}", number.assignment,
        number.value, dimension_info(spec.dimension).si, comparison, number.before_unit, unit, number.after_unit));
  };
  if (spec.dimension == Dimension::length && !spec.knows_initial_radius) {
    if (size > k_large_radius) doubt(reading.doubtful_scales, "", "mm");
  } else if (spec.dimension == Dimension::length && size > k_long_path * reading.initial_radius) {
    doubt(reading.doubtful_paths, fmt::format(", {:.3g} times the radius", number.value / reading.initial_radius),
          "R0");
  } else if (reading.is_of_material && spec.dimension == Dimension::stress && size > 0.0 && size < k_soft_stress) {
    doubt(reading.doubtful_scales, "", "MPa");
  }
}

Section::Section(Reading& reading, Origin origin, std::span<const KeySpec> keys, std::span<const ForeignKey> foreign)
    : reading_(reading), origin_(std::move(origin)), keys_(keys) {
  misspelt_ = check_names(reading_, *origin_.table, origin_.place, origin_.label, keys_, foreign);
  for (const KeySpec& spec : keys_) {
    if (const toml::node* node = origin_.table->get(spec.name)) check_value(spec, *node);
  }
  check_required();
}

bool Section::has_table(std::string_view key) const {
  const toml::node* node = origin_.table->get(key);
  return node != nullptr && node->is_table();
}

bool Section::has_or_misspells(std::string_view key) const {
  return !origin_.is_readable || has(key) || std::ranges::find(misspelt_, key) != misspelt_.end();
}

std::string Section::text(std::string_view key) const {
  if (const auto found = values_.find(key); found != values_.end()) return std::get<std::string>(found->second);
  const KeySpec* spec = find_key(keys_, key);
  const auto* word = spec == nullptr ? nullptr : std::get_if<std::string_view>(&spec->default_value);
  return word == nullptr ? std::string() : std::string(*word);
}

std::optional<double> Section::column_number(std::string_view key) const {
  const auto found = values_.find(key);
  const auto* number = found == values_.end() ? nullptr : std::get_if<double>(&found->second);
  return number == nullptr ? std::nullopt : std::optional(*number);
}

Section::Origin Section::table(std::string_view key, std::string label) const {
  const toml::node* node = origin_.table->get(key);
  const toml::table* table = node == nullptr ? nullptr : node->as_table();
  if (table == nullptr)
    return {&k_empty_table, origin_.place, std::move(label), origin_.is_readable && node == nullptr};
  return {table, value_place(key), std::move(label)};
}

std::vector<Section::Origin> Section::tables(std::string_view key, const std::string& label) const {
  std::vector<Origin> result;
  const toml::node* node = origin_.table->get(key);
  if (node == nullptr || !node->is_array()) return result;
  for (const toml::node& entry : *node->as_array()) {
    if (const auto* table = entry.as_table()) result.push_back({table, place_of(entry.source(), origin_.place), label});
  }
  return result;
}

SourceLocation Section::key_place(std::string_view key) const {
  const auto found = origin_.table->find(key);
  return found == origin_.table->end() ? origin_.place : place_of(found->first.source(), origin_.place);
}

SourceLocation Section::value_place(std::string_view key) const {
  const toml::node* node = origin_.table->get(key);
  return node == nullptr ? origin_.place : place_of(node->source(), origin_.place);
}

SourceLocation Section::value_place(std::string_view key, std::size_t entry) const {
  const toml::node* node = origin_.table->get(key);
  const toml::node* value = node == nullptr || !node->is_array() ? nullptr : node->as_array()->get(entry);
  return value == nullptr ? value_place(key) : place_of(value->source(), origin_.place);
}

void Section::check_required() {
  for (const KeySpec& spec : keys_) {
    // A misspelt or misplaced key is one fault, not two.
    if (!spec.is_required || has_or_misspells(spec.name)) continue;
    if (std::ranges::find(reading_.misplaced, spec.name) != reading_.misplaced.end()) continue;
    reading_.faults.add(origin_.place, fmt::format("key '{}' is missing in {}; expected for example {}", spec.name,
                                                   origin_.label, example_line(spec)));
  }
}

void Section::check_value(const KeySpec& spec, const toml::node& node) {
  if (std::optional<Value> value = read(spec, node)) values_.emplace(spec.name, std::move(*value));
}

std::optional<Section::Value> Section::read(const KeySpec& spec, const toml::node& node) {
  switch (spec.kind) {
    case Kind::text:
    case Kind::identifier:
    case Kind::file:
      return read_text(spec, node);
    case Kind::column:
      if (node.is_string()) return read_text(spec, node);
      return read_integer(spec, node);
    case Kind::toggle:
    case Kind::mark:
      return read_toggle(spec, node);
    case Kind::choice:
      return read_choice(spec, node);
    case Kind::integer:
      return read_integer(spec, node);
    case Kind::quantity:
      return read_quantity(spec, node);
    case Kind::pair:
      return read_pair(spec, node);
    case Kind::instants:
      return read_instants(spec, node);
    case Kind::direction:
      return read_direction(spec, node);
    case Kind::texts:
      return read_texts(spec, node);
    case Kind::table:
      if (!node.is_table() || (node.as_table()->empty() && !spec.may_be_empty)) unexpected(spec, node);
      return std::nullopt;
    case Kind::tables:
      check_tables(spec, node);
      return std::nullopt;
    case Kind::any:
      return std::nullopt;
  }
  return std::nullopt;
}

std::optional<Section::Value> Section::read_text(const KeySpec& spec, const toml::node& node) {
  const auto* text = node.as_string();
  if (text == nullptr) return unexpected(spec, node);
  if (spec.kind == Kind::identifier && !is_identifier(text->get())) return unexpected(spec, node);
  if (spec.kind == Kind::file && text->get().empty()) return unexpected(spec, node);
  return text->get();
}

std::optional<Section::Value> Section::read_choice(const KeySpec& spec, const toml::node& node) {
  const std::optional<std::string> written = as_word(node);
  if (!written) return unexpected(spec, node);
  const auto former = std::ranges::find(spec.renamed, *written, &std::pair<std::string_view, std::string_view>::first);
  const std::string word = former == spec.renamed.end() ? *written : std::string(former->second);
  if (!node.is_string() && std::ranges::find(spec.choices, word) == spec.choices.end()) return unexpected(spec, node);
  // Without a model, any event is accepted.
  if (spec.choices.empty() || std::ranges::find(spec.choices, word) != spec.choices.end()) return word;
  if (std::ranges::find(spec.reserved, word) != spec.reserved.end()) {
    reading_.faults.add(place_of(node.source(), origin_.place),
                        fmt::format("{} '{}' is not available {}; available: {}", spec.name, word, spec.reserved_where,
                                    listed(spec.choices)));
    return std::nullopt;
  }
  return unexpected(spec, node, did_you_mean(word, spec.choices));
}

std::optional<Section::Value> Section::read_toggle(const KeySpec& spec, const toml::node& node) {
  const auto* toggle = node.as_boolean();
  if (toggle == nullptr || (spec.kind == Kind::mark && !toggle->get())) return unexpected(spec, node);
  return toggle->get();
}

std::optional<double> Section::read_integer(const KeySpec& spec, const toml::node& node) {
  const std::optional<double> value = as_number(node);
  const bool is_good = value && spec.range.contains(*value) && is_whole(*value / spec.multiple_of);
  if (!is_good) return unexpected(spec, node);
  return value;
}

std::optional<double> Section::read_quantity(const KeySpec& spec, const toml::node& node) {
  if (spec.may_be_table && node.is_table()) return std::nullopt;
  std::optional<double> value = as_number(node);
  const auto* text = node.as_string();
  if (text != nullptr && spec.dimension != Dimension::none) {
    const auto radius = spec.knows_initial_radius ? std::optional(reading_.initial_radius) : std::nullopt;
    const ParsedQuantity quantity = parse_quantity(text->get(), spec.dimension, radius);
    if (!quantity.value) return fault(spec, node, quantity.problem);
    value = quantity.value;
    const bool is_scale = spec.dimension == Dimension::time || quantity.unit == dimension_info(spec.dimension).relative;
    reading_.has_units = reading_.has_units || !is_scale;
  } else if (value) {
    doubt_missing_unit(spec, node, *value);
  }
  if (!value) return unexpected(spec, node);
  if (const Range range = finite_range(spec); !range.contains(*value)) {
    return fault(spec, node, "out of range; expected " + describe(spec.dimension, range));
  }
  return value;
}

std::optional<Section::Value> Section::read_pair(const KeySpec& spec, const toml::node& node) {
  const auto* array = node.as_array();
  if (array == nullptr) {
    const std::optional<double> single = read_quantity(spec, node);
    return single ? std::optional<Value>(std::vector<double>{*single}) : std::nullopt;
  }
  if (array->size() != 2) return unexpected(spec, node);
  std::vector<double> values;
  for (const toml::node& entry : *array) {
    if (const auto value = read_quantity(spec, entry)) values.push_back(*value);
  }
  return values.size() == 2 ? std::optional<Value>(std::move(values)) : std::nullopt;
}

std::optional<Section::Value> Section::read_instants(const KeySpec& spec, const toml::node& node) {
  const auto* array = node.as_array();
  if (array == nullptr || array->empty()) return unexpected(spec, node);
  std::vector<double> instants;
  bool is_good = true;
  for (const toml::node& entry : *array) {
    const std::optional<double> instant = read_quantity(spec, entry);
    is_good = is_good && instant;
    if (!instant) continue;
    if (!instants.empty() && *instant <= instants.back()) {
      fault(spec, entry, "not later than the one before; expected ascending times");
      is_good = false;
    }
    instants.push_back(*instant);
  }
  if (!is_good) return std::nullopt;
  return instants;
}

std::optional<Section::Value> Section::read_direction(const KeySpec& spec, const toml::node& node) {
  const auto* array = node.as_array();
  if (array == nullptr || array->size() != 3) return unexpected(spec, node);
  std::vector<double> components;
  for (const toml::node& entry : *array) {
    const std::optional<double> component = as_number(entry);
    if (!component) return unexpected(spec, entry);
    if (!(std::abs(*component) <= k_greatest_normal)) {
      return fault(
          spec, entry,
          fmt::format("out of range; expected a number from {:.6g} to {:.6g}", -k_greatest_normal, k_greatest_normal));
    }
    components.push_back(*component);
  }
  const auto is_tiny = [](double component) { return std::abs(component) < k_least_normal; };
  if (std::ranges::all_of(components, is_tiny))
    return fault(spec, node, "it has no direction; expected " + expectation(spec));
  return components;
}

std::optional<Section::Value> Section::read_texts(const KeySpec& spec, const toml::node& node) {
  const auto* array = node.as_array();
  if (array == nullptr || array->empty()) return unexpected(spec, node);
  std::vector<std::string> texts;
  for (const toml::node& entry : *array) {
    if (const auto* text = entry.as_string()) {
      texts.push_back(text->get());
    } else if (as_number(entry)) {
      texts.push_back(shown(entry));
    } else {
      return unexpected(spec, entry);
    }
  }
  return texts;
}

void Section::expect_like_units(std::initializer_list<std::string_view> keys) {
  std::vector<std::pair<std::string_view, const toml::node*>> values;
  for (const std::string_view key : keys) {
    const toml::node* node = origin_.table->get(key);
    if (node == nullptr) continue;
    if (const auto* array = node->as_array()) {
      for (const toml::node& entry : *array) values.emplace_back(key, &entry);
    } else {
      values.emplace_back(key, node);
    }
  }
  const auto number_of = [](const toml::node& node) {
    const auto text = node.value<std::string>();
    return text ? number_in(trimmed(*text)) : as_number(node);
  };
  const auto has_unit = [&](const auto& value) {
    const auto text = value.second->template value<std::string>();
    return text && !number_of(*value.second) && begins_a_number(trimmed(*text));
  };
  const auto with_unit = std::ranges::find_if(values, has_unit);
  if (with_unit == values.end()) return;
  for (const auto& [key, node] : values) {
    if (number_of(*node).value_or(0.0) == 0.0) continue;
    reading_.faults.add(place_of(node->source(), origin_.place),
                        fmt::format("{} = {}: a number without a unit beside {}; expected a unit for each", key,
                                    shown(*node), shown(*with_unit->second)));
    return;
  }
}

void Section::check_tables(const KeySpec& spec, const toml::node& node) {
  const auto* array = node.as_array();
  if (array == nullptr || array->empty()) {
    unexpected(spec, node);
    return;
  }
  for (const toml::node& entry : *array) {
    if (!entry.is_table()) unexpected(spec, entry);
  }
}

void Section::doubt_missing_unit(const KeySpec& spec, const toml::node& node, double value) const {
  // Nodes of a template have no place.
  const bool has_line = node.source().begin.line > 0 && !is_override(place_of(node.source(), origin_.place));
  const std::string line = has_line ? fmt::format(" (line {})", node.source().begin.line) : "";
  monograin::doubt_missing_unit(
      reading_, spec,
      {fmt::format("{} = {}{}", spec.name, shown(node), line), value, fmt::format("\"{} ", shown(node)), "\""});
}

std::nullopt_t Section::fault(const KeySpec& spec, const toml::node& node, std::string_view problem) {
  reading_.faults.add(place_of(node.source(), origin_.place),
                      fmt::format("{} = {}: {}", spec.name, shown(node), problem));
  return std::nullopt;
}

std::nullopt_t Section::unexpected(const KeySpec& spec, const toml::node& node, std::string_view suggestion) {
  reading_.faults.add(place_of(node.source(), origin_.place),
                      fmt::format("{} = {}: expected {}{}", spec.name, shown(node), expectation(spec), suggestion));
  return std::nullopt;
}

}  // namespace monograin
