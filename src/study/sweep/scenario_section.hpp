/// The scenario that a sweep varies. For readers of TOML files: includes the library.
#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenario/file_keys.hpp"
#include "scenario/key_path.hpp"
#include "scenario/scenario.hpp"
#include "scenario/section.hpp"
#include "scenario/text_file.hpp"
#include "study/sweep/factor.hpp"

namespace monograin::sweep {

struct VariedScenario {
  std::optional<ScenarioTemplate> made{};  ///< none: there are faults
  std::string name{};
  std::filesystem::path folder{};     ///< of the files that it names
  std::optional<FileKey> file{};      ///< none: it is a table of the sweep file
  std::vector<std::string> models{};  ///< models over which the sweep varies
  toml::table tree{};
  double radius = 1.0;  ///< [m]; if it cannot be read, the scenario's own check reports that

  [[nodiscard]] std::string model() const { return tree["model"].value_or(std::string()); }
  /// The key in the language of the scenario's model, or of a model in the sweep.
  [[nodiscard]] KeyAnswer key(const std::string& path) const;
  /// A factor for a key, or none and a fault at its position.
  [[nodiscard]] std::optional<Factor> factor(const std::string& path, const SourceLocation& where,
                                             FaultList& faults) const;
};

/// Reads the scenario that a sweep file names or contains.
/// @param tree    of the sweep file
/// @param source  the sweep file
[[nodiscard]] VariedScenario scenario_in(Reading& reading, const Section& root, const toml::table& tree,
                                         const NamedText& source);

}  // namespace monograin::sweep
