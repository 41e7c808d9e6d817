/// A scenario: what a scenario file says, read from one or set key by key.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "monograin/faults.hpp"

namespace monograin {

/// A constant of a scenario before anything moves, with the defaults filled in.
struct Parameter {
  std::string name;
  double value = 0.0;
  std::string unit;
};

/// The keys of a scenario and their values.
///
/// Nothing is checked until it is needed: set() takes the keys in any order, validate() tells all faults at once, and
/// run() refuses a scenario that has any. A copy is independent; a const scenario may be used from many threads.
class Scenario {
 public:
  /// A scenario without keys.
  Scenario() = default;

  /// The scenario of a text in TOML.
  /// @param origin     stands for the file in messages and names the scenario; tables are sought from its folder
  /// @param overrides  what is set, as `key=value` with a value in TOML: see overrides()
  [[nodiscard]] static Scenario parse(std::string text, std::string origin = "scenario.toml",
                                      std::vector<std::string> overrides = {});

  /// Sets a key to a number in SI units, a text ("10 mm", "die"), a switch, or a list. The last value of a key counts.
  ///
  /// @param key  as in a scenario file, tables joined by dots: `material.youngs_modulus`. An index in brackets picks
  ///             from an array, counted from 0: `loading.steps[0].displacement`. One past the end appends an entry.
  Scenario& set(std::string_view key, double value);
  Scenario& set(std::string_view key, int value);
  Scenario& set(std::string_view key, bool value);
  Scenario& set(std::string_view key, std::string_view text);
  Scenario& set(std::string_view key, const char* text) { return set(key, std::string_view(text)); }
  Scenario& set(std::string_view key, std::span<const double> values);
  Scenario& set(std::string_view key, std::initializer_list<double> values) {
    return set(key, std::span(values.begin(), values.size()));
  }
  Scenario& set(std::string_view key, std::span<const std::string> texts);

  /// All faults: unknown and missing keys, types, units, ranges, values that do not go together. Empty: it can be run.
  [[nodiscard]] std::vector<Fault> validate() const;

  /// Material and what follows from it, defaults filled in, as `monograin models NAME --parameters` prints it.
  /// @throws ScenarioError with all faults
  [[nodiscard]] std::vector<Parameter> parameters() const;

  [[nodiscard]] const std::string& text() const noexcept { return text_; }
  [[nodiscard]] const std::string& origin() const noexcept { return origin_; }
  /// Keys that were set, as `key=value`, in this order.
  [[nodiscard]] const std::vector<std::string>& overrides() const noexcept { return overrides_; }

 private:
  Scenario& set_value(std::string_view key, std::string_view value);

  std::string text_;
  std::string origin_ = "scenario.toml";
  std::vector<std::string> overrides_;
};

/// Reads a scenario file. What it says is checked by validate() and by run().
/// @throws ScenarioError where the file cannot be read
[[nodiscard]] Scenario read_scenario(const std::filesystem::path& file);

}  // namespace monograin
