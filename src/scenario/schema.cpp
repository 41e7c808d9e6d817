#include "scenario/schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "scenario/language.hpp"
#include "scenario/schema_value.hpp"

namespace monograin {
namespace {

using nlohmann::json;

/// Schemas of the content of keys of kind table and tables, by key.
using Contents = std::map<std::string_view, json>;

json properties_of(std::span<const KeySpec> keys, const Contents& contents = {}) {
  json properties = json::object();
  for (const KeySpec& spec : keys) {
    const auto content = contents.find(spec.name);
    properties[std::string(spec.name)] =
        content == contents.end() ? value_schema(spec) : value_schema(spec, content->second);
  }
  return properties;
}

json required_of(std::span<const KeySpec> keys) {
  json required = json::array();
  for (const KeySpec& spec : keys) {
    if (spec.is_required) required.push_back(spec.name);
  }
  return required;
}

json table_schema(std::span<const KeySpec> keys, const Contents& contents = {}) {
  return object_schema(properties_of(keys, contents), required_of(keys));
}

json exactly_one_of(std::string_view a, std::string_view b) {
  return json::array({{{"required", {a}}}, {{"required", {b}}}});
}

/// Schema that a fixed wall meets.
json is_fixed_wall() { return {{"properties", {{"fixed", {{"const", true}}}}}, {"required", {"fixed"}}}; }

/// Definitions of one model and the references between them.
class ModelSchema {
 public:
  explicit ModelSchema(const Model& model) : language_(language_of(model.name)), name_(model.name) {}

  void add_to(json& definitions) const {
    definitions[name_ + "-step"] = step();
    definitions[name_ + "-loading"] = loading();
    definitions[name_] = root();
  }

 private:
  [[nodiscard]] json reference(std::string_view part) const {
    return {{"$ref", fmt::format("#/definitions/{}-{}", name_, part)}};
  }

  [[nodiscard]] json step() const {
    json forms = json::array();
    for (const StepForm& form : language_.steps) {
      Contents contents{{"until", until()}, {"steps", reference("step")}};
      if (form.course) contents.emplace(form.key, course(*form.course));
      json schema = table_schema(form.keys, contents);
      if (form.takes_duration_or_rate) schema["oneOf"] = exactly_one_of("duration", "rate");
      if (form.course) add_rules_of_course(schema, form.key);
      for (const DriveKey& key : form.lateral) add_exclusions(schema, form, key);
      forms.push_back(std::move(schema));
    }
    return {{"oneOf", std::move(forms)}};
  }

  [[nodiscard]] json until() const {
    json schema = table_schema(language_.until);
    if (find_key(language_.until, "wall") == nullptr) return schema;
    // A wall needs a quantity beside it.
    schema["anyOf"] = {{{"not", {{"required", {"wall"}}}}}};
    for (const KeySpec& key : language_.until) {
      if (key.kind == KeySpec::Kind::quantity) schema["anyOf"].push_back({{"required", {key.name}}});
    }
    return schema;
  }

  static json course(const CourseForm& form) {
    return {{"oneOf", {table_schema(form.table), table_schema(form.sine, {{"sine", table_schema(form.in_sine)}})}}};
  }

  /// A table or a sine has times of its own; any other target has a duration or a rate.
  static void add_rules_of_course(json& schema, std::string_view target) {
    const json is_course{{"properties", {{target, {{"type", "object"}}}}}};
    for (json& either : schema["oneOf"]) either["not"] = is_course;
    json own_times = is_course;
    own_times["not"] = {{"anyOf", exactly_one_of("duration", "rate")}};
    schema["oneOf"].push_back(std::move(own_times));
  }

  /// Excludes other lateral keys, and a pair, beside a lateral key.
  static void add_exclusions(json& schema, const StepForm& form, const DriveKey& key) {
    json others = json::array();
    for (const DriveKey& other : form.lateral) {
      if (other.name != key.name) others.push_back({{"required", {other.name}}});
    }
    const json is_pair{{"properties", {{form.key, {{"type", "array"}}}}}, {"required", {form.key}}};
    others.push_back(is_pair);
    schema["allOf"].push_back({{"not", {{"required", {key.name}}, {"anyOf", std::move(others)}}}});
  }

  [[nodiscard]] json wall() const {
    json schema = table_schema(language_.wall, {{"steps", reference("step")}});
    schema["not"] = {{"allOf", {is_fixed_wall(), {{"required", {"steps"}}}}}};
    return schema;
  }

