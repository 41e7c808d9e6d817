/// A scenario: the keys of a scenario file, read from one or set one by one.
#pragma once

#include <concepts>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "monograin/faults.hpp"

namespace monograin {

/// A constant of a scenario: a material parameter, or a constant that follows from the material.
struct Parameter {
  std::string name;
  double value = 0.0;
  std::string unit;
};

/// The keys of a scenario and their values.
///
/// set() checks nothing. It takes keys in any order, but the entries of an array one after the other. validate()
/// returns all faults at once, and run() refuses a scenario with faults. Copies are independent; many threads may use
/// one const scenario.
class Scenario {
 public:
  /// A scenario without keys.
  Scenario() = default;

  /// Makes a scenario of a text in TOML. The text is checked by validate() and run(), not here.
  /// @param text       content of a scenario file
  /// @param origin     file name that messages show and that names the scenario; file names in the scenario are
  ///                   relative to its folder
  /// @param overrides  keys set on top of the text, as `key=value` with a value in TOML: see overrides()
  /// @param files      texts of the files that the scenario names, by these names; no file is read then
  [[nodiscard]] static Scenario parse(std::string text, std::string origin = "scenario.toml",
                                      std::vector<std::string> overrides = {},
                                      std::optional<std::map<std::string, std::string>> files = {});

  /// Sets a key to a number in SI units, a text ("10 mm", "die"), a switch, or a list. The last value set wins.
  ///
  /// @param key  as in a scenario file, tables joined by dots: `material.youngs_modulus`. An index in brackets picks
  ///             from an array, counted from 0: `loading.steps[0].displacement`. One past the end appends an entry.
  Scenario& set(std::string_view key, double value);
  template <std::integral Integer>
  Scenario& set(std::string_view key, Integer value) {
    return set_value(key, std::to_string(value));
  }
  Scenario& set(std::string_view key, bool value);
  Scenario& set(std::string_view key, std::string_view text);
  Scenario& set(std::string_view key, const char* text) { return set(key, std::string_view(text)); }
  Scenario& set(std::string_view key, std::span<const double> values);
  Scenario& set(std::string_view key, std::initializer_list<double> values) {
    return set(key, std::span(values.begin(), values.size()));
  }
  Scenario& set(std::string_view key, std::span<const std::string> texts);
  Scenario& set(std::string_view key, std::initializer_list<std::string_view> texts) {
    return set(key, std::vector<std::string>(texts.begin(), texts.end()));
  }
  Scenario& set(std::string_view key, std::initializer_list<const char*> texts) {
    return set(key, std::vector<std::string>(texts.begin(), texts.end()));
  }

  /// All faults: unknown and missing keys, types, units, ranges, inconsistent values. Empty: the scenario can be run.
  [[nodiscard]] std::vector<Fault> validate() const;

  /// Parameters of particle and material, defaults filled in, and the constants that follow from them, as
  /// `monograin models NAME --parameters FILE` prints them.
  /// @throws ScenarioError with all faults
  [[nodiscard]] std::vector<Parameter> parameters() const;

  /// Text of the scenario file, without overrides; empty if there is none.
  [[nodiscard]] const std::string& text() const noexcept { return text_; }
  /// File name that messages show and that names the scenario.
  [[nodiscard]] const std::string& origin() const noexcept { return origin_; }
  /// Keys that were set, as `key=value` with a value in TOML, in the order of the calls.
  [[nodiscard]] const std::vector<std::string>& overrides() const noexcept { return overrides_; }
  /// Texts of the files that the scenario names, by these names; none: the files are read beside origin().
  [[nodiscard]] const std::optional<std::map<std::string, std::string>>& files() const noexcept { return files_; }

 private:
  Scenario& set_value(std::string_view key, std::string_view value);

  std::string text_;
  std::string origin_ = "scenario.toml";
  std::vector<std::string> overrides_;
  std::optional<std::map<std::string, std::string>> files_;
};

/// Reads a scenario file. Its content is checked by validate() and run(), not here.
/// @throws ScenarioError if the file cannot be read
[[nodiscard]] Scenario read_scenario(const std::filesystem::path& file);

}  // namespace monograin
