/// The keys of a scenario that name files.
#pragma once

#include <string>
#include <vector>

#include "scenario/scenario.hpp"

namespace monograin {

/// A key whose value is the name of a file.
struct FileKey {
  std::string path;  ///< as of an override
  std::string name;  ///< of the file, as the scenario has it
  std::string text;  ///< of the file
};

/// All files that a scenario names, each once: by their options, and those of its program as `loading.NAME`.
[[nodiscard]] std::vector<FileKey> named_files(const CheckedScenario& scenario);

/// The keys of all files that a scenario names: of its options, and of the tables that its steps follow.
[[nodiscard]] std::vector<FileKey> file_keys(const CheckedScenario& scenario);

}  // namespace monograin
