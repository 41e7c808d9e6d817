/// Faults of a scenario, and where they are written.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace monograin {

/// A place in a text that a user wrote: a file, or an override given beside it.
struct SourceLocation {
  std::string file;
  std::size_t line = 1;
  std::size_t column = 1;
};

struct Fault {
  SourceLocation where;
  std::string message;
};

/// All faults of a scenario, in the order of their places. what() has one line per fault: `file:line:column: message`.
class ScenarioError : public std::runtime_error {
 public:
  explicit ScenarioError(std::vector<Fault> faults);
  [[nodiscard]] const std::vector<Fault>& faults() const noexcept { return faults_; }

 private:
  std::vector<Fault> faults_;
};

}  // namespace monograin
