/// Keys that are varied and the values they take. For readers of TOML files: includes the library.
#pragma once

#include <toml++/toml.h>

#include <array>
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

/// Values that lie as a probability distribution says.
struct FactorDistribution {
  enum class Shape { normal, lognormal, triangular };

  Shape shape = Shape::normal;
  /// Mean and standard deviation; median and standard deviation of the logarithm; lowest, likeliest and highest value.
  std::array<double, 3> parameters{};
  bool is_in_radii = false;

  /// The value that a share of all are below. @param share  between 0 and 1
  [[nodiscard]] FactorValue at(double share) const;
};

/// A key with what it is varied over: a range, a distribution, a list of values, or none of them where a table gives
/// the values.
struct Factor {
  std::string key;  ///< path as of `--set`
  KeySpec spec;
  SourceLocation where;
  std::optional<FactorRange> range;
  std::optional<FactorDistribution> distribution;
  std::vector<FactorValue> values;

  /// The value at a share, between 0 and 1, of what it is varied over.
  [[nodiscard]] FactorValue at(double share) const;

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

/// A design asks one of these of its factors.
enum class Levels {
  points,  ///< a grid: ranges are divided
  whole,   ///< ranges as they are
  shares,  ///< shares of anything: distributions, too
};

/// Fills what the factor is varied over from `{ from, to, points, scale }`, `{ mean, std }`, `{ lognormal }`,
/// `{ triangular }` or `{ values }`.
void read_levels(Reading& reading, const toml::table& table, const SourceLocation& place, Levels levels,
                 Factor& factor);

}  // namespace monograin
