/// What a model is given of a checked scenario, and what it derives from it.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "system/walls.hpp"

namespace monograin {

/// Control and target of the ramp that a step prescribes for one channel.
struct Prescription {
  Control control = Control::displacement;
  double target = 0.0;  ///< [SI]
};

/// A step of the program of a model without walls, cycles written out.
struct PlannedStep {
  std::optional<Prescription> first{};    ///< first channel; none: the controlled quantity keeps its value
  std::optional<Prescription> lateral{};  ///< second channel; none: the controlled quantity keeps its value
  bool may_end_early = false;             ///< true if the step has a condition
};

/// Samples from a file that an option names: a curve y(x), or a table of values over x and y.
struct SampledCurve {
  std::string text;  ///< the file as it was read
  std::vector<double> x{};
  std::vector<double> y{};
  std::vector<std::vector<double>> values{};  ///< further columns of a table, in the order of OptionKey::columns
};

/// Value of an option: toggle, quantity [SI], or the word of a choice or file name.
using OptionValue = std::variant<bool, double, std::string>;

/// A scenario as its model sees it. Each value alone is admissible; Model::objections checks them together.
struct ModelInput {
  double radius = 0.0;                                ///< R0 [m]; 0 if the model has no particle
  const std::map<std::string, double>& values;        ///< values of the keys in `[material]` [SI]
  const std::map<std::string, OptionValue>& options;  ///< options by name, defaults filled in
  const std::map<std::string, SampledCurve>& curves;  ///< content of the files, by the option that names the file
  std::string_view configuration{};                   ///< wall set; empty if the model has none
  bool centre_is_free = false;         ///< true if the forces on the particle determine the position of its centre
  std::vector<PlannedStep> program{};  ///< program of a model without walls; empty with walls
  std::string_view integrator{};       ///< integrator that the scenario names, before `auto` is resolved

  /// Value of a key in `[material]` [SI]. @throws std::out_of_range if the scenario has no such key
  [[nodiscard]] double material(const char* key) const {
    const auto found = values.find(key);
    if (found != values.end()) return found->second;
    throw std::out_of_range(std::string("the law asks for '") + key + "', which is no key of its [material]");
  }
  /// Value of a key in `[material]` [SI]; none if the scenario has no such key.
  [[nodiscard]] std::optional<double> optional_material(const char* key) const {
    const auto found = values.find(key);
    return found == values.end() ? std::nullopt : std::optional(found->second);
  }
  /// Value of an option of kind quantity [SI]; none if it is absent.
  [[nodiscard]] std::optional<double> number(const char* key) const {
    const auto found = options.find(key);
    return found == options.end() ? std::nullopt : std::optional(std::get<double>(found->second));
  }
  /// Word of an option of kind choice, or file name of an option of kind file.
  [[nodiscard]] const std::string& word(const char* key) const { return std::get<std::string>(options.at(key)); }
  [[nodiscard]] bool toggle(const char* key) const { return std::get<bool>(options.at(key)); }
  [[nodiscard]] const SampledCurve* curve(const char* key) const {
    const auto found = curves.find(key);
    return found == curves.end() ? nullptr : &found->second;
  }
  /// Value of an option of kind choice as an enumerator, by a table of words and enumerators.
  /// @throws std::logic_error if the table lacks the word
  template <class Enum, std::size_t N>
  [[nodiscard]] Enum choice(const char* key, const std::pair<const char*, Enum> (&table)[N]) const {
    for (const auto& [name, value] : table) {
      if (word(key) == name) return value;
    }
    throw std::logic_error(std::string("option ") + key + " = '" + word(key) + "' was checked but is not bound");
  }
};

/// A fault of a scenario whose values are inconsistent, though each is admissible.
struct Objection {
  std::string_view key;  ///< key in `[material]` or in the model's own table, or `configuration`
  std::string message;
  std::optional<std::size_t> step{};  ///< index of a step; if given, the message points to this step, not to the key
};

/// Contact classes of a scene and their ramps in the first step. The ramp of a wall at rest ends where it starts.
struct FirstStep {
  std::span<const ContactClass> classes;
  std::span<const Ramp> ramps;  ///< one for each class [SI]
};

/// A constant that follows from the material of a scenario, before the program starts.
struct DerivedParameter {
  std::string_view name;
  double value = 0.0;
  std::string_view unit;
  std::string_view symbol{};  ///< symbol in the source; empty: none
};

/// Lists keys of `[material]` with their values, as constants with the given units. Keys that the scenario lacks are
/// left out.
[[nodiscard]] std::vector<DerivedParameter> material_parameters(
    const ModelInput& input, std::initializer_list<std::pair<const char*, std::string_view>> keys);

}  // namespace monograin
