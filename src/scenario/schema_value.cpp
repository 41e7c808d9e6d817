#include "scenario/schema_value.hpp"

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

#include "scenario/units.hpp"

namespace monograin {
namespace {

using nlohmann::json;
using Kind = KeySpec::Kind;

/// Bounds that NaN does not pass in any validator. Whatever `x < bound` and `x >= bound` give for NaN, one of `minimum`
/// and the negated `exclusiveMaximum` fails.
json bounds(const Range& range) {
  json schema{{"type", "number"}};
  schema[range.lower_is_open ? "exclusiveMinimum" : "minimum"] = range.lower;
  schema[range.upper_is_open ? "exclusiveMaximum" : "maximum"] = range.upper;
  schema["not"] = {{range.lower_is_open ? "maximum" : "exclusiveMaximum", range.lower}};
  return schema;
}

std::string escaped(std::string_view symbol) {
  std::string pattern;
  for (const char c : symbol) {
    if (c == '^') pattern += '\\';
    pattern += c;
  }
  return pattern;
}

std::string units_pattern(const DimensionInfo& info, bool with_relative) {
  std::string pattern;
  for (const Unit& unit : info.units) pattern += fmt::format("{}{}", pattern.empty() ? "" : "|", escaped(unit.symbol));
  if (with_relative) pattern += fmt::format("|{}", info.relative);
  return pattern;
}

// A mantissa with a digit other than zero; exponents of three digits are beyond every plausible range.
constexpr std::string_view k_magnitude = R"(([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?0*[0-9]{1,2})?)";
constexpr std::string_view k_not_zero = R"((?=[0-9.]*[1-9]))";

/// Schema of texts with a unit; sign and zero as in the key's range. The reader checks the upper bound.
json unit_text(const KeySpec& spec) {
  const DimensionInfo& info = dimension_info(spec.dimension);
  const bool with_relative = spec.knows_initial_radius && !info.relative.empty();
  const bool may_be_negative = spec.range.lower < 0.0;
  const bool may_be_zero = spec.range.contains(0.0);
  const std::string_view sign = may_be_negative ? "[+-]?" : "\\+?";
  std::string number = fmt::format("{}{}{}", sign, may_be_zero ? "" : k_not_zero, k_magnitude);
  std::string pattern = fmt::format("{}[ \\t]*({})", number, units_pattern(info, with_relative));
  if (with_relative) pattern = fmt::format("({}|{})", pattern, info.relative);
  return {{"type", "string"}, {"pattern", fmt::format("^[ \\t]*{}[ \\t]*$", pattern)}};
}

json quantity(const KeySpec& spec) {
  json number = bounds(finite_range(spec));
  if (spec.dimension == Dimension::none) return number;
  return {{"anyOf", {number, unit_text(spec)}}};
}

json quantity_or_table(const KeySpec& spec, const json& content) {
  json schema = quantity(spec);
  if (spec.may_be_table) schema["anyOf"].push_back(content);
  return schema;
}

json integer(const KeySpec& spec) {
  json schema = bounds(spec.range);
  schema["type"] = "integer";
  if (spec.multiple_of != 1) schema["multipleOf"] = spec.multiple_of;
  return schema;
}

bool is_whole_number(std::string_view word) {
  return !word.empty() && word.find_first_not_of("0123456789") == std::string_view::npos;
}

/// Choices that are numbers may be written with and without quotes.
json choice(const KeySpec& spec) {
  json words = spec.choices;
  for (const std::string_view word : spec.choices) {
    if (is_whole_number(word)) words.push_back(std::stoll(std::string(word)));
  }
  for (const auto& [former, present] : spec.renamed) words.push_back(former);
  return {{"enum", std::move(words)}};
}

json direction() {
  json component = bounds({.lower = -k_greatest_normal, .upper = k_greatest_normal});
  const json points_somewhere{{"anyOf", {{{"minimum", k_least_normal}}, {{"maximum", -k_least_normal}}}}};
  return {{"type", "array"}, {"items", component}, {"minItems", 3}, {"maxItems", 3}, {"contains", points_somewhere}};
}

json with(json schema, const char* keyword, int value) {
  schema[keyword] = value;
  return schema;
}

json kind_schema(const KeySpec& spec, const json& content) {
  switch (spec.kind) {
    case Kind::text:
      return {{"type", "string"}};
    case Kind::file:
      return {{"type", "string"}, {"minLength", 1}};
    case Kind::column:
      return {{"anyOf", {{{"type", "string"}}, integer(spec)}}};
    case Kind::identifier:
      return {{"type", "string"}, {"pattern", "^[A-Za-z][A-Za-z0-9_-]*$"}};
    case Kind::toggle:
      return {{"type", "boolean"}};
    case Kind::mark:
      return {{"type", "boolean"}, {"const", true}};
    case Kind::choice:
      return choice(spec);
    case Kind::integer:
      return integer(spec);
    case Kind::quantity:
      return quantity_or_table(spec, content);
    case Kind::pair:
      return {{"anyOf",
               {quantity(spec), {{"type", "array"}, {"items", quantity(spec)}, {"minItems", 2}, {"maxItems", 2}}}}};
    case Kind::instants:
      return {{"type", "array"}, {"items", quantity(spec)}, {"minItems", 1}, {"uniqueItems", true}};
    case Kind::direction:
      return direction();
    case Kind::texts:
      return {{"type", "array"}, {"items", {{"type", {"string", "number"}}}}, {"minItems", 1}};
    case Kind::table:
      return spec.may_be_empty ? content : with(content, "minProperties", 1);
    case Kind::tables:
      return {{"type", "array"}, {"items", content}, {"minItems", 1}};
    case Kind::any:
      break;
  }
  return json::object();
}

json default_json(const KeySpec& spec) {
  return std::visit(
      [](const auto& value) -> json {
        if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::monostate>)
          return nullptr;
        else
          return value;
      },
      spec.default_value);
}

}  // namespace

json value_schema(const KeySpec& spec, const json& content) {
  json schema = kind_schema(spec, content);
  // In draft 7 a validator ignores everything beside a reference.
  if (schema.contains("$ref")) schema = {{"allOf", {schema}}};
  schema["description"] = spec.meaning;
  if (json value = default_json(spec); !value.is_null()) schema["default"] = std::move(value);
  return schema;
}

json object_schema(json properties, json required) {
  json schema{{"type", "object"}, {"additionalProperties", false}, {"properties", std::move(properties)}};
  if (!required.empty()) schema["required"] = std::move(required);
  return schema;
}

}  // namespace monograin
