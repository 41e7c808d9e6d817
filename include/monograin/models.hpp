/// Descriptions of the models: keys, regimes, events, limits and sources.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace monograin {

struct Model;

/// A key of a scenario file that a model reads.
struct KeyInfo {
  std::string name;
  std::string meaning;
  std::string unit;                       ///< SI; "-": a pure number; empty: the value is not a number
  std::optional<double> default_value{};  ///< [SI]; none: the key is required, optional, or not a number
  std::vector<std::string> choices{};     ///< admissible words, the default first; empty: the value is not a choice
};

/// A regime or an event of a model, with one sentence about it.
struct TermInfo {
  std::string name;
  std::string meaning;
};

/// Description of one model.
struct ModelInfo {
  std::string name;
  std::string summary;
  std::vector<std::string> references;      ///< publications, the main one first: authors (year), title, venue, DOI
  std::string source;                       ///< equations of the references that give the law, and misprints corrected
  std::vector<KeyInfo> material;            ///< keys of the table `[material]`
  std::vector<KeyInfo> options;             ///< keys of the table named after the model
  std::vector<std::string> configurations;  ///< wall sets that a scenario may name; empty: there is no choice
  std::vector<TermInfo> regimes;
  std::vector<TermInfo> events;
  std::vector<std::string> domain;  ///< limits of validity, a sentence each
};

/// Descriptions of all models, in the order in which `monograin models` lists them.
[[nodiscard]] std::vector<ModelInfo> models();

/// Adds your own law as a model that scenarios can name. Call it before the first scenario is read.
/// @param model  described in `monograin/laws/system/model.hpp`; the texts and arrays that its views and spans point to
///               must outlive the program's use of monograin
/// @throws std::invalid_argument if the name is taken
void add_model(const Model& model);

}  // namespace monograin
