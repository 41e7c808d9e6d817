/// Keys that are varied and the values they take. For readers of TOML files: includes the library.
#pragma once

#include <toml++/toml.h>

#include <compare>
#include <optional>
#include <string>
#include <vector>

#include "scenario/language.hpp"
#include "scenario/section.hpp"

namespace monograin {

inline constexpr std::string_view k_example_range = "{ from = 0.2, to = 0.48 }";

/// A value of a key, before it is known how long the unit R0 is.
struct FactorValue {
  double number = 0.0;       ///< in SI, or in initial radii
  bool is_in_radii = false;  ///< the number counts initial radii
  std::string word{};        ///< of a key that is no number

  bool operator==(const FactorValue&) const = default;
  auto operator<=>(const FactorValue&) const = default;
};

/// All values between two.
struct FactorRange {
  FactorValue from;
  FactorValue to;
  bool is_logarithmic = false;
  int points = 2;  ///< of a grid

  /// The value at a share of the way, from 0 to 1; the ends are met exactly.
  [[nodiscard]] FactorValue at(double share) const;
  /// The share of the way at which a number is.
  [[nodiscard]] double share_of(double number) const;
};

/// A key with what it is varied over: a range, a list of values, or neither where a table gives the values.
struct Factor {
  std::string key;  ///< path as of `--set`
  KeySpec spec;
  SourceLocation where;
  std::optional<FactorRange> range;
  std::vector<FactorValue> values;

  [[nodiscard]] bool is_number() const noexcept;
  [[nodiscard]] bool is_toggle() const noexcept;
  /// SI, "-" of a pure number, empty of words.
  [[nodiscard]] std::string unit() const;
  /// Whether the range or the list, where there is one, has the value.
  [[nodiscard]] bool admits(const FactorValue& value) const;
};

/// Whether a key has a single value that can be another in every run.
[[nodiscard]] bool can_be_varied(KeySpec::Kind kind) noexcept;

struct ReadValue {
  std::optional<FactorValue> value;
  std::string problem;  ///< where there is no value: what is expected
};

/// Reads a value as it is written in a list or a table. What is out of range is read nevertheless.
/// @param unit  of a bare number; empty: SI
[[nodiscard]] ReadValue read_value(const KeySpec& spec, const std::string& text, const std::string& unit);

/// What is wrong with the unit in a column's heading; empty: nothing. No unit is SI.
[[nodiscard]] std::string unit_problem(const KeySpec& spec, const std::string& unit);

/// Fills the factor's range or values from `{ from, to, points, scale }` or `{ values }`.
/// @param is_grid  whether ranges have points
void read_levels(Reading& reading, const toml::table& table, const SourceLocation& place, bool is_grid, Factor& factor);

}  // namespace monograin