  /// One alternative for each configuration with keys of its own, and one for all others.
  [[nodiscard]] json loading() const {
    const KeySpec* configuration = find_key(language_.loading, "configuration");
    if (configuration == nullptr) return loading_of({});
    std::vector<std::string_view> common;
    json alternatives = json::array();
    for (const std::string_view word : configuration->choices) {
      const auto is_its_own = [&](const KeySpec& spec) { return spec.only_with == word; };
      if (std::ranges::any_of(language_.loading, is_its_own)) {
        alternatives.push_back(loading_of({word}));
      } else {
        common.push_back(word);
      }
    }
    if (!common.empty()) alternatives.insert(alternatives.begin(), loading_of(common));
    return {{"oneOf", std::move(alternatives)}};
  }

  [[nodiscard]] json loading_of(const std::vector<std::string_view>& configurations) const {
    std::vector<KeySpec> keys;
    for (const KeySpec& spec : language_.loading) {
      if (!spec.only_with.empty() && spec.only_with != configurations.front()) continue;
      keys.push_back(spec);
      if (spec.name == "configuration") keys.back().choices = configurations;
    }
    json schema = table_schema(keys, {{"wall", wall()}, {"steps", reference("step")}});
    if (!configurations.empty() && configurations.front() == "walls") {
      add_rules_of_walls(schema);
    } else {
      schema["required"].push_back("steps");
    }
    return schema;
  }

  /// Adds the rules of walls: each has steps, is fixed, or follows the steps of `[loading]`; at least one is driven.
  static void add_rules_of_walls(json& schema) {
    const json is_on_its_own{{"anyOf", {is_fixed_wall(), {{"required", {"steps"}}}}}};
    json& walls = schema["properties"]["wall"];
    walls["maxItems"] = k_most_walls;
    walls["contains"] = {{"not", is_fixed_wall()}};
    schema["required"].push_back("wall");
    const json some_follow{{"properties", {{"wall", {{"contains", {{"not", is_on_its_own}}}}}}},
                           {"required", {"steps"}}};
    const json none_follows{{"properties", {{"wall", {{"items", is_on_its_own}}}}}, {"not", {{"required", {"steps"}}}}};
    schema["oneOf"] = {some_follow, none_follows};
  }

  [[nodiscard]] json material() const {
    json schema = table_schema(language_.material, {{"ludwik", table_schema(language_.ludwik)}});
    if (!language_.ludwik.empty()) {
      const json either{{"anyOf", {{{"required", {"strength"}}}, {{"required", {"hardening_exponent"}}}}}};
      schema["oneOf"] = {{{"required", {"strength", "hardening_exponent"}}},
                         {{"required", {"ludwik"}}, {"not", either}}};
    }
    return schema;
  }

  [[nodiscard]] json root() const {
    const Contents contents{{"particle", table_schema(language_.particle)},
                            {"material", material()},
                            {"loading", reference("loading")},
                            {"output", table_schema(language_.output)},
                            {"numerics", table_schema(language_.numerics)},
                            {"sensitivities", table_schema(language_.sensitivities)},
                            {name_, table_schema(language_.options)}};
    json schema = table_schema(language_.root, contents);
    schema["properties"]["model"]["enum"] = {name_};
    schema["required"] = {"model", "loading"};
    if (!language_.particle.empty()) schema["required"].push_back("particle");
    const auto is_required = [](const KeySpec& key) { return key.is_required; };
    if (!language_.ludwik.empty() || std::ranges::any_of(language_.material, is_required)) {
      schema["required"].push_back("material");
    }
    return schema;
  }

  const Language& language_;
  std::string name_;
};

}  // namespace

std::string scenario_schema() {
  json definitions = json::object();
  json alternatives = json::array();
  for (const Model& model : model_catalogue()) {
    ModelSchema(model).add_to(definitions);
    alternatives.push_back({{"$ref", fmt::format("#/definitions/{}", model.name)}});
  }
  const json schema{{"$schema", "http://json-schema.org/draft-07/schema#"},
                    {"title", "monograin scenario"},
                    {"type", "object"},
                    {"oneOf", std::move(alternatives)},
                    {"definitions", std::move(definitions)}};
  return schema.dump(2);
}

}  // namespace monograin
