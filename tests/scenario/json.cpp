#include "scenario/json.hpp"

#include <toml++/toml.h>

#include <sstream>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "scenario/schema.hpp"

namespace monograin {
namespace {

using nlohmann::json;

json as_json(const toml::node& node) {
  if (const auto* table = node.as_table()) {
    json object = json::object();
    for (const auto& [key, value] : *table) object[std::string(key.str())] = as_json(value);
    return object;
  }
  if (const auto* array = node.as_array()) {
    json result = json::array();
    for (const auto& value : *array) result.push_back(as_json(value));
    return result;
  }
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* integer = node.as_integer()) return integer->get();
  if (const auto* floating = node.as_floating_point()) return floating->get();
  if (const auto* boolean = node.as_boolean()) return boolean->get();
  return "a date or time";
}

class ScenarioSchema {
 public:
  ScenarioSchema() : document_(json::parse(scenario_schema())) {
    const valijson::adapters::NlohmannJsonAdapter adapter(document_);
    valijson::SchemaParser(valijson::SchemaParser::kDraft7).populateSchema(adapter, schema_);
  }

  bool accepts(const json& value) {
    const valijson::adapters::NlohmannJsonAdapter adapter(value);
    return valijson::Validator().validate(schema_, adapter, nullptr);
  }

 private:
  json document_;
  valijson::Schema schema_;
};

}  // namespace

std::optional<json> toml_as_json(std::string_view text) {
  try {
    return as_json(toml::parse(text));
  } catch (const toml::parse_error&) {
    return std::nullopt;
  }
}

bool schema_accepts(const json& value) {
  // Compiling the schema takes longer than all the checks.
  static ScenarioSchema schema;
  return schema.accepts(value);
}

}  // namespace monograin
