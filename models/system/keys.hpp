/// Words with which a model is used, as data: keys of scenario files, regimes and events.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "system/resolution.hpp"
#include "system/walls.hpp"

namespace monograin {

/// Physical dimension of a quantity. It fixes which unit strings are accepted; a bare number is always in SI units.
enum class Dimension {
  none,
  length,
  stress,
  surface_energy,
  stiffness,  ///< force over displacement
  force,
  time,
  velocity,
  force_rate,
  angle,
  strain_rate,  ///< rate of a strain or of another pure number
  stress_rate,
  frequency
};

/// Interval of admissible values. It contains its bounds unless they are marked open.
struct Range {
  double lower = -k_infinity;
  double upper = k_infinity;
  bool lower_is_open = false;
  bool upper_is_open = false;

  [[nodiscard]] constexpr bool contains(double value) const noexcept {
    return (lower_is_open ? value > lower : value >= lower) && (upper_is_open ? value < upper : value <= upper);
  }
};

inline constexpr Range k_positive{.lower = 0.0, .lower_is_open = true};
inline constexpr Range k_not_negative{.lower = 0.0};
/// Poisson's ratio, incompressible material included.
inline constexpr Range k_poisson_to_half{.lower = -1.0, .upper = 0.5, .lower_is_open = true};
/// Poisson's ratio of compressible material.
inline constexpr Range k_poisson_below_half{.lower = -1.0, .upper = 0.5, .lower_is_open = true, .upper_is_open = true};

/// Wall sets that a scenario may name if the model allows walls in any position.
inline constexpr std::array<std::string_view, 5> k_wall_configurations{"simple", "die", "hydrostatic", "oblique-die",
                                                                       "walls"};

/// A quantity in `[material]` (or a number in a model's own table).
struct QuantityKey {
  std::string_view name;
  std::string_view meaning;
  Dimension dimension = Dimension::none;
  Range range;
  std::optional<double> default_value{};  ///< none: the key must be given, or is optional
  bool is_optional = false;
};

/// A choice, a switch, a file name or a number in the table named after the model.
struct OptionKey {
  enum class Kind { choice, toggle, file, quantity };
  std::string_view name;
  std::string_view meaning;
  Kind kind = Kind::choice;
  std::span<const std::string_view> choices{};  ///< words of a choice; the first one is the default
  bool default_toggle = false;                  ///< default of a toggle
  Dimension dimension = Dimension::none;        ///< dimension of a quantity
  Range range{};                                ///< admissible values of a quantity
  std::optional<double> default_value{};        ///< default of a quantity; none: the quantity may be absent
  /// Columns of a file with a table of values over x and y; empty for a curve of two columns. No two rows of the table
  /// have the same x and y.
  std::span<const QuantityKey> columns{};
  std::string (*example)() = nullptr;  ///< content of an example file
};

/// A controlled quantity that a step of a model without walls may prescribe; its name is the key in the step.
struct DriveKey {
  std::string_view name;
  std::string_view meaning;
  Control control = Control::strain;
  Dimension dimension = Dimension::none;
  Range range;
  std::string_view example;  ///< value as written in a scenario file
  /// True if the key also takes `[axial, lateral]`: targets of this quantity in the first and the second channel.
  bool may_take_lateral = false;
  std::string_view column{};  ///< column of the history with the controlled quantity; empty: the column named `name`
};

/// A named material from a table of the source: values of some keys in `[material]`.
struct Preset {
  struct Value {
    std::string_view key;
    double value = 0.0;  ///< [SI]
  };
  std::string_view name;
  std::string_view source;  ///< table of the source
  std::span<const Value> values;
};

/// A regime or an event with one sentence about it.
struct Term {
  std::string_view name;
  std::string_view meaning;
};

}  // namespace monograin
