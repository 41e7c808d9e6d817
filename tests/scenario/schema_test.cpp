#include "scenario/schema.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "catalogue.hpp"
#include "scenario/json.hpp"
#include "scenario/support.hpp"
#include "support/text_file.hpp"

namespace monograin::schema_test {
namespace {

using nlohmann::json;

json good() { return *toml_as_json(k_good_scenario); }

TEST(Schema, IsADraft7Document) {
  const json schema = json::parse(scenario_schema());
  EXPECT_EQ(schema.at("$schema"), "http://json-schema.org/draft-07/schema#");
}

TEST(Schema, AcceptsEveryReadyScenario) {
  for (const auto& file : toml_files("scenarios")) {
    const auto value = toml_as_json(read_text(file));
    ASSERT_TRUE(value) << file;
    EXPECT_TRUE(schema_accepts(*value)) << file;
  }
}

TEST(Schema, DescribesEveryKeyOfTheCatalogue) {
  const json schema = json::parse(scenario_schema());
  for (const Model& model : model_catalogue()) {
    const json& properties = schema.at("definitions").at(std::string(model.name)).at("properties");
    for (const QuantityKey& key : model.material) {
      const json& property = properties.at("material").at("properties").at(std::string(key.name));
      EXPECT_EQ(property.at("description"), key.meaning);
      EXPECT_EQ(property.contains("default"), key.default_value.has_value()) << key.name;
    }
  }
}

TEST(Schema, RejectsNumbersThatAreNotFinite) {
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity()}) {
    for (const char* path : {"/particle/radius", "/material/poisson_ratio", "/loading/steps/0/displacement",
                             "/loading/steps/0/duration", "/numerics/rtol", "/output/points"}) {
      json scenario = good();
      scenario[json::json_pointer(path)] = value;
      EXPECT_FALSE(schema_accepts(scenario)) << path << " = " << value;
    }
  }
}

TEST(Schema, KnowsUnitsAndSigns) {
  const auto accepts_radius = [](const char* text) {
    json scenario = good();
    scenario["particle"]["radius"] = text;
    return schema_accepts(scenario);
  };
  for (const char* text : {"10 mm", "10mm", "+1e-3 m", ".5 um", "5 \u00b5m", "5 \u03bcm", "0.1 cm", "05. m", " 1 m "}) {
    EXPECT_TRUE(accepts_radius(text)) << text;
    EXPECT_TRUE(faults_of(with_line(4, std::string("radius = \"") + text + "\"")).empty()) << text;
  }
  for (const char* text :
       {"", "10", "-10 mm", "0 mm", "0.00 mm", "0e5 mm", "10 MM", "R0", "1 R0", "1e400 m", "nan m"}) {
    EXPECT_FALSE(accepts_radius(text)) << text;
  }
}

TEST(Schema, AcceptsADisplacementInEveryForm) {
  for (const json& value : {json("-0.1 R0"), json("R0"), json("0 R0"), json(0), json(-1e-3), json("1 um")}) {
    json scenario = good();
    scenario["loading"]["steps"][0]["displacement"] = value;
    EXPECT_TRUE(schema_accepts(scenario)) << value;
  }
}

TEST(Schema, AcceptsNestedCycles) {
  json scenario = good();
  const json step = scenario["loading"]["steps"][0];
  scenario["loading"]["steps"][0] = {{"cycle", 2}, {"steps", {step, {{"cycle", 3}, {"steps", {step}}}}}};
  EXPECT_TRUE(schema_accepts(scenario));
  scenario["loading"]["steps"][0]["steps"][1]["steps"][0].erase("duration");
  EXPECT_FALSE(schema_accepts(scenario));
}

}  // namespace
}  // namespace monograin::schema_test
