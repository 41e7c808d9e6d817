/// Collects the faults of a scenario, so that a user sees all of them at once.
#pragma once

#include <cstddef>
#include <string>
#include <unordered_set>
#include <vector>

#include "scenario/scenario.hpp"

namespace monograin {

/// Largest number of faults that are reported for one table, and shown in one message; the rest is counted.
inline constexpr std::size_t k_most_shown_faults = 20;

class FaultList {
 public:
  /// Adds a fault, unless the list has it already. The time does not depend on the number of faults.
  void add(SourceLocation where, std::string message);
  [[nodiscard]] std::size_t size() const noexcept { return faults_.size(); }

  /// @throws ScenarioError with every fault: those of files before those of overrides, each in the order of the text
  void throw_if_any() const;

 private:
  std::vector<Fault> faults_;
  std::unordered_set<std::string> lines_;  ///< each fault as it is printed
};

/// @throws ScenarioError with this one fault
[[noreturn]] void throw_fault(SourceLocation where, std::string message);

}  // namespace monograin
