/// The models, as users read about them.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace monograin {

struct Model;

struct KeyInfo {
  std::string name;
  std::string meaning;
  std::string unit;                       ///< SI; "-": a pure number; empty: no number
  std::optional<double> default_value{};  ///< [SI]
  std::vector<std::string> choices{};     ///< of a word; the first one is the default
};

struct TermInfo {
  std::string name;
  std::string meaning;
};

struct ModelInfo {
  std::string name;
  std::string summary;
  std::vector<std::string> references;  ///< publications, the main one first: authors (year), title, venue, DOI
  std::string source;                   ///< where in the references the law stands, and what of them is corrected
  std::vector<KeyInfo> material;        ///< of `[material]`
  std::vector<KeyInfo> options;         ///< of the table that bears the model's name
  std::vector<std::string> configurations;
  std::vector<TermInfo> regimes;
  std::vector<TermInfo> events;
  std::vector<std::string> domain;  ///< limits of validity, a sentence each
};

/// All models, in the order in which `monograin models` lists them.
[[nodiscard]] std::vector<ModelInfo> models();

/// Adds a law of one's own as a model like the others, before a scenario is read: scenarios name it.
/// @param model  as `monograin/laws/system/model.hpp` describes it; what it refers to has to stay where it is
/// @throws std::invalid_argument where the name is taken
void add_model(const Model& model);

}  // namespace monograin
