#include "catalogue.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <set>
#include <string_view>

#include <gtest/gtest.h>

namespace monograin::catalogue_test {
namespace {

using std::string_view;

// Event names are a contract with the readers of events.csv.
constexpr auto k_contract_events = std::to_array<string_view>(
    {// contacts
     "contact-made", "contact-lost", "pull-off", "stick", "peel", "follow", "dent-touched", "impingement",
     "caps-intersect", "force-extremum",
     // material
     "yield", "fully-plastic", "low-compressibility", "zero-porosity", "secondary-onset", "load-reversal", "reload",
     "retreat", "transition", "plastic-off", "segment-change", "plastic-softening",
     // particle, program
     "growth-on", "growth-off", "jamming", "step-end", "until-met",
     // ends of the domain
     "limit", "singular-growth", "volume-limit", "radius-limit", "density-limit", "loss-of-uniqueness",
     "cap-centre-tensile", "cap-axis-nonpositive", "poisson-half", "full", "stiffening"});

constexpr auto k_configurations =
    std::to_array<string_view>({"simple", "die", "hydrostatic", "oblique-die", "walls", "triaxial", "strain-path"});

template <class Range>
bool contains(const Range& range, string_view name) {
  return std::ranges::find(range, name) != std::ranges::end(range);
}

/// Names in a list of keys or terms that are empty or occur more than once.
template <class Items>
std::set<string_view> faulty_names(const Items& items) {
  std::set<string_view> seen;
  std::set<string_view> faulty;
  for (const auto& item : items) {
    if (item.name.empty() || !seen.insert(item.name).second) faulty.insert(item.name);
  }
  return faulty;
}

using Names = std::set<string_view>;

TEST(Catalogue, FindsEveryModelByItsName) {
  ASSERT_FALSE(model_catalogue().empty());
  for (const Model& model : model_catalogue()) EXPECT_EQ(find_model(model.name), &model) << model.name;
}

TEST(Catalogue, HasAFolderOfTheNameOfEveryModel) {
  for (const Model& model : model_catalogue()) {
    const auto folder = std::filesystem::path(MONOGRAIN_SOURCE_DIR) / "models" / model.name;
    EXPECT_TRUE(std::filesystem::exists(folder / "model.cpp")) << model.name;
  }
}

TEST(Catalogue, HasNoModelOfAnUnknownName) {
  for (const string_view name : {"", "MDR", "mdr ", "herz"}) EXPECT_EQ(find_model(name), nullptr) << name;
}

TEST(Catalogue, NamesEverythingOnce) {
  EXPECT_EQ(faulty_names(model_catalogue()), Names{});
  for (const Model& model : model_catalogue()) {
    EXPECT_EQ(faulty_names(model.material), Names{}) << model.name;
    EXPECT_EQ(faulty_names(model.options), Names{}) << model.name;
    EXPECT_EQ(faulty_names(model.regimes), Names{}) << model.name;
    EXPECT_EQ(faulty_names(model.events), Names{}) << model.name;
  }
}

TEST(Catalogue, DescribesEverythingItNames) {
  for (const Model& model : model_catalogue()) {
    EXPECT_FALSE(model.summary.empty()) << model.name;
    for (const auto& key : model.material) EXPECT_FALSE(key.meaning.empty()) << model.name << ": " << key.name;
    for (const auto& key : model.options) EXPECT_FALSE(key.meaning.empty()) << model.name << ": " << key.name;
    for (const auto& term : model.regimes) EXPECT_FALSE(term.meaning.empty()) << model.name << ": " << term.name;
    for (const auto& term : model.events) EXPECT_FALSE(term.meaning.empty()) << model.name << ": " << term.name;
  }
}

TEST(Catalogue, HasTheFunctionsThatTheWorkbenchCallsOfEveryModel) {
  for (const Model& model : model_catalogue()) {
    EXPECT_EQ(fault_of(model), "");
    EXPECT_TRUE(model.draw != nullptr) << model.name;
    EXPECT_EQ(model.channels != nullptr, !model.has_walls()) << model.name;
    EXPECT_EQ(model.draw_program != nullptr, !model.has_walls()) << model.name;
  }
}

TEST(Catalogue, HasAnExampleOfEveryFileThatAnOptionNames) {
  for (const Model& model : model_catalogue()) {
    for (const OptionKey& option : model.options) {
      EXPECT_EQ(option.example != nullptr, option.kind == OptionKey::Kind::file) << model.name << "." << option.name;
    }
  }
}

TEST(Catalogue, OffersChoicesWhereItAsksForOneAndOnlyThere) {
  for (const Model& model : model_catalogue()) {
    for (const OptionKey& option : model.options) {
      EXPECT_EQ(option.choices.empty(), option.kind != OptionKey::Kind::choice) << model.name << "." << option.name;
      EXPECT_EQ(Names(option.choices.begin(), option.choices.end()).size(), option.choices.size())
          << model.name << "." << option.name;
    }
  }
}

TEST(Catalogue, HasDefaultsInsideTheirRanges) {
  for (const Model& model : model_catalogue()) {
    for (const QuantityKey& key : model.material) {
      EXPECT_TRUE(!key.default_value || key.range.contains(*key.default_value)) << model.name << ": " << key.name;
    }
    for (const OptionKey& key : model.options) {
      EXPECT_TRUE(!key.default_value || key.range.contains(*key.default_value)) << model.name << ": " << key.name;
    }
  }
}

/// True if a model with the preset has the key.
bool is_key_beside(const Preset& preset, std::string_view key) {
  return std::ranges::any_of(model_catalogue(), [&](const Model& model) {
    const bool has_preset = std::ranges::find(model.presets, preset.name, &Preset::name) != model.presets.end();
    return has_preset && std::ranges::find(model.material, key, &QuantityKey::name) != model.material.end();
  });
}

TEST(Catalogue, HasPresetsOfKeysThatTheirModelsKnow) {
  for (const Model& model : model_catalogue()) {
    EXPECT_EQ(faulty_names(model.presets), Names{}) << model.name;
    for (const Preset& preset : model.presets) {
      EXPECT_FALSE(preset.source.empty()) << preset.name;
      bool has_use = false;
      for (const auto& [name, value] : preset.values) {
        const auto key = std::ranges::find(model.material, name, &QuantityKey::name);
        if (key == model.material.end()) {  // then it is that of another model with these presets
          EXPECT_TRUE(is_key_beside(preset, name)) << model.name << ", " << preset.name << ": " << name;
          continue;
        }
        has_use = true;
        EXPECT_TRUE(key->range.contains(value)) << preset.name << ": " << name;
      }
      EXPECT_TRUE(has_use) << model.name << ": " << preset.name;
    }
  }
}

TEST(Catalogue, KnowsOnlyEventsOfTheContract) {
  for (const Model& model : model_catalogue()) {
    for (const Term& event : model.events) {
      EXPECT_TRUE(contains(k_contract_events, event.name)) << model.name << ": " << event.name;
    }
  }
}

TEST(Catalogue, KnowsOnlyWallConfigurationsOfTheLanguage) {
  for (const Model& model : model_catalogue()) {
    if (!model.has_walls()) continue;
    EXPECT_FALSE(model.configurations.empty()) << model.name;
    for (const string_view name : model.configurations) {
      EXPECT_TRUE(contains(k_configurations, name)) << model.name << ": " << name;
    }
  }
}

TEST(Range, ContainsItsBoundsUnlessTheyAreOpen) {
  constexpr Range closed{.lower = 0.0, .upper = 1.0};
  EXPECT_TRUE(closed.contains(0.0) && closed.contains(0.5) && closed.contains(1.0));
  EXPECT_FALSE(closed.contains(-0.1) || closed.contains(1.1));
  constexpr Range open{.lower = 0.0, .upper = 1.0, .lower_is_open = true, .upper_is_open = true};
  EXPECT_TRUE(open.contains(0.5));
  EXPECT_FALSE(open.contains(0.0) || open.contains(1.0));
  EXPECT_FALSE(closed.contains(std::numeric_limits<double>::quiet_NaN()));
}

}  // namespace
}  // namespace monograin::catalogue_test
