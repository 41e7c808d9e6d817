/// What each contact law is called, which keys it reads, which regimes and events it knows, and where it comes from.
///
/// The catalogue is data, and for each model what it objects to. Reading and checking scenario files, the JSON Schema
/// and `monograin models` are all made from it, so that a key is described in one place only.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "system/walls.hpp"

namespace monograin {

/// Physical dimension of a quantity; fixes which unit strings are accepted (a bare number is always SI).
enum class Dimension {
  none,
  length,
  stress,
  surface_energy,
  force,
  time,
  velocity,
  force_rate,
  angle,
  strain_rate,  ///< of strains and other pure numbers
  stress_rate
};

/// Interval of admissible values; the bounds belong to it unless they are marked open.
struct Range {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool lower_is_open = false;
  bool upper_is_open = false;

  [[nodiscard]] constexpr bool contains(double value) const noexcept {
    return (lower_is_open ? value > lower : value >= lower) && (upper_is_open ? value < upper : value <= upper);
  }
};

/// A quantity in `[material]` (or a number in a model's own table).
struct QuantityKey {
  std::string_view name;
  std::string_view meaning;
  Dimension dimension = Dimension::none;
  Range range;
  std::optional<double> default_value;  ///< none: the key must be given, or is optional
  bool is_optional = false;
};

/// A choice, a switch, a file name or a number in the table that bears the model's name.
struct OptionKey {
  enum class Kind { choice, toggle, file, quantity };
  std::string_view name;
  std::string_view meaning;
  Kind kind = Kind::choice;
  std::span<const std::string_view> choices;  ///< of a choice; the first one is the default
  bool default_toggle = false;
  Dimension dimension = Dimension::none;  ///< of a quantity, as its range and default
  Range range{};
  std::optional<double> default_value{};  ///< none: the quantity may be absent
  /// Of a file that is not a curve of two columns: the columns that are read. No two rows have the same first two.
  std::span<const QuantityKey> columns{};
};

/// A ramp that a step of a model without walls may prescribe; its name is the step's key.
struct DriveKey {
  std::string_view name;
  std::string_view meaning;
  Control control = Control::strain;
  Dimension dimension = Dimension::none;
  Range range;
  std::string_view example;  ///< as written in a file
  /// `[axial, lateral]` stands for a value of this key and one that controls the same in the second channel.
  bool may_take_lateral = false;
  std::string_view column{};  ///< of the history, that shows what it prescribes; empty: that of its name
};

/// A material of a source's table: values of keys in `[material]`, not of all of them.
struct Preset {
  struct Value {
    std::string_view key;
    double value = 0.0;  ///< [SI]
  };
  std::string_view name;
  std::string_view source;  ///< table
  std::span<const Value> values;
};

/// A regime or an event with one sentence about it.
struct Term {
  std::string_view name;
  std::string_view meaning;
};

/// What a step prescribes one channel: the end of its ramp.
struct Prescription {
  Control control = Control::displacement;
  double target = 0.0;  ///< [SI]
};

/// A step of the program of a model without walls, cycles written out.
struct PlannedStep {
  std::optional<Prescription> first{};    ///< none: what is controlled is kept
  std::optional<Prescription> lateral{};  ///< of the second channel; none: it keeps its value
  bool may_end_early = false;             ///< has a condition
};

/// What a scenario says, each value right by itself.
struct ModelInput {
  const std::map<std::string, double>& material;      ///< [SI]
  const std::map<std::string, std::string>& choices;  ///< options of kinds choice and file
  const std::map<std::string, double>& numbers;       ///< options of kind quantity [SI]
  const std::map<std::string, bool>& toggles;         ///< options of kind toggle
  std::string_view configuration;                     ///< empty where the model has none
  std::span<const PlannedStep> program;               ///< empty where there are walls
  std::string_view integrator;                        ///< as asked for
};

/// Why values do not go together.
struct Objection {
  std::string_view key;  ///< in `[material]`, in the model's own table, or `configuration`
  std::string message;
  std::optional<std::size_t> step{};  ///< of the program: the place is this step's, not that of the key
};

struct ModelInfo {
  std::string_view name;
  std::string_view summary;
  std::string_view source;
  std::span<const QuantityKey> material;
  std::span<const OptionKey> options;
  std::span<const std::string_view> configurations;  ///< empty: there is nothing to choose from
  bool has_free_centre = false;                      ///< `[loading] centre = "equilibrium"` is defined
  bool has_contact_area = true;  ///< there are contact radii, pressures, and a surface that may move
  bool has_profile = false;      ///< pressure and surface under a contact are known
  std::span<const Term> regimes;
  std::span<const Term> events;
  std::span<const std::string_view> domain;       ///< limits of validity, a sentence each
  double least_wall_angle = 0.0;                  ///< [rad], between any two walls
  std::span<const OptionKey> material_options{};  ///< options that stand in `[material]`
  /// What `preset` in `[material]` may name. Keys that are given beside it win.
  std::span<const Preset> presets{};
  /// `strength` and `hardening_exponent` may be given by Ludwik's law instead.
  bool takes_ludwik = false;
  std::vector<Objection> (*objections)(const ModelInput& given) = nullptr;  ///< null: none
  std::string_view sign{};  ///< convention of stresses and strains, where it is not that compression is positive
  /// What steps prescribe of a model that has neither particle nor walls; empty: it has both.
  std::span<const DriveKey> drives{};
  /// What such a step can prescribe besides, in a second channel, under keys of their own.
  std::span<const DriveKey> lateral_drives{};
  /// What such a step can wait for, besides events.
  std::span<const QuantityKey> conditions{};

  [[nodiscard]] bool has_walls() const noexcept { return drives.empty(); }
};

/// All models this version can run, in the order in which they are listed to users.
[[nodiscard]] std::span<const ModelInfo> model_catalogue() noexcept;

/// The entry of that name, or nullptr.
[[nodiscard]] const ModelInfo* find_model(std::string_view name) noexcept;

}  // namespace monograin
