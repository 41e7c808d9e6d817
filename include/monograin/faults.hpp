/// Faults of a scenario and their positions in the text.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace monograin {

/// A position in a text that a user wrote: a scenario file, or an override. Lines and columns count from 1.
struct SourceLocation {
  std::string file;
  std::size_t line = 1;
  std::size_t column = 1;
};

/// One fault of a scenario, as a message for the user.
struct Fault {
  SourceLocation where;
  std::string message;
};

/// Thrown for a scenario with faults; carries all of them, ordered by position.
/// what() has a line `file:line:column: message` for each of the first twenty faults, and counts the rest.
class ScenarioError : public std::runtime_error {
 public:
  explicit ScenarioError(std::vector<Fault> faults);
  /// All faults. Functions of monograin order them by position.
  [[nodiscard]] const std::vector<Fault>& faults() const noexcept { return faults_; }

 private:
  std::vector<Fault> faults_;
};

}  // namespace monograin
